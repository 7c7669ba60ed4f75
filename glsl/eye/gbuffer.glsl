// Reading the G-buffer: the surface that an eye sample sees, made again from what is stored.
#ifndef GBUFFER_GLSL
#define GBUFFER_GLSL

#include "shared/frame.glsl"
#include "shared/interface.glsl"

layout(set = 0, binding = 8) uniform usampler2D eye_gbuffer;

layout(push_constant, scalar) uniform Push {
    ivec2 size;  // pixels of the picture
    int samples; // k: k^2 samples a pixel
} push;

// Texel of sample k (0 <= k < samples^2) of the pixel.
ivec2 sample_texel(ivec2 pixel, int k) {
    return pixel * push.samples + ivec2(k % push.samples, k / push.samples);
}

// The eye's ray through a sample.
void eye_ray(ivec2 texel, out vec3 o, out vec3 d) {
    view_ray(frame.data.eye, (vec2(texel) + 0.5) / vec2(push.size * push.samples), o, d);
}

// The surface under a sample, and the eye ray; false where the eye sees nothing.
bool eye_surface(ivec2 texel, out Surface s, out vec3 d) {
    uvec4 seen = texelFetch(eye_gbuffer, texel, 0);
    if (seen.x == 0u) return false;
    vec3 o;
    eye_ray(texel, o, d);
    s = surface_seen(seen, o, d);
    return true;
}

#endif

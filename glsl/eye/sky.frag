#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The sky where the eye sees nothing else, the mean of a pixel's samples. What is seen by way of glass, water and mirrors
// `eye/trace` adds.

#include "eye/gbuffer.glsl"
#include "eye/sky.glsl"

layout(location = 0) out vec4 sky;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    sky = vec4(0.0);
    int samples = push.samples * push.samples;
    for (int k = 0; k < samples; k++) {
        ivec2 texel = sample_texel(pixel, k);
        if (texelFetch(eye_gbuffer, texel, 0).x != 0u) continue;
        vec3 o, d;
        eye_ray(texel, o, d);
        sky.rgb += sky_seen(d, innermost(frame.data.eye_media));
    }
    sky /= float(samples);
}

#version 460

// Radiance is the sum of its layers.

layout(set = 0, binding = 8) uniform sampler2D layer_direct;
#ifdef CAUSTIC
layout(set = 0, binding = 9) uniform sampler2D layer_caustic;
#endif
#ifdef SKY
layout(set = 0, binding = 10) uniform sampler2D layer_sky;
#endif

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    radiance = vec4(texelFetch(layer_direct, pixel, 0).rgb, 1.0);
#ifdef CAUSTIC
    radiance.rgb += texelFetch(layer_caustic, pixel, 0).rgb;
#endif
#ifdef SKY
    radiance.rgb += texelFetch(layer_sky, pixel, 0).rgb;
#endif
}

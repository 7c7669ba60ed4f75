#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Slot `surface` seen by the eye: what a provider's `surface_irradiance` says, the mean of a pixel's samples.

#include "eye/gbuffer.glsl"
#include "eye/medium.glsl"
#include "shared/albedo.glsl"
#include "provider.glsl"

layout(location = 0) out vec4 irradiance;
layout(location = 1) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    irradiance = vec4(0.0);
    radiance = vec4(0.0);
    int samples = push.samples * push.samples;
#ifdef SEARCHES
    int begun = 0; // less than all where the device ends this loop too
#endif
    for (int k = 0; k < samples; k++) {
#ifdef SEARCHES
        begun++;
#endif
        Surface s;
        vec3 d;
        if (!eye_surface(sample_texel(pixel, k), s, d)) continue;
        Material m = scene_materials.data[s.material];
        if (m.kind != MATERIAL_DIFFUSE) continue;
#ifdef SEARCHES
        search_cut = false;
#endif
        vec3 e = surface_irradiance(s.p, facing_normal(s, d), s.object, s.uv);
        irradiance.rgb += e;
#ifdef SEARCHES
        irradiance.a += search_cut ? 1.0 : 0.0; // read back alone: no layer has it
#endif
        radiance.rgb += e * albedo(s) / PI * eye_transmits(s.p);
    }
#ifdef SEARCHES
    irradiance.a += float(samples - begun);
#endif
    irradiance /= float(samples);
    radiance /= float(samples);
}

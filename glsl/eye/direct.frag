#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Direct light of a pixel, the mean of its samples: irradiance and radiance. Alpha of the irradiance is the mask: the
// share of the pixel that looks at a specular object.

#include "eye/direct.glsl"
#include "eye/gbuffer.glsl"
#include "eye/medium.glsl"
#include "shared/albedo.glsl"

layout(location = 0) out vec4 irradiance;
layout(location = 1) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    irradiance = vec4(0.0);
    radiance = vec4(0.0);
    int samples = push.samples * push.samples;
    for (int k = 0; k < samples; k++) {
#ifdef AREA_SAMPLES
        eye_sample = k;
        eye_samples = samples;
#endif
        Surface s;
        vec3 d;
        if (!eye_surface(sample_texel(pixel, k), s, d)) continue;
        Material m = scene_materials.data[s.material];
        if (m.kind != MATERIAL_DIFFUSE) {
            irradiance.a += 1.0;
            continue;
        }
        vec3 e = direct_irradiance(s, d);
        irradiance.rgb += e;
        radiance.rgb += e * albedo(s) / PI * eye_transmits(s.p);
    }
    irradiance /= float(samples);
    radiance /= float(samples);
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Pixels that look at or through specular objects: the Fresnel tree, exact, to DEPTH events a path, added to the
// radiance of direct light, of the caustic and of the sky. What lies deeper is not seen.

#include "eye/direct.glsl"
#include "eye/gbuffer.glsl"
#include "eye/medium.glsl"
#include "shared/albedo.glsl"
#include "provider.glsl"
#ifdef SKY
#include "eye/sky.glsl"
#endif

layout(location = 0) out vec4 direct;
#ifdef CAUSTIC
layout(location = 1) out vec4 caustic;
#else
vec4 caustic; // no provider: nothing to write
#endif
#ifdef SKY
layout(location = SKY_LOCATION) out vec4 sky;
#endif

const float FAINT = 1e-4; // a branch that carries less of what the eye sees is left

struct Branch {
    vec3 o;
    vec3 d;
    vec3 share; // of the radiance at its end that reaches the eye
    uint media;
    int events;
};

Branch branches[DEPTH + 2];
int branch_count = 0;

void follow(Surface s, vec3 d, vec3 share, uint media, int events) {
    if (branch_count >= DEPTH + 2 || !(max(share.r, max(share.g, share.b)) > FAINT)) return;
    branches[branch_count++] = Branch(leave(s, d), d, share, media, events);
}

// One specular surface: its reflected and refracted rays. L/n^2 is invariant across an interface. A surface between two
// shapes of one material is passed, and counts as an event.
void split(Surface s, vec3 d, vec3 share, uint media, int events) {
    Material m = scene_materials.data[s.material];
    uint bent = 0u;
    float reflectance;
    vec3 reflected, refracted;
    if (is_opaque_mirror(m)) {
        bend_reflect(s, d, 1.0, 1.0, reflected, reflectance, bent);
        follow(s, reflected, share * mirror_share(m, d, reflected, media), media, events + 1);
        return;
    }
    uint beyond = media_beyond(s, d, media);
    if (innermost(beyond) == innermost(media)) {
        follow(s, d, share, beyond, events + 1);
        return;
    }
    float from = medium_ior(innermost(media));
    float to = medium_ior(innermost(beyond));
    // One reflectance for both branches, so that they share out just what came.
    if (bend_refract(s, d, from, to, refracted, reflectance, bent)) {
        float scale = from / to;
        follow(s, refracted, share * (1.0 - reflectance) * scale * scale, beyond, events + 1);
    }
    float of_reflection;
    bend_reflect(s, d, from, to, reflected, of_reflection, bent);
    follow(s, reflected, share * reflectance, media, events + 1);
}

void look(Surface s, vec3 d) {
    split(s, d, of_traced_bands(eye_transmits(s.p)), media_before(s, d, frame.data.eye_media), 0);
    while (branch_count > 0) {
        Branch b = branches[--branch_count];
        Hit hit;
        if (!trace(b.o, b.d, FAR, MASK_ALL, hit)) {
#ifdef SKY
            sky.rgb += b.share * sky_seen(b.d, innermost(b.media));
#endif
            continue;
        }
        Surface at = surface_at(b.o, b.d, hit);
        Material m = scene_materials.data[at.material];
        vec3 share = b.share * medium_transmits(innermost(b.media), hit.t);
        if (m.kind == MATERIAL_DIFFUSE) {
            share *= albedo(at) / PI;
            direct.rgb += share * direct_irradiance(at, b.d);
#ifdef SEARCHES
            search_cut = false;
#endif
            caustic.rgb += share * surface_irradiance(at.p, facing_normal(at, b.d), at.object, at.uv);
#ifdef SEARCHES
            caustic.a += search_cut ? 1.0 : 0.0; // read back alone: no layer has it
#endif
        } else if (b.events < DEPTH) {
            split(at, b.d, share, b.media, b.events);
        }
    }
#ifdef SEARCHES
    caustic.a += float(branch_count); // none, but where the device ends this loop too
    branch_count = 0;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    direct = vec4(0.0);
    caustic = vec4(0.0);
#ifdef SKY
    sky = vec4(0.0);
#endif
    int samples = push.samples * push.samples;
#ifdef SEARCHES
    int begun = 0; // as in surface.frag
#endif
    for (int k = 0; k < samples; k++) {
#ifdef SEARCHES
        begun++;
#endif
#ifdef AREA_SAMPLES
        eye_sample = k;
        eye_samples = samples;
#endif
        Surface s;
        vec3 d;
        if (!eye_surface(sample_texel(pixel, k), s, d)) continue;
        if (scene_materials.data[s.material].kind == MATERIAL_DIFFUSE) continue;
#ifdef DISPERSIVE
        for (traced_band = 0; traced_band < 3; traced_band++) look(s, d);
#else
        look(s, d);
#endif
    }
#ifdef SEARCHES
    caustic.a += float(samples - begun);
#endif
    direct /= float(samples);
    caustic /= float(samples);
#ifdef SKY
    sky /= float(samples);
#endif
}

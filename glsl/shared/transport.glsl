// Light on its way: through which medium, and how much of it is left.
#ifndef TRANSPORT_GLSL
#define TRANSPORT_GLSL

#include "shared/surface.glsl"

const float PI = 3.14159265358979;
const float FAR = 3.0e38;            // m, beyond everything

// A medium is named by its material. The media about a point are packed in bytes, the innermost lowest: of more than four
// the outermost is forgotten. A material twice is one medium.
const uint MEDIUM_AIR = 0xffu;
const uint MEDIA_NONE = 0xffffffffu;

uint innermost(uint media) {
    return media & 0xffu;
}

uint media_entered(uint media, uint material) {
    return media << 8 | material;
}

// Without the innermost one of this material.
uint media_left(uint media, uint material) {
    for (int k = 0; k < 32; k += 8) {
        if ((media >> k & 0xffu) != material) continue;
        uint inner = (1u << k) - 1u;
        return (media & inner) | ((media >> 8 | 0xff000000u) & ~inner);
    }
    return media;
}

bool media_hold(uint media, uint material) {
    return media_left(media, material) != media;
}

// The band that is traced; where nothing is dispersive, all bands are traced as one.
#ifdef DISPERSIVE
int traced_band = 0;
#else
const int traced_band = 0;
#endif

float medium_ior(uint medium) {
    return medium == MEDIUM_AIR ? 1.0 : scene_materials.data[medium].ior[traced_band];
}

// All bands, or the one that is traced alone.
vec3 of_traced_bands(vec3 bands) {
#ifdef DISPERSIVE
    return mix(vec3(0.0), bands, equal(ivec3(0, 1, 2), ivec3(traced_band)));
#else
    return bands;
#endif
}

bool is_opaque_mirror(Material m) {
    return m.kind == MATERIAL_MIRROR || m.kind == MATERIAL_CONDUCTOR;
}

// What a mirror sends back of light that came along d and goes on along r, from within these media.
vec3 mirror_share(Material m, vec3 d, vec3 r, uint media) {
    if (m.kind == MATERIAL_MIRROR) return m.colour;
    float cosine = sqrt(max(0.5 - 0.5 * dot(d, r), 0.0));
    vec3 share = vec3(0.0);
    uint medium = innermost(media);
    for (int band = 0; band < 3; band++) {
        float n = medium == MEDIUM_AIR ? 1.0 : scene_materials.data[medium].ior[band];
        share[band] = fresnel_conductor(cosine, m.ior[band] / n, m.absorption[band] / n);
    }
    return share;
}

// The media on the far side of a dielectric surface that a ray along d meets.
uint media_beyond(Surface s, vec3 d, uint media) {
    return dot(d, s.ng) < 0.0 ? media_entered(media, s.material) : media_left(media, s.material);
}

// The media before the first surface that a ray meets: where it meets the inside of a dielectric that was not known to hold
// it (from infinity, or through a hole), it is in that too.
uint media_before(Surface s, vec3 d, uint media) {
    bool inside = scene_materials.data[s.material].kind == MATERIAL_DIELECTRIC && dot(d, s.ng) > 0.0;
    return inside && !media_hold(media, s.material) ? media_entered(media, s.material) : media;
}

// What a medium lets pass on a way.
vec3 medium_transmits(uint medium, float metres) {
    return medium == MEDIUM_AIR ? vec3(1.0) : absorb(scene_materials.data[medium].absorption, metres);
}

#endif

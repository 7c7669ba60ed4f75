// The photon image's columns, fetched.
#ifndef PHOTONS_GLSL
#define PHOTONS_GLSL

#ifdef LAYERS
#define PHOTON_SAMPLER sampler2DArray
#define PHOTON_PLACE(texel, layer) ivec3(texel, layer)
const int PHOTONS = LAYERS; // of a sample
#else
#define PHOTON_SAMPLER sampler2D
#define PHOTON_PLACE(texel, layer) texel
const int PHOTONS = 1;
#endif

layout(set = 0, binding = 8) uniform PHOTON_SAMPLER photons_hit;
layout(set = 0, binding = 9) uniform PHOTON_SAMPLER photons_flux;

vec4 hit_at(ivec2 texel, int layer) {
    return texelFetch(photons_hit, PHOTON_PLACE(texel, layer), 0);
}

vec4 flux_at(ivec2 texel, int layer) {
    return texelFetch(photons_flux, PHOTON_PLACE(texel, layer), 0);
}

int photons_side() {
    return textureSize(photons_hit, 0).x;
}

#endif

// From a photon to its splat: where in which layer of the map, and with which flux. Both ways to sum splats share it.
#ifndef PHOTON_SPLAT_GLSL
#define PHOTON_SPLAT_GLSL

#include "maps/views.glsl"
#include "shared/photon.glsl"
#include "shared/splat.glsl"

#ifdef LAYERS
layout(set = 0, binding = 8) uniform sampler2DArray photons_hit;
layout(set = 0, binding = 9) uniform sampler2DArray photons_flux;
#define PHOTON_PLACE(texel, layer) ivec3(texel, layer)
#else
layout(set = 0, binding = 8) uniform sampler2D photons_hit;
layout(set = 0, binding = 9) uniform sampler2D photons_flux;
#define PHOTON_PLACE(texel, layer) texel
#endif

struct Splat {
    vec3 flux;   // W, already divided by the sum of the weights
    vec2 centre; // texels
    int layer;
};

// False if no map takes the photon, or there is none.
bool splat_of(ivec2 texel, int photon_layer, uint light, int side, float diameter, out Splat s) {
    s = Splat(vec3(0.0), vec2(0.0), 0);
    vec4 hit = texelFetch(photons_hit, PHOTON_PLACE(texel, photon_layer), 0);
    if (hit.w == 0.0) return false;
    vec4 flux = texelFetch(photons_flux, PHOTON_PLACE(texel, photon_layer), 0);
    vec2 xy01;
    uint receiver = uint(hit.w) - 1u;
    int layer = map_layer(hit.xyz, photon_normal(flux.w), receiver, light, xy01);
    if (layer < 0) return false;
    vec2 p = vec2(splat_snap(xy01.x * float(side)), splat_snap(xy01.y * float(side)));
    p = min(p, vec2(float(side) - 1.0 / SPLAT_GRID)); // the centre stays inside: points are clipped by it
    float norm = splat_norm(p.x, diameter, side) * splat_norm(p.y, diameter, side);
    if (!(norm > 0.0)) return false;
    s = Splat(flux.rgb / norm, p, layer);
    return true;
}

#endif

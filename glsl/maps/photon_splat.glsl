// From a photon to its splat: where in which layer of the map, and with which flux. All ways to gather share it.
#ifndef PHOTON_SPLAT_GLSL
#define PHOTON_SPLAT_GLSL

#include "maps/views.glsl"
#include "shared/photon.glsl"
#include "shared/splat.glsl"

struct Splat {
    vec3 flux;   // W, already divided by the sum of the weights
    vec2 centre; // texels
    int layer;
};

// From its columns. False if no map takes the photon, or there is none.
bool splat_of(vec4 hit, vec4 flux, uint light, int side, float diameter, out Splat s) {
    s = Splat(vec3(0.0), vec2(0.0), 0);
    if (hit.w == 0.0) return false;
    vec2 xy01;
    uint receiver = uint(hit.w) - 1u;
    int layer = map_layer(hit.xyz, photon_normal(flux.w), receiver, light, xy01);
    if (layer < 0) return false;
    vec2 p = vec2(splat_snap(xy01.x * float(side)), splat_snap(xy01.y * float(side)));
    p = min(p, vec2(float(side) - 1.0 / SPLAT_GRID)); // the centre stays inside: points are clipped by it
    float norm = splat_norm(p.x, diameter, side) * splat_norm(p.y, diameter, side);
    if (!(norm > 0.0)) return false;
    s = Splat(photon_flux(flux.rgb) / norm, p, layer);
    return true;
}

#endif

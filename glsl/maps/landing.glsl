// Where a photon lands in the map.
#ifndef LANDING_GLSL
#define LANDING_GLSL

#include "maps/views.glsl"
#include "shared/photon.glsl"

// A photon in its map.
struct Landed {
    vec3 p;
    vec3 n;
    uint receiver;
    vec2 xy01;
    int map; // of the views
};

// From its columns. False if no map takes a photon of this light, or there is none.
bool landing_of(vec4 hit, float normal, uint light, out Landed l) {
    l = Landed(hit.xyz, vec3(0.0), 0u, vec2(0.0), -1);
    if (hit.w == 0.0) return false;
    l.n = photon_normal(normal);
    l.receiver = uint(hit.w) - 1u;
    l.map = map_view(l.p, l.n, l.receiver, light, l.xy01);
    return l.map >= 0;
}

#endif

// The caustic map's views: one layer each. Where a world point lies in a map, and whether the map looks at its side.
#ifndef MAPS_VIEWS_GLSL
#define MAPS_VIEWS_GLSL

#include "shared/view.glsl"

layout(set = 0, binding = 13, scalar) readonly buffer MapViews { View data[]; } maps_views;

// The layer that light `light` deposits in: its own, or the one that all share.
uint map_layer(uint light) {
    return min(light, uint(maps_views.data.length()) - 1u);
}

// True if the surface at p with geometric normal n faces the view; xy01 where it is seen.
bool map_project(View v, vec3 p, vec3 n, out vec2 xy01) {
    if (!view_project(v, p, xy01)) return false;
    vec3 towards = v.perspective != 0u ? p - v.origin : v.forward;
    return dot(n, towards) < 0.0;
}

// A photon is the map's if the texel it lands on is.
bool map_captures(View v, vec3 p, vec3 n, out vec2 xy01) {
    return map_project(v, p, n, xy01) && all(greaterThanEqual(xy01, vec2(0.0))) && all(lessThan(xy01, vec2(1.0)));
}

#endif

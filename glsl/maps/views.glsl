// The caustic map's views: one layer each. Where a world point lies in a map, and whether the map looks at its side.
#ifndef MAPS_VIEWS_GLSL
#define MAPS_VIEWS_GLSL

#include "shared/view.glsl"

const uint ANY = 0xffffffffu;

struct MapView {
    View view;
    uint receiver; // the object whose light the layer holds, or ANY
    uint light;    // the light whose photons it takes, or ANY
};

layout(set = 0, binding = 13, scalar) readonly buffer MapViews { MapView data[]; } maps_views;

// True if the surface at p with geometric normal n faces the view; xy01 where it is seen.
bool map_project(View v, vec3 p, vec3 n, out vec2 xy01) {
    if (!view_project(v, p, xy01)) return false;
    vec3 towards = v.perspective != 0u ? p - v.origin : v.forward;
    return dot(n, towards) < 0.0;
}

// A photon is the map's if it lies on the map's receiver and the texel it lands on is the map's.
bool map_captures(MapView map, vec3 p, vec3 n, uint receiver, out vec2 xy01) {
    xy01 = vec2(0.0);
    if (map.receiver != ANY && map.receiver != receiver) return false;
    return map_project(map.view, p, n, xy01) && all(greaterThanEqual(xy01, vec2(0.0))) && all(lessThan(xy01, vec2(1.0)));
}

// The layer that takes a photon of this light, and where it lands in it; -1 if none does.
int map_layer(vec3 p, vec3 n, uint receiver, uint light, out vec2 xy01) {
    for (int layer = 0; layer < maps_views.data.length(); layer++) {
        MapView map = maps_views.data[layer];
        if ((map.light == ANY || map.light == light) && map_captures(map, p, n, receiver, xy01)) return layer;
    }
    xy01 = vec2(0.0);
    return -1;
}

#endif

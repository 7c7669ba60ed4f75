// The caustic map's views. Where a world point lies in a map, and what of its light the map takes.
#ifndef MAPS_VIEWS_GLSL
#define MAPS_VIEWS_GLSL

#include "shared/view.glsl"

const uint ANY = 0xffffffffu;

// Which sides of surfaces a view takes.
const uint SIDES_FACING = 0u; // those that face it, whole
const uint SIDES_AWAY = 1u;   // those turned away from it, whole
const uint SIDES_SHARED = 2u; // those that face it, by the square of the cosine: views along three axes take all of what faces them

struct MapView {
    View view;
    uint receiver; // the object whose light it takes, or ANY
    uint light;    // the light whose photons it takes, or ANY
    uint layer;    // of the map
    uint sides;
    vec2 low;      // its window in the layer, 0..1
    vec2 high;
};

layout(set = 0, binding = 13, scalar) readonly buffer MapViews { MapView data[]; } maps_views;

// What of the light of the surface at p with geometric normal n the view takes, 0..1; xy01 where it is seen in the layer.
float map_share(MapView map, vec3 p, vec3 n, out vec2 xy01) {
    View v = map.view;
    if (!view_project(v, p, xy01)) return 0.0;
    vec3 towards = v.perspective != 0u ? p - v.origin : v.forward;
    float facing = -dot(n, towards);
    if (map.sides == SIDES_AWAY) facing = -facing;
    if (!(facing > 0.0)) return 0.0;
    return map.sides == SIDES_SHARED ? min(facing * facing, 1.0) : 1.0;
}

// Whether a view takes light of this receiver, and of this light; it is asked of all, and little is read of most.
bool map_is_of(int map, uint receiver, uint light) {
    uint wanted = maps_views.data[map].receiver, sender = maps_views.data[map].light;
    return (wanted == ANY || wanted == receiver) && (light == ANY || sender == ANY || sender == light);
}

bool map_holds(MapView map, vec2 xy01) {
    return all(greaterThanEqual(xy01, map.low)) && all(lessThan(xy01, map.high));
}

// 0..1, a number of the place: as good as chance.
float map_chance(vec3 p) {
    uvec3 bits = floatBitsToUint(p) * uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);
    uint h = bits.x ^ (bits.y >> 7) ^ (bits.z << 9);
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    return float((h ^ (h >> 16)) >> 8) * 5.9604645e-8; // 2^-24
}

// The view that takes a photon of this light, and where it lands in its layer; -1 if none does. Of several that share it
// one takes it whole, by chance: a view has as much of the light as is its share.
int map_view(vec3 p, vec3 n, uint receiver, uint light, out vec2 xy01) {
    int found = -1;
    float chance = 0.0;
    xy01 = vec2(0.0);
    for (int k = 0; k < maps_views.data.length(); k++) {
        if (!map_is_of(k, receiver, light)) continue;
        MapView map = maps_views.data[k];
        vec2 at;
        float share = map_share(map, p, n, at);
        if (!(share > 0.0) || !map_holds(map, at)) continue;
        if (found < 0) chance = map_chance(p);
        found = k;
        xy01 = at;
        chance -= share;
        if (chance < 0.0) break; // the last has what rounding leaves
    }
    return found;
}

#endif

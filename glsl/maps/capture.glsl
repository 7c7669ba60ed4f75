// Which photons the caustic map takes: the account calls it, as the gather does.
#include "maps/views.glsl"

bool captured(vec3 p, vec3 n, uint receiver, uint light) {
    for (int layer = 0; layer < maps_views.data.length(); layer++) {
        MapView map = maps_views.data[layer];
        vec2 xy01;
        if (map.light == ANY || map.light == light) return map_captures(map, p, n, receiver, xy01);
    }
    return false;
}

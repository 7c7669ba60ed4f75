// Which photons the caustic map takes: the account calls it, as the gather does.
#include "maps/views.glsl"

bool captured(vec3 p, vec3 n, uint receiver, uint light) {
    vec2 xy01;
    return map_view(p, n, receiver, light, xy01) >= 0;
}

// Where a photon lands in the caustic map, 0..1, and which of its views takes it; -1 if none does.
#include "maps/landing.glsl"

int measured(vec4 hit, float normal, uint light, out vec2 xy01) {
    Landed l;
    xy01 = vec2(0.0);
    if (!landing_of(hit, normal, light, l)) return -1;
    xy01 = l.xy01;
    return l.map;
}

// Whether children fall into one texel of one map (Wyman 2008, section 3.2).
#ifndef CONVERGE_GLSL
#define CONVERGE_GLSL

#include "maps/landing.glsl"

const ivec3 NO_TEXEL = ivec3(-1);

// Takes a child, by its columns, to those before, which fall into `common_texel`. One that is invalid falls nowhere; but a
// valid one may be the mean of few photons, which the factor 4^i then counts as all.
bool falls_into(vec4 hit, float normal, uint light, int map_side, inout ivec3 common_texel) {
    Landed l;
    if (!landing_of(hit, normal, light, l)) return false;
    ivec3 place = ivec3(ivec2(floor(l.xy01 * float(map_side))), l.map);
    if (common_texel != NO_TEXEL && place != common_texel) return false;
    common_texel = place;
    return true;
}

#endif

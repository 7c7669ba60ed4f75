// Photons at every level: the photon image at 0, above it the pyramid (`maps/pyramid.comp`), a quarter as many a level.
// Its levels lie below each other in one image.
#ifndef LEVELS_GLSL
#define LEVELS_GLSL

#include "maps/photons.glsl"

int level_side(int n, int level) {
    return (n + (1 << level) - 1) >> level;
}

// Whether all that a texel of a level covers lies in the image. Where sides are rounded up, some of it does not: photons that are
// none, and fall nowhere.
bool is_whole(int n, int level, ivec2 at) {
    return all(lessThanEqual((at + 1) << level, ivec2(n)));
}

// In the place of the counts of splats below the four children of a texel: it is one splat itself.
const uvec4 OWN = uvec4(0x80000000u, 0u, 0u, 0u);

// Splats below a texel.
uint splats_of(uvec4 below) {
    return below == OWN ? 1u : below.x + below.y + below.z + below.w;
}

// Where a texel of a level, from 1 on, lies in the pyramid over n x n photons. Levels begin at 2 a (1 - 2^-(level - 1)),
// a the first one's side, and two rows each for sides that are rounded up.
ivec2 pyramid_place(int n, int level, ivec2 at) {
    int twice = 2 * level_side(n, 1);
    return at + ivec2(0, twice - (twice >> (level - 1)) + 2 * (level - 1));
}

#ifndef PYRAMID_WRITTEN
#ifdef MERGE
layout(set = 0, binding = 14) uniform sampler2DArray pyramid_hit;
layout(set = 0, binding = 15) uniform sampler2DArray pyramid_flux;
#elif defined(EXACT)
layout(set = 0, binding = 14) uniform sampler2DArray pyramid_flux;
layout(set = 0, binding = 15) uniform sampler2DArray pyramid_mean;
layout(set = 0, binding = 16) uniform sampler2DArray pyramid_bounds;
layout(set = 0, binding = 17) uniform sampler2DArray pyramid_lean;
#elif defined(TRAVERSE)
layout(set = 0, binding = 14) uniform sampler2DArray pyramid_valid;
#endif

#ifdef POINTS
layout(set = 0, binding = 18) uniform usampler2DArray pyramid_points;
#endif

ivec3 above(ivec2 at, int level, int layer) {
    return ivec3(pyramid_place(photons_side(), level, at), layer);
}

// Columns at a level. Of what does not merge, only the photons themselves are asked for.
vec4 hit_of(ivec2 at, int level, int layer) {
#ifdef MERGE
    if (level > 0) return texelFetch(pyramid_hit, above(at, level, layer), 0);
#endif
    return hit_at(at, layer);
}

vec4 flux_of(ivec2 at, int level, int layer) {
#ifdef MERGE
    if (level > 0) return texelFetch(pyramid_flux, above(at, level, layer), 0);
#endif
    return flux_at(at, layer);
}
#endif

#endif

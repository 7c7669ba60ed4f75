#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// How many splats come before each texel of the topmost level, and after the last of them, by a prefix sum over their
// counts; with that the work groups of the dispatch over all of them. One work group.

#define POINTS
#include "maps/levels.glsl"
#include "shared/prefix.glsl"

const uint SPLATS = 64u;  // of a work group of the dispatch
const uint WIDE = 32768u; // its groups along the first axis, at most

layout(local_size_x = 256) in;

layout(push_constant) uniform Push {
    int level;
    uint row; // of `maps_rows`
} push;

layout(set = 0, binding = 19, scalar) writeonly buffer Before { uint data[]; } maps_before;
layout(set = 0, binding = 20, scalar) writeonly buffer Rows { uvec4 data[]; } maps_rows;

uint points_of(uint at) {
    uint side = uint(level_side(photons_side(), push.level)), row = at / side;
    return splats_of(texelFetch(pyramid_points, above(ivec2(at % side, row % side), push.level, int(row / side)), 0));
}

void main() {
    const uint texels = TEXELS; // a buffer may be longer than its content
    uint own = gl_LocalInvocationIndex;
    uint each = (texels + PREFIX_GROUP - 1u) / PREFIX_GROUP, first = min(own * each, texels), last = min(first + each, texels);
    uint sum = 0u;
    for (uint at = first; at < last; at++) sum += points_of(at);
    uint before = prefix_before(sum);
    for (uint at = first; at < last; at++) {
        maps_before.data[at] = before;
        before += points_of(at);
    }
    if (own != PREFIX_GROUP - 1u) return;
    maps_before.data[texels] = before;
    uint groups = (before + SPLATS - 1u) / SPLATS;
    maps_rows.data[push.row] = uvec4(min(groups, WIDE), (groups + WIDE - 1u) / WIDE, 1u, before);
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// How many large splats come before each work group that marked some, by a prefix sum, and the draw of all. One work group.

#include "maps/large.glsl"
#include "shared/prefix.glsl"
#ifdef TOP
layout(set = 0, binding = 19, scalar) readonly buffer Before { uint data[]; } maps_before;
#endif

layout(local_size_x = 256) in;

layout(push_constant) uniform Push {
    uint row; // of `large_rows`
} push;

layout(set = 0, binding = 22, scalar) writeonly buffer LargeBefore { uint data[]; } large_before;
layout(set = 0, binding = 20, scalar) writeonly buffer Rows { uvec4 data[]; } large_rows;

uint large_of(uint group) {
    uvec2 mask = large_masks.data[group];
    return uint(bitCount(mask.x) + bitCount(mask.y));
}

void main() {
    uint own = gl_LocalInvocationIndex, groups = GROUPS; // a buffer may be longer than its content
#ifdef TOP
    groups = (maps_before.data[TEXELS] + 63u) / 64u; // that ran
#endif
    uint each = (groups + PREFIX_GROUP - 1u) / PREFIX_GROUP, first = min(own * each, groups), last = min(first + each, groups);
    uint sum = 0u;
    for (uint group = first; group < last; group++) sum += large_of(group);
    uint before = prefix_before(sum);
    for (uint group = first; group < last; group++) {
        large_before.data[group] = before;
        before += large_of(group);
    }
    if (own == PREFIX_GROUP - 1u) large_rows.data[push.row] = uvec4(before, 1u, 0u, groups);
}

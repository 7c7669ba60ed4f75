#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// How many photons are traced before each block, and in all, by a prefix sum; with that the work groups of the dispatch over them.
// A block of one photon has it already. One work group.

#include "light/blocks.glsl"
#include "shared/prefix.glsl"

const uint PHOTONS = 64u; // of a work group of the dispatch
const uint WIDE = 32768u; // its groups along the first axis, at most

layout(local_size_x = 256) in;

layout(push_constant, scalar) uniform Push {
    ivec2 size; // slots of the image that lie in the view
    uint view;
} push;

layout(set = 0, binding = 19, scalar) writeonly buffer Before { uint data[]; } blocks_before;
layout(set = 0, binding = 20, scalar) writeonly buffer Rows { uvec4 data[]; } blocks_rows;

uint photons_at(uint number) {
    int stride = stride_at(number, push.view);
    if (stride == BLOCK_SIDE) return 0u;
    ivec2 photons = photons_of(block_at(number), stride, push.size);
    return uint(photons.x * photons.y);
}

void main() {
    const uint blocks = uint(BLOCKS * BLOCKS);
    uint own = gl_LocalInvocationIndex;
    uint each = (blocks + PREFIX_GROUP - 1u) / PREFIX_GROUP, first = min(own * each, blocks), last = min(first + each, blocks);
    uint sum = 0u;
    for (uint at = first; at < last; at++) sum += photons_at(at);
    uint before = prefix_before(sum);
    for (uint at = first; at < last; at++) {
        blocks_before.data[at] = before;
        before += photons_at(at);
    }
    if (own != PREFIX_GROUP - 1u) return;
    blocks_before.data[blocks] = before;
    uint groups = (before + PHOTONS - 1u) / PHOTONS;
    blocks_rows.data[push.view] = uvec4(min(groups, WIDE), (groups + WIDE - 1u) / WIDE, 1u, before);
}

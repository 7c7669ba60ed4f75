#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// How many cells of a view are wrong by how much, if they are not traced finer.

#include "maps/view_weight.glsl"

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (!is_in_view(texel)) return;
    read_ways(texel);
    atomicAdd(cells_rows.data[row_of(push.view, 0u) + WEIGHTS + octave_at(texel)], 1u);
}

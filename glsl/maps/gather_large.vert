#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// The large splats that the dispatch before left, in the order of its invocations.

#include "maps/points_splat.glsl"
#include "maps/splat_point.glsl"
#include "maps/large.glsl"
#ifdef TOP
#include "maps/descend.glsl"
#endif

layout(set = 0, binding = 22, scalar) readonly buffer LargeBefore { uint data[]; } large_before;
layout(set = 0, binding = 20, scalar) readonly buffer Rows { uvec4 data[]; } large_rows;

// The work group that marked the large splat of this number: the last before which no more come.
uint group_of(uint number) {
    uint low = 0u, high = large_rows.data[ROW].w;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (large_before.data[middle] <= number) low = middle;
        else high = middle;
    }
    return low;
}

// The invocation of a group that marked its large splat of this number.
uint invocation_of(uvec2 mask, uint number) {
    uint of_first = uint(bitCount(mask.x)), word = number < of_first ? mask.x : mask.y;
    uint first = number < of_first ? 0u : 32u;
    for (uint k = number < of_first ? number : number - of_first; k > 0u; k--) word &= word - 1u;
    return first + uint(max(findLSB(word), 0));
}

void main() {
    uint number = uint(gl_VertexIndex), group = group_of(number);
    uint invocation = invocation_of(large_masks.data[group], number - large_before.data[group]);
    Splat s;
#ifdef TOP
    Found at = find(64u * group + invocation);
    bool takes = point_splat(at.texel, at.level, at.layer, s);
#else
    uint across = (uint(photons_side()) + 7u) / 8u, row = group / across;
    ivec2 texel = 8 * ivec2(group % across, row % across) + ivec2(invocation % 8u, invocation / 8u);
    bool takes = point_splat(texel, 0, int(row / across), s);
#endif
    emit_splat(s, takes);
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The large pieces of a view's cells: a work group each, whose invocations take parts of rows.

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // texels
    uint light;
    uint view;
} push;

#include "maps/cells.glsl"

const int PART = 16; // texels of a row

void main() {
    uint pieces = min(cells_counts.data[2u * push.view + 1u], LARGE_PLACES);
    for (uint piece = gl_WorkGroupID.x; piece < pieces; piece += gl_NumWorkGroups.x) {
        Large large = cells_large.data[piece];
        ivec2 first, last;
        if (!reach(large.shape, push.side, first, last)) continue;
        Flat t = from_texel(large.shape, first);
        vec3 density = density_of(t, large.flux);
        ivec2 size = last - first + 1;
        int parts = (size.x + PART - 1) / PART;
        for (int k = int(gl_LocalInvocationIndex); k < parts * size.y; k += 64) {
            int from = k / size.y * PART;
            spread_row(t, k % size.y, from, min(from + PART, size.x) - 1, first, large.layer, density);
        }
    }
}

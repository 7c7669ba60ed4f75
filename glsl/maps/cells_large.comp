#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The large pieces of a view's cells: a work group for each part of one, whose invocations take pieces of rows.

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // texels
    uint light;
    uint view;
} push;

#include "maps/cells.glsl"

void main() {
    uint parts = min(cells_counts.data[push.view], uint(cells_large.data.length()));
    for (uint part = gl_WorkGroupID.x; part < parts; part += gl_NumWorkGroups.x) {
        spread_part(cells_large.data[part], int(gl_LocalInvocationIndex), 64);
    }
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// waves.variant = vertex: the colour of every vertex of a fine mesh, and the water's height above it. Normals are finite
// differences between the vertices beside it, at the border between it and the one within.

#include "waves/grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 36, rgba32f) uniform writeonly image2D waves_vertices;

vec2 vertex(ivec2 k) {
    return water_place(vec2(k) / float(push.side));
}

void main() {
    ivec2 k = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThan(k, ivec2(push.side)))) return;
    vec2 slope;
    for (int axis = 0; axis < 2; axis++) {
        ivec2 step = axis == 0 ? ivec2(1, 0) : ivec2(0, 1);
        vec2 low = vertex(max(k - step, 0)), high = vertex(min(k + step, push.side));
        slope[axis] = (water_height(high) - water_height(low)) / (high - low)[axis];
    }
    imageStore(waves_vertices, k, vec4(sun_below(slope), water_height(vertex(k))));
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Traverse `compute`: each photon adds the texels of its splat to exact sums in fixed point.

#include "maps/points_splat.glsl"
#include "maps/deposit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef LARGE
#include "maps/large_mark.glsl"
#endif

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    Splat s;
    bool takes = all(lessThan(texel, ivec2(photons_side()))) && point_splat(texel, 0, int(gl_GlobalInvocationID.z), s);
#ifdef LARGE
    takes = keeps_small(takes, s, (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x);
#endif
    if (takes) deposit(s);
}

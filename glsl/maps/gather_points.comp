#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Traverse `compute` with a hierarchy: an invocation for each splat finds it and adds its texels to exact sums in fixed
// point.

#include "maps/points_splat.glsl"
#include "maps/deposit.glsl"
#include "maps/descend.glsl"

layout(local_size_x = 64) in;

#ifdef LARGE
#include "maps/large_mark.glsl"
#endif

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x, number = 64u * group + gl_LocalInvocationIndex;
    Splat s;
    bool takes = number < splats_in_all();
    if (takes) {
        Found at = find(number);
        takes = point_splat(at.texel, at.level, at.layer, s);
    }
#ifdef LARGE
    takes = keeps_small(takes, s, group);
#endif
    if (takes) deposit(s);
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// Traverse `hierarchical`: the points that the traversal left become splats.

#include "maps/points_splat.glsl"
#include "maps/splat_point.glsl"
#include "maps/stream_point.glsl"

layout(location = 0) in uvec2 streamed;

void main() {
    StreamPoint at = unpack_point(streamed);
    Splat s;
    bool takes = point_splat(at.texel, at.level, at.layer, s);
    emit_splat(s, takes);
}

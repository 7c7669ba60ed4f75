#version 460
#extension GL_GOOGLE_include_directive : require

// The points of a step of the traversal: with FIRST every texel of the topmost level, an instance a layer; else what the
// step before streamed out.

#include "maps/stream_point.glsl"

#ifdef FIRST
#include "maps/traverse_step.glsl"
#else
layout(location = 0) in uvec2 streamed;
#endif

layout(location = 0) flat out uvec2 point;

void main() {
#ifdef FIRST
    ivec2 texel = ivec2(gl_VertexIndex % push.top_side, gl_VertexIndex / push.top_side);
    point = pack_point(StreamPoint(texel, push.level, gl_InstanceIndex, false));
#else
    point = streamed;
#endif
    gl_Position = vec4(0.0);
    gl_PointSize = 1.0;
}

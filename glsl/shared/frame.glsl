// What changes every frame; written from the command stream before the first pass.
#ifndef FRAME_GLSL
#define FRAME_GLSL

#include "shared/view.glsl"

struct FrameData {
    View eye;
    float time; // s
    uint index;
    uint seed;
    uint eye_media; // about the eye (transport.glsl)
};

layout(set = 0, binding = 6, scalar) readonly buffer FrameBlock { FrameData data; } frame;

#endif

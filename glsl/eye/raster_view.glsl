// The view that the G-buffer is drawn from: the eye's.
#ifndef RASTER_VIEW_GLSL
#define RASTER_VIEW_GLSL

#include "shared/frame.glsl"
#include "shared/scene.glsl"

#ifdef HAS_CAST
layout(push_constant, scalar) uniform Push { ivec2 size; } push;
#endif

View raster_view() {
    return frame.data.eye;
}

#endif

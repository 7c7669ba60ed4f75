// The view that an image of a light's is drawn from: one of a list.
#ifndef RASTER_VIEW_GLSL
#define RASTER_VIEW_GLSL

#include "shared/view.glsl"

layout(set = 0, binding = 6, scalar) readonly buffer RasterViews { View data[]; } raster_views;

layout(push_constant, scalar) uniform Push {
    ivec2 size; // texels
    uint view;
} push;

View raster_view() {
    return raster_views.data[push.view];
}

#endif

// The view that an image of a light's is drawn from: one of a list, or a tile of it.
#ifndef RASTER_VIEW_GLSL
#define RASTER_VIEW_GLSL

#include "shared/view.glsl"

layout(set = 0, binding = 6, scalar) readonly buffer RasterViews { View data[]; } raster_views;

layout(push_constant, scalar) uniform Push {
    ivec2 size; // texels
    uint view;
    ivec2 first; // the whole view's texel that is the image's first
    int whole;   // texels a side of the whole view
} push;

View raster_view() {
    View v = raster_views.data[push.view];
    if (push.whole == push.size.x) return v;
    vec2 low = view_window(v, vec2(push.first) / float(push.whole));
    vec2 high = view_window(v, vec2(push.first + push.size) / float(push.whole));
    v.x0 = low.x;
    v.y1 = low.y;
    v.x1 = high.x;
    v.y0 = high.y;
    return v;
}

// The ray through a place of the image, texels: of a tile the whole view's, bit by bit.
void raster_ray(vec2 at, out vec3 o, out vec3 d) {
    view_ray(raster_views.data[push.view], (vec2(push.first) + at) / vec2(push.whole), o, d);
}

#endif

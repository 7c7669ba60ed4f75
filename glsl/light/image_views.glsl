// Where the images are seen from that the view at hand is traced with: the back of the specular objects, the receivers.
#ifndef IMAGE_VIEWS_GLSL
#define IMAGE_VIEWS_GLSL

#include "shared/view.glsl"

layout(set = 0, binding = 17, scalar) readonly buffer LightImageViews { View data[]; } light_image_views;

View back_view() {
    return light_image_views.data[2u * push.view];
}

View receiving_view() {
    return light_image_views.data[2u * push.view + 1u];
}

// Narrows an interval to where a + b t, linear along a ray, is not negative.
void clip_interval(float a, float b, inout vec2 interval) {
    if (b > 0.0) interval.x = max(interval.x, -a / b);
    if (b < 0.0) interval.y = min(interval.y, -a / b);
    if (b == 0.0 && a < 0.0) interval.y = -1.0;
}

// The part of the ray from o along d that lies in the view's frustum; empty where its end is before its start.
vec2 within_view(View v, vec3 o, vec3 d) {
    const float LEAST = 1e-6; // of the far plane: nearer to a point light nothing is projected
    vec3 q = o - v.origin;
    vec3 at = vec3(dot(q, v.right), dot(q, v.up), dot(q, v.forward));
    vec3 by = vec3(dot(d, v.right), dot(d, v.up), dot(d, v.forward));
    bool cone = v.perspective != 0u;
    vec2 w = cone ? vec2(at.z, by.z) : vec2(1.0, 0.0);
    vec2 interval = vec2(0.0, 3.0e38);
    float near = cone ? max(v.near, LEAST * v.far) : v.near;
    clip_interval(at.z - near, by.z, interval);
    clip_interval(v.far - at.z, -by.z, interval);
    clip_interval(at.x - v.x0 * w.x, by.x - v.x0 * w.y, interval);
    clip_interval(v.x1 * w.x - at.x, v.x1 * w.y - by.x, interval);
    clip_interval(at.y - v.y0 * w.x, by.y - v.y0 * w.y, interval);
    clip_interval(v.y1 * w.x - at.y, v.y1 * w.y - by.y, interval);
    return interval;
}

#endif

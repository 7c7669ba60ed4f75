// What light meets inside a body after a total reflection (Davis and Wyman 2007): the front or the back that the images
// show, marched and bisected between the two, whichever the tracer.
#ifndef INSIDE_GLSL
#define INSIDE_GLSL

#include "light/back.glsl"

// The front that the whole view sees: light that entered in one tile may meet it in another.
layout(set = 0, binding = 31) uniform sampler2D light_whole_front_position;
layout(set = 0, binding = 32) uniform sampler2D light_whole_front_normal;

const int INSIDE_STEPS = 64;
const int INSIDE_HALVINGS = 16;

// Whether p lies between front and back; if not, `crossed` is the one that it is beyond, if the images show one.
bool is_inside(vec3 p, inout Face crossed) {
    Face back, front;
    vec2 xy01;
    bool has_back = back_beneath(p, back);
    bool has_front = view_project(light_views.data[push.view], p, xy01) &&
                     face_beneath(light_whole_front_position, light_whole_front_normal, xy01, front);
    if (has_back && beyond_face(p, back) >= 0.0) {
        crossed = back;
        return false;
    }
    if (has_front && beyond_face(p, front) >= 0.0) {
        crossed = front;
        return false;
    }
    return has_back && has_front;
}

// From o, on the body's surface, along d into it.
bool inside(vec3 o, vec3 d, out Surface s, out float way) {
    way = 0.0;
    s = Surface(o, -d, -d, vec2(0.0), 0u, 0u, 0.0);
    float end = within_view(back_view(), o, d).y;
    if (!(end > 0.0)) return false;
    Face crossed = Face(vec4(0.0), vec4(0.0));
    float low = 0.0, high = end;
    for (int k = 1; k <= INSIDE_STEPS; k++) {
        high = end * float(k) / float(INSIDE_STEPS);
        if (!is_inside(o + high * d, crossed)) break;
        low = high;
    }
    for (int k = 0; k < INSIDE_HALVINGS; k++) {
        float middle = 0.5 * (low + high);
        if (is_inside(o + middle * d, crossed)) low = middle; else high = middle;
    }
    way = low;
    return is_face(crossed) && leave_by(crossed, o, d, way, s);
}

#endif

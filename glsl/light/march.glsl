// Marching with bisection through a body (Hu and Qin 2007): light comes out where it first is before no back any more.
#ifndef MARCH_GLSL
#define MARCH_GLSL

#include "light/back.glsl"

const int MARCH_STEPS = 64;    // over the image of the body
const int MARCH_HALVINGS = 16; // of a step

bool march_to_back(vec3 o, vec3 d, out Surface s, out float way) {
    way = 0.0;
    s = Surface(o, -d, -d, vec2(0.0), 0u, 0u, 0.0);
    float end = within_view(back_view(), o, d).y;
    if (!(end > 0.0)) return false;
    Face face, last = Face(vec4(0.0), vec4(0.0));
    float low = 0.0, high = end;
    for (int k = 1; k <= MARCH_STEPS; k++) {
        high = end * float(k) / float(MARCH_STEPS);
        if (!back_beneath(o + high * d, face) || beyond_face(o + high * d, face) >= 0.0) break;
        last = face;
        low = high;
    }
    for (int k = 0; k < MARCH_HALVINGS; k++) {
        float middle = 0.5 * (low + high);
        bool there = back_beneath(o + middle * d, face);
        if (there) last = face; // beyond a silhouette there is none: the nearest to it counts
        if (there && beyond_face(o + middle * d, face) < 0.0) low = middle; else high = middle;
    }
    way = low;
    return is_face(last) && leave_by(last, o, d, way, s);
}

#endif

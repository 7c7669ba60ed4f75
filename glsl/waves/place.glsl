// Where a point of a receiver lies below the water.
#ifndef WAVES_PLACE_GLSL
#define WAVES_PLACE_GLSL

#include "shared/frame.glsl"
#include "waves/sun.glsl"

// `at` in m along the rectangle's axes, `above` its plane; false beside it, and on sides that look away from the water.
bool water_over(vec3 p, vec3 n, out vec2 at, out float above) {
    Water w = water_frame();
    vec3 q = p - w.center;
    at = vec2(dot(q, w.u), dot(q, w.v));
    above = dot(q, w.n);
    return water_inside(at) && dot(n, w.n) > 0.0;
}

// The paper's w, by which slopes are divided: distances from the eye below 1 m dim the light. Parallel views have none.
float screen_depth(vec3 p) {
    View eye = frame.data.eye;
    return eye.perspective == 0u ? 1.0 : clamp(dot(p - eye.origin, eye.forward), 0.0, 1.0);
}

// A slope as the eye's distance flattens or, near the eye, steepens it; at the eye it is upright.
vec2 seen_slope(vec2 slope, vec3 p) {
#ifdef WAVES_SCREEN_DEPTH
    return slope / max(screen_depth(p), 1e-6);
#else
    return slope;
#endif
}

#endif

// The media that the eye is in.
#ifndef EYE_MEDIUM_GLSL
#define EYE_MEDIUM_GLSL

#include "shared/frame.glsl"
#include "shared/transport.glsl"

// What is left at the eye of radiance from p, the first surface it sees. Parallel rays each have their own start.
vec3 eye_transmits(vec3 p) {
    View eye = frame.data.eye;
    vec3 way = p - eye.origin;
    float metres = eye.perspective != 0u ? length(way) : dot(way, eye.forward) - eye.near;
    return medium_transmits(innermost(frame.data.eye_media), metres);
}

#endif

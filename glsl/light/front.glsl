// The first specular surface that each sample of a view meets.
#ifndef FRONT_GLSL
#define FRONT_GLSL

#include "light/faces.glsl"

layout(set = 0, binding = 14) uniform sampler2D light_front_position;
layout(set = 0, binding = 15) uniform sampler2D light_front_normal;

Face front_face(ivec2 texel) {
    return Face(texelFetch(light_front_position, texel, 0), texelFetch(light_front_normal, texel, 0));
}

#endif

#version 460
#extension GL_GOOGLE_include_directive : require

// One texel of a splat: its share of the photon's flux, added to the map.

#include "shared/splat.glsl"

layout(push_constant) uniform Push {
    int side;
    float diameter;
    uint light;
} push;

layout(location = 0) flat in vec3 splat_flux;
layout(location = 1) flat in vec2 splat_centre;
layout(location = 0) out vec4 deposited;

void main() {
    float weight = splat_weight(gl_FragCoord.x, splat_centre.x, push.diameter) *
                   splat_weight(gl_FragCoord.y, splat_centre.y, push.diameter);
    deposited = vec4(weight * splat_flux, 0.0);
}

#version 460
#extension GL_GOOGLE_include_directive : require

// One texel of a splat: its share of the photon's flux, added to the map.

#include "shared/splat.glsl"

layout(location = 0) flat in vec4 splat_flux;   // W, already divided by the sum of the weights; diameter
layout(location = 1) flat in vec4 splat_centre; // texels of its level; the level's side; layer
layout(location = 0) out vec4 deposited;

void main() {
#ifdef MULTIRES
    if (any(greaterThan(gl_FragCoord.xy, splat_centre.zz))) discard; // beyond its level's corner
#endif
    float weight = splat_weight(gl_FragCoord.x, splat_centre.x, splat_flux.w) *
                   splat_weight(gl_FragCoord.y, splat_centre.y, splat_flux.w);
    deposited = vec4(weight * splat_flux.rgb, 0.0);
}

#version 460
#extension GL_GOOGLE_include_directive : require

// One texel of a splat: its share of the photon's flux, added to the map.

#include "shared/splat.glsl"

layout(location = 0) flat in vec4 splat_flux;   // W, already divided by the sum of the weights; diameter
layout(location = 1) flat in vec4 splat_centre; // texels of its level; the level's side; layer
#ifdef COUNTED
layout(location = 2) flat in float splat_count; // photons, divided by the sum of the weights
#endif
layout(location = 0) out vec4 deposited;

void main() {
#ifdef MULTIRES
    if (any(greaterThan(gl_FragCoord.xy, splat_centre.zz))) discard; // beyond its level's corner
#endif
    float weight = splat_weight(gl_FragCoord.x, splat_centre.x, splat_flux.w) *
                   splat_weight(gl_FragCoord.y, splat_centre.y, splat_flux.w);
#ifdef COUNTED
    deposited = vec4(weight * splat_flux.rgb, weight * splat_count);
#else
    deposited = vec4(weight * splat_flux.rgb, 0.0);
#endif
}

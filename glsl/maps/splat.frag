#version 460
#extension GL_GOOGLE_include_directive : require

// One texel of a splat: its share of the photon's flux, added to the map.

#include "shared/splat.glsl"

layout(location = 0) flat in vec4 splat_flux;   // W, already divided by the sum of the weights; diameter
layout(location = 1) flat in vec4 splat_centre; // texels of its level; the level's side; layer
#ifdef COUNTED
layout(location = 2) flat in float splat_count; // photons, divided by the sum of the weights
#endif
#ifdef SHAPED
layout(location = 3) flat in vec2 splat_shape; // diameter along columns; rows that the centre moves by a column
#endif
layout(location = 0) out vec4 deposited;

void main() {
#ifdef MULTIRES
    if (any(greaterThan(gl_FragCoord.xy, splat_centre.zz))) discard; // beyond its level's corner
#endif
    vec2 centre = splat_centre.xy;
    float diameter = splat_flux.w;
#ifdef SHAPED
    // The point is the square about a long splat, and covers more than it.
    centre.y += splat_shape.y * (gl_FragCoord.x - centre.x);
    float weight = splat_weight_within(gl_FragCoord.x, centre.x, diameter) * splat_weight_within(gl_FragCoord.y, centre.y, splat_shape.x);
#else
    float weight = splat_weight(gl_FragCoord.x, centre.x, diameter) * splat_weight(gl_FragCoord.y, centre.y, diameter);
#endif
#ifdef COUNTED
    deposited = vec4(weight * splat_flux.rgb, weight * splat_count);
#else
    deposited = vec4(weight * splat_flux.rgb, 0.0);
#endif
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The landing points of one view's photons into the pixels of the region's picture that they lie in, and nothing made of
// them: no splat, no map, no margin.

#include "shared/flux_sums.glsl"
#include "shared/photon.glsl"
#include "shared/view.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef LAYERS
layout(set = 0, binding = 8) uniform sampler2DArray photons_hit;
layout(set = 0, binding = 9) uniform sampler2DArray photons_flux;
#define PHOTON_PLACE(texel, layer) ivec3(texel, layer)
#else
layout(set = 0, binding = 8) uniform sampler2D photons_hit;
layout(set = 0, binding = 9) uniform sampler2D photons_flux;
#define PHOTON_PLACE(texel, layer) texel
#endif

layout(set = 0, binding = 13, scalar) readonly buffer BudgetView { View view; } budget_view;

layout(push_constant, scalar) uniform Push {
    ivec2 size; // pixels
    uint receiver;
} push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, textureSize(photons_hit, 0).xy))) return;
    vec4 hit = texelFetch(photons_hit, PHOTON_PLACE(texel, int(gl_GlobalInvocationID.z)), 0);
    if (hit.w == 0.0 || uint(hit.w) - 1u != push.receiver) return;
    vec4 flux = texelFetch(photons_flux, PHOTON_PLACE(texel, int(gl_GlobalInvocationID.z)), 0);
    vec2 at;
    if (!view_project(budget_view.view, hit.xyz, at)) return;
    if (!(dot(photon_normal(flux.w), budget_view.view.forward) < 0.0)) return; // on the side that nobody sees
    ivec2 pixel = ivec2(floor(at * vec2(push.size)));
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, push.size))) return;
    add_flux(uint(pixel.y * push.size.x + pixel.x), flux.rgb);
}

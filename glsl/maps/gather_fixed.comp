#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Traverse `compute`: each photon adds the texels of its splat to exact sums in fixed point.

#include "maps/varying.glsl"
#include "maps/deposit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(photons_side())))) return;
    int layer = int(gl_GlobalInvocationID.z);
    vec4 flux = flux_at(texel, layer);
    Landed l;
    Splat s;
    if (!land(hit_at(texel, layer), flux.w, l)) return;
    if (splat_of(l, photon_flux(flux.rgb), splat_size(l, texel, 0, layer), s)) deposit(s);
}

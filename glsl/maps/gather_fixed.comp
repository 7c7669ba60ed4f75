#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Traverse `compute`: each photon adds the texels of its splat to exact sums in fixed point.

#include "maps/varying.glsl"
#include "shared/flux_sums.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// The texels that a point of this size about p would cover: as `splat_norm` sums over them.
ivec2 covered(float p, float d, int side) {
    return ivec2(max(int(ceil(p - 0.5 * d - 0.5)), 0), min(int(ceil(p + 0.5 * d - 0.5)), side));
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(photons_side())))) return;
    int layer = int(gl_GlobalInvocationID.z);
    vec4 flux = flux_at(texel, layer);
    Landed l;
    Splat s;
    if (!land(hit_at(texel, layer), flux.w, l)) return;
    if (!splat_of(l, photon_flux(flux.rgb), splat_size(l, texel, 0, layer), s)) return;
    ivec2 columns = covered(s.centre.x, s.diameter, s.side), rows = covered(s.centre.y, s.diameter, s.side);
    for (int y = rows.x; y < rows.y; y++) {
        float across = splat_weight(float(y) + 0.5, s.centre.y, s.diameter);
        for (int x = columns.x; x < columns.y; x++) {
            vec3 share = across * splat_weight(float(x) + 0.5, s.centre.x, s.diameter) * s.flux;
            add_flux(uint((s.layer * push.side + y) * push.side + x), share);
        }
    }
}

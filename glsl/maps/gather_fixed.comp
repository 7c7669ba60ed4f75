#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Gather `fetch` with sums in fixed point: each photon adds the texels of its splat to exact sums.

#include "maps/photon_splat.glsl"
#include "shared/flux_sums.glsl"
#include "maps/photons.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // texels
    uint light;
} push;

// The texels that a point of this size about p would cover: as `splat_norm` sums over them.
ivec2 covered(float p, float d) {
    return ivec2(max(int(ceil(p - 0.5 * d - 0.5)), 0), min(int(ceil(p + 0.5 * d - 0.5)), push.side));
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, textureSize(photons_hit, 0).xy))) return;
    Splat s;
    int layer = int(gl_GlobalInvocationID.z);
    if (!splat_of(hit_at(texel, layer), flux_at(texel, layer), push.light, push.side, push.diameter, s)) return;
    float d = splat_diameter(push.diameter);
    ivec2 columns = covered(s.centre.x, d), rows = covered(s.centre.y, d);
    for (int y = rows.x; y < rows.y; y++) {
        float across = splat_weight(float(y) + 0.5, s.centre.y, d);
        for (int x = columns.x; x < columns.y; x++) {
            vec3 flux = across * splat_weight(float(x) + 0.5, s.centre.x, d) * s.flux;
            add_flux(uint((s.layer * push.side + y) * push.side + x), flux);
        }
    }
}

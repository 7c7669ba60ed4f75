#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Gather `fetch` with sums in fixed point: each photon adds the texels of its splat to 64-bit sums of two words. The word
// that wraps tells the one who made it wrap, and he carries: integers add up to the same in any order, so that the sum
// is exact but for the rounding of each addend, and repeats.

#include "maps/photon_splat.glsl"
#include "maps/photons.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // texels
    uint light;
} push;

layout(set = 0, binding = 10, scalar) buffer MapSums { uint data[]; } maps_sums; // low, high of each band of each texel

layout(set = 0, binding = 11, scalar) readonly buffer MapUnit { float per_watt, watts; } maps_unit;

// Beyond what any number of photons may bring: keeps what is infinite from being converted.
const float MOST = 1.1529215e18; // 2^60

void add_fixed(uint word, float flux) {
    float units = min(flux * maps_unit.per_watt, MOST);
    if (!(units > 0.0)) return;
    uint high = uint(units * 2.3283064e-10); // 2^-32
    float rest = units - float(high) * 4294967296.0;
    uint low = uint(rest) + (fract(rest) >= 0.5 ? 1u : 0u);
    uint before = atomicAdd(maps_sums.data[word], low);
    if (before + low < before) high++;
    if (high != 0u) atomicAdd(maps_sums.data[word + 1u], high);
}

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
            uint word = 6u * uint((s.layer * push.side + y) * push.side + x);
            add_fixed(word, flux.r);
            add_fixed(word + 2u, flux.g);
            add_fixed(word + 4u, flux.b);
        }
    }
}

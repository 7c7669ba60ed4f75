#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// How dense photons are in each block of the photon image, from one photon in each: what they tell is how far apart those of
// one slot each would land. The plan puts in what measures that for the method at hand.

#define STRIDES_WRITTEN
#include "light/blocks.glsl"
#include "measure.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
    ivec2 size; // slots that lie in the view
    uint light;
    uint view;
    float side; // texels of what the method measures in
    float most; // texels that photons may lie apart,
    float edge; // and where light breaks
} push;

layout(set = 0, binding = 8) uniform sampler2D photons_hit;
layout(set = 0, binding = 9) uniform sampler2D photons_flux;
layout(set = 0, binding = 16) uniform sampler2D photons_way;

// A block's photon, as the method takes it.
struct Seen {
    bool known; // whether it lies in the image
    float way;  // 0: none that it takes
    int place;  // which of its maps
    vec2 at;    // texels
};

Seen seen(ivec2 block) {
    Seen s = Seen(false, 0.0, -1, vec2(0.0));
    if (any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block, ivec2(BLOCKS)))) return s;
    s.known = true;
    ivec2 slot = block * BLOCK_SIDE;
    vec4 hit = texelFetch(photons_hit, slot, 0);
    if (hit.w == 0.0) return s;
    s.place = measured(hit, texelFetch(photons_flux, slot, 0).w, push.light, s.at);
    s.at *= push.side;
    if (s.place >= 0) s.way = texelFetch(photons_way, slot, 0).r;
    return s;
}

Seen around[9];

void main() {
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, ivec2(BLOCKS)))) return;
    for (int k = 0; k < 9; k++) around[k] = seen(block + ivec2(k % 3, k / 3) - 1);
    bool lit = false, edge = false, pair = false;
    float apart = 0.0; // texels a slot
    for (int k = 0; k < 9; k++) {
        if (!around[k].known) continue;
        lit = lit || around[k].way != 0.0;
        edge = edge || around[k].way != around[4].way || around[k].place != around[4].place;
        for (int axis = 0; axis < 2; axis++) {
            int next = axis == 0 ? k + 1 : k + 3;
            if (axis == 0 ? k % 3 == 2 : k >= 6) continue;
            if (around[k].way == 0.0 || around[next].way != around[k].way || around[next].place != around[k].place) continue;
            pair = true;
            vec2 way = around[next].at - around[k].at;
            apart = max(apart, length(way) / float(BLOCK_SIDE));
        }
    }
    int level = BLOCK_LEVELS;
    // One that the view's end cuts has all its photons: others would stand for fewer slots than their stride says.
    bool cut = any(greaterThan((block + 1) * BLOCK_SIDE, push.size));
    if (lit) {
        float most = edge ? push.edge : push.most;
        if (!pair || cut) level = 0;
        else if (apart > 0.0) level = int(floor(clamp(log2(most / apart), 0.0, float(BLOCK_LEVELS))));
    }
    block_strides.data[push.view * uint(BLOCKS_MOST) + number_of(block)] = uint(level);
}

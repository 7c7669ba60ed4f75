#version 460
#extension GL_EXT_scalar_block_layout : require

// What the cells of all views brought, and how many were traced finer, for the report; their sums begin anew.

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    uint first; // place of the sums beyond the map's
    uint views;
} push;

layout(set = 0, binding = 10, scalar) buffer MapSums { uint data[]; } maps_sums;
layout(set = 0, binding = 12, scalar) readonly buffer MapUnit { float per_watt, watts; } maps_unit;
layout(set = 0, binding = 19, scalar) buffer Counts { uint data[]; } cells_counts; // two a view
layout(set = 0, binding = 18, scalar) writeonly buffer Tally { uint data[]; } cells_tally;

// 64 slots of three bands of two words, twice; a band of a kind for each of the first six invocations.
void main() {
    uint lane = gl_LocalInvocationIndex;
    if (lane < 6u) {
        uint low = 0u, high = 0u; // which cell adds to which slot is chance: only integers sum to the same
        for (uint slot = 0u; slot < 64u; slot++) {
            uint word = 6u * (push.first + 64u * (lane / 3u) + slot) + 2u * (lane % 3u);
            low += maps_sums.data[word];
            high += maps_sums.data[word + 1u] + (low < maps_sums.data[word] ? 1u : 0u);
            maps_sums.data[word] = 0u;
            maps_sums.data[word + 1u] = 0u;
        }
        float units = float(high) * 4294967296.0 + float(low);
        cells_tally.data[lane] = floatBitsToUint(units * maps_unit.watts); // W
    }
    if (lane == 6u) {
        uint listed = 0u;
        for (uint view = 0u; view < push.views; view++) {
            listed += cells_counts.data[2u * view];
            cells_counts.data[2u * view] = 0u;
            cells_counts.data[2u * view + 1u] = 0u;
        }
        cells_tally.data[6] = listed;
    }
}

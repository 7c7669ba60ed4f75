#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// What the cells of all views brought, and how many were traced finer, for the report; their sums begin anew.

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    uint first; // place of the sums beyond the map's
    uint views;
} push;

#ifdef CELLS_LEVELS
#include "maps/finer.glsl"
#endif

layout(set = 0, binding = 10, scalar) buffer MapSums { uint data[]; } maps_sums;
layout(set = 0, binding = 12, scalar) readonly buffer MapUnit { float per_watt, watts; } maps_unit;
layout(set = 0, binding = 19, scalar) buffer Counts { uint data[]; } cells_counts; // large parts of each view
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
        for (uint view = 0u; view < push.views; view++) cells_counts.data[view] = 0u;
        uint traced = 0u, left = 0u, rays = 0u;
#ifdef CELLS_LEVELS
        for (uint row = 0u; row < ROW * push.views * uint(CELLS_LEVELS); row += ROW) {
            bool first = row / ROW % uint(CELLS_LEVELS) == 0u;
            uint from = first ? cells_rows.data[row + PAYS] : 0u, least = least_octave(row, from);
            uint finer = 0u, coarse = 0u;
            for (uint octave = 0u; octave < OCTAVES; octave++) {
                if (octave >= least) finer += cells_rows.data[row + WEIGHTS + octave];
                else if (octave >= from) coarse += cells_rows.data[row + WEIGHTS + octave];
                cells_rows.data[row + WEIGHTS + octave] = 0u;
            }
            traced += finer;
            left += coarse;
#ifdef SHARED_EDGES
            uint each = RAYS_SHARED;
#else
            uint each = uint(RAYS_FINER);
#endif
            rays += cells_rows.data[row + ALONE];
            rays += first ? each * finer : uint(RAYS_DEEPER) * finer + RAYS_LEFT * coarse;
            cells_rows.data[row + ALONE] = 0u;
        }
#endif
        cells_tally.data[6] = traced;
        cells_tally.data[7] = left;
        cells_tally.data[8] = rays;
    }
}

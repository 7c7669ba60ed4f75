// Cells to be traced finer: a list a level, and for each level of each view a row of what its list holds.
//
// CELLS_LEVELS of them.
#ifndef FINER_GLSL
#define FINER_GLSL

const uint OCTAVES = 32u;
const uint ROW = 4u + OCTAVES; // work groups along three axes and the cells listed; how many cells have how much flux
const uint CELLS_OF_GROUP = 4u; // lavapipe ends all loops of an invocation after 65535 rounds
const uint GROUPS_MOST = 65535u;

layout(set = 0, binding = 21, scalar) buffer Rows { uint data[]; } cells_rows;

uint row_of(uint view, uint level) {
    return ROW * (view * uint(CELLS_LEVELS) + level);
}

// The least octave of a row whose cells are traced finer: all, unless they are more than CELLS_MOST.
#ifdef CELLS_MOST
uint least_octave(uint row) {
    if (cells_rows.data[row + 3u] <= uint(CELLS_MOST)) return 0u;
    uint taken = 0u, octave = OCTAVES;
    while (octave > 0u && taken + cells_rows.data[row + 3u + octave] <= uint(CELLS_MOST)) {
        taken += cells_rows.data[row + 3u + octave];
        octave--;
    }
    return octave;
}
#endif

#ifdef LISTS
layout(set = 0, binding = 30, scalar) writeonly buffer Next { uvec2 data[]; } cells_next;

// The octave of a flux (W, all bands) above a unit of the map's sums.
uint octave_of(float flux) {
    const float FIRST = 7.0;
    return uint(clamp(log2(max(flux * flux_unit.per_watt, 1.0)) - FIRST, 0.0, float(OCTAVES - 1u)));
}

// Lists a cell of a level's grid, which has fewer than 2^24 a side.
void list_cell(uint view, uint level, ivec2 at, float flux) {
    uint row = row_of(view, level), octave = octave_of(flux);
    uint place = atomicAdd(cells_rows.data[row + 3u], 1u);
    atomicAdd(cells_rows.data[row + 4u + octave], 1u);
    if (place % CELLS_OF_GROUP == 0u && place / CELLS_OF_GROUP < GROUPS_MOST) atomicAdd(cells_rows.data[row], 1u);
    cells_next.data[place] = uvec2(uint(at.x) | octave << 24, uint(at.y));
}
#endif

#endif

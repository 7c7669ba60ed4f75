// Cells to be traced finer: a list a level, and for each level of each view a row of what its list holds.
//
// CELLS_LEVELS of them.
#ifndef FINER_GLSL
#define FINER_GLSL

const uint OCTAVES = 32u;
const uint LISTED = 3u;  // cells listed, behind work groups along three axes
const uint RAYS = 4u;    // of a view's own grid, from the host
const uint PAYS = 5u;    // of the first level's row: the least octave of its cells that pays,
const uint LEAST = 6u;   // the least that is traced finer,
const uint DEEPER_FROM = 7u;  // and the least that is in the levels after it
const uint WEIGHTS = 8u; // how many cells have which weight
const uint ALONE = WEIGHTS + OCTAVES; // of the first level's row: rays on edges that no neighbour shares
const uint ROW = ALONE + 4u;          // whole rows of a dispatch's words
const float RAYS_FINER = 36.0;  // of a cell of the view that is traced finer: 25 corners and 16 centres, 5 of which are known
const uint RAYS_SHARED = 30u;   // of those, without the two edges that neighbours have, if they are listed
const float RAYS_DEEPER = 41.0; // of a smaller one
const uint RAYS_LEFT = 5u;      // of a smaller one that is left as it is
const uint CELLS_OF_GROUP = 4u; // lavapipe ends all loops of an invocation after 65535 rounds
const uint GROUPS_MOST = 65535u;

layout(set = 0, binding = 21, scalar) buffer Rows { uint data[]; } cells_rows;

uint row_of(uint view, uint level) {
    return ROW * (view * uint(CELLS_LEVELS) + level);
}

const float FIRST_OCTAVE = -12.0; // log2 of the least weight but none

// A cell's weight is the root of its error: what is estimated may be off by a power of ten, and a few cells would seem to hold
// all of the error.
uint octave_of(float error) {
    if (!(error > 0.0)) return 0u;
    return uint(clamp(0.5 * log2(error) - FIRST_OCTAVE, 0.0, float(OCTAVES - 1u)));
}

// The least octave of a row, from `from` on, whose cells are traced finer: all, unless they are more than CELLS_MOST.
#ifdef CELLS_MOST
uint least_octave(uint row, uint from) {
    uint taken = 0u, octave = OCTAVES;
    while (octave > from && taken + cells_rows.data[row + WEIGHTS + octave - 1u] <= uint(CELLS_MOST)) {
        octave--;
        taken += cells_rows.data[row + WEIGHTS + octave];
    }
    return octave;
}
#endif

#ifdef LISTS
layout(set = 0, binding = 30, scalar) writeonly buffer Next { uvec2 data[]; } cells_next;

// Lists a cell of a level's grid, which has fewer than 2^24 a side.
void list_cell(uint row, ivec2 at, uint octave) {
    uint place = atomicAdd(cells_rows.data[row + LISTED], 1u);
    if (place % CELLS_OF_GROUP == 0u && place / CELLS_OF_GROUP < GROUPS_MOST) atomicAdd(cells_rows.data[row], 1u);
    cells_next.data[place] = uvec2(uint(at.x) | octave << 24, uint(at.y));
}
#endif

#endif

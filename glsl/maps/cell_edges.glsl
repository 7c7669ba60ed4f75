// Light samples on the edges of the cells of a view's own grid that are traced finer. Each cell has those of its own first row
// and column; what lies on the other two edges is its neighbours', where those are listed too.
#ifndef CELL_EDGES_GLSL
#define CELL_EDGES_GLSL

const int EDGE_PARTS = 4; // of an edge (FINER of cells_refine.comp)
const int EDGE_SAMPLES = 2 * (EDGE_PARTS - 1);

// Where a photon of a sample landed.
struct EdgePhoton {
    vec3 p;
    uint way; // 0: none
    uint receiver;
    float flux; // W, all bands
};

struct Edges {
    uint listed; // 1: the cell is traced finer
    EdgePhoton photons[EDGE_SAMPLES * PHOTONS];
};

layout(set = 0, binding = 36, scalar) buffer CellEdges { Edges data[]; } cells_edges; // of each cell of the view

uint edges_of(ivec2 cell) {
    return uint(cell.y * push.size.x + cell.x);
}

// From the cell's corner, in parts of its edge.
ivec2 edge_step(int number) {
    return number < EDGE_PARTS - 1 ? ivec2(number + 1, 0) : ivec2(0, number - EDGE_PARTS + 2);
}

// Which sample of its owner's lies at a step from a cell's corner, on any of its edges.
int edge_number(ivec2 step) {
    return step.x % EDGE_PARTS == 0 ? step.y + EDGE_PARTS - 2 : step.x - 1;
}

#endif

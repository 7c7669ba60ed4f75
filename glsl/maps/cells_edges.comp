#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The samples on the edges of the cells that a view lists, each once: neighbours share them.

#include "light/sample.glsl"
#ifdef LAYERS
#include "light/layers.glsl"
#include "light/tree.glsl"
#else
#include "light/tracer.glsl"
#endif

layout(local_size_x = 64) in;

layout(set = 0, binding = 18, scalar) readonly buffer List { uvec2 data[]; } cells_list;

#include "maps/finer.glsl"
#include "maps/photons.glsl"
#include "maps/cell_edges.glsl"

void store_edge(uint cell, int number, int photon, Photon p) {
    cells_edges.data[cell].photons[number * PHOTONS + photon] = EdgePhoton(p.hit, photon_way(p), p.receiver, p.flux.r + p.flux.g + p.flux.b);
}

uint traced_cell; // the cell and the number of the sample that is traced
int traced_number;

#ifdef LAYERS
void end_photon(Photon p) {
    if (p.status != PHOTON_VALID) return;
    int layer = take_layer(sum_of_bands(p.flux));
    if (layer != NO_LAYER) store_edge(traced_cell, traced_number, layer, p);
}
#endif

void trace_edge(ivec2 cell, int number) {
    traced_cell = edges_of(cell);
    traced_number = number;
    LightSample light = light_corner(EDGE_PARTS * cell + edge_step(number), EDGE_PARTS);
#ifdef LAYERS
    layers_filled = 0;
    for (int k = 0; k < PHOTONS; k++) store_edge(traced_cell, number, k, no_photon());
    trace_tree(light);
#else
    store_edge(traced_cell, number, 0, trace_photon(light));
#endif
}

void main() {
    const uint EACH = uint(EDGE_SAMPLES);
    uint samples = EACH * cells_rows.data[row_of(push.view, 0u) + LISTED];
    for (uint k = gl_GlobalInvocationID.x; k < samples; k += gl_WorkGroupSize.x * gl_NumWorkGroups.x) {
        uvec2 listed = cells_list.data[k / EACH];
        trace_edge(ivec2(listed.x & 0xffffffu, listed.y), int(k % EACH));
    }
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The cells that one sheet of light is too coarse for, each traced as 4 x 4 smaller ones, a row of which an invocation takes.
// What is still no sheet, or torn, goes as points.

#define PUSH_MORE int side; float diameter; // texels
#include "light/sample.glsl"
#ifdef LAYERS
#include "light/layers.glsl"
#include "light/tree.glsl"
#else
#include "light/tracer.glsl"
#endif
#include "maps/cells.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 18, scalar) readonly buffer List { uint data[]; } cells_list;

const int FINER = 4; // smaller cells a side
const int STEPS = 3 * FINER + 2; // of a row: two corners, then a centre and two corners for each smaller cell

#ifdef LAYERS
const int PHOTONS = LAYERS;
#else
const int PHOTONS = 1;
#endif

// What a photon brings to the map.
struct Arrival {
    Corner landed;
    vec3 flux; // W
    int layer;
};

// All that a light sample leaves.
struct Sample {
    Arrival photon[PHOTONS];
};

Arrival arrival_of(Photon p) {
    uint way = photon_way(p);
    vec2 xy01;
    int layer = way == 0u ? NO_MAP : layer_of(p.receiver, push.light);
    if (layer != NO_MAP && !map_project(maps_views.data[layer].view, p.hit, p.normal, xy01)) layer = NO_MAP;
    return Arrival(landed_at(p.hit, way, layer, push.side), p.flux, layer);
}

#ifdef LAYERS
Sample traced;

void end_photon(Photon p) {
    if (p.status != PHOTON_VALID) return;
    int layer = take_layer(sum_of_bands(p.flux));
    if (layer != NO_LAYER) traced.photon[layer] = arrival_of(p);
}
#endif

// A corner of the smaller cells, or a centre, counted from the view's first.
Sample sample_at(ivec2 at, bool centre) {
    LightSample light = light_sample(min(at, FINER * push.size - 1), FINER);
    if (!centre) light = light_sample_at(place_in_view(vec2(at), FINER), light.footprint);
#ifdef LAYERS
    layers_filled = 0;
    for (int k = 0; k < PHOTONS; k++) traced.photon[k].landed.way = 0u;
    trace_tree(light);
    return traced;
#else
    return Sample(Arrival[PHOTONS](arrival_of(trace_photon(light))));
#endif
}

// Where that way led from a corner.
Corner by_way(Sample corner, uint way) {
    for (int k = 0; k < PHOTONS; k++) {
        if (corner.photon[k].landed.way == way) return corner.photon[k].landed;
    }
    return Corner(vec2(0.0), 0u);
}

// What of a smaller cell's flux lands in the map.
vec3 take(Sample corner[4], Sample centre, uint slot) {
    vec3 arrived = vec3(0.0);
    for (int k = 0; k < PHOTONS; k++) {
        Arrival a = centre.photon[k];
        if (a.landed.way == 0u) continue;
        Cell c;
        c.centre = a.landed;
        for (int at = 0; at < 4; at++) c.corner[at] = by_way(corner[at], a.landed.way);
        if (!is_one_sheet(c) || is_torn(c)) {
            arrived += put_point(c.centre.at, a.layer, a.flux, slot);
        } else if (!is_beside_map(bounds(c), push.side)) {
            arrived += spread_cell(c, a.layer, a.flux);
        }
    }
    return arrived;
}

// From left to right: corners above and below, then a centre and the corners right of it.
void refine_row(ivec2 first, uint slot) {
    Sample corner[4], centre;
    vec3 arrived = vec3(0.0);
    for (int step = 0; step < STEPS; step++) {
        int kind = step % 3, x = step / 3;
        Sample s = sample_at(first + ivec2(x, kind & 1), kind == 2);
        if (kind == 0) {
            corner[0] = corner[1];
            corner[3] = corner[2];
            corner[1] = s;
        } else if (kind == 1) {
            corner[2] = s;
            if (x > 0) arrived += take(corner, centre, slot);
        } else {
            centre = s;
        }
    }
    book(slot, arrived);
}

void main() {
    uint rows = uint(FINER) * cells_counts.data[2u * push.view];
    for (uint row = gl_GlobalInvocationID.x; row < rows; row += 64u * gl_NumWorkGroups.x) {
        int number = int(cells_list.data[row / uint(FINER)]);
        ivec2 cell = ivec2(number % push.size.x, number / push.size.x);
        refine_row(FINER * cell + ivec2(0, row % uint(FINER)), row);
    }
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The cells that one sheet of light is too coarse for, each traced as 4 x 4 smaller ones, a row of which an invocation takes.
// What is still no sheet, or torn, goes as points.

#define PUSH_MORE int side; float diameter; // texels
#include "light/sample.glsl"
#include "light/tracer.glsl"
#include "maps/cells.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 18, scalar) readonly buffer List { uint data[]; } cells_list;

const int FINER = 4; // smaller cells a side
const int STEPS = 3 * FINER + 2; // of a row: two corners, then a centre and two corners for each smaller cell

struct Sample {
    Corner landed;
    vec3 flux; // W
    int layer;
};

// A corner of the smaller cells, or a centre, counted from the view's first.
Sample sample_at(ivec2 at, bool centre) {
    LightSample light = light_sample(min(at, FINER * push.size - 1), FINER);
    if (!centre) light = light_sample_at(place_in_view(vec2(at), FINER), light.footprint);
    Photon p = trace_photon(light);
    uint way = photon_way(p);
    vec2 xy01;
    int layer = way == 0u ? NO_MAP : layer_of(p.receiver, push.light);
    if (layer != NO_MAP && !map_project(maps_views.data[layer].view, p.hit, p.normal, xy01)) layer = NO_MAP;
    return Sample(landed_at(p.hit, way, layer, push.side), p.flux, layer);
}

// What of a smaller cell's flux lands in the map.
vec3 take(Cell c, Sample centre, uint slot) {
    if (c.centre.way == 0u) return vec3(0.0);
    if (!is_one_sheet(c) || is_torn(c)) {
        return put_point(c.centre.at, centre.layer, centre.flux, slot);
    }
    return is_beside_map(bounds(c), push.side) ? vec3(0.0) : spread_cell(c, centre.layer, centre.flux);
}

// From left to right: corners above and below, then a centre and the corners right of it.
void refine_row(ivec2 first, uint slot) {
    Cell c;
    Sample centre;
    vec3 arrived = vec3(0.0);
    for (int step = 0; step < STEPS; step++) {
        int kind = step % 3, x = step / 3;
        Sample s = sample_at(first + ivec2(x, kind & 1), kind == 2);
        if (kind == 0) {
            c.corner[0] = c.corner[1];
            c.corner[3] = c.corner[2];
            c.corner[1] = s.landed;
        } else if (kind == 1) {
            c.corner[2] = s.landed;
            if (x > 0) arrived += take(c, centre, slot);
        } else {
            centre = s;
            c.centre = s.landed;
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

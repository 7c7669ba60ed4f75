#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The cells that one sheet of light is too coarse for, each traced as 4 x 4 smaller ones by a work group: first their corners
// and centres, each by an invocation, then the photons of each. What is still no sheet, or torn, goes as points.

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
const int CORNERS = FINER + 1;
const int FIRST_CENTRE = CORNERS * CORNERS;
const int SAMPLES = FIRST_CENTRE + FINER * FINER;

#ifdef LAYERS
const int PHOTONS = LAYERS;
#else
const int PHOTONS = 1;
#endif

// A photon that lands on a receiver.
struct Arrival {
    vec3 p;
    uint way; // 0: none
    vec3 flux; // W
    float normal; // packed
    uint receiver;
};

shared Arrival arrivals[SAMPLES][PHOTONS];
shared vec3 arrived[64]; // W, by the invocations

Arrival arrival_of(Photon p) {
    return Arrival(p.hit, photon_way(p), p.flux, octahedral_pack(p.normal), p.receiver);
}

#ifdef LAYERS
int traced; // of the samples

void end_photon(Photon p) {
    if (p.status != PHOTON_VALID) return;
    int layer = take_layer(sum_of_bands(p.flux));
    if (layer != NO_LAYER) arrivals[traced][layer] = arrival_of(p);
}
#endif

// Traces a corner of the smaller cells, or a centre, counted from the image's first.
void trace_sample(int number, ivec2 at, bool centre) {
    LightSample light = light_sample(min(at, FINER * push.size - 1), FINER);
    if (!centre) light = light_sample_at(place_in_view(vec2(at), FINER), light.footprint);
#ifdef LAYERS
    traced = number;
    layers_filled = 0;
    for (int k = 0; k < PHOTONS; k++) arrivals[number][k].way = 0u;
    trace_tree(light);
#else
    arrivals[number][0] = arrival_of(trace_photon(light));
#endif
}

// Where that way led from a corner.
Corner by_way(int corner, uint way, int map) {
    for (int k = 0; k < PHOTONS; k++) {
        if (arrivals[corner][k].way == way) return landed_at(arrivals[corner][k].p, way, map);
    }
    return Corner(vec2(0.0), 0u);
}

// What of a flux (W) about the centre of a smaller cell lands in a view's layer.
vec3 put_cell(ivec2 at, Arrival a, int map, vec3 flux, uint slot) {
    Cell c;
    c.centre = landed_at(a.p, a.way, map);
    for (int k = 0; k < 4; k++) {
        ivec2 corner = at + step_to(k);
        c.corner[k] = by_way(corner.y * CORNERS + corner.x, a.way, map);
    }
    if (c.centre.way == 0u) return vec3(0.0);
    if (!is_one_sheet(c) || is_torn(c)) return put_point(c.centre.at, map, flux, slot);
    return is_beside_map(bounds(c), push.side) ? vec3(0.0) : spread_cell(c, map, flux);
}

// What of a photon's lands in the map.
vec3 take(ivec2 at, int photon, uint slot) {
    Arrival a = arrivals[FIRST_CENTRE + at.y * FINER + at.x][photon];
    vec3 got = vec3(0.0);
    if (a.way == 0u) return got;
    for (int map = 0; map < maps_views.data.length(); map++) {
        float share = share_of(map, a.p, octahedral_unpack(a.normal), a.receiver);
        if (share > 0.0) got += put_cell(at, a, map, share * a.flux, slot);
    }
    return got;
}

void refine(uint cell) {
    int lane = int(gl_LocalInvocationIndex), number = int(cells_list.data[cell]);
    ivec2 first = FINER * ivec2(number % push.size.x, number / push.size.x);
    if (lane < FIRST_CENTRE) {
        trace_sample(lane, first + ivec2(lane % CORNERS, lane / CORNERS), false);
    } else if (lane < SAMPLES) {
        int centre = lane - FIRST_CENTRE;
        trace_sample(lane, first + ivec2(centre % FINER, centre / FINER), true);
    }
    barrier();
    vec3 got = vec3(0.0);
    for (int k = lane; k < FINER * FINER * PHOTONS; k += 64) {
        int at = k % (FINER * FINER);
        got += take(ivec2(at % FINER, at / FINER), k / (FINER * FINER), uint(number));
    }
    arrived[lane] = got;
    barrier();
    if (lane == 0) {
        for (int k = 1; k < 64; k++) got += arrived[k]; // in one order, or it would not repeat
        book(uint(number), got);
    }
    barrier();
}

void main() {
    uint cells = cells_counts.data[2u * push.view];
    for (uint cell = gl_WorkGroupID.x; cell < cells; cell += gl_NumWorkGroups.x) refine(cell);
}

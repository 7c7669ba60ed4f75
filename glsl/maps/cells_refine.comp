#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The cells of a level that one sheet of light is too coarse for, each traced as 4 x 4 smaller ones by a work group: first
// their corners and centres, each by an invocation, then the photons of each. With DEEPER what is still too coarse is listed
// for the next level; without it what is no sheet, or torn, goes as points.

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

layout(set = 0, binding = 18, scalar) readonly buffer List { uvec2 data[]; } cells_list;

#ifdef DEEPER
#define LISTS
#endif
#include "maps/finer.glsl"

const int FINER = 4; // smaller cells a side
const int GRID = 1 << 2 * CELLS_LEVEL; // the level's cells along a side of a view's texel
const int LEFT = 5; // samples of a cell that is left as it is
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

// Traces a corner of cells, or a centre, counted from the image's first, where a texel has so many a side.
void trace_sample(int number, ivec2 at, bool centre, int finer) {
    LightSample light = light_sample(min(at, finer * push.size - 1), finer);
    if (!centre) light = light_sample_at(place_in_view(vec2(at), finer), light.footprint);
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

// Which samples a cell is made of: its centre, and its corners in their order round it.
struct Samples {
    int centre;
    int corner[4];
};

Samples cell_samples(int number, bool whole) {
    ivec2 at = ivec2(number % FINER, number / FINER);
    Samples s;
    s.centre = whole ? 4 : FIRST_CENTRE + number;
    for (int k = 0; k < 4; k++) {
        ivec2 corner = at + step_to(k);
        s.corner[k] = whole ? k : corner.y * CORNERS + corner.x;
    }
    return s;
}

// What lies about a photon of a cell's centre, in a view's layer.
Cell cell_of(Samples s, Arrival a, int map) {
    Cell c;
    c.centre = landed_at(a.p, a.way, map);
    for (int k = 0; k < 4; k++) c.corner[k] = by_way(s.corner[k], a.way, map);
    return c;
}

// What of a photon's flux goes to a view's layer.
float share_of_arrival(Arrival a, int map) {
    return a.way == 0u ? 0.0 : share_of(map, a.p, octahedral_unpack(a.normal), a.receiver);
}

// What of a flux (W) about the centre of a cell lands in a view's layer.
vec3 put_cell(Cell c, int map, vec3 flux, uint slot) {
    if (c.centre.way == 0u) return vec3(0.0);
    if (!is_one_sheet(c) || is_torn(c)) return put_point(c.centre.at, map, flux, slot);
    return is_beside_map(bounds(c), push.side) ? vec3(0.0) : spread_cell(c, map, flux);
}

// What of a photon's of a cell's centre lands in the map.
vec3 take(Samples s, int photon, uint slot) {
    Arrival a = arrivals[s.centre][photon];
    vec3 got = vec3(0.0);
    for (int map = 0; map < maps_views.data.length(); map++) {
        float share = share_of_arrival(a, map);
        if (share > 0.0) got += put_cell(cell_of(s, a, map), map, share * a.flux, slot);
    }
    return got;
}

#ifdef DEEPER
shared bool deeper[FINER * FINER];

// Whether a photon of a cell's centre is too coarse for what is about it, in any view.
bool is_coarse_arrival(Samples s, Arrival a) {
    for (int map = 0; map < maps_views.data.length(); map++) {
        if (!(share_of_arrival(a, map) > 0.0)) continue;
        Cell c = cell_of(s, a, map);
        vec4 b = bounds(c);
        if (!is_beside_map(b, push.side) && (!is_one_sheet(c) || is_coarse(c, b))) return true;
    }
    return false;
}

// Whether a corner's photon lands in the map by a way that none of the centre's went.
bool is_stray(Samples s, Arrival a) {
    if (a.way == 0u) return false;
    for (int photon = 0; photon < PHOTONS; photon++) {
        if (arrivals[s.centre][photon].way == a.way) return false;
    }
    for (int map = 0; map < maps_views.data.length(); map++) {
        if (!map_is_of(map, a.receiver, push.light)) continue;
        Corner c = landed_at(a.p, a.way, map);
        if (c.way != 0u && !is_beside_map(vec4(c.at, c.at), push.side)) return true;
    }
    return false;
}

// The flux (W, all bands) of the brightest photon for which a cell is worth tracing finer; none, if it is not.
float coarse_flux(Samples s) {
    float most = 0.0;
    for (int photon = 0; photon < PHOTONS; photon++) {
        Arrival a = arrivals[s.centre][photon];
        if (is_coarse_arrival(s, a)) most = max(most, a.flux.r + a.flux.g + a.flux.b);
        for (int k = 0; k < 4; k++) {
            Arrival corner = arrivals[s.corner[k]][photon];
            if (is_stray(s, corner)) most = max(most, corner.flux.r + corner.flux.g + corner.flux.b);
        }
    }
    return most;
}
#endif

// Books what invocations brought to the map.
void add_up(int lane, vec3 got, uint slot) {
    arrived[lane] = got;
    barrier();
    if (lane == 0) {
        for (int k = 1; k < 64; k++) got += arrived[k]; // in one order, or it would not repeat
        book(slot, got);
    }
    barrier();
}

// Traces what the invocation has of a cell, `whole` where it is left as it is. One call: tracers are large.
void trace_own(ivec2 at, int lane, bool whole) {
    int centre = lane - FIRST_CENTRE;
    if (lane >= (whole ? LEFT : SAMPLES)) return;
    bool is_centre = whole ? lane == 4 : centre >= 0;
    ivec2 step = is_centre ? ivec2(centre % FINER, centre / FINER) : ivec2(lane % CORNERS, lane / CORNERS);
    if (whole) step = is_centre ? ivec2(0) : step_to(lane);
    trace_sample(lane, (whole ? 1 : FINER) * at + step, is_centre, whole ? GRID : FINER * GRID);
}

void refine(ivec2 at, int lane, bool whole, uint slot) {
    trace_own(at, lane, whole);
    barrier();
    int cells = whole ? 1 : FINER * FINER;
#ifdef DEEPER
    if (lane < cells) {
        float flux = whole ? 0.0 : coarse_flux(cell_samples(lane, false));
        deeper[lane] = flux > 0.0;
        if (flux > 0.0) list_cell(push.view, uint(CELLS_LEVEL + 1), FINER * at + ivec2(lane % FINER, lane / FINER), flux);
    }
    barrier();
#endif
    vec3 got = vec3(0.0);
    for (int k = lane; k < cells * PHOTONS; k += 64) {
        int number = k % cells;
#ifdef DEEPER
        if (deeper[number]) continue;
#endif
        got += take(cell_samples(number, whole), k / cells, slot);
    }
    add_up(lane, got, slot);
}

void main() {
    int lane = int(gl_LocalInvocationIndex);
    uint row = row_of(push.view, uint(CELLS_LEVEL)), cells = cells_rows.data[row + 3u], least = least_octave(row);
    for (uint cell = gl_WorkGroupID.x; cell < cells; cell += gl_NumWorkGroups.x) {
        uvec2 listed = cells_list.data[cell];
        ivec2 at = ivec2(listed.x & 0xffffffu, listed.y);
        refine(at, lane, listed.x >> 24 < least, uint(at.y * GRID * push.size.x + at.x));
    }
}

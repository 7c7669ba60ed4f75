#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The cells of a level that pay for it, each traced as 4 x 4 smaller ones by a work group: first their corners and centres, each
// by an invocation, then the photons of each. With DEEPER what is still cut or torn is listed for the next level; without
// it that goes as points.

// texels
#define PUSH_MORE int side; float diameter; float blur;
#include "light/sample.glsl"
#ifdef LAYERS
#include "light/layers.glsl"
#include "light/tree.glsl"
#else
#include "light/tracer.glsl"
#endif
#include "maps/cell_error.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 18, scalar) readonly buffer List { uvec2 data[]; } cells_list;

#ifdef DEEPER
#define LISTS
#endif
#include "maps/finer.glsl"

#include "maps/photons.glsl"
#if CELLS_LEVEL == 0
layout(set = 0, binding = 14) uniform PHOTON_SAMPLER photons_way;
layout(set = 0, binding = 15) uniform PHOTON_SAMPLER corners_hit;
layout(set = 0, binding = 16) uniform PHOTON_SAMPLER corners_way;
#ifdef SHARED_EDGES
#include "maps/cell_edges.glsl"
#endif
#endif

const int FINER = 4; // smaller cells a side
const int GRID = 1 << 2 * CELLS_LEVEL; // the level's cells along a side of a view's texel
const int LEFT = 5; // samples of a cell that is left as it is
const int CORNERS = FINER + 1;
const int FIRST_CENTRE = CORNERS * CORNERS;
const int SAMPLES = FIRST_CENTRE + FINER * FINER;

// A photon that lands on a receiver.
struct Arrival {
    vec3 p;
    uint way; // 0: none
    vec3 flux; // W
    float normal; // packed
    uint receiver;
};

shared Arrival arrivals[SAMPLES][PHOTONS];

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
    LightSample light;
    if (centre) light = light_sample(at, finer);
    else light = light_corner(at, finer);
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
// Flux (W, all bands) by a way: the most of what was traced here.
float flux_by(uint way) {
    float most = 0.0;
    for (int sample_at = 0; sample_at < SAMPLES; sample_at++) {
        for (int photon = 0; photon < PHOTONS; photon++) {
            Arrival a = arrivals[sample_at][photon];
            if (a.way == way) most = max(most, a.flux.r + a.flux.g + a.flux.b);
        }
    }
    return most;
}

// What a photon of a cell's centre is wrong by in all views, if it is cut or torn. What bends alone is left: a cell of a
// quarter of the side has a 64th of the error.
float arrival_error(Samples s, Arrival a) {
    float error = 0.0;
    for (int map = 0; map < maps_views.data.length(); map++) {
        float flux = share_of_arrival(a, map) * (a.flux.r + a.flux.g + a.flux.b);
        if (!(flux > 0.0)) continue;
        Cell c = cell_of(s, a, map);
        vec4 b = bounds(c);
        if (is_beside_map(b, push.side)) continue;
        if (!is_one_sheet(c)) error += cut_error(flux, dim_flux(map, a.p));
        else if (is_torn(c)) error += torn_error(b, flux, dim_flux(map, a.p));
    }
    return error;
}

// What lands in the map at a corner by a way that no photon of the centre went.
float stray_error(Samples s, Arrival a) {
    for (int photon = 0; photon < PHOTONS; photon++) {
        if (arrivals[s.centre][photon].way == a.way) return 0.0;
    }
    int map = map_hit(a.p, a.way, a.receiver);
    return map < 0 ? 0.0 : cut_error(flux_by(a.way), dim_flux(map, a.p));
}

uint octave_of_cell(Samples s) {
    float error = 0.0, stray = 0.0;
    for (int photon = 0; photon < PHOTONS; photon++) {
        error += arrival_error(s, arrivals[s.centre][photon]);
        for (int k = 0; k < 4; k++) stray = max(stray, stray_error(s, arrivals[s.corner[k]][photon]));
    }
    return octave_of(error + stray);
}

// Lists a smaller cell if it pays.
bool goes_deeper(ivec2 at, Samples s) {
    uint octave = octave_of_cell(s), row = row_of(push.view, uint(CELLS_LEVEL + 1));
    if (octave < cells_rows.data[row_of(push.view, 0u) + DEEPER_FROM]) return false;
    atomicAdd(cells_rows.data[row + WEIGHTS + octave], 1u);
    list_cell(row, at, octave);
    return true;
}

shared bool deeper[FINER * FINER];
#endif

#if CELLS_LEVEL == 0
// Takes a corner or the centre of a cell of the view's own grid, whose flux is not asked for.
void recall(int number, ivec2 texel, bool centre) {
    for (int k = 0; k < PHOTONS; k++) {
        vec4 hit = centre ? hit_at(texel, k) : texelFetch(corners_hit, PHOTON_PLACE(texel, k), 0);
        vec4 way = centre ? texelFetch(photons_way, PHOTON_PLACE(texel, k), 0) : texelFetch(corners_way, PHOTON_PLACE(texel, k), 0);
        arrivals[number][k] = Arrival(hit.xyz, uint(way.r), vec3(0.0), 0.0, uint(max(hit.w, 1.0)) - 1u);
    }
}

#ifdef SHARED_EDGES
// Takes a sample on an edge that was traced for the cell, or for a listed neighbour; false where it was for none.
bool recall_edge(int number, ivec2 cell, ivec2 step) {
    ivec2 owner = cell + step / FINER;
    if (any(greaterThanEqual(owner, push.size)) || cells_edges.data[edges_of(owner)].listed == 0u) {
        atomicAdd(cells_rows.data[row_of(push.view, 0u) + ALONE], 1u);
        return false;
    }
    for (int k = 0; k < PHOTONS; k++) {
        EdgePhoton known = cells_edges.data[edges_of(owner)].photons[edge_number(step) * PHOTONS + k];
        // Of its flux the sum is asked for alone.
        arrivals[number][k] = Arrival(known.p, known.way, vec3(known.flux, 0.0, 0.0), 0.0, known.receiver);
    }
    return true;
}
#endif
#endif

// Traces what the invocation has of a cell, `whole` where it is left as it is. One call: tracers are large.
void trace_own(ivec2 at, int lane, bool whole) {
    int centre = lane - FIRST_CENTRE;
    if (lane >= (whole ? LEFT : SAMPLES)) return;
    bool is_centre = whole ? lane == 4 : centre >= 0;
    ivec2 step = is_centre ? ivec2(centre % FINER, centre / FINER) : ivec2(lane % CORNERS, lane / CORNERS);
#if CELLS_LEVEL == 0
    bool middle = step == ivec2(FINER / 2);
    if (!is_centre && (middle || all(equal(step % FINER, ivec2(0))))) {
        recall(lane, middle ? at : at + step / FINER, middle);
        return;
    }
#ifdef SHARED_EDGES
    if (!is_centre && any(equal(step % FINER, ivec2(0))) && recall_edge(lane, at, step)) return;
#endif
#else
    if (whole) step = is_centre ? ivec2(0) : step_to(lane);
#endif
    trace_sample(lane, (whole ? 1 : FINER) * at + step, is_centre, whole ? GRID : FINER * GRID);
}

void refine(ivec2 at, int lane, bool whole, uint slot) {
    trace_own(at, lane, whole);
    barrier();
    int cells = whole ? 1 : FINER * FINER;
#ifdef DEEPER
    if (lane < cells) deeper[lane] = !whole && goes_deeper(FINER * at + ivec2(lane % FINER, lane / FINER), cell_samples(lane, false));
#ifdef LAYERS
    barrier(); // else an invocation asks only for what it has itself decided
#endif
#endif
    for (int k = lane; k < cells * PHOTONS; k += 64) {
        int number = k % cells;
#ifdef DEEPER
        if (deeper[number]) continue;
#endif
        book(slot + uint(k), take(cell_samples(number, whole), k / cells, slot + uint(k)));
    }
    barrier();
}

void main() {
    int lane = int(gl_LocalInvocationIndex);
    uint row = row_of(push.view, uint(CELLS_LEVEL)), cells = cells_rows.data[row + LISTED];
#if CELLS_LEVEL == 0
    uint least = 0u; // of more cells than a list takes none is in it
#else
    uint least = least_octave(row, 0u);
#endif
    for (uint cell = gl_WorkGroupID.x; cell < cells; cell += gl_NumWorkGroups.x) {
        uvec2 listed = cells_list.data[cell];
        ivec2 at = ivec2(listed.x & 0xffffffu, listed.y);
        refine(at, lane, listed.x >> 24 < least, uint(at.y * GRID * push.size.x + at.x));
    }
}

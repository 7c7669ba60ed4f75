// Cells of light: what lies between four corners of a light sample's texel and its centre lands as four triangles, a
// quarter of the centre's flux each. What all ways to take a cell share; the including file has `push.side`,
// `push.diameter` and `push.light`.
#ifndef CELLS_GLSL
#define CELLS_GLSL

#include "maps/spread.glsl"
#include "maps/views.glsl"
#include "shared/flux_sums.glsl"
#include "shared/splat.glsl"

const uint SLOTS = 64u; // places beyond the map's, twice: sums of what arrived, and of what of it went as points

// A corner's or a centre's landing.
struct Corner {
    vec2 at;   // texels of the map
    uint way;  // that it came by and where it landed; 0: nowhere in the map's plane
};

struct Cell {
    Corner corner[4]; // in their order round it
    Corner centre;
};

// The corners' places about a cell's, in their order round it.
ivec2 step_to(int k) {
    return ivec2((k + 1) >> 1 & 1, k >> 1);
}

// Texels beyond which a place is not told from infinity.
const float FARTHEST = 1e5;

// Where in the layer of a view.
Corner landed_at(vec3 p, uint way, int map) {
    vec2 xy01;
    if (way == 0u || !view_project(maps_views.data[map].view, p, xy01)) return Corner(vec2(0.0), 0u);
    vec2 at = xy01 * float(push.side);
    return Corner(at, all(lessThan(abs(at), vec2(FARTHEST))) ? way : 0u);
}

// What of a photon's flux goes to a view's layer.
float share_of(int map, vec3 p, vec3 n, uint receiver) {
    vec2 xy01;
    if (!map_is_of(map, receiver, push.light)) return 0.0;
    return map_share(maps_views.data[map], p, n, xy01);
}

bool is_one_sheet(Cell c) {
    uvec4 corners = uvec4(c.corner[0].way, c.corner[1].way, c.corner[2].way, c.corner[3].way);
    return c.centre.way != 0u && all(equal(corners, uvec4(c.centre.way)));
}

// How far the centre lands beside the middle of the corners: in texels, and of how far apart they land.
vec2 bend(Cell c) {
    const float LEAST = 1e-9;
    vec2 middle = 0.25 * (c.corner[0].at + c.corner[1].at + c.corner[2].at + c.corner[3].at);
    float beside = distance(middle, c.centre.at);
    float across = max(distance(c.corner[0].at, c.corner[2].at), distance(c.corner[1].at, c.corner[3].at));
    return vec2(beside, beside / max(across, LEAST));
}

// Whether the light of neighbouring rays parts within the cell, at a crease or behind an edge: its triangles would
// reach over places where none lands.
bool is_torn(Cell c) {
    const float TEXELS = 0.5;
    const float SHARE = 0.2;
    vec2 b = bend(c);
    return b.x > TEXELS && b.y > SHARE;
}

// Least and greatest coordinate of what landed.
vec4 bounds(Cell c) {
    const float FAR = 3e38;
    vec4 b = vec4(vec2(FAR), vec2(-FAR));
    if (c.centre.way != 0u) b = vec4(c.centre.at, c.centre.at);
    for (int k = 0; k < 4; k++) {
        if (c.corner[k].way == 0u) continue;
        b = vec4(min(b.xy, c.corner[k].at), max(b.zw, c.corner[k].at));
    }
    return b;
}

bool is_beside_map(vec4 bounds, int side) {
    return !(all(lessThan(bounds.xy, vec2(side))) && all(greaterThanEqual(bounds.zw, vec2(0.0))));
}

// The first view in whose window light lands that came by a way to a receiver; -1 if none.
int map_hit(vec3 p, uint way, uint receiver) {
    if (way == 0u) return -1;
    for (int map = 0; map < maps_views.data.length(); map++) {
        if (!map_is_of(map, receiver, push.light)) continue;
        Corner c = landed_at(p, way, map);
        if (c.way != 0u && !is_beside_map(vec4(c.at, c.at), push.side)) return map;
    }
    return -1;
}

void put(ivec2 texel, int layer, vec3 flux) {
    add_flux(uint((layer * push.side + texel.y) * push.side + texel.x), flux);
}

// Of the map, whose last views lie in its last layer.
uint places() {
    return (maps_views.data[maps_views.data.length() - 1].layer + 1u) * uint(push.side * push.side);
}

void book(uint slot, vec3 arrived) {
    add_flux(places() + slot % SLOTS, arrived);
}

// Rows of a piece of a cell too large for one invocation.
struct Large {
    Flat shape;
    vec3 flux; // W, of all its rows
    int layer;
    int row; // the first, counted from the first that the map has of it
};

layout(set = 0, binding = 19, scalar) buffer Counts { uint data[]; } cells_counts; // large parts of each view
layout(set = 0, binding = 20, scalar) buffer LargeList { Large data[]; } cells_large;

// Rows of a part, of which a piece has `across` texels each.
int rows_of_part(int across) {
    const int TEXELS = 4096; // of a part: some tens for each of a work group's invocations
    return max(TEXELS / across, 1);
}

// What one of several invocations spreads of a part.
void spread_part(Large large, int which, int several) {
    const int PIECE = 16; // texels of a row
    ivec2 first, last;
    if (!reach(large.shape, push.side, first, last)) return;
    Flat t = from_texel(large.shape, first);
    vec3 density = density_of(t, large.flux);
    ivec2 size = last - first + 1;
    int rows = min(rows_of_part(size.x), size.y - large.row), pieces = (size.x + PIECE - 1) / PIECE;
    for (int k = which; k < pieces * rows; k += several) {
        int from = k / rows * PIECE, row = large.row + k % rows;
        spread_row(t, row, from, min(from + PIECE, size.x) - 1, first, large.layer, density);
    }
}

// Spreads what few texels hold, and lists the rest while there is room: its neighbours would wait for it.
void spread_or_list(Flat t, int layer, vec3 flux) {
    const int FEW = 64;
    ivec2 first, last;
    if (!reach(t, push.side, first, last)) return;
    ivec2 size = last - first + 1;
    if (size.x * size.y <= FEW || is_thin(t)) {
        spread(t, push.side, layer, flux);
        return;
    }
    int rows = rows_of_part(size.x);
    uint parts = uint((size.y + rows - 1) / rows), place = atomicAdd(cells_counts.data[push.view], parts);
    for (uint part = 0u; part < parts; part++) {
        Large large = Large(t, flux, layer, int(part) * rows);
        if (place + part < uint(cells_large.data.length())) {
            cells_large.data[place + part] = large;
        } else {
            spread_part(large, 0, 1);
        }
    }
}

// A cell's flux; returns what of it lands in the map. A quarter for each of the triangles about the centre, which never fold;
// where none is turned over and they are alike, or so small that nobody sees where in the quad light lies, that is the
// quad, for a fraction of the additions.
vec3 spread_cell(Cell c, int map, vec3 flux) {
    int layer = int(maps_views.data[map].layer);
    const float ALIKE = 0.9;  // least of their areas to the greatest
    const float SMALL = 1.5;  // texels across
    vec2 m = c.centre.at;
    Flat triangles[4];
    vec4 areas;
    for (int k = 0; k < 4; k++) {
        triangles[k] = triangle_of(c.corner[k].at, c.corner[(k + 1) & 3].at, m);
        areas[k] = twice_area(triangles[k]);
    }
    Flat quad = Flat(vec4(c.corner[0].at.x, c.corner[1].at.x, c.corner[2].at.x, c.corner[3].at.x),
                     vec4(c.corner[0].at.y, c.corner[1].at.y, c.corner[2].at.y, c.corner[3].at.y));
    vec2 size = vec2(most(quad.x) - least(quad.x), most(quad.y) - least(quad.y));
    float turned = least(areas) * most(areas);
    float alike = least(abs(areas)) / max(most(abs(areas)), 1e-30);
    if (turned > 0.0 && !is_thin(quad) && (alike >= ALIKE || max(size.x, size.y) <= SMALL)) {
        spread_or_list(quad, layer, flux);
        return share_within(quad, float(push.side)) * flux;
    }
    vec3 arrived = vec3(0.0);
    for (int k = 0; k < 4; k++) {
        spread_or_list(triangles[k], layer, 0.25 * flux);
        arrived += 0.25 * share_within(triangles[k], float(push.side)) * flux;
    }
    return arrived;
}

// Texels of one axis that a splat about p covers: as `splat_norm` sums over them.
ivec2 covered(float p, float d) {
    return ivec2(max(int(ceil(p - 0.5 * d - 0.5)), 0), min(int(ceil(p + 0.5 * d - 0.5)), push.side));
}

// A light sample of which nothing better is known, as a splat of fixed size; returns what of its flux lands in the map.
vec3 put_point(vec2 at, int map, vec3 flux, uint slot) {
    int layer = int(maps_views.data[map].layer);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(push.side)))) return vec3(0.0);
    float d = splat_diameter(push.diameter);
    vec2 p = vec2(splat_snap(at.x), splat_snap(at.y));
    float norm = splat_norm(p.x, d, push.side) * splat_norm(p.y, d, push.side);
    if (!(norm > 0.0)) return vec3(0.0);
    ivec2 columns = covered(p.x, d), rows = covered(p.y, d);
    for (int y = rows.x; y < rows.y; y++) {
        float across = splat_weight(float(y) + 0.5, p.y, d) / norm;
        for (int x = columns.x; x < columns.y; x++) {
            put(ivec2(x, y), layer, across * splat_weight(float(x) + 0.5, p.x, d) * flux);
        }
    }
    add_flux(places() + SLOTS + slot % SLOTS, flux);
    return flux;
}

// What of a flux (W) about the centre of a cell lands in a view's layer: spread, or as a point where it is torn or no sheet.
vec3 put_cell(Cell c, int map, vec3 flux, uint slot) {
    if (c.centre.way == 0u) return vec3(0.0);
    if (!is_one_sheet(c) || is_torn(c)) return put_point(c.centre.at, map, flux, slot);
    return is_beside_map(bounds(c), push.side) ? vec3(0.0) : spread_cell(c, map, flux);
}

#endif

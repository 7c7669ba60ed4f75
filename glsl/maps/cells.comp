#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Every cell of a view that is one sheet of light and flat enough is spread over the map. With REFINED the others are listed,
// to be traced finer; without it they are spread unless they are torn, and else their centres are splatted.

#include "shared/photon.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // of a point's splat, texels
    uint light;
    uint view;
    ivec2 size;     // cells
} push;

#include "maps/cells.glsl"
#include "maps/photons.glsl"

layout(set = 0, binding = 14) uniform PHOTON_SAMPLER photons_way;
layout(set = 0, binding = 15) uniform PHOTON_SAMPLER corners_hit;
layout(set = 0, binding = 16) uniform PHOTON_SAMPLER corners_way;
#ifdef REFINED
#define LISTS
#include "maps/finer.glsl"
#endif

// The layer that takes the centre's photon, or none.
int layer_of_centre(vec4 hit, float normal) {
    vec2 xy01;
    if (hit.w == 0.0) return NO_MAP;
    int layer = layer_of(uint(hit.w) - 1u, push.light);
    if (layer == NO_MAP) return NO_MAP;
    return map_project(maps_views.data[layer].view, hit.xyz, photon_normal(normal), xy01) ? layer : NO_MAP;
}

// Of a cell's corners, the ways that its photons went; 0 where there is none.
uint corner_way[4][PHOTONS];

ivec2 corner_place(ivec2 texel, int k) {
    return texel + step_to(k);
}

Corner corner_landed(ivec2 texel, int k, int photon) {
    vec4 hit = texelFetch(corners_hit, PHOTON_PLACE(corner_place(texel, k), photon), 0);
    if (hit.w == 0.0) return Corner(vec2(0.0), 0u);
    return landed_at(hit.xyz, corner_way[k][photon], layer_of(uint(hit.w) - 1u, push.light), push.side);
}

// What lies between a photon of the centre and those of the corners that went its way.
Cell cell_about(ivec2 texel, Corner centre) {
    Cell cell;
    cell.centre = centre;
    for (int k = 0; k < 4; k++) {
        cell.corner[k] = Corner(vec2(0.0), 0u);
        for (int photon = 0; photon < PHOTONS; photon++) {
            if (corner_way[k][photon] == centre.way) cell.corner[k] = corner_landed(texel, k, photon);
        }
    }
    return cell;
}

// Whether light lands in the map at a corner by a way that no photon of the centre went.
bool has_strays(ivec2 texel, uint way[PHOTONS]) {
    for (int k = 0; k < 4; k++) {
        for (int photon = 0; photon < PHOTONS; photon++) {
            bool known = corner_way[k][photon] == 0u;
            for (int other = 0; other < PHOTONS; other++) known = known || corner_way[k][photon] == way[other];
            if (known) continue;
            Corner c = corner_landed(texel, k, photon);
            if (c.way != 0u && !is_beside_map(vec4(c.at, c.at), push.side)) return true;
        }
    }
    return false;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, push.size))) return;
    uint way[PHOTONS], number = uint(texel.y * push.size.x + texel.x);
    for (int photon = 0; photon < PHOTONS; photon++) {
        way[photon] = uint(texelFetch(photons_way, PHOTON_PLACE(texel, photon), 0).r);
        for (int k = 0; k < 4; k++) {
            corner_way[k][photon] = uint(texelFetch(corners_way, PHOTON_PLACE(corner_place(texel, k), photon), 0).r);
        }
    }
    Cell cells[PHOTONS];
    int layers[PHOTONS]; // that take them, or none
    vec3 flux[PHOTONS];  // W
    bool coarse = false;
    float most = 0.0; // W, all bands
    for (int photon = 0; photon < PHOTONS; photon++) {
        vec4 hit = hit_at(texel, photon), stored = flux_at(texel, photon);
        flux[photon] = photon_flux(stored.rgb);
        layers[photon] = layer_of_centre(hit, stored.w);
        if (layers[photon] == NO_MAP) continue;
        Cell cell = cell_about(texel, landed_at(hit.xyz, way[photon], layers[photon], push.side));
        vec4 b = bounds(cell);
        if (is_beside_map(b, push.side)) layers[photon] = NO_MAP;
        cells[photon] = cell;
#ifdef REFINED
        if (layers[photon] == NO_MAP) continue;
        coarse = coarse || !is_one_sheet(cell) || is_coarse(cell, b);
        most = max(most, flux[photon].r + flux[photon].g + flux[photon].b);
#endif
    }
#ifdef REFINED
    if (coarse || has_strays(texel, way)) {
        list_cell(push.view, 0u, texel, most);
        return;
    }
#endif
    for (int photon = 0; photon < PHOTONS; photon++) {
        if (layers[photon] == NO_MAP) continue;
        Cell cell = cells[photon];
        bool whole = is_one_sheet(cell) && !is_torn(cell);
        if (cell.centre.way == 0u) continue;
        book(number, whole ? spread_cell(cell, layers[photon], flux[photon])
                           : put_point(cell.centre.at, layers[photon], flux[photon], number));
    }
}

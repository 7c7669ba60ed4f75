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

// Of a cell's corners, the ways that its photons went; 0 where there is none.
uint corner_way[4][PHOTONS];

vec4 corner_hit(ivec2 texel, int k, int photon) {
    return texelFetch(corners_hit, PHOTON_PLACE(texel + step_to(k), photon), 0);
}

// What lies between a photon of the centre and those of the corners that went its way.
Cell cell_about(ivec2 texel, vec3 p, uint way, int map) {
    Cell cell;
    cell.centre = landed_at(p, way, map);
    for (int k = 0; k < 4; k++) {
        cell.corner[k] = Corner(vec2(0.0), 0u);
        for (int photon = 0; photon < PHOTONS; photon++) {
            if (corner_way[k][photon] == way) cell.corner[k] = landed_at(corner_hit(texel, k, photon).xyz, way, map);
        }
    }
    return cell;
}

// Whether a corner's photon lands in the map.
bool lands_in_map(vec4 hit, uint way) {
    for (int map = 0; map < maps_views.data.length(); map++) {
        if (!map_is_of(map, uint(hit.w) - 1u, push.light)) continue;
        Corner c = landed_at(hit.xyz, way, map);
        if (c.way != 0u && !is_beside_map(vec4(c.at, c.at), push.side)) return true;
    }
    return false;
}

// Whether light lands in the map at a corner by a way that no photon of the centre went.
bool has_strays(ivec2 texel, uint way[PHOTONS]) {
    for (int k = 0; k < 4; k++) {
        for (int photon = 0; photon < PHOTONS; photon++) {
            bool known = corner_way[k][photon] == 0u;
            for (int other = 0; other < PHOTONS; other++) known = known || corner_way[k][photon] == way[other];
            if (!known && lands_in_map(corner_hit(texel, k, photon), corner_way[k][photon])) return true;
        }
    }
    return false;
}

// Whether a photon of the centre is too coarse for what is about it, in any view; with `spreads` its light is spread.
bool is_coarse_photon(ivec2 texel, int photon, uint way, bool spreads, uint number) {
    vec4 hit = hit_at(texel, photon), flux = flux_at(texel, photon);
    if (hit.w == 0.0) return false;
    vec3 n = photon_normal(flux.w);
    for (int map = 0; map < maps_views.data.length(); map++) {
        float share = share_of(map, hit.xyz, n, uint(hit.w) - 1u);
        if (!(share > 0.0)) continue;
        Cell cell = cell_about(texel, hit.xyz, way, map);
        vec4 b = bounds(cell);
        if (is_beside_map(b, push.side)) continue;
        bool whole = is_one_sheet(cell);
        if (!spreads) {
            if (!whole || is_coarse(cell, b)) return true;
        } else if (whole && !is_torn(cell)) {
            book(number, spread_cell(cell, map, share * photon_flux(flux.rgb)));
        } else if (cell.centre.way != 0u) {
            book(number, put_point(cell.centre.at, map, share * photon_flux(flux.rgb), number));
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
            corner_way[k][photon] = uint(texelFetch(corners_way, PHOTON_PLACE(texel + step_to(k), photon), 0).r);
        }
    }
#ifdef REFINED
    bool coarse = has_strays(texel, way);
    float most = 0.0; // W, all bands
    for (int photon = 0; photon < PHOTONS; photon++) {
        vec3 flux = photon_flux(flux_at(texel, photon).rgb);
        most = max(most, flux.r + flux.g + flux.b);
        coarse = coarse || is_coarse_photon(texel, photon, way[photon], false, number);
    }
    if (coarse) {
        list_cell(push.view, 0u, texel, most);
        return;
    }
#endif
    for (int photon = 0; photon < PHOTONS; photon++) is_coarse_photon(texel, photon, way[photon], true, number);
}

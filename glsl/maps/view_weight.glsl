// What a cell of a view's own grid is wrong by: the octave of its weight.
#ifndef VIEW_WEIGHT_GLSL
#define VIEW_WEIGHT_GLSL

#include "maps/view_cells.glsl"
#include "maps/cell_error.glsl"
#include "maps/finer.glsl"

bool is_in_view(ivec2 texel) {
    return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, push.size));
}

// Where that way led from the centre of another cell.
Corner beside(ivec2 texel, uint way, int map) {
    if (!is_in_view(texel)) return Corner(vec2(0.0), 0u);
    for (int photon = 0; photon < PHOTONS; photon++) {
        if (way_at(texel, photon) == way) return landed_at(hit_at(texel, photon).xyz, way, map);
    }
    return Corner(vec2(0.0), 0u);
}

// Of the centres before and after one; what the cell itself says, where they are of other sheets.
vec2 second_difference(ivec2 texel, ivec2 step, Corner centre, int map, vec2 own) {
    Corner before = beside(texel - step, centre.way, map), after = beside(texel + step, centre.way, map);
    return before.way != 0u && after.way != 0u ? before.at + after.at - 2.0 * centre.at : own;
}

Curve curve_about(ivec2 texel, Cell c, int map) {
    Curve k = curve_of(c);
    k.uu = second_difference(texel, ivec2(1, 0), c.centre, map, k.uu);
    k.vv = second_difference(texel, ivec2(0, 1), c.centre, map, k.vv);
    return k;
}

// Of a photon of the centre, in all views.
float photon_error(ivec2 texel, int photon) {
    vec4 hit = hit_at(texel, photon), stored = flux_at(texel, photon);
    if (hit.w == 0.0) return 0.0;
    vec3 n = photon_normal(stored.w), watts = photon_flux(stored.rgb);
    float error = 0.0;
    for (int map = 0; map < maps_views.data.length(); map++) {
        float share = share_of(map, hit.xyz, n, uint(hit.w) - 1u);
        if (!(share > 0.0)) continue;
        Cell cell = cell_about(texel, hit.xyz, centre_way[photon], map);
        vec4 b = bounds(cell);
        if (is_beside_map(b, push.side)) continue;
        float flux = share * (watts.r + watts.g + watts.b), dim = dim_flux(map, hit.xyz);
        if (!is_one_sheet(cell)) error += cut_error(flux, dim);
        else if (is_torn(cell)) error += torn_error(b, flux, dim);
        else error += sheet_error(cell, curve_about(texel, cell, map), flux, dim);
    }
    return error;
}

// Flux (W, all bands) by a way about a corner: the most of the centres around it, or all that a cell is lit with.
float flux_about(ivec2 corner, uint way) {
    float most = 0.0;
    for (int k = 0; k < 4; k++) {
        ivec2 at = corner - step_to(k);
        if (!is_in_view(at)) continue;
        for (int photon = 0; photon < PHOTONS; photon++) {
            if (way_at(at, photon) != way) continue;
            vec3 flux = photon_flux(flux_at(at, photon).rgb);
            most = max(most, flux.r + flux.g + flux.b);
        }
    }
    return most > 0.0 ? most : cells_lights.data[push.view].x;
}

// Of what lands in the map at a corner by a way that no photon of the centre went.
float stray_error(ivec2 texel, int k, int photon) {
    uint way = corner_way[k][photon];
    for (int other = 0; other < PHOTONS; other++) {
        if (centre_way[other] == way) return 0.0;
    }
    vec4 hit = corner_hit(texel, k, photon);
    int map = map_hit(hit.xyz, way, uint(hit.w) - 1u);
    return map < 0 ? 0.0 : cut_error(flux_about(texel + step_to(k), way), dim_flux(map, hit.xyz));
}

// `read_ways` comes before.
uint octave_at(ivec2 texel) {
    float error = 0.0, stray = 0.0;
    for (int photon = 0; photon < PHOTONS; photon++) {
        error += photon_error(texel, photon);
        for (int k = 0; k < 4; k++) stray = max(stray, stray_error(texel, k, photon));
    }
    return octave_of(error + stray);
}

#endif

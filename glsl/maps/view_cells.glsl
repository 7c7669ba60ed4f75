// The cells of a view's own grid, of the photons of its centres and corners.
#ifndef VIEW_CELLS_GLSL
#define VIEW_CELLS_GLSL

#include "shared/photon.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // of a point's splat, texels
    uint light;
    uint view;
    ivec2 size;     // cells
    float blur;     // texels
} push;

#include "maps/cells.glsl"
#include "maps/photons.glsl"

layout(set = 0, binding = 14) uniform PHOTON_SAMPLER photons_way;
layout(set = 0, binding = 15) uniform PHOTON_SAMPLER corners_hit;
layout(set = 0, binding = 16) uniform PHOTON_SAMPLER corners_way;

// Of a cell's centre and of its corners, the ways that its photons went; 0 where there is none.
uint centre_way[PHOTONS];
uint corner_way[4][PHOTONS];

uint way_at(ivec2 texel, int photon) {
    return uint(texelFetch(photons_way, PHOTON_PLACE(texel, photon), 0).r);
}

void read_ways(ivec2 texel) {
    for (int photon = 0; photon < PHOTONS; photon++) {
        centre_way[photon] = way_at(texel, photon);
        for (int k = 0; k < 4; k++) {
            corner_way[k][photon] = uint(texelFetch(corners_way, PHOTON_PLACE(texel + step_to(k), photon), 0).r);
        }
    }
}

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

#endif

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

layout(set = 0, binding = 14) uniform sampler2D photons_way;
layout(set = 0, binding = 15) uniform sampler2D corners_hit;
layout(set = 0, binding = 16) uniform sampler2D corners_way;
#ifdef REFINED
layout(set = 0, binding = 18, scalar) writeonly buffer List { uint data[]; } cells_list;
#endif

// What makes a cell worth tracing finer.
bool is_coarse(Cell c, vec4 b) {
    const float TEXELS = 0.5; // below it a bend is not seen
    const float SHARE = 0.05;
    const float WIDE = 4096.0; // texels
    vec2 bent = bend(c), size = b.zw - b.xy;
    return bent.x > TEXELS && bent.y > SHARE || size.x * size.y > WIDE;
}

// The corners' places about a cell's, in their order round it.
ivec2 step_to(int k) {
    return ivec2((k + 1) >> 1 & 1, k >> 1);
}

// The layer that takes the centre's photon, or none.
int layer_of_centre(vec4 hit, float normal) {
    vec2 xy01;
    if (hit.w == 0.0) return NO_MAP;
    int layer = layer_of(uint(hit.w) - 1u, push.light);
    if (layer == NO_MAP) return NO_MAP;
    return map_project(maps_views.data[layer].view, hit.xyz, photon_normal(normal), xy01) ? layer : NO_MAP;
}

// The cell as a layer sees it: the centre's, or else that of any corner, and whether it is the centre's.
bool cell_at(ivec2 texel, float normal, out Cell cell, out int layer) {
    vec4 centre = hit_at(texel, 0), corner[4];
    layer = layer_of_centre(centre, normal);
    bool own = layer != NO_MAP;
    for (int k = 0; k < 4; k++) {
        corner[k] = texelFetch(corners_hit, texel + step_to(k), 0);
        if (layer == NO_MAP && corner[k].w != 0.0) layer = layer_of(uint(corner[k].w) - 1u, push.light);
    }
    cell.centre = landed_at(centre.xyz, uint(texelFetch(photons_way, texel, 0).r), layer, push.side);
    for (int k = 0; k < 4; k++) {
        uint way = uint(texelFetch(corners_way, texel + step_to(k), 0).r);
        cell.corner[k] = landed_at(corner[k].xyz, way, layer, push.side);
    }
    return own;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, push.size))) return;
    vec4 flux = flux_at(texel, 0);
    Cell cell;
    int layer;
    bool own = cell_at(texel, flux.w, cell, layer), sheet = is_one_sheet(cell);
    vec4 b = bounds(cell);
    if (layer == NO_MAP || is_beside_map(b, push.side) || sheet && !own) return;
    uint number = uint(texel.y * push.size.x + texel.x);
    vec3 watts = photon_flux(flux.rgb);
#ifdef REFINED
    if (!sheet || is_coarse(cell, b)) {
        cells_list.data[atomicAdd(cells_counts.data[2u * push.view], 1u)] = number;
        return;
    }
#else
    if (!sheet || is_torn(cell)) {
        if (own && cell.centre.way != 0u) book(number, put_point(cell.centre.at, layer, watts, number));
        return;
    }
#endif
    book(number, spread_cell(cell, layer, watts));
}

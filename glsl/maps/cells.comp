#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Every cell of a view is spread over the map. With REFINED those are listed instead that pay for being traced finer; others that
// are torn, or no sheet of light, go as points.

#ifdef REFINED
#define LISTS
#include "maps/view_weight.glsl"
#ifdef SHARED_EDGES
#include "maps/cell_edges.glsl"
#endif
#else
#include "maps/view_cells.glsl"
#endif

// Spreads what lies about a photon of the centre, in every view.
void spread_photon(ivec2 texel, int photon, uint slot) {
    vec4 hit = hit_at(texel, photon), stored = flux_at(texel, photon);
    if (hit.w == 0.0) return;
    vec3 n = photon_normal(stored.w), flux = photon_flux(stored.rgb);
    for (int map = 0; map < maps_views.data.length(); map++) {
        float share = share_of(map, hit.xyz, n, uint(hit.w) - 1u);
        if (share > 0.0) book(slot, put_cell(cell_about(texel, hit.xyz, centre_way[photon], map), map, share * flux, slot));
    }
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, push.size))) return;
    read_ways(texel);
#ifdef REFINED
    uint row = row_of(push.view, 0u), octave = octave_at(texel);
    bool is_listed = octave >= cells_rows.data[row + LEAST];
#ifdef SHARED_EDGES
    cells_edges.data[edges_of(texel)].listed = is_listed ? 1u : 0u;
#endif
    if (is_listed) {
        list_cell(row, texel, octave);
        return;
    }
#endif
    for (int photon = 0; photon < PHOTONS; photon++) spread_photon(texel, photon, uint(texel.y * push.size.x + texel.x));
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The photon image's float16 as the float32 of a vertex buffer: what a copy cannot do, since copies do not convert.

#include "maps/photons.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 10, scalar) writeonly buffer Hits { vec4 data[]; } maps_vertices_hit;
layout(set = 0, binding = 11, scalar) writeonly buffer Fluxes { vec4 data[]; } maps_vertices_flux;

void main() {
    ivec2 size = textureSize(photons_hit, 0).xy, texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, size))) return;
    int layer = int(gl_GlobalInvocationID.z);
    int vertex = (layer * size.y + texel.y) * size.x + texel.x;
    maps_vertices_hit.data[vertex] = hit_at(texel, layer);
    maps_vertices_flux.data[vertex] = flux_at(texel, layer);
}

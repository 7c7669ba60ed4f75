#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// Traverse `fetch` (Wyman 2008, section 4: no copy, no vertex data): an instanced draw over the photons, an instance a
// row, layer after layer. Each becomes, in its receiver's layer of the map, a point splat whose weights sum to one over the
// texels it touches.

#include "maps/points_splat.glsl"
#include "maps/splat_point.glsl"

void main() {
    int rows = photons_side();
    ivec2 texel = ivec2(gl_VertexIndex, gl_InstanceIndex % rows);
    int layer = gl_InstanceIndex / rows;
    Splat s;
    bool takes = point_splat(texel, 0, layer, s);
    emit_splat(s, takes);
}

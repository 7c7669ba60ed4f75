#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// Gather `fetch` (Wyman 2008, section 4: no copy, no vertex data): an instanced draw over the photons, an instance a
// row, layer after layer. Each becomes, in its receiver's layer of the map, a point splat of fixed size whose weights sum
// to one over the texels it touches.

#include "maps/photon_splat.glsl"
#include "maps/photons.glsl"

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // texels
    uint light;
} push;

layout(location = 0) flat out vec3 splat_flux;   // W, already divided by the sum of the weights
layout(location = 1) flat out vec2 splat_centre; // texels

void main() {
    int rows = textureSize(photons_hit, 0).y;
    Splat s;
    ivec2 texel = ivec2(gl_VertexIndex, gl_InstanceIndex % rows);
    int layer = gl_InstanceIndex / rows;
    bool takes =
        splat_of(hit_at(texel, layer), flux_at(texel, layer), push.light, push.side, push.diameter, s);
    gl_Position = takes ? vec4(2.0 * s.centre / float(push.side) - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0); // culled
    gl_PointSize = takes ? splat_diameter(push.diameter) : 1.0;
    gl_Layer = s.layer;
    splat_flux = s.flux;
    splat_centre = s.centre;
}

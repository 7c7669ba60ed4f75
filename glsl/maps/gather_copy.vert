#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// Gather `copy` (Wyman and Davis 2006): a point a photon, whose columns the copy before made vertex attributes. Each
// becomes the splat that `gather_fetch.vert` makes of it.

#include "maps/photon_splat.glsl"

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // texels
    uint light;
} push;

layout(location = 0) in vec4 photon_hit_in;
layout(location = 1) in vec4 photon_flux_in;

layout(location = 0) flat out vec3 splat_flux;   // W, already divided by the sum of the weights
layout(location = 1) flat out vec2 splat_centre; // texels

void main() {
    Splat s;
    bool takes = splat_of(photon_hit_in, photon_flux_in, push.light, push.side, push.diameter, s);
    gl_Position = takes ? vec4(2.0 * s.centre / float(push.side) - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0); // culled
    gl_PointSize = takes ? splat_diameter(push.diameter) : 1.0;
    gl_Layer = s.layer;
    splat_flux = s.flux;
    splat_centre = s.centre;
}

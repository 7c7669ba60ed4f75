#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// Gather `fetch` (Wyman 2008, section 4: no copy, no vertex data): an instanced draw over the photons, an instance a
// row, layer after layer. Each becomes, in its receiver's layer of the map, a point splat of fixed size whose weights sum
// to one over the texels it touches.

#include "maps/views.glsl"
#include "shared/photon.glsl"
#include "shared/splat.glsl"

#ifdef LAYERS
layout(set = 0, binding = 8) uniform sampler2DArray photons_hit;
layout(set = 0, binding = 9) uniform sampler2DArray photons_flux;
#else
layout(set = 0, binding = 8) uniform sampler2D photons_hit;
layout(set = 0, binding = 9) uniform sampler2D photons_flux;
#endif

layout(push_constant, scalar) uniform Push {
    int side;       // texels of the map
    float diameter; // texels
    uint light;
} push;

layout(location = 0) flat out vec3 splat_flux;   // W, already divided by the sum of the weights
layout(location = 1) flat out vec2 splat_centre; // texels

void main() {
#ifdef LAYERS
    int rows = textureSize(photons_hit, 0).y;
    ivec3 texel = ivec3(gl_VertexIndex, gl_InstanceIndex % rows, gl_InstanceIndex / rows);
#else
    ivec2 texel = ivec2(gl_VertexIndex, gl_InstanceIndex);
#endif
    vec4 hit = texelFetch(photons_hit, texel, 0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside: culled
    gl_PointSize = 1.0;
    gl_Layer = 0;
    splat_flux = vec3(0.0);
    splat_centre = vec2(0.0);
    if (hit.w == 0.0) return;
    vec4 flux = texelFetch(photons_flux, texel, 0);
    vec2 xy01;
    uint receiver = uint(hit.w) - 1u;
    int layer = map_layer(hit.xyz, photon_normal(flux.w), receiver, push.light, xy01);
    if (layer < 0) return;
    gl_Layer = layer;
    vec2 p = vec2(splat_snap(xy01.x * float(push.side)), splat_snap(xy01.y * float(push.side)));
    p = min(p, vec2(float(push.side) - 1.0 / SPLAT_GRID)); // the centre stays inside: points are clipped by it
    float norm = splat_norm(p.x, push.diameter, push.side) * splat_norm(p.y, push.diameter, push.side);
    if (!(norm > 0.0)) return;
    gl_Position = vec4(2.0 * p / float(push.side) - 1.0, 0.0, 1.0);
    gl_PointSize = splat_diameter(push.diameter);
    splat_flux = flux.rgb / norm;
    splat_centre = p;
}

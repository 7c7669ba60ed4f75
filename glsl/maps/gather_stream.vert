#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// Traverse `hierarchical`: the points that the traversal left become splats. A cluster of 4^i merged photons at level i
// stands for so many alike (Wyman 2008, section 3.2), also where some of them were invalid.

#include "maps/varying.glsl"
#include "maps/splat_point.glsl"
#include "maps/stream_point.glsl"

layout(location = 0) in uvec2 streamed;

void main() {
    StreamPoint at = unpack_point(streamed);
    vec4 flux = flux_of(at.texel, at.level, at.layer);
    Landed l;
    Splat s = NO_SPLAT;
    bool takes = land(hit_of(at.texel, at.level, at.layer), flux.w, l);
    vec3 total = photon_flux(flux.rgb) * float(1 << (2 * at.level));
    if (takes) takes = splat_of(l, total, splat_size(l, at.texel, at.level, at.layer), s);
    emit_splat(s, takes);
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require

// Traverse `copy` (Wyman and Davis 2006): a point a photon, whose columns the copy before made vertex attributes. Each
// becomes the splat that `gather_fetch.vert` makes of it.

#include "maps/splat_point.glsl"

layout(location = 0) in vec4 photon_hit_in;
layout(location = 1) in vec4 photon_flux_in;

void main() {
    Landed l;
    Splat s = NO_SPLAT;
    bool takes = land(photon_hit_in, photon_flux_in.w, l);
    if (takes) takes = splat_of(l, photon_flux(photon_flux_in.rgb), push.diameter, s);
    emit_splat(s, takes);
}

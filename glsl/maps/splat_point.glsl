// A splat as a point: what a vertex shader hands to `maps/splat.frag`.
#ifndef SPLAT_POINT_GLSL
#define SPLAT_POINT_GLSL

#include "maps/photon_splat.glsl"

layout(location = 0) flat out vec4 splat_flux;   // W, already divided by the sum of the weights; diameter
layout(location = 1) flat out vec4 splat_centre; // texels of its level; the level's side; layer
#ifdef COUNTED
layout(location = 2) flat out float splat_count; // photons, divided by the sum of the weights
#endif
#ifdef SHAPED
layout(location = 3) flat out vec2 splat_shape; // diameter along columns; rows that the centre moves by a column
#endif

void emit_splat(Splat s, bool takes) {
    gl_Position = takes ? vec4(2.0 * s.centre / float(push.side) - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0); // culled
    gl_PointSize = takes ? s.diameter : 1.0;
#ifdef SHAPED
    gl_PointSize = takes ? min(reach_of(s.diameter, s.shape), SPLAT_MAX_DIAMETER) : 1.0;
    splat_shape = s.shape;
#endif
#ifndef CULL
    gl_Layer = s.layer; // else the geometry shader says so
#endif
    splat_flux = vec4(s.flux, s.diameter);
#ifdef COUNTED
    splat_count = s.count;
#endif
    splat_centre = vec4(s.centre, float(s.side), float(s.layer));
}

#endif

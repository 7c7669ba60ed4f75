// A splat as a point: what a vertex shader hands to `maps/splat.frag`.
#ifndef SPLAT_POINT_GLSL
#define SPLAT_POINT_GLSL

#include "maps/photon_splat.glsl"
#ifdef SHAPED
#include "maps/shape.glsl"
#endif

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
#ifndef CULL
    gl_Layer = s.layer; // else the geometry shader says so
#endif
    splat_flux = vec4(s.flux, s.diameter);
#ifdef COUNTED
    splat_count = s.count;
#endif
    splat_centre = vec4(s.centre, float(s.side), float(s.layer));
}

#ifdef SHAPED
void emit_splat(Splat s, Shape shape, bool takes) {
    emit_splat(s, takes);
    splat_shape = vec2(shape.rows, shape.lean);
    // The square that holds all of it.
    if (takes) gl_PointSize = min(max(s.diameter, shape.rows + abs(shape.lean) * s.diameter), SPLAT_MAX_DIAMETER);
}
#endif

#endif

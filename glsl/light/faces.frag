#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Surfaces that a light's view sees, exactly where the ray through the texel's centre meets them: no shape is tessellated.
//
// BACK: of faces turned away from the light. FARTHEST: the last one along the ray, else the nearest. DEPTH_ALONE: no more
// than how far they are.

#include "light/faces.glsl"
#include "raster_view.glsl"
#include "shared/surface.glsl"

layout(location = 0) in vec2 shape_uv;
layout(location = 1) in float eye_depth;
layout(location = 2) flat in uvec2 shape;
#ifndef DEPTH_ALONE
layout(location = 0) out vec4 face_position;
layout(location = 1) out vec4 face_normal;
#endif

// Where the ray meets the shape drawn: of an analytic one its nearest crossing. On an edge, where rasteriser and ray
// differ by a rounding, the rasteriser's place stands.
bool fragment_hit(vec3 o, vec3 d, out Hit hit) {
    Instance at = scene_instances.data[shape.x];
    hit = Hit(NO_HIT, shape.x, shape.y, shape_uv);
    LocalRay ray = local_ray(map_point(at.to_object, o), map_vector(at.to_object, d));
#ifdef HAS_MESHES
    if (at.kind == SHAPE_MESH) {
        Triangle triangle = scene_triangles.data[shape.y];
        vec2 uv;
        float t = hit_triangle(ray, triangle.a, triangle.b, triangle.c, NO_HIT, uv);
        if (t < NO_HIT) hit = Hit(t, shape.x, shape.y, uv);
        return true;
    }
#endif
    uint primitive;
    vec2 uv;
    float t = hit_shape(at, ray, NO_HIT, primitive, uv);
    if (t < NO_HIT) hit = Hit(t, shape.x, primitive, uv);
    return t < NO_HIT || at.kind == SHAPE_QUAD;
}

void main() {
    View v = raster_view();
    vec3 o, d;
    raster_ray(gl_FragCoord.xy, o, d);
#ifdef BACK
    // From behind, the nearest crossing is the last.
    vec3 from = o + d * ((v.far - v.near) / dot(d, v.forward)), along = -d;
#else
    vec3 from = o, along = d;
#endif
    Hit hit;
    if (!fragment_hit(from, along, hit)) discard;
    Surface s = surface_at(from, along, hit);
    float depth = dot(s.p - v.origin, v.forward);
    if (depth < v.near) discard;
#ifdef BACK
    if (!(dot(d, s.ng) > 0.0)) discard;
#endif
    float linear = clamp((depth - v.near) / (v.far - v.near), 0.0, 1.0);
#ifdef FARTHEST
    gl_FragDepth = 1.0 - linear;
#else
    gl_FragDepth = linear;
#endif
#ifndef DEPTH_ALONE
    Face face = face_of(s, shape.x);
    face_position = face.position;
    face_normal = face.normal;
#endif
}

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The G-buffer: 1 + instance, primitive, and (u, v), from which any pass makes the surface again without loss.
// Depth is linear in metres, so that it keeps its digits far from the eye.

#include "raster_view.glsl"
#include "shared/bvh.glsl"

layout(location = 0) in vec2 shape_uv;
layout(location = 1) in float eye_depth;
layout(location = 2) flat in uvec2 shape;
layout(location = 0) out uvec4 seen;

void main() {
    View eye = raster_view();
    float depth = eye_depth;
    uint primitive = shape.y;
    vec2 uv = shape_uv;
#ifdef HAS_CAST
    Instance at = scene_instances.data[shape.x];
    if (at.kind != SHAPE_QUAD && at.kind != SHAPE_MESH) {
        vec3 o, d;
        view_ray(eye, gl_FragCoord.xy / vec2(push.size), o, d);
        LocalRay ray = local_ray(map_point(at.to_object, o), map_vector(at.to_object, d));
        float t = hit_shape(at, ray, NO_HIT, primitive, uv);
        if (!(t < NO_HIT)) discard;
        depth = dot(o + t * d - eye.origin, eye.forward);
    }
#endif
    if (depth < eye.near) discard; // an orthographic eye has no apex to clip what lies behind it
    gl_FragDepth = clamp((depth - eye.near) / (eye.far - eye.near), 0.0, 1.0);
    seen = uvec4(shape.x + 1u, primitive, floatBitsToUint(uv));
}

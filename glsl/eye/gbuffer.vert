#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// What the eye or a light sees, rasterised: an instance a draw, vertices pulled from the scene. A quad is two triangles, a mesh its
// own; of any other shape it is the box about it, and the fragment shader intersects it exactly.

#include "raster_view.glsl"
#include "shared/bvh.glsl"

layout(location = 0) out vec2 shape_uv;
layout(location = 1) out float eye_depth; // metres along the view's forward axis
layout(location = 2) flat out uvec2 shape; // instance, primitive

const float ABOUT = 1.001; // a shape touches its box; a rounded edge must not cut it

vec3 box_corner(int vertex) {
    int face = vertex / 6, corner = vertex % 6;
    vec2 q = vec2((corner == 1 || corner == 2 || corner == 4) ? 1.0 : -1.0, corner >= 2 && corner != 3 ? 1.0 : -1.0);
    float side = (face & 1) == 0 ? 1.0 : -1.0;
    vec3 p = vec3(q, side);
    return ABOUT * (face < 2 ? p : face < 4 ? p.yzx : p.zxy);
}

vec2 quad_corner(int vertex) {
    return vec2((vertex == 1 || vertex == 2 || vertex == 4) ? 1.0 : -1.0, vertex >= 2 && vertex != 3 ? 1.0 : -1.0);
}

void main() {
    Instance at = scene_instances.data[gl_InstanceIndex];
    vec3 local = vec3(0.0);
    shape = uvec2(uint(gl_InstanceIndex), 0u);
    shape_uv = vec2(0.0);
    if (at.kind == SHAPE_QUAD) {
        shape_uv = quad_corner(gl_VertexIndex);
        local = vec3(shape_uv, 0.0);
    } else if (at.kind != SHAPE_MESH) {
        local = box_corner(gl_VertexIndex);
        if (at.kind == SHAPE_DISK) local.z *= ABOUT - 1.0;
        if (at.kind == SHAPE_CYLINDER || at.kind == SHAPE_PARABOLOID) local.z = 0.5 + 0.5 * local.z;
    }
#ifdef HAS_MESHES
    if (at.kind == SHAPE_MESH) {
        shape.y = uint(gl_VertexIndex) / 3u;
        Triangle triangle = scene_triangles.data[shape.y];
        int corner = gl_VertexIndex % 3;
        local = corner == 0 ? triangle.a : corner == 1 ? triangle.b : triangle.c;
        shape_uv = vec2(corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0);
    }
#endif
    vec3 p = map_point(at.to_world, local);
    View view = raster_view();
    eye_depth = dot(p - view.origin, view.forward);
    gl_Position = view_clip(view, p);
    // Depth is the fragment's. A box must not be cut where its corners reach beyond what it stands for.
    gl_Position.z = 0.5 * gl_Position.w;
}

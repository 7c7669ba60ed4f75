#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The way through the body against the normal of its front (d_N of Wyman 2005), exact: once, before the first frame.

#include "light/front.glsl"
#include "light/sample.glsl"
#include "shared/interface.glsl"
#include "shared/transport.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 8, r32f) uniform writeonly image2D light_inward;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, push.size))) return;
    Face face = front_face(texel);
    float metres = 0.0;
    if (is_face(face)) {
        Surface s = surface_of_face(face);
        Instance shape = scene_instances.data[uint(face.position.w) - 1u];
        s.eps = surface_rounding(shape, s.p, s.ng, map_point(shape.to_object, s.p), 1.0);
        uint unused = 0u;
        vec3 inward = -bending_normal(s, light_sample(texel).direction, unused);
        Hit hit;
        if (trace(leave(s, inward), inward, FAR, MASK_SPECULAR, hit)) metres = hit.t;
    }
    imageStore(light_inward, texel, vec4(metres));
}

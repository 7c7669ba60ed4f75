#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// A step of the traversal (Wyman 2008, listings of sections 3.1 and 3.2, whose `IsValid` is printed the wrong way round): a
// point with no valid photon below it is dropped; one whose children converge goes on as it is, ready; any other leaves
// its children.

#define TRAVERSE
#include "maps/levels.glsl"
#include "maps/stream_point.glsl"
#include "maps/traverse_step.glsl"
#ifdef CONVERGE
#include "maps/views.glsl"
#include "shared/photon.glsl"
#endif

layout(points) in;
layout(points, max_vertices = 4) out;

layout(location = 0) flat in uvec2 point[];
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 8) flat out uvec2 streamed;

void emit(StreamPoint p) {
    streamed = pack_point(p);
    gl_PointSize = 1.0;
    EmitVertex();
    EndPrimitive();
}

bool is_valid(StreamPoint p) {
#ifdef MERGE
    return hit_of(p.texel, p.level, p.layer).w != 0.0;
#else
    return texelFetch(pyramid_valid, above(p.texel, p.level, p.layer), 0).r != 0.0;
#endif
}

// A child's texel; false beyond the image, where sides are odd.
bool child_of(StreamPoint p, int k, out ivec2 texel) {
    texel = 2 * p.texel + ivec2(k & 1, k >> 1);
    return all(lessThan(texel, ivec2(level_side(photons_side(), p.level - 1))));
}

#ifdef CONVERGE
// Whether all children fall into one texel of one map. One that is invalid falls nowhere; but a valid one may be the mean of
// few photons, which the factor 4^i then counts as all.
bool converges(StreamPoint p) {
    ivec3 common_texel = ivec3(-1);
    for (int k = 0; k < 4; k++) {
        ivec2 texel;
        if (!child_of(p, k, texel)) continue;
        vec4 hit = hit_of(texel, p.level - 1, p.layer);
        if (hit.w == 0.0) return false;
        vec2 xy01;
        vec3 normal = photon_normal(flux_of(texel, p.level - 1, p.layer).w);
        int map = map_layer(hit.xyz, normal, uint(hit.w) - 1u, push.light, xy01);
        ivec3 place = ivec3(ivec2(floor(xy01 * float(push.map_side))), map);
        if (map < 0 || (common_texel.z >= 0 && place != common_texel)) return false;
        common_texel = place;
    }
    return common_texel.z >= 0;
}
#endif

void main() {
    StreamPoint p = unpack_point(point[0]);
#ifdef READY
    if (p.ready) {
        emit(p);
        return;
    }
#endif
    if (!is_valid(p)) return;
#ifdef CONVERGE
    if (converges(p)) {
        p.ready = true;
        emit(p);
        return;
    }
#endif
    for (int k = 0; k < 4; k++) {
        ivec2 texel;
        if (child_of(p, k, texel)) emit(StreamPoint(texel, p.level - 1, p.layer, false));
    }
}

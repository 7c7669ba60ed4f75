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
#include "maps/converge.glsl"
#endif
#ifdef EXACT
#include "maps/clusters.glsl"
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
#ifdef EXACT
    return texelFetch(pyramid_flux, above(p.texel, p.level, p.layer), 0).a != NOWHERE;
#elif defined(MERGE)
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
bool converges(StreamPoint p) {
    ivec3 common_texel = NO_TEXEL;
    if (!is_whole(photons_side(), p.level, p.texel)) return false;
    for (int k = 0; k < 4; k++) {
        ivec2 texel = 2 * p.texel + ivec2(k & 1, k >> 1);
        vec4 hit = hit_of(texel, p.level - 1, p.layer);
        float normal = flux_of(texel, p.level - 1, p.layer).w;
        if (!falls_into(hit, normal, push.light, push.map_side, common_texel)) return false;
    }
    return common_texel != NO_TEXEL;
}
#elif defined(EXACT)
bool converges(StreamPoint p) {
    ivec3 at = above(p.texel, p.level, p.layer);
    float place = texelFetch(pyramid_flux, at, 0).a;
    return is_one_splat(place, texelFetch(pyramid_bounds, at, 0), push.diameter, push.share);
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
#if defined(CONVERGE) || defined(EXACT)
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

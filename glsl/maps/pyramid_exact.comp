#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// A level of the pyramid of clusters over the photons, from the one below. With POINTS also how many splats are below each
// child of a texel, or that it is one itself.

#define PYRAMID_WRITTEN
#include "maps/clusters.glsl"
#include "maps/levels.glsl"
#include "maps/pyramid_step.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 14, rgba32f) uniform image2DArray pyramid_flux;
layout(set = 0, binding = 15, rgba32f) uniform image2DArray pyramid_mean;
layout(set = 0, binding = 16, rgba32f) uniform image2DArray pyramid_bounds;
layout(set = 0, binding = 17, r32f) uniform image2DArray pyramid_lean;
#ifdef POINTS
layout(set = 0, binding = 18, rgba32ui) uniform uimage2DArray pyramid_points;
#endif

ivec3 place(ivec2 at, int level, int layer) {
    return ivec3(pyramid_place(push.side, level, at), layer);
}

#ifdef FROM_PHOTONS
Cluster child(ivec2 at, int layer, out uint points) {
    vec4 hit = hit_at(at, layer);
    points = hit.w == 0.0 ? 0u : 1u;
    vec4 flux = flux_at(at, layer);
    Landed l;
    if (!landing_of(hit, flux.w, push.light, l)) return NO_CLUSTER;
    return cluster_of(l, photon_flux(flux.rgb), push.map_side);
}
#else
Cluster child(ivec2 at, int layer, out uint points) {
    ivec3 from = place(at, push.level - 1, layer);
    vec4 flux = imageLoad(pyramid_flux, from), mean = imageLoad(pyramid_mean, from);
    points = 0u;
#ifdef POINTS
    points = splats_of(imageLoad(pyramid_points, from));
#endif
    vec3 spread = vec3(mean.zw, imageLoad(pyramid_lean, from).r);
    return Cluster(flux.rgb, flux.a, mean.xy, spread, imageLoad(pyramid_bounds, from));
}
#endif

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, ivec2(level_side(push.side, push.level))))) return;
    Cluster all = NO_CLUSTER;
    uvec4 points = uvec4(0u);
    for (int k = 0; k < 4; k++) {
        ivec2 at = 2 * texel.xy + ivec2(k & 1, k >> 1);
        if (any(greaterThanEqual(at, ivec2(level_side(push.side, push.level - 1))))) continue;
        all = joined(all, child(at, texel.z, points[k]));
    }
    ivec3 to = place(texel.xy, push.level, texel.z);
    imageStore(pyramid_flux, to, vec4(all.flux, all.place));
    imageStore(pyramid_mean, to, vec4(all.mean, all.spread.xy));
    imageStore(pyramid_bounds, to, all.bounds);
    imageStore(pyramid_lean, to, vec4(all.spread.z));
#ifdef POINTS
    if (all.place == NOWHERE) points = uvec4(0u); // what lies beside the map goes here
    if (is_one_splat(all.place, all.bounds, push.diameter, push.share)) points = OWN;
    imageStore(pyramid_points, to, points);
#endif
}

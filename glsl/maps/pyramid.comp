#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// A level of the pyramid over the photons from the one below: with MERGE the mean of what is valid, as hardware makes mip
// maps (receiver and normal are the first one's); else whether anything is. With POINTS also how many splats are below
// each child of a texel, or, where with CONVERGE its children converge, that it is one itself.

#define PYRAMID_WRITTEN
#include "maps/levels.glsl"
#include "maps/pyramid_step.glsl"
#ifdef CONVERGE
#include "maps/converge.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef MERGE
layout(set = 0, binding = 14, rgba32f) uniform image2DArray pyramid_hit;
layout(set = 0, binding = 15, rgba32f) uniform image2DArray pyramid_flux;
#else
layout(set = 0, binding = 14, r32f) uniform image2DArray pyramid_valid;
#endif
#ifdef POINTS
layout(set = 0, binding = 18, rgba32ui) uniform uimage2DArray pyramid_points;
#endif

ivec3 place(ivec2 at, int level, int layer) {
    return ivec3(pyramid_place(push.side, level, at), layer);
}

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, ivec2(level_side(push.side, push.level))))) return;
    int below = push.level - 1;
    vec4 hit = vec4(0.0), flux = vec4(0.0);
    float count = 0.0;
#ifdef POINTS
    uvec4 points = uvec4(0u);
#endif
#ifdef CONVERGE
    ivec3 common_texel = NO_TEXEL;
    bool converges = is_whole(push.side, push.level, texel.xy);
#endif
    for (int k = 0; k < 4; k++) {
        ivec2 at = 2 * texel.xy + ivec2(k & 1, k >> 1);
        if (any(greaterThanEqual(at, ivec2(level_side(push.side, below))))) continue;
#ifdef FROM_PHOTONS
        vec4 h = hit_at(at, texel.z);
#elif defined(MERGE)
        vec4 h = imageLoad(pyramid_hit, place(at, below, texel.z));
#else
        vec4 h = imageLoad(pyramid_valid, place(at, below, texel.z)).rrrr;
#endif
#ifdef CONVERGE
        if (h.w == 0.0) converges = false;
#endif
        if (h.w == 0.0) continue;
#ifdef POINTS
#ifdef FROM_PHOTONS
        points[k] = 1u;
#else
        points[k] = splats_of(imageLoad(pyramid_points, place(at, below, texel.z)));
#endif
#endif
#ifdef MERGE
#ifdef FROM_PHOTONS
        vec4 f = flux_at(at, texel.z);
#else
        vec4 f = imageLoad(pyramid_flux, place(at, below, texel.z));
#endif
#ifdef CONVERGE
        converges = converges && falls_into(h, f.w, push.light, push.map_side, common_texel);
#endif
        if (count == 0.0) {
            hit.w = h.w;
            flux.w = f.w;
        }
        hit.xyz += h.xyz;
        flux.rgb += f.rgb;
#endif
        count += 1.0;
    }
    ivec3 to = place(texel.xy, push.level, texel.z);
#ifdef POINTS
#ifdef CONVERGE
    if (converges && count > 0.0) points = OWN;
#endif
    imageStore(pyramid_points, to, points);
#endif
#ifdef MERGE
    float share = count > 0.0 ? 1.0 / count : 0.0;
    imageStore(pyramid_hit, to, vec4(hit.xyz * share, hit.w));
    imageStore(pyramid_flux, to, vec4(flux.rgb * share, flux.w));
#else
    imageStore(pyramid_valid, to, vec4(count > 0.0 ? 1.0 : 0.0));
#endif
}

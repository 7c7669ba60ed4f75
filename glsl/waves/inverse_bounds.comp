#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Where rays of cells can land, at any depth: of a cell by its four corners (OF_CELLS), of a node above them by the four below it.

#define INVERSE_RAYS readonly
#include "waves/inverse.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 36, scalar) buffer WaterBoundsAll { WaterBounds at[]; } water_bounds;

layout(push_constant, scalar) uniform Push {
    int level;
} push;

const float FAR_OFF = 3e38; // bounds that hold nothing have their least above their greatest

void join(inout vec4 all, vec2 low, vec2 high) {
    all = vec4(min(all.xy, low), max(all.zw, high));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    uint light = gl_GlobalInvocationID.z;
    if (any(greaterThanEqual(at, level_size(push.level)))) return;
    vec4 nothing = vec4(vec2(FAR_OFF), vec2(-FAR_OFF));
    WaterBounds all = WaterBounds(nothing, nothing);
    bool lit = false;
    for (int k = 0; k < 4; k++) {
#ifdef OF_CELLS
        WaterRay ray = water_rays.at[ray_at(light, at + ivec2(k & 1, k >> 1))];
        if (any(lessThan(ray.passes, vec3(0.0)))) continue;
        lit = lit || any(greaterThan(ray.passes, vec3(0.0)));
        for (int band = 0; band < INVERSE_BANDS; band++) {
            vec2 reach = slope_reach(ray, band, water_lights.at[light].radius);
            vec2 low = ray.slope[band] - reach, high = ray.slope[band] + reach;
            vec2 down = ray.start.z + water_lights.at[light].depths;
            vec2 a = down.x * low, b = down.x * high, c = down.y * low, d = down.y * high;
            join(all.near, ray.start.xy + min(a, b), ray.start.xy + max(a, b));
            join(all.far, ray.start.xy + min(c, d), ray.start.xy + max(c, d));
            // A receiver above the ray's start is asked for as where it starts.
            if (down.x < 0.0) join(all.near, ray.start.xy, ray.start.xy);
            if (down.y < 0.0) join(all.far, ray.start.xy, ray.start.xy);
        }
#else
        ivec2 child = 2 * at + ivec2(k & 1, k >> 1);
        if (any(greaterThanEqual(child, level_size(push.level - 1)))) continue;
        WaterBounds part = water_bounds.at[bounds_at(light, push.level - 1, child)];
        if (part.near.x > part.near.z) continue;
        lit = true;
        join(all.near, part.near.xy, part.near.zw);
        join(all.far, part.far.xy, part.far.zw);
#endif
    }
    if (!lit) all = WaterBounds(nothing, nothing);
    water_bounds.at[bounds_at(light, push.level, at)] = all;
}

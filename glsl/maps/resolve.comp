#version 460
#extension GL_EXT_scalar_block_layout : require

// The caustic map from its sums in fixed point, which begin anew for the next frame.

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
    int side;
} push;

layout(set = 0, binding = 10, scalar) buffer MapSums { uint data[]; } maps_sums;
layout(set = 0, binding = 12, scalar) readonly buffer MapUnit { float per_watt, watts; } maps_unit;
#ifdef DRAWN
layout(set = 0, binding = 11, rgba32f) uniform image2DArray maps_map; // holds what was drawn
#else
layout(set = 0, binding = 11, rgba32f) uniform writeonly image2DArray maps_map;
#endif

void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(texel.xy, ivec2(push.side)))) return;
    uint word = 6u * uint((texel.z * push.side + texel.y) * push.side + texel.x);
    vec3 flux;
    for (uint band = 0u; band < 3u; band++) {
        uint low = maps_sums.data[word + 2u * band], high = maps_sums.data[word + 2u * band + 1u];
        flux[band] = (float(high) * 4294967296.0 + float(low)) * maps_unit.watts;
        maps_sums.data[word + 2u * band] = 0u;
        maps_sums.data[word + 2u * band + 1u] = 0u;
    }
#ifdef DRAWN
    flux += imageLoad(maps_map, texel).rgb;
#endif
    imageStore(maps_map, texel, vec4(flux, 0.0));
}

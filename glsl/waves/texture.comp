#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// waves.variant = texture: the first level of the target, at texels' middles, with the water's height beside the colour.

#include "waves/grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 36, rgba32f) uniform writeonly image2D waves_texture;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(push.side)))) return;
    vec2 at = water_place((vec2(texel) + 0.5) / float(push.side));
    imageStore(waves_texture, texel, vec4(sun_below(water_gradient(at)), water_height(at)));
}

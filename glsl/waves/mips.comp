#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// waves.variant = texture: a level from the one before it, each texel the mean of four.

#include "waves/atlas.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 36, rgba32f) uniform image2D waves_texture;

layout(push_constant, scalar) uniform Push {
    int side;
    int level;
} push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(level_side(push.side, push.level))))) return;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 child = 2 * texel + ivec2(k & 1, k >> 1);
        sum += imageLoad(waves_texture, level_place(push.side, push.level - 1, child));
    }
    imageStore(waves_texture, level_place(push.side, push.level, texel), 0.25 * sum);
}

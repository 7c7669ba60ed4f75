#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The photons of one view into its layer, before the next view's take their place.

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 8) uniform sampler2D photons_hit;
layout(set = 0, binding = 9) uniform sampler2D photons_flux;
layout(set = 0, binding = 10) uniform sampler2D photons_exit;
layout(set = 0, binding = 12, rgba32f) uniform writeonly image2DArray kept_hit;
layout(set = 0, binding = 13, rgba32f) uniform writeonly image2DArray kept_flux;
layout(set = 0, binding = 14, rgba32f) uniform writeonly image2DArray kept_exit;

layout(push_constant) uniform Push { int layer; } push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, textureSize(photons_hit, 0)))) return;
    imageStore(kept_hit, ivec3(texel, push.layer), texelFetch(photons_hit, texel, 0));
    imageStore(kept_flux, ivec3(texel, push.layer), texelFetch(photons_flux, texel, 0));
    imageStore(kept_exit, ivec3(texel, push.layer), texelFetch(photons_exit, texel, 0));
}

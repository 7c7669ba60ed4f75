#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// N x N photons of one light and view into the columns that the method reads. With LAYERS, each sample leaves up to so
// many, one a layer. With BLOCK_LEVELS photons are as dense as each block of the image asks for: with COARSE one for each block,
// else those that are listed.

#include "light/sample.glsl"
#ifdef LAYERS
#include "light/layers.glsl"
#include "light/tree.glsl"
#define COLUMN_IMAGE image2DArray
#define COLUMN_PLACE ivec3
#else
#include "light/tracer.glsl"
#define COLUMN_IMAGE image2D
#define COLUMN_PLACE ivec2
#endif

#ifdef BLOCK_LEVELS
#include "light/blocks.glsl"
#endif

#ifdef LISTED
layout(local_size_x = 64) in;
#else
layout(local_size_x = 8, local_size_y = 8) in;
#endif

#ifdef COLUMN_HIT
layout(set = 0, binding = 8, COLUMN_HIT) uniform writeonly COLUMN_IMAGE photons_hit;
#endif
#ifdef COLUMN_FLUX
layout(set = 0, binding = 9, COLUMN_FLUX) uniform writeonly COLUMN_IMAGE photons_flux;
#endif
#ifdef COLUMN_EXIT
layout(set = 0, binding = 10, COLUMN_EXIT) uniform writeonly COLUMN_IMAGE photons_exit;
#endif
#ifdef COLUMN_DIRECTION
layout(set = 0, binding = 11, COLUMN_DIRECTION) uniform writeonly COLUMN_IMAGE photons_direction;
#endif
#ifdef COLUMN_WAY
layout(set = 0, binding = 12, COLUMN_WAY) uniform writeonly COLUMN_IMAGE photons_way;
#endif

void store_photon(COLUMN_PLACE place, Photon p) {
#ifdef COLUMN_HIT
    imageStore(photons_hit, place, photon_hit_column(p));
#endif
#ifdef COLUMN_FLUX
    imageStore(photons_flux, place, photon_flux_column(p));
#endif
#ifdef COLUMN_WAY
    imageStore(photons_way, place, vec4(float(photon_way(p))));
#endif
#ifdef COLUMN_EXIT
    imageStore(photons_exit, place, vec4(p.exit, float(p.status)));
#endif
#ifdef COLUMN_DIRECTION
    imageStore(photons_direction, place, vec4(p.direction, float(p.status)));
#endif
}

#ifdef LAYERS
// Ends that are no photons of the class leave nothing: with several to a sample none of them is the texel's.
void end_photon(Photon p) {
    if (p.status != PHOTON_VALID) return;
    int layer = take_layer(sum_of_bands(p.flux));
    if (layer != NO_LAYER) store_photon(ivec3(gl_GlobalInvocationID.xy, layer), p);
}
#endif

#ifdef COARSE
// What of a slot is asked for before it is known to hold a photon.
void clear_slot(ivec2 slot) {
    imageStore(photons_hit, slot, vec4(0.0));
    imageStore(photons_way, slot, vec4(0.0));
}

void main() {
    ivec2 block = ivec2(gl_GlobalInvocationID.xy), low = block * BLOCK_SIDE;
    if (any(greaterThanEqual(block, ivec2(BLOCKS)))) return;
    for (int at = 1; at < BLOCK_SIDE * BLOCK_SIDE; at++) clear_slot(low + ivec2(at % BLOCK_SIDE, at / BLOCK_SIDE));
    if (all(lessThan(low, push.size))) {
        store_photon(low, trace_photon(light_sample_of(low, min(low + BLOCK_SIDE, push.size))));
    } else {
        store_photon(low, no_photon());
    }
}
#elif defined(LISTED)
layout(set = 0, binding = 32, scalar) readonly buffer Before { uint data[]; } blocks_before;

// The block that a photon is of: the last before which no more come.
uint block_of(uint number) {
    uint low = 0u, high = uint(BLOCKS * BLOCKS);
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (blocks_before.data[middle] <= number) low = middle;
        else high = middle;
    }
    return low;
}

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x, number = 64u * group + gl_LocalInvocationIndex;
    if (number >= blocks_before.data[BLOCKS * BLOCKS]) return;
    uint at = block_of(number);
    ivec2 block = block_at(at);
    int stride = stride_at(at, push.view), own = int(number - blocks_before.data[at]);
    int along = photons_of(block, stride, push.size).x;
    ivec2 low = block * BLOCK_SIDE + stride * ivec2(own % along, own / along);
    store_photon(low, trace_photon(light_sample_of(low, min(low + stride, push.size))));
}
#else
void main() {
    // What is stored beyond the image is dropped; a tile that reaches beyond its view holds nothing there.
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    bool emits = all(lessThan(texel, push.size));
#ifdef LAYERS
    if (emits) trace_tree(light_sample(texel));
    for (int layer = layers_filled; layer < LAYERS; layer++) store_photon(ivec3(texel, layer), no_photon());
#else
    if (emits) {
        store_photon(texel, trace_photon(light_sample(texel)));
    } else {
        store_photon(texel, no_photon());
    }
#endif
}
#endif

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// N x N photons of one light and view into the columns that the method reads. With LAYERS, each sample leaves up to so
// many, one a layer.

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

layout(local_size_x = 8, local_size_y = 8) in;

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

#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Counts and sums the photons of one view, outside the timed frames: a row for each work group, added on the host in
// float64. Flux is the mean of the bands.

#include "light/sample.glsl"
#ifdef LAYERS
#include "light/layers.glsl"
#include "light/tree.glsl"
#else
#include "light/tracer.glsl"
#endif
#include "capture.glsl"
#ifdef BLOCK_LEVELS
#include "light/blocks.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

struct AccountRow {
    uint counts[PHOTON_STATUSES]; // [0]: samples emitted; then how each, or each branch of it, ended
    uint bent;
    float flux[PHOTON_STATUSES];  // W; [0]: emitted; then by status, at the end
    float other;                  // W
    float absorbed;               // W, on the way
};

layout(set = 0, binding = 8, scalar) writeonly buffer Account { AccountRow data[]; } account_rows;

shared AccountRow group_rows[64];

float mean(vec3 bands) {
    return (bands.r + bands.g + bands.b) / 3.0;
}

AccountRow empty_row() {
    AccountRow row;
    for (uint k = 0u; k < PHOTON_STATUSES; k++) {
        row.counts[k] = 0u;
        row.flux[k] = 0.0;
    }
    row.bent = 0u;
    row.other = 0.0;
    row.absorbed = 0.0;
    return row;
}

void book(uint status, float flux) {
    group_rows[gl_LocalInvocationIndex].counts[status]++;
    group_rows[gl_LocalInvocationIndex].flux[status] += flux;
}

// How a photon ended, seen by the method: the map has what arrives where it looks.
uint status_for_method(Photon p) {
    if (p.status != PHOTON_VALID) return p.status;
    vec3 normal = photon_normal(photon_flux_column(p).w); // as the method reads it
    return captured(p.hit, normal, p.receiver, push.light) ? PHOTON_VALID : PHOTON_OUTSIDE_MAP;
}

// What a photon, or the first branch of it to end, started with, and what happened since.
void book_way(Photon p) {
    uint slot = gl_LocalInvocationIndex;
    float emitted = mean(p.emitted);
    if (emitted > 0.0) book(0u, emitted);
    group_rows[slot].bent += p.bent;
    group_rows[slot].other += mean(p.other);
    group_rows[slot].absorbed += mean(p.absorbed);
}

#ifdef LAYERS
uint layer_status[LAYERS];
float layer_mean[LAYERS]; // W

void end_photon(Photon p) {
    book_way(p);
    uint status = status_for_method(p);
    float flux = mean(p.flux);
    if (p.status == PHOTON_VALID) {
        int filled = layers_filled;
        int layer = take_layer(sum_of_bands(p.flux));
        if (layer == NO_LAYER) {
            status = PHOTON_NO_LAYER;
        } else {
            uint next = status;
            float next_mean = flux;
            status = filled < LAYERS ? PHOTON_NONE : PHOTON_NO_LAYER; // of what lay there
            flux = layer_mean[layer];
            layer_status[layer] = next;
            layer_mean[layer] = next_mean;
        }
    }
    if (status != PHOTON_NONE) book(status, flux);
}
#endif

void account(ivec2 texel) {
#ifdef LAYERS
    trace_tree(light_sample(texel));
    for (int layer = 0; layer < layers_filled; layer++) book(layer_status[layer], layer_mean[layer]);
#else
#ifdef BLOCK_LEVELS
    int stride = stride_of(texel, push.view);
    if (any(notEqual(texel & (stride - 1), ivec2(0)))) return;
    Photon p = trace_photon(light_sample_of(texel, min(texel + stride, push.size)));
#else
    Photon p = trace_photon(light_sample(texel));
#endif
    if (p.status == PHOTON_NONE) return;
    book_way(p);
    book(status_for_method(p), mean(p.flux));
#endif
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    group_rows[gl_LocalInvocationIndex] = empty_row();
    if (all(lessThan(texel, push.size))) account(texel);
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    AccountRow row = empty_row();
    for (uint slot = 0u; slot < 64u; slot++) {
        for (uint k = 0u; k < PHOTON_STATUSES; k++) {
            row.counts[k] += group_rows[slot].counts[k];
            row.flux[k] += group_rows[slot].flux[k];
        }
        row.bent += group_rows[slot].bent;
        row.other += group_rows[slot].other;
        row.absorbed += group_rows[slot].absorbed;
    }
    account_rows.data[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = row;
}

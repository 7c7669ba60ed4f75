#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Counts and sums the photons of one view, outside the timed frames: a row for each work group, added on the host in
// float64. Flux is the mean of the bands.

#include "light/sample.glsl"
#include "light/tracer.glsl"
#include "capture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

struct AccountRow {
    uint counts[PHOTON_STATUSES]; // [0]: emitted; then by status
    uint bent;
    float flux[PHOTON_STATUSES];  // W; [0]: emitted; then by status, on arrival
    float other;                  // W
    float absorbed;               // W, of all photons but those that end absorbed
};

layout(set = 0, binding = 8, scalar) writeonly buffer Account { AccountRow data[]; } account_rows;

shared uint group_status[64];
shared uint group_bent[64];
shared vec4 group_flux[64]; // emitted, on arrival, other, absorbed

float mean(vec3 bands) {
    return (bands.r + bands.g + bands.b) / 3.0;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    uint slot = gl_LocalInvocationIndex;
    group_status[slot] = PHOTON_NONE;
    group_bent[slot] = 0u;
    group_flux[slot] = vec4(0.0);
    if (all(lessThan(texel, push.size))) {
        Photon p = trace_photon(light_sample(texel));
        vec3 normal = photon_normal(photon_flux_column(p).w); // as the method reads it
        if (p.status == PHOTON_VALID && !captured(p.hit, normal, p.receiver, push.light)) p.status = PHOTON_OUTSIDE_MAP;
        group_status[slot] = p.status;
        group_bent[slot] = p.bent;
        group_flux[slot] = vec4(mean(p.emitted), mean(p.flux), mean(p.other), mean(p.absorbed));
    }
    barrier();
    if (slot != 0u) return;
    AccountRow row;
    for (uint k = 0u; k < PHOTON_STATUSES; k++) {
        row.counts[k] = 0u;
        row.flux[k] = 0.0;
    }
    row.bent = 0u;
    row.other = 0.0;
    row.absorbed = 0.0;
    for (uint k = 0u; k < 64u; k++) {
        uint status = group_status[k];
        if (status == PHOTON_NONE) continue;
        row.counts[0]++;
        row.counts[status]++;
        row.bent += group_bent[k];
        row.flux[0] += group_flux[k].x;
        row.flux[status] += group_flux[k].y;
        row.other += group_flux[k].z;
        row.absorbed += group_flux[k].w;
    }
    account_rows.data[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = row;
}

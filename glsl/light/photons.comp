#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// N x N photons of one light and view into the columns that the method reads.

#include "light/sample.glsl"
#include "light/tracer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef COLUMN_HIT
layout(set = 0, binding = 8, COLUMN_HIT) uniform writeonly image2D photons_hit;
#endif
#ifdef COLUMN_FLUX
layout(set = 0, binding = 9, COLUMN_FLUX) uniform writeonly image2D photons_flux;
#endif
#ifdef COLUMN_EXIT
layout(set = 0, binding = 10, COLUMN_EXIT) uniform writeonly image2D photons_exit;
#endif
#ifdef COLUMN_DIRECTION
layout(set = 0, binding = 11, COLUMN_DIRECTION) uniform writeonly image2D photons_direction;
#endif

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, push.size))) return;
    Photon p = trace_photon(light_sample(texel));
#ifdef COLUMN_HIT
    imageStore(photons_hit, texel, photon_hit_column(p));
#endif
#ifdef COLUMN_FLUX
    imageStore(photons_flux, texel, photon_flux_column(p));
#endif
#ifdef COLUMN_EXIT
    imageStore(photons_exit, texel, vec4(p.exit, float(p.status)));
#endif
#ifdef COLUMN_DIRECTION
    imageStore(photons_direction, texel, vec4(p.direction, float(p.status)));
#endif
}

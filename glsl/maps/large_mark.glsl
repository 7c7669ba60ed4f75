// Marks the splats of a work group of 64 that are LARGE texels wide or wider: they are drawn afterwards.
#ifndef LARGE_MARK_GLSL
#define LARGE_MARK_GLSL

#define LARGE_WRITTEN
#include "maps/large.glsl"

shared uint large_mask[2];

// Whether a splat is to be added here. All invocations of the group call it once. Of a counted dispatch, whose last row is full,
// more groups may run than splats need: what those would mark lies beyond the buffer.
bool keeps_small(bool takes, Splat s, uint group) {
    uint own = gl_LocalInvocationIndex;
    if (own < 2u) large_mask[own] = 0u;
    barrier();
    bool large = takes && s.diameter >= LARGE;
    if (large) atomicOr(large_mask[own / 32u], 1u << own % 32u);
    barrier();
    if (own == 0u && group < uint(large_masks.data.length())) large_masks.data[group] = uvec2(large_mask[0], large_mask[1]);
    return takes && !large;
}

#endif

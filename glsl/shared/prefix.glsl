// A prefix sum over the invocations of one work group of 256.
#ifndef PREFIX_GLSL
#define PREFIX_GLSL

const uint PREFIX_GROUP = 256u;

shared uint prefix_sums[PREFIX_GROUP];

// What all invocations before this one gave. All call it once.
uint prefix_before(uint own_sum) {
    uint own = gl_LocalInvocationIndex;
    prefix_sums[own] = own_sum;
    barrier();
    for (uint step = 1u; step < PREFIX_GROUP; step *= 2u) {
        uint more = own >= step ? prefix_sums[own - step] : 0u;
        barrier();
        prefix_sums[own] += more;
        barrier();
    }
    return prefix_sums[own] - own_sum;
}

#endif

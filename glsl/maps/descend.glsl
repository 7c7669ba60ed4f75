// From the number of a splat to its texel, down the counts of splats below each (a histogram pyramid: Ziegler, Tevs, Theobalt
// and Seidel 2006): they come in the order of the quadtree. TOP is the level it starts from, TEXELS how many it has in all layers.
#ifndef DESCEND_GLSL
#define DESCEND_GLSL

#include "maps/levels.glsl"

layout(set = 0, binding = 19, scalar) readonly buffer Before { uint data[]; } maps_before;

uint splats_in_all() {
    return maps_before.data[TEXELS];
}

// The texel of the topmost level that holds it, in layers, rows and columns: the last before which no more come.
uint texel_of(uint number) {
    uint low = 0u, high = TEXELS;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (maps_before.data[middle] <= number) low = middle;
        else high = middle;
    }
    return low;
}

struct Found {
    ivec2 texel;
    int level;
    int layer;
};

// Of a number below `splats_in_all`.
Found find(uint number) {
    int side = level_side(photons_side(), TOP);
    uint top = texel_of(number), rest = number - maps_before.data[top];
    int row = int(top) / side;
    Found found = Found(ivec2(int(top) % side, row % side), TOP, row / side);
    while (found.level > 0) {
        uvec4 below = texelFetch(pyramid_points, above(found.texel, found.level, found.layer), 0);
        if (below == OWN) break;
        int child = 0;
        for (; child < 3 && rest >= below[child]; child++) rest -= below[child];
        found.texel = 2 * found.texel + ivec2(child & 1, child >> 1);
        found.level--;
    }
    return found;
}

#endif

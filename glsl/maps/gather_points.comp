#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// Traverse `compute` with a hierarchy: the splats in the order of the quadtree, an invocation each, which finds its own by
// going down the counts of splats (a histogram pyramid: Ziegler, Tevs, Theobalt and Seidel 2006). TOP is the level it
// starts from.

#include "maps/points_splat.glsl"
#include "maps/deposit.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 19, scalar) readonly buffer Before { uint data[]; } maps_before;

// The texel of the topmost level that holds the splat of this number, in layers, rows and columns: the last before which no
// more come.
uint texel_of(uint number) {
    uint low = 0u, high = uint(maps_before.data.length()) - 1u;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (maps_before.data[middle] <= number) low = middle;
        else high = middle;
    }
    return low;
}

uint counted_at(ivec2 at, int level, int layer) {
    return level > 0 ? texelFetch(pyramid_points, above(at, level, layer), 0).r : hit_at(at, layer).w == 0.0 ? 0u : 1u;
}

// A cluster is its own splat.
bool is_own(uint counted) {
#ifdef EXACT
    return counted == 1u; // one photon alone is its own cluster
#else
    return counted >= OWN;
#endif
}

void main() {
    uint number = gl_WorkGroupID.y * gl_NumWorkGroups.x * 64u + gl_WorkGroupID.x * 64u + gl_LocalInvocationIndex;
    if (number >= maps_before.data[maps_before.data.length() - 1]) return;
    int side = level_side(photons_side(), TOP), level = TOP;
    uint top = texel_of(number), rest = number - maps_before.data[top];
    int row = int(top) / side, layer = row / side;
    ivec2 at = ivec2(int(top) % side, row % side);
    uint counted = counted_at(at, level, layer);
    while (level > 0 && !is_own(counted)) {
        level--;
        ivec2 first = 2 * at, sides = ivec2(level_side(photons_side(), level));
        for (int k = 0; k < 4; k++) {
            ivec2 child = first + ivec2(k & 1, k >> 1);
            if (any(greaterThanEqual(child, sides))) continue;
            counted = counted_at(child, level, layer);
            at = child;
            uint splats = counted & ~OWN;
            if (rest < splats) break;
            rest -= splats;
        }
    }
    Splat s;
#ifdef SHAPED
    Shape shape;
    if (point_splat(at, level, layer, s, shape)) deposit(s, shape);
#else
    if (point_splat(at, level, layer, s)) deposit(s);
#endif
}

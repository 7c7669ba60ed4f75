// Splats as photon differentials make them: ellipses that reach to the photons beside them.
#ifndef ELLIPTIC_GLSL
#define ELLIPTIC_GLSL

#include "maps/levels.glsl"
#include "maps/shape.glsl"

layout(set = 0, binding = 16) uniform PHOTON_SAMPLER photons_way;

float way_at(ivec2 at, int layer) {
    return texelFetch(photons_way, PHOTON_PLACE(at, layer), 0).r;
}

// How far from a photon, in texels of its map, the one at `next` lands that came the same way; false if none did.
bool beside_in_map(ivec2 next, int layer, float way, Landed l, out vec2 apart) {
    apart = vec2(0.0);
    if (any(lessThan(next, ivec2(0))) || any(greaterThanEqual(next, ivec2(photons_side())))) return false;
    if (way_at(next, layer) != way) return false;
    vec2 xy01;
    if (!view_project(maps_views.data[l.map].view, hit_at(next, layer).xyz, xy01)) return false;
    apart = (xy01 - l.xy01) * float(push.side);
    return true;
}

#ifndef BLOCK_LEVELS
// The landing's change by a sample along an axis: half of that between both neighbours, or that to the only one.
bool differential(ivec2 at, ivec2 axis, int layer, float way, Landed l, out vec2 change) {
    vec2 after, before;
    bool has_after = beside_in_map(at + axis, layer, way, l, after);
    bool has_before = beside_in_map(at - axis, layer, way, l, before);
    change = has_after && has_before ? 0.5 * (after - before) : after - before;
    return has_after || has_before;
}

bool differentials(ivec2 at, int layer, float way, Landed l, out vec2 x, out vec2 y) {
    bool has_x = differential(at, ivec2(1, 0), layer, way, l, x), has_y = differential(at, ivec2(0, 1), layer, way, l, y);
    return has_x || has_y;
}
#else
#include "light/blocks.glsl"

// Twice the middle of the slots that the photon of a slot stands for, and the first of them.
ivec2 middle_of(ivec2 slot, out ivec2 first) {
    int stride = stride_of(slot, push.view);
    first = slot & ~(stride - 1);
    return 2 * first + stride;
}

// The landing's change between the photons on both sides along an axis, or to the only one; and how far those lie apart, slots.
// Where strides change the photon across is not straight ahead.
bool differential(ivec2 at, int stride, ivec2 axis, int layer, float way, Landed l, out vec2 change, out vec2 apart) {
    ivec2 beside = stride / 2 * (1 - axis);
    change = apart = vec2(0.0);
    bool has = false;
    for (int side = 0; side < 2; side++) {
        ivec2 across = at + beside + (side == 0 ? stride * axis : -axis), first;
        if (any(lessThan(across, ivec2(0))) || any(greaterThanEqual(across, ivec2(photons_side())))) continue;
        vec2 away = 0.5 * vec2(middle_of(across, first) - (2 * at + stride)), landed;
        if (!beside_in_map(first, layer, way, l, landed)) continue;
        change += side == 0 ? landed : -landed;
        apart += side == 0 ? away : -away;
        has = true;
    }
    return has;
}

// The landing's change by a stride along both axes.
bool differentials(ivec2 at, int layer, float way, Landed l, out vec2 x, out vec2 y) {
    int stride = stride_of(at, push.view);
    vec2 dx, dy, ox, oy;
    bool has_x = differential(at, stride, ivec2(1, 0), layer, way, l, dx, ox);
    bool has_y = differential(at, stride, ivec2(0, 1), layer, way, l, dy, oy);
    x = y = vec2(0.0);
    if (!has_x) ox = vec2(1.0, 0.0);
    if (!has_y) oy = vec2(0.0, 1.0);
    if (!has_x) oy.x = 0.0;
    if (!has_y) ox.y = 0.0;
    // Photons across lie aside by less than ahead: the determinant is above nought.
    float all = float(stride) / (ox.x * oy.y - ox.y * oy.x);
    x = (oy.y * dx - ox.y * dy) * all;
    y = (ox.x * dy - oy.x * dx) * all;
    return has_x || has_y;
}
#endif

// A Gaussian whose standard deviation is half of how far neighbours lie apart, as that of varying splats, on top of one that
// is two texels wide: else it could fall between texels. False without a neighbour.
bool elliptic_splat_of(Landed l, vec3 flux, ivec2 at, int layer, out Splat s) {
    const float LEAST = 2.0;
    const float FARTHEST = 1e3; // texels: beyond it nothing is told from what is evenly lit
    float way = way_at(at, layer);
    vec2 x, y;
    if (!differentials(at, layer, way, l, x, y)) return false;
    x = clamp(x, vec2(-FARTHEST), vec2(FARTHEST));
    y = clamp(y, vec2(-FARTHEST), vec2(FARTHEST));
    vec3 covariance = 0.25 * LOWERED * vec3(x * x + y * y, x.x * x.y + y.x * y.y);
    return shaped_splat_of(l.xy01 * float(push.side), flux, l.map, covariance, LEAST, s);
}

#endif

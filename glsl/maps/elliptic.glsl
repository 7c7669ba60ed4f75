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

// The landing's change by a sample along an axis: half of that between both neighbours, or that to the only one.
bool differential(ivec2 at, ivec2 axis, int layer, float way, Landed l, out vec2 change) {
    vec2 after, before;
    bool has_after = beside_in_map(at + axis, layer, way, l, after);
    bool has_before = beside_in_map(at - axis, layer, way, l, before);
    change = has_after && has_before ? 0.5 * (after - before) : after - before;
    return has_after || has_before;
}

// A Gaussian whose standard deviation is half of how far neighbours lie apart, as that of varying splats, on top of one that
// is two texels wide: else it could fall between texels. False without a neighbour.
bool elliptic_splat_of(Landed l, vec3 flux, ivec2 at, int layer, out Splat s) {
    const float LEAST = 2.0;
    const float FARTHEST = 1e3; // texels: beyond it nothing is told from what is evenly lit
    float way = way_at(at, layer);
    vec2 x, y;
    bool has_x = differential(at, ivec2(1, 0), layer, way, l, x), has_y = differential(at, ivec2(0, 1), layer, way, l, y);
    if (!has_x && !has_y) return false;
    x = clamp(x, vec2(-FARTHEST), vec2(FARTHEST));
    y = clamp(y, vec2(-FARTHEST), vec2(FARTHEST));
    vec3 covariance = 0.25 * LOWERED * vec3(x * x + y * y, x.x * x.y + y.x * y.y);
    return shaped_splat_of(l.xy01 * float(push.side), flux, l.map, covariance, LEAST, s);
}

#endif

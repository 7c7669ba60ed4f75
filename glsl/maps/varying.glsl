// How large a splat is: fixed, or as far as the photons beside it lie apart (Wyman 2008, section 3.3).
#ifndef VARYING_GLSL
#define VARYING_GLSL

#include "maps/levels.glsl"
#include "maps/photon_splat.glsl"

#ifdef VARYING
// The photon beside one along an axis, on the same receiver: the next, else the one before; false if neither is there.
bool beside(ivec2 at, ivec2 axis, int level, int layer, uint receiver, out vec3 p, out ivec2 step) {
    int side = level_side(photons_side(), level);
    for (int sign = 1; sign >= -1; sign -= 2) {
        step = sign * axis;
        ivec2 next = at + step;
        if (any(lessThan(next, ivec2(0))) || any(greaterThanEqual(next, ivec2(side)))) continue;
        vec4 hit = hit_of(next, level, layer);
        p = hit.xyz;
        if (hit.w == float(receiver + 1u)) return true;
    }
    return false;
}

#ifdef THIN_LENS
layout(set = 0, binding = 16) uniform PHOTON_SAMPLER photons_exit;

vec3 exit_at(ivec2 at, int layer) {
    return texelFetch(photons_exit, PHOTON_PLACE(at, layer), 0).xyz;
}

// Our reading of Wyman and Dachsbacher 2007: D_0 |1 - d/f|. D_0 is twice the largest distance of neighbouring exits, d the way
// from the exit to the receiver, and f that on which neighbours at as long a way come nearest: of exits P and directions D
// relative to the photon's own, the least of the sum of |P + s D|^2. Without a neighbour, the diameter of fixed splats.
float splat_size(Landed l, ivec2 at, int level, int layer) {
    vec3 own = exit_at(at, layer), way = l.p - own;
    float d = sqrt(dot(way, way));
    if (!(d > 0.0)) return push.diameter;
    float towards = 0.0, spread = 0.0, apart = 0.0;
    for (int axis = 0; axis < 2; axis++) {
        vec3 p;
        ivec2 step;
        if (!beside(at, ivec2(1 - axis, axis), level, layer, l.receiver, p, step)) continue;
        vec3 exit = exit_at(at + step, layer), other = p - exit;
        float far = sqrt(dot(other, other));
        if (!(far > 0.0)) continue;
        vec3 away = exit - own, turn = other / far - way / d;
        towards -= dot(away, turn);
        spread += dot(turn, turn);
        apart = max(apart, dot(away, away));
    }
    if (!(apart > 0.0)) return push.diameter;
    float texel = view_texel_area(maps_views.data[l.map].view, ivec2(push.side), l.xy01, l.p, l.n);
    float unbent = 2.0 * sqrt(apart / max(texel, 1e-30));
    // |1 - d/f| = |towards - d spread| / |towards|: parallel rays keep their distance, and f = 0 has no bound.
    float bent = spread > 0.0 ? abs(towards - d * spread) / max(abs(towards), 1e-30) : 1.0;
    return min(unbent * bent, 1e6);
}
#else
// Equation 2: twice r_i = sqrt(A / A_0), in texels of the map: A over a texel's footprint A_map on the receiver. A is the
// quad of four adjacent photons, or the square of their largest distance; the diameter in texels, of the whole map.
// Without any neighbour, that of fixed splats.
float splat_size(Landed l, ivec2 at, int level, int layer) {
    vec3 right, down;
    ivec2 x, y;
    bool has_right = beside(at, ivec2(1, 0), level, layer, l.receiver, right, x);
    bool has_down = beside(at, ivec2(0, 1), level, layer, l.receiver, down, y);
    if (!has_right && !has_down) return push.diameter;
    vec3 a = (has_right ? right : down) - l.p, b = (has_down ? down : right) - l.p;
    float area = dot(a, a); // of one neighbour alone: a square
    if (has_right && has_down) {
        vec4 fourth = hit_of(at + x + y, level, layer);
        vec3 c = fourth.w == float(l.receiver + 1u) ? fourth.xyz - l.p : a + b;
#ifdef FOOTPRINT_AREA
        vec3 n = cross(c, b - a); // twice the quad, its diagonals crossed
        area = 0.5 * sqrt(dot(n, n));
#else
        area = max(max(dot(a, a), dot(b, b)), max(dot(c - a, c - a), dot(c - b, c - b)));
#endif
    }
    float texel = view_texel_area(maps_views.data[l.map].view, ivec2(push.side), l.xy01, l.p, l.n);
    float squared = area / max(texel, 1e-30);
    return squared > 0.0 ? min(2.0 * sqrt(squared), 1e6) : 0.0; // NaN ends here
}
#endif
#else
float splat_size(Landed l, ivec2 at, int level, int layer) {
    return push.diameter;
}
#endif

#endif

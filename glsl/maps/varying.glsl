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
#else
float splat_size(Landed l, ivec2 at, int level, int layer) {
    return push.diameter;
}
#endif

#endif

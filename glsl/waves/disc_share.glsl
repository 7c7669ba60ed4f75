// How much of a triangle lies in the unit disc, exactly.
#ifndef DISC_SHARE_GLSL
#define DISC_SHARE_GLSL

#include "shared/cover.glsl"

// The part of the way a..b inside the disc, as shares of it; empty where its end is not beyond its start.
vec2 way_in_disc(vec2 a, vec2 b) {
    vec2 d = b - a;
    float dd = dot(d, d), ad = dot(a, d), rest = ad * ad - dd * (dot(a, a) - 1.0);
    if (!(dd > 0.0) || !(rest > 0.0)) return vec2(0.0);
    float root = sqrt(rest);
    return clamp(vec2(-ad - root, -ad + root) / dd, 0.0, 1.0);
}

// Signed, of the sector of the disc between two ways from its middle.
float sector(vec2 a, vec2 b) {
    return 0.5 * atan(a.x * b.y - a.y * b.x, dot(a, b));
}

// Signed area between the middle, a and b that lies in the disc: a triangle for the part of the edge inside, sectors beside it.
float fan_area(vec2 a, vec2 b) {
    vec2 part = way_in_disc(a, b);
    if (!(part.x < part.y)) return sector(a, b);
    vec2 from = mix(a, b, part.x), to = mix(a, b, part.y);
    float area = 0.5 * (from.x * to.y - from.y * to.x);
    if (part.x > 0.0) area += sector(a, from);
    if (part.y < 1.0) area += sector(to, b);
    return area;
}

// Of a triangle; of what is thin, its longest edge (cover.glsl).
float share_in_disc(Flat t) {
    vec4 squared = t.x * t.x + t.y * t.y;
    if (most(squared) <= 1.0) return 1.0;
    if (least(t.x) > 1.0 || most(t.x) < -1.0 || least(t.y) > 1.0 || most(t.y) < -1.0) return 0.0;
    if (is_thin(t)) {
        Line line = line_of(t);
        return line_share(line, way_in_disc(line.from, line.to));
    }
    vec2 a = vec2(t.x.x, t.y.x), b = vec2(t.x.y, t.y.y), c = vec2(t.x.z, t.y.z);
    float inside = fan_area(a, b) + fan_area(b, c) + fan_area(c, a);
    return clamp(abs(inside) / (0.5 * abs(twice_area(t))), 0.0, 1.0);
}

#endif

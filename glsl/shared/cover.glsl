// How much of a quad, or of a triangle, lies in a unit square, exactly, however small, thin or large it is.
//
// For each height the width inside a column is the difference of the sides' x, clamped to the column: the area is the
// integral of clamped x along the outline (Green). The parts of an edge that two neighbouring squares see end in the same
// numbers, so that shares of all squares sum to one but for rounding.
//
// A triangle thinner than THIN is taken for its longest edge: its area is lost in rounding, but how wide it is along that
// edge, a tent with its top at the third corner, is not. One without length is a point.
#ifndef COVER_GLSL
#define COVER_GLSL

const float THIN = 1.0 / 64.0; // sides of a square: what a thin triangle may be displaced by

// A quad in the plane of the squares, that does not cross itself: its corners in their order. A triangle has its last twice.
struct Flat {
    vec4 x;
    vec4 y;
};

// A thin triangle.
struct Line {
    vec2 from;
    vec2 to;
    float top; // of the tent, share of the way
};

// What the edges do between two heights.
struct Strip {
    vec4 from; // x where they enter
    vec4 to;   // and leave
    vec4 down; // heights between, signed
};

Flat triangle_of(vec2 a, vec2 b, vec2 c) {
    return Flat(vec4(a.x, b.x, c.x, c.x), vec4(a.y, b.y, c.y, c.y));
}

float least(vec4 v) {
    return min(min(v.x, v.y), min(v.z, v.w));
}

float most(vec4 v) {
    return max(max(v.x, v.y), max(v.z, v.w));
}

// From the diagonals, signed.
float twice_area(Flat t) {
    return (t.x.z - t.x.x) * (t.y.w - t.y.y) - (t.x.w - t.x.y) * (t.y.z - t.y.x);
}

bool is_thin(Flat t) {
    vec4 dx = t.x.yzwx - t.x, dy = t.y.yzwx - t.y;
    float across = length(vec2(t.x.z - t.x.x, t.y.z - t.y.x));
    return !(abs(twice_area(t)) > THIN * max(across, sqrt(most(dx * dx + dy * dy))));
}

Strip strip_between(Flat t, float low, float high) {
    const float LEVEL = 1e-30; // an edge that rises by less rises by nothing
    vec4 rise = t.y.yzwx - t.y;
    bvec4 level = lessThan(abs(rise), vec4(LEVEL));
    vec4 y0 = clamp(t.y, low, high), y1 = clamp(t.y.yzwx, low, high);
    vec4 over = mix(rise, vec4(1.0), level);
    vec4 s0 = clamp((y0 - t.y) / over, 0.0, 1.0), s1 = clamp((y1 - t.y) / over, 0.0, 1.0);
    return Strip(mix(t.x, t.x.yzwx, s0), mix(t.x, t.x.yzwx, s1), mix(y1 - y0, vec4(0.0), level));
}

// Least and greatest x of what the edges enclose in the strip; least above greatest if nothing.
vec2 strip_bounds(Strip s) {
    const float FAR = 3e38;
    bvec4 none = equal(s.down, vec4(0.0));
    vec4 low = mix(min(s.from, s.to), vec4(FAR), none), high = mix(max(s.from, s.to), vec4(-FAR), none);
    return vec2(least(low), most(high));
}

// Mean along a segment of its x clamped to 0..1.
vec4 mean_clamped(vec4 from, vec4 to) {
    const float LEAST = 1e-20; // in place of no width, which is only ever a divisor of what it is far below
    vec4 low = min(from, to), high = max(from, to);
    vec4 width = max(high - low, LEAST);
    vec4 beyond = clamp((high - 1.0) / width, 0.0, 1.0), before = clamp(-low / width, 0.0, 1.0);
    return beyond + (1.0 - beyond - before) * 0.5 * (clamp(low, 0.0, 1.0) + clamp(high, 0.0, 1.0));
}

// Area of a strip in the unit square of column `x`.
float strip_area(Strip s, float x) {
    return abs(dot(s.down, mean_clamped(s.from - x, s.to - x)));
}

// Of a triangle.
Line line_of(Flat t) {
    vec2 a = vec2(t.x.x, t.y.x), b = vec2(t.x.y, t.y.y), c = vec2(t.x.z, t.y.z), third = c;
    vec3 l = vec3(distance(a, b), distance(b, c), distance(c, a));
    Line line = Line(a, b, 0.0);
    if (l.y > l.x && l.y >= l.z) {
        line = Line(b, c, 0.0);
        third = a;
    } else if (l.z > l.x) {
        line = Line(c, a, 0.0);
        third = b;
    }
    vec2 way = line.to - line.from;
    float squared = dot(way, way);
    line.top = squared > 0.0 ? clamp(dot(third - line.from, way) / squared, 0.0, 1.0) : 0.5;
    return line;
}

// Of the tent's area, what lies before a share of the way.
float tent_before(float s, float top) {
    if (s < top) return s * s / top;
    return s < 1.0 ? 1.0 - (1.0 - s) * (1.0 - s) / (1.0 - top) : 1.0;
}

// The part of the way on which a coordinate lies in low..high; empty where its end is not beyond its start.
vec2 way_between(float from, float to, float low, float high) {
    float d = to - from;
    if (abs(d) < 1e-30) return from >= low && from < high ? vec2(0.0, 1.0) : vec2(0.0);
    vec2 s = clamp((vec2(low, high) - from) / d, 0.0, 1.0);
    return d > 0.0 ? s : s.yx;
}

// Share of a line between two shares of its way.
float line_share(Line line, vec2 part) {
    return part.x < part.y ? tent_before(part.y, line.top) - tent_before(part.x, line.top) : 0.0;
}

// Share of it in the square from 0 to `side` both ways; of what is thin, if it is a triangle.
float share_within(Flat t, float side) {
    if (min(least(t.x), least(t.y)) >= 0.0 && max(most(t.x), most(t.y)) <= side) return 1.0;
    if (is_thin(t)) {
        Line line = line_of(t);
        vec2 x = way_between(line.from.x, line.to.x, 0.0, side), y = way_between(line.from.y, line.to.y, 0.0, side);
        return line_share(line, vec2(max(x.x, y.x), min(x.y, y.y)));
    }
    Flat unit = Flat(t.x / side, t.y / side);
    float whole = 0.5 * abs(twice_area(t)) / (side * side);
    return clamp(strip_area(strip_between(unit, 0.0, 1.0), 0.0) / whole, 0.0, 1.0);
}

#endif

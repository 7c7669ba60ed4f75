// The flux of a quad or triangle, spread evenly over it and shared out among the texels of a map that it covers. Whoever includes this
// defines `put`, which takes what a texel gets.
#ifndef SPREAD_GLSL
#define SPREAD_GLSL

#include "shared/cover.glsl"

void put(ivec2 texel, int layer, vec3 flux);

// A thin triangle, row by row, in coordinates from the texel `first` on.
void spread_line(Line line, ivec2 first, ivec2 last, int layer, vec3 flux) {
    for (int row = 0; row <= last.y; row++) {
        vec2 rows = way_between(line.from.y, line.to.y, float(row), float(row + 1));
        if (!(rows.x < rows.y)) continue;
        vec2 ends = mix(line.from.xx, line.to.xx, rows);
        int low = max(int(floor(min(ends.x, ends.y))), 0), high = min(int(floor(max(ends.x, ends.y))), last.x);
        for (int column = low; column <= high; column++) {
            vec2 columns = way_between(line.from.x, line.to.x, float(column), float(column + 1));
            float share = line_share(line, vec2(max(rows.x, columns.x), min(rows.y, columns.y)));
            if (share > 0.0) put(first + ivec2(column, row), layer, share * flux);
        }
    }
}

// What of a row of texels it covers, columns `first` to `last`.
void spread_row(Flat t, int row, int first, int last, ivec2 origin, int layer, vec3 density) {
    Strip strip = strip_between(t, float(row), float(row + 1));
    vec2 ends = clamp(floor(strip_bounds(strip)), vec2(first), vec2(last + 1));
    for (int column = int(ends.x); column <= min(int(ends.y), last); column++) {
        float area = strip_area(strip, float(column));
        if (area > 0.0) put(origin + ivec2(column, row), layer, area * density);
    }
}

// The texels of a map of `side` that it reaches; false if none. Corners must be numbers that an int holds.
bool reach(Flat t, int side, out ivec2 first, out ivec2 last) {
    first = max(ivec2(floor(vec2(least(t.x), least(t.y)))), 0);
    last = min(ivec2(floor(vec2(most(t.x), most(t.y)))), side - 1);
    return all(lessThanEqual(first, last));
}

// In coordinates from a texel on, which are small and keep their digits.
Flat from_texel(Flat t, ivec2 first) {
    return Flat(t.x - float(first.x), t.y - float(first.y));
}

// What a texel wholly covered gets.
vec3 density_of(Flat t, vec3 flux) {
    return flux / (0.5 * abs(twice_area(t)));
}

// What lies beyond the map gets nothing. What is thin must be a triangle.
void spread(Flat t, int side, int layer, vec3 flux) {
    ivec2 first, last;
    if (!reach(t, side, first, last)) return;
    if (first == last && share_within(t, float(side)) == 1.0) {
        put(first, layer, flux);
        return;
    }
    t = from_texel(t, first);
    last -= first;
    if (is_thin(t)) {
        spread_line(line_of(t), first, last, layer, flux);
        return;
    }
    vec3 density = density_of(t, flux);
    for (int row = 0; row <= last.y; row++) spread_row(t, row, 0, last.x, first, layer, density);
}

#endif

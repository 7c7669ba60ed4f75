// What the light of a cell is wrong by where it is not traced finer, as the picture shows it, by estimate: the square of the
// relative error, summed over texels. An error is relative to the cell's own light, and to what is dim. The including file has
// `push.blur`, in texels.
#ifndef CELL_ERROR_GLSL
#define CELL_ERROR_GLSL

#include "maps/cells.glsl"

// Of each view of emission: W of a cell, all bands, at most; W/m^2, all bands, of what is dim.
layout(set = 0, binding = 35, scalar) readonly buffer Lights { vec2 data[]; } cells_lights;

// Second differences of where light lands along both axes of the view and across them, texels for a step of a cell.
struct Curve {
    vec2 uu;
    vec2 vv;
    vec2 uv;
};

// From the cell alone, which tells the sum of the first two: either may be as large.
Curve curve_of(Cell c) {
    vec2 middle = 0.25 * (c.corner[0].at + c.corner[1].at + c.corner[2].at + c.corner[3].at);
    vec2 both = 8.0 * (middle - c.centre.at);
    return Curve(both, both, c.corner[0].at - c.corner[1].at + c.corner[2].at - c.corner[3].at);
}

// Flux (W, all bands) of a texel about p that is told from none just so.
float dim_flux(int map, vec3 p) {
    View v = maps_views.data[map].view;
    float away = v.perspective != 0u ? dot(p - v.origin, v.forward) : 1.0;
    return cells_lights.data[push.view].y * abs((v.x1 - v.x0) * (v.y1 - v.y0)) * away * away / (float(push.side) * float(push.side));
}

float across(vec2 a, vec2 b) {
    return abs(a.x * b.y - a.y * b.x);
}

// Of a sheet that is spread evenly, quarter by quarter: how dense it is changes over it by as much as its area does.
float sheet_error(Cell c, Curve k, float flux, float dim) {
    const float QUARTERED = 1.0 / 3.0; // of the change from the middle to an end, what is left within a quarter
    if (!(flux > 0.0)) return 0.0;
    float f = push.blur;
    vec2 u = 0.5 * (c.corner[1].at + c.corner[2].at - c.corner[0].at - c.corner[3].at);
    vec2 v = 0.5 * (c.corner[3].at + c.corner[2].at - c.corner[0].at - c.corner[1].at);
    float area = across(u, v), seen = area + f * (length(u) + length(v)) + f * f;
    float moved = across(k.uu, v) + across(k.uv, u) + across(k.uv, v) + across(k.vv, u) +
                  f * (length(k.uu) + length(k.vv)) / 16.0;
    float own = flux / (area + moved + f * f);
    float off = flux / seen * min(QUARTERED * moved / seen, 1.0) / (own + dim);
    return seen * off * off;
}

// Of light that goes as a point, and belongs where it is `own` W a texel.
float point_error(float flux, float own, float dim) {
    if (!(flux > 0.0)) return 0.0;
    float off = flux / (own + dim) / push.blur;
    return off * off;
}

// Of a sheet that is torn.
float torn_error(vec4 bounds, float flux, float dim) {
    vec2 size = bounds.zw - bounds.xy + 1.0;
    return point_error(flux, flux / (size.x * size.y), dim);
}

// Of a cell that is cut: how far its light reaches is not known, but that it is seldom dim all about where it lands.
float cut_error(float flux, float dim) {
    const float ABOUT = 3.0;
    return point_error(flux, 0.0, ABOUT * dim);
}

#endif

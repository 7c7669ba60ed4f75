// A Gaussian splat of fixed size, separable, its weights summing to one over the texels it covers.
//
// It is lowered to zero at its window's edge. Cut off there (at two standard deviations, 14 % of its height) it would
// jump by a fifth of a texel whenever a texel enters or leaves the window, and where photons lie nearly as dense as
// texels the two beat: seams of 15 % across an evenly lit receiver.
//
// A point of size D centred at p (in texels; texel k spans k..k+1) covers the texels whose centres lie in
// [p - D/2, p + D/2). Along each axis a texel's share is splat_weight(centre, p, D) / splat_norm(p, D, side):
// what a border cuts off is shared out among the rest.
#ifndef SPLAT_GLSL
#define SPLAT_GLSL

// The rasteriser keeps point centres to 1/256 texel (subPixelPrecisionBits = 8). A centre already on that grid is
// covered as this file says; any other could gain or lose a row at the window's edge.
const float SPLAT_GRID = 256.0;
const float SPLAT_MAX_DIAMETER = 255.0;

float splat_snap(float p) {
    return floor(p * SPLAT_GRID + 0.5) / SPLAT_GRID;
}

float splat_diameter(float diameter) {
    return clamp(diameter, 1.0, SPLAT_MAX_DIAMETER);
}

// Not normalised. Standard deviation, before it is lowered, a quarter of the diameter.
float splat_weight(float texel_centre, float p, float diameter) {
    const float EDGE = 0.13533528; // exp(-2), the Gaussian at the window's edge
    float d = splat_diameter(diameter);
    if (d == 1.0) return 1.0; // one texel, perhaps at the edge
    float x = (texel_centre - p) * 4.0 / d;
    return max(exp(-0.5 * x * x) - EDGE, 0.0);
}

// The same of a texel that no loop or point of this size has chosen: nothing outside the window, where what is one texel wide
// would else weigh 1 at any distance.
float splat_weight_within(float texel_centre, float p, float diameter) {
    float beside = texel_centre - p, reach = 0.5 * splat_diameter(diameter);
    return beside >= -reach && beside < reach ? splat_weight(texel_centre, p, diameter) : 0.0;
}

// Sum of the weights over the texels of one axis that the window covers inside a map of `side` texels; zero if
// there are none.
float splat_norm(float p, float diameter, int side) {
    float d = splat_diameter(diameter);
    if (!(p > -d && p < float(side) + d)) return 0.0; // NaN and what no int can hold end here
    // floor(x) < p <= k + 1/2 in exact arithmetic; p and D/2 are dyadic, so nothing is rounded for centres on the
    // grid.
    int first = max(int(ceil(p - 0.5 * d - 0.5)), 0);
    int last = min(int(ceil(p + 0.5 * d - 0.5)), side);
    float sum = 0.0;
    for (int k = first; k < last; k++) sum += splat_weight(float(k) + 0.5, p, d);
    return sum;
}

#endif

// Splats that are longer one way than the other: of clusters whose photons lie apart, or of photons whose neighbours do.
#ifndef SHAPE_GLSL
#define SHAPE_GLSL

#include "maps/clusters.glsl"
#include "maps/photon_splat.glsl"

// Variance of a Gaussian that is lowered to zero at two deviations, of the Gaussian's:
// (sqrt(2 pi) erf(sqrt 2) - 28/3 e^-2) / (sqrt(2 pi) erf(sqrt 2) - 4 e^-2).
const float LOWERED = 0.6102;

// A fixed splat of a diameter beyond one texel that has a covariance (xx, yy, xy, texels^2) on top of its own: along rows a
// Gaussian of standard deviation sqrt(Sxx), and in each column one of sqrt(Syy - Sxy^2 / Sxx) about a centre that moves by
// Sxy / Sxx a column.
bool shaped_splat_of(vec2 at, vec3 flux, int view, vec3 covariance, float diameter, out Splat s) {
    s = NO_SPLAT;
    vec3 sum = covariance / LOWERED + 0.0625 * diameter * diameter * vec3(1.0, 1.0, 0.0);
    float lean = sum.z / sum.x, d = 4.0 * sqrt(sum.x), rows = 4.0 * sqrt(max(sum.y - lean * sum.z, 0.0));
    float fits = min(1.0, SPLAT_MAX_DIAMETER / reach_of(d, vec2(rows, lean)));
    d = splat_diameter(fits * d);
    rows = splat_diameter(fits * rows);
    vec2 p = min(vec2(splat_snap(at.x), splat_snap(at.y)), vec2(float(push.side) - 1.0 / SPLAT_GRID));
    float norm = 0.0;
    int first = max(int(ceil(p.x - 0.5 * d - 0.5)), 0), last = min(int(ceil(p.x + 0.5 * d - 0.5)), push.side);
    for (int x = first; x < last; x++) {
        float beside = float(x) + 0.5 - p.x;
        norm += splat_weight(beside, 0.0, d) * splat_norm(p.y + lean * beside, rows, push.side);
    }
    if (!(norm > 0.0)) return false;
    s = Splat(flux / norm, 1.0 / norm, p, d, vec2(rows, lean), push.side, int(maps_views.data[view].layer));
    return true;
}

#endif

// Splats that are longer one way than the other: those of clusters whose photons lie apart.
#ifndef SHAPE_GLSL
#define SHAPE_GLSL

#include "maps/clusters.glsl"
#include "maps/photon_splat.glsl"

// Beside a splat's diameter along rows.
struct Shape {
    float rows; // its diameter along columns, texels
    float lean; // rows that its centre moves by a column
};

// A fixed splat that has the covariance of a cluster on top of its own: a Gaussian of covariance S along rows of standard
// deviation sqrt(Sxx), and in each column one of sqrt(Syy - Sxy^2 / Sxx) about a centre that moves by Sxy / Sxx a column.
// Lowered to zero at two deviations, its variance is 0.6102 of the Gaussian's.
bool shaped_splat_of(Cluster c, float diameter, out Splat s, out Shape shape) {
    const float LOWERED = 0.6102;
    s = NO_SPLAT;
    shape = Shape(diameter, 0.0);
    float d = diameter;
    if (diameter > 1.0) {
        vec3 spread = c.spread / LOWERED + 0.0625 * diameter * diameter * vec3(1.0, 1.0, 0.0);
        d = splat_diameter(4.0 * sqrt(spread.x));
        shape.lean = spread.z / spread.x;
        shape.rows = splat_diameter(4.0 * sqrt(max(spread.y - shape.lean * spread.z, 0.0)));
    }
    vec2 p = min(vec2(splat_snap(c.mean.x), splat_snap(c.mean.y)), vec2(float(push.side) - 1.0 / SPLAT_GRID));
    float norm = 0.0;
    int first = max(int(ceil(p.x - 0.5 * d - 0.5)), 0), last = min(int(ceil(p.x + 0.5 * d - 0.5)), push.side);
    for (int x = first; x < last; x++) {
        float beside = float(x) + 0.5 - p.x;
        norm += splat_weight(beside, 0.0, d) * splat_norm(p.y + shape.lean * beside, shape.rows, push.side);
    }
    if (!(norm > 0.0)) return false;
    s = Splat(c.flux / norm, 1.0 / norm, p, d, push.side, layer_of_place(c.place));
    return true;
}

#ifdef EXACT
Cluster cluster_at(ivec2 texel, int level, int layer) {
    ivec3 at = above(texel, level, layer);
    vec4 flux = texelFetch(pyramid_flux, at, 0), mean = texelFetch(pyramid_mean, at, 0);
    vec3 spread = vec3(mean.zw, texelFetch(pyramid_lean, at, 0).r);
    return Cluster(flux.rgb, flux.a, mean.xy, spread, vec4(0.0));
}
#endif

#endif

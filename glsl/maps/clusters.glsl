// Clusters with exact books (`maps.merge = exact`): of all photons below a texel of the pyramid, their flux, and where in the
// map they land: mean, covariance and bounds. One splat that has these three moments stands for them: what of a map it
// changes begins with their third, whatever the kernel.
#ifndef CLUSTERS_GLSL
#define CLUSTERS_GLSL

#include "maps/landing.glsl"

const float NOWHERE = 0.0;
const float SEVERAL = -1.0;

struct Cluster {
    vec3 flux;   // W
    float place; // the receiver and the map's view that all share, from 1 on; NOWHERE without a photon, or SEVERAL
    vec2 mean;   // flux-weighted, texels of the map
    vec3 spread; // covariance xx, yy, xy, texels^2
    vec4 bounds; // least and greatest, texels
};

const Cluster NO_CLUSTER = Cluster(vec3(0.0), NOWHERE, vec2(0.0), vec3(0.0), vec4(0.0));

Cluster cluster_of(Landed l, vec3 flux, int map_side) {
    vec2 at = l.xy01 * float(map_side);
    float place = float(1 + l.map + maps_views.data.length() * int(l.receiver));
    return Cluster(flux, place, at, vec3(0.0), vec4(at, at));
}

// The map's view of a cluster that has one.
int view_of_place(float place) {
    return (int(place) - 1) % maps_views.data.length();
}

float weight_of(Cluster c) {
    return c.flux.r + c.flux.g + c.flux.b;
}

// Both together. Covariances are about the mean: differences of squares would lose their digits.
Cluster joined(Cluster a, Cluster b) {
    if (a.place == NOWHERE) return b;
    if (b.place == NOWHERE) return a;
    float share = weight_of(b) / max(weight_of(a) + weight_of(b), 1e-37); // photons without flux are none
    vec2 apart = b.mean - a.mean;
    vec3 between = vec3(apart * apart, apart.x * apart.y);
    vec3 spread = mix(a.spread, b.spread, share) + share * (1.0 - share) * between;
    vec4 bounds = vec4(min(a.bounds.xy, b.bounds.xy), max(a.bounds.zw, b.bounds.zw));
    return Cluster(a.flux + b.flux, a.place == b.place ? a.place : SEVERAL, a.mean + share * apart, spread, bounds);
}

// Whether one splat stands for all: none lies further from another, along rows or columns, than a share of the standard
// deviation of the splats (a quarter of their diameter), which are of one texel each if they are no wider.
bool is_one_splat(float place, vec4 bounds, float diameter, float share) {
    if (place < 1.0) return false;
    if (diameter <= 1.0) return floor(bounds.xy) == floor(bounds.zw);
    vec2 extent = bounds.zw - bounds.xy;
    return max(extent.x, extent.y) <= share * 0.25 * diameter;
}

#endif

// From a photon to its splat: where in which layer of the map, how large, and with which flux. All ways to gather share it.
#ifndef PHOTON_SPLAT_GLSL
#define PHOTON_SPLAT_GLSL

#include "maps/landing.glsl"
#include "shared/splat.glsl"

layout(push_constant, scalar) uniform Push {
    int side;        // texels of the map
    float diameter;  // texels: of fixed splats, and of varying ones without a neighbour
    float threshold; // texels: the diameter beyond which a splat goes to a smaller level
    uint light;
    uint view;       // of emission
} push;

struct Splat {
    vec3 flux;      // W, already divided by the sum of the weights
    float count;    // photons, divided by it too
    vec2 centre;    // texels of its level
    float diameter; // texels of its level
    vec2 shape;     // of a long one: its diameter along columns, and rows that its centre moves by a column
    int side;       // texels of its level
    int layer;      // of the image
};

// The side of the square that holds all of it, texels.
float reach_of(float diameter, vec2 shape) {
    return max(diameter, shape.x + abs(shape.y) * diameter);
}

const Splat NO_SPLAT = Splat(vec3(0.0), 0.0, vec2(0.0), 1.0, vec2(1.0, 0.0), 0, 0);

bool land(vec4 hit, float normal, out Landed l) {
    return landing_of(hit, normal, push.light, l);
}

#ifdef VARYING
const int LEVELS = 4; // of the paper: what is larger is dropped

// As printed (trunc), or as the text means (ceil: no splat larger than the threshold in any level).
int level_of(float diameter) {
    float octaves = log2(max(1.0, diameter / push.threshold));
#ifdef LEVEL_CEIL
    octaves = ceil(octaves);
#endif
    return int(min(octaves, 64.0));
}
#endif

// The splat of a flux (W) about where the photon landed, of a diameter in texels of the map. False if it is dropped.
bool splat_of(Landed l, vec3 flux, float diameter, out Splat s) {
    s = NO_SPLAT;
    float scale = 1.0;
    int layer = int(maps_views.data[l.map].layer);
#ifdef VARYING
    int level = level_of(diameter);
    if (level >= LEVELS) return false;
#ifdef MULTIRES
    scale = exp2(-float(level));
    layer = layer * LEVELS + level;
#endif
#endif
    float reach = scale * float(push.side); // of the level's corner of the layer
    int side = int(ceil(reach));
    vec2 p = vec2(splat_snap(l.xy01.x * reach), splat_snap(l.xy01.y * reach));
    p = min(p, vec2(float(side) - 1.0 / SPLAT_GRID)); // the centre stays inside: points are clipped by it
    float d = splat_diameter(scale * diameter);
    float norm = splat_norm(p.x, d, side) * splat_norm(p.y, d, side);
    if (!(norm > 0.0)) return false;
    s = Splat(flux / norm, 1.0 / norm, p, d, vec2(d, 0.0), side, layer);
    return true;
}

#endif

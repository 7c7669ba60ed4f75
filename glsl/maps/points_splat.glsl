// The splat of a point of a traversal: of a photon, or of a cluster at its level.
#ifndef POINTS_SPLAT_GLSL
#define POINTS_SPLAT_GLSL

#include "maps/varying.glsl"
#ifdef SHAPED
#include "maps/shape.glsl"
#endif

#ifndef EXACT
// A cluster of 4^i merged photons at level i stands for so many alike (Wyman 2008, section 3.2), also where some of them
// were invalid.
bool point_splat(ivec2 texel, int level, int layer, out Splat s) {
    vec4 flux = flux_of(texel, level, layer);
    Landed l;
    s = NO_SPLAT;
    if (!land(hit_of(texel, level, layer), flux.w, l)) return false;
    vec3 total = photon_flux(flux.rgb) * float(1 << (2 * level));
    return splat_of(l, total, splat_size(l, texel, level, layer), s);
}
#else
bool point_splat(ivec2 texel, int level, int layer, out Splat s, out Shape shape) {
    s = NO_SPLAT;
    shape = Shape(push.diameter, 0.0);
    if (level > 0) return shaped_splat_of(cluster_at(texel, level, layer), push.diameter, s, shape);
    vec4 flux = flux_at(texel, layer);
    Landed l;
    return land(hit_at(texel, layer), flux.w, l) && splat_of(l, photon_flux(flux.rgb), push.diameter, s);
}
#endif

#endif

// The splat of a point of a traversal: of a photon, or of a cluster at its level.
#ifndef POINTS_SPLAT_GLSL
#define POINTS_SPLAT_GLSL

#include "maps/varying.glsl"
#ifdef ELLIPTIC
#include "maps/elliptic.glsl"
#endif
#ifdef EXACT
#include "maps/shape.glsl"

// Of a cluster with exact books.
bool cluster_splat(ivec3 at, out Splat s) {
    vec4 flux = texelFetch(pyramid_flux, at, 0), mean = texelFetch(pyramid_mean, at, 0);
    int view = view_of_place(flux.a);
    if (push.diameter > 1.0) {
        vec3 spread = vec3(mean.zw, texelFetch(pyramid_lean, at, 0).r);
        if (shaped_splat_of(mean.xy, flux.rgb, view, spread, push.diameter, s)) return true;
    }
    Landed l = Landed(vec3(0.0), vec3(0.0), 0u, mean.xy / float(push.side), view);
    return splat_of(l, flux.rgb, push.diameter, s);
}
#endif

// False if no map takes it, or it is dropped. A cluster of 4^i merged photons at level i stands for so many alike (Wyman
// 2008, section 3.2), also where some of them were invalid.
bool point_splat(ivec2 texel, int level, int layer, out Splat s) {
    s = NO_SPLAT;
#ifdef EXACT
    if (level > 0) return cluster_splat(above(texel, level, layer), s);
#endif
    vec4 flux = flux_of(texel, level, layer);
    Landed l;
    if (!land(hit_of(texel, level, layer), flux.w, l)) return false;
    vec3 total = photon_flux(flux.rgb) * float(1 << (2 * level));
#ifdef ELLIPTIC
    if (elliptic_splat_of(l, total, texel, layer, s)) return true;
#endif
    return splat_of(l, total, splat_size(l, texel, level, layer), s);
}

#endif

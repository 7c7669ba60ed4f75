// A splat's texels, added to exact sums in fixed point.
#ifndef DEPOSIT_GLSL
#define DEPOSIT_GLSL

#include "maps/photon_splat.glsl"
#include "shared/flux_sums.glsl"

// The texels that a point of this size about p would cover: as `splat_norm` sums over them.
ivec2 covered(float p, float d, int side) {
    return ivec2(max(int(ceil(p - 0.5 * d - 0.5)), 0), min(int(ceil(p + 0.5 * d - 0.5)), side));
}

uint place_of(Splat s, int x, int y) {
    return uint((s.layer * push.side + y) * push.side + x);
}

void deposit(Splat s) {
    ivec2 columns = covered(s.centre.x, s.diameter, s.side);
#ifdef SHAPED
    for (int x = columns.x; x < columns.y; x++) {
        float beside = float(x) + 0.5 - s.centre.x, centre = s.centre.y + s.shape.y * beside;
        float across = splat_weight(beside, 0.0, s.diameter);
        ivec2 rows = covered(centre, s.shape.x, s.side);
        for (int y = rows.x; y < rows.y; y++) {
            add_flux(place_of(s, x, y), across * splat_weight(float(y) + 0.5, centre, s.shape.x) * s.flux);
        }
    }
#else
    ivec2 rows = covered(s.centre.y, s.diameter, s.side);
    for (int y = rows.x; y < rows.y; y++) {
        float across = splat_weight(float(y) + 0.5, s.centre.y, s.diameter);
        for (int x = columns.x; x < columns.y; x++) {
            vec3 share = across * splat_weight(float(x) + 0.5, s.centre.x, s.diameter) * s.flux;
            add_flux(place_of(s, x, y), share);
        }
    }
#endif
}

#endif

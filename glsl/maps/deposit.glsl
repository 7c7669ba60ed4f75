// A splat's texels, added to exact sums in fixed point.
#ifndef DEPOSIT_GLSL
#define DEPOSIT_GLSL

#include "maps/photon_splat.glsl"
#include "shared/flux_sums.glsl"
#ifdef SHAPED
#include "maps/shape.glsl"
#endif

// The texels that a point of this size about p would cover: as `splat_norm` sums over them.
ivec2 covered(float p, float d, int side) {
    return ivec2(max(int(ceil(p - 0.5 * d - 0.5)), 0), min(int(ceil(p + 0.5 * d - 0.5)), side));
}

uint place_of(Splat s, int x, int y) {
    return uint((s.layer * push.side + y) * push.side + x);
}

void deposit(Splat s) {
    ivec2 columns = covered(s.centre.x, s.diameter, s.side), rows = covered(s.centre.y, s.diameter, s.side);
    for (int y = rows.x; y < rows.y; y++) {
        float across = splat_weight(float(y) + 0.5, s.centre.y, s.diameter);
        for (int x = columns.x; x < columns.y; x++) {
            vec3 share = across * splat_weight(float(x) + 0.5, s.centre.x, s.diameter) * s.flux;
            add_flux(place_of(s, x, y), share);
        }
    }
}

#ifdef SHAPED
void deposit(Splat s, Shape shape) {
    ivec2 columns = covered(s.centre.x, s.diameter, s.side);
    for (int x = columns.x; x < columns.y; x++) {
        float beside = float(x) + 0.5 - s.centre.x, centre = s.centre.y + shape.lean * beside;
        float across = splat_weight(beside, 0.0, s.diameter);
        ivec2 rows = covered(centre, shape.rows, s.side);
        for (int y = rows.x; y < rows.y; y++) {
            add_flux(place_of(s, x, y), across * splat_weight(float(y) + 0.5, centre, shape.rows) * s.flux);
        }
    }
}
#endif

#endif

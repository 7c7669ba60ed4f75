// Slot `surface` of waves.variant = listing: the printed code as it stands (Listings 2-1 and 2-2), over the unit square that the
// water's rectangle is to it. The line starts at the floor's point, its way is (+dz/dx, +dz/dy, w) with w the screen's depth, and it
// meets the plane z = -0.8; 0.8 times that place, as it is, and not relative to the point, is where the light map is read, which repeats.
#include "waves/place.glsl"

const float PLANE = -0.8;
const float SCALE = 0.8;

vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    vec2 at;
    float above;
    if (!water_over(p, n, at, above)) return vec3(0.0);
    float w = screen_depth(p);
    if (!(w > 0.0)) return vec3(0.0);
    vec2 xy = 0.5 + 0.5 * at / water_frame().half_size;
    vec2 intercept = xy + water_gradient(at) * (PLANE / w);
    vec2 aside = fract(SCALE * intercept) - 0.5;
    // The map is as wide as its sun is, seen over the plane's distance.
    return waves.data.irradiance * sun_map(atan(length(aside), -PLANE * SCALE));
}

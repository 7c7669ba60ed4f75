// Slot `surface` of waves.variant = pixel: the wave's gradient at every point that is seen.
#include "waves/place.glsl"

vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    vec2 at;
    float above;
    if (!water_over(p, n, at, above)) return vec3(0.0);
    return sunlight(sun_below(seen_slope(water_gradient(at), p)), water_height(at) - above);
}

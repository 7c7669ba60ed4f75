// Slot `surface` of waves.variant = shortcut: no refraction. The wave's normal, extended from the floor to the water's height, leans
// by the slope times the depth; the sun map is looked up that far from its middle, so that deeper floors see a smaller sun.
#include "waves/place.glsl"

vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    vec2 at;
    float above;
    if (!water_over(p, n, at, above)) return vec3(0.0);
    float depth = water_height(at) - above;
    float aside = length(seen_slope(water_gradient(at), p)) * max(depth, 0.0);
    return sunlight(vec3(sun_map(atan(aside, waves.data.distance))), depth);
}

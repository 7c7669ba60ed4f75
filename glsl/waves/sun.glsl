// What the water's vertical ray brings down: the sun map, where that ray goes in the air (Guardado and Sanchez-Crespo, GPU Gems
// (2004), ch. 2). The sun stands along the water's normal, as in the paper, wherever the scene's is.
#ifndef WAVES_SUN_GLSL
#define WAVES_SUN_GLSL

#include "shared/water.glsl"

struct Waves {
    vec3 irradiance;  // of all suns, W/m^2 on a plane that faces them
    vec3 attenuation; // 1/m
    float inner;      // half width of the sun in the map, rad: within, all of it
    float outer;      // beyond, nothing
    float distance;   // with shortcut, how far away the map lies, m
};

layout(set = 0, binding = 35, scalar) readonly buffer WavesBlock { Waves data; } waves;

// No way into the air.
const float WAVES_DARK = 1e9;

// The sun map, 0 to 1: a disc with a smooth edge, by the angle (rad) from its middle.
float sun_map(float angle) {
    Waves w = waves.data;
    if (!(angle < w.outer)) return angle <= w.inner ? 1.0 : 0.0; // a sharp edge belongs to the disc
    if (angle <= w.inner) return 1.0;
    float t = (w.outer - angle) / (w.outer - w.inner);
    return t * t * (3.0 - 2.0 * t);
}

// From the vertical (rad), how far the ray leans in the air that went up through water of such a slope; Snell's law in
// reverse. WAVES_DARK past total reflection.
float lean(vec2 slope, float ior) {
    float steep = length(slope);
    float along = 1.0 / sqrt(1.0 + steep * steep), aside = steep * along; // cosine and sine of incidence
    float sine = ior * aside;
    if (!(sine < 1.0)) return WAVES_DARK;
    float turn = sqrt((1.0 - sine) * (1.0 + sine)) - ior * along; // along the normal
    return atan(abs(turn) * aside, ior + turn * along);
}

// The sun's share that comes down below water of such a slope, in each band.
vec3 sun_below(vec2 slope) {
#ifdef WAVES_BANDS
    vec3 ior = water_frame().ior;
    return vec3(sun_map(lean(slope, ior.r)), sun_map(lean(slope, ior.g)), sun_map(lean(slope, ior.b)));
#else
    return vec3(sun_map(lean(slope, water_frame().ior.r)));
#endif
}

// What of it arrives after so much water, W/m^2: nothing above the water.
vec3 sunlight(vec3 share, float depth) {
    if (!(depth >= 0.0)) return vec3(0.0);
    return waves.data.irradiance * share * exp(-waves.data.attenuation * depth);
}

#endif

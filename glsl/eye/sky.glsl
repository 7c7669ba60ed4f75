// The sky, as the eye sees it where nothing is. It lights nothing. SKY is the kind that the scene has (`scene/sky.rs`).
#ifndef SKY_GLSL
#define SKY_GLSL

#include "shared/transport.glsl"

#define SKY_GRADIENT 1
#define SKY_IMAGE 2

#if SKY == SKY_GRADIENT

struct SkyGradient {
    vec3 up; // unit, to the zenith
    vec3 zenith; // W/m^2/sr
    vec3 horizon;
    vec3 ground;
};

layout(set = 0, binding = 38, scalar) readonly buffer SkyBlock { SkyGradient data; } scene_sky;

// W/m^2/sr along unit d, by a smooth step in the sine of the elevation.
vec3 sky_radiance(vec3 d) {
    float s = clamp(dot(scene_sky.data.up, d), -1.0, 1.0);
    return mix(scene_sky.data.horizon, s < 0.0 ? scene_sky.data.ground : scene_sky.data.zenith, s * s * (3.0 - 2.0 * abs(s)));
}

#else

struct SkyImage {
    uvec2 size; // pixels
    vec3 right; // unit, a quarter of the picture right of its middle
    vec3 up;    // unit, to the zenith
    vec3 ahead; // unit, to the picture's middle
};

layout(set = 0, binding = 38, scalar) readonly buffer SkyBlock { SkyImage data; } scene_sky;
layout(set = 0, binding = 39, scalar) readonly buffer SkyTexels { vec3 data[]; } scene_sky_texels;

// A pixel up to one row or column beyond the picture: over a pole lies the column opposite, beyond a side the other side.
vec3 sky_pixel(ivec2 at, ivec2 size) {
    if (at.y < 0 || at.y >= size.y) at = ivec2(at.x + size.x / 2, clamp(at.y, 0, size.y - 1));
    return scene_sky_texels.data[at.y * size.x + (at.x + size.x) % size.x];
}

// W/m^2/sr along unit d: equirectangular, bilinear between the middles of pixels.
vec3 sky_radiance(vec3 d) {
    vec2 level = vec2(dot(scene_sky.data.right, d), dot(scene_sky.data.ahead, d));
    float across = dot(level, level) > 0.0 ? atan(level.x, level.y) / (2.0 * PI) : 0.0; // straight up has no azimuth
    float down = atan(length(level), dot(scene_sky.data.up, d)) / PI;
    ivec2 size = ivec2(scene_sky.data.size);
    vec2 pixel = vec2(0.5 + across, down) * vec2(size) - 0.5;
    ivec2 low = ivec2(floor(pixel));
    vec2 share = pixel - vec2(low);
    vec3 above = mix(sky_pixel(low, size), sky_pixel(low + ivec2(1, 0), size), share.x);
    vec3 below = mix(sky_pixel(low + ivec2(0, 1), size), sky_pixel(low + 1, size), share.x);
    return mix(above, below, share.y);
}

#endif

// The same from within a medium that a ray along d leaves the scene in: it has no end, so that nothing comes through what
// absorbs, and through what does not n^2 times as much, as L/n^2 is invariant. Of all bands.
vec3 sky_seen(vec3 d, uint medium) {
    vec3 radiance = sky_radiance(d);
    if (medium == MEDIUM_AIR) return radiance;
    vec3 n = scene_materials.data[medium].ior;
    return radiance * n * n * medium_transmits(medium, FAR);
}

#endif

// Slot `surface` as the caustic map provides it: irradiance at any world point.
#include "maps/views.glsl"

layout(set = 0, binding = 12) uniform sampler2DArray maps_map; // W a texel
#ifdef NARROWEST
layout(set = 0, binding = 16) uniform sampler2DArray maps_map_1; // in alpha, photons a texel
layout(set = 0, binding = 17) uniform sampler2DArray maps_map_2;
layout(set = 0, binding = 18) uniform sampler2DArray maps_map_3;
#endif

// Beyond the border as at the border: the outer half of a border texel holds no less light than the inner.
vec4 map_texel(sampler2DArray map, ivec3 at, ivec2 size) {
    return texelFetch(map, ivec3(clamp(at.xy, ivec2(0), size - 1), at.z), 0);
}

// Bilinear, in full precision (samplers keep 8 bits of the fraction). The integral over the map is its sum.
vec4 map_flux(sampler2DArray map, vec2 at01, int layer, vec2 reach) {
    ivec2 size = ivec2(ceil(reach));
    vec2 at = at01 * reach - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 f = at - vec2(low);
    vec4 top = mix(map_texel(map, ivec3(low, layer), size), map_texel(map, ivec3(low + ivec2(1, 0), layer), size), f.x);
    vec4 bottom = mix(map_texel(map, ivec3(low + ivec2(0, 1), layer), size),
                      map_texel(map, ivec3(low + ivec2(1, 1), layer), size), f.x);
    return mix(top, bottom, f.y);
}

// W a texel of the whole map.
vec3 texel_flux(vec2 xy01, int map, ivec2 size) {
#if defined(LEVELS)
    // A texel of level i covers 4^i of them (Wyman 2008, equation 3).
    vec3 sum = vec3(0.0);
    for (int level = 0; level < LEVELS; level++) {
        float scale = exp2(-float(level));
        sum += scale * scale * map_flux(maps_map, xy01, map * LEVELS + level, scale * vec2(size)).rgb;
    }
    return sum;
#elif defined(NARROWEST)
    // Our reading of Wyman and Dachsbacher 2007: of splats of four diameters, each twice the one before, those between whose
    // windows some dozen photons fall, as many as the paper says hide their noise; counted where splats are widest.
    const float DOZEN = 12.0;
    vec4 widest = map_flux(maps_map_3, xy01, map, vec2(size));
    float wanted = sqrt(DOZEN / (0.78539816 * max(widest.a, 1e-6))); // pi/4 D^2 times photons a texel
    float at = clamp(log2(wanted / NARROWEST), 0.0, 3.0);
    vec3 low, high;
    if (at < 1.0) {
        low = map_flux(maps_map, xy01, map, vec2(size)).rgb;
        high = map_flux(maps_map_1, xy01, map, vec2(size)).rgb;
    } else if (at < 2.0) {
        low = map_flux(maps_map_1, xy01, map, vec2(size)).rgb;
        high = map_flux(maps_map_2, xy01, map, vec2(size)).rgb;
    } else {
        low = map_flux(maps_map_2, xy01, map, vec2(size)).rgb;
        high = widest.rgb;
    }
    return mix(low, high, at - min(floor(at), 2.0));
#else
    return map_flux(maps_map, xy01, map, vec2(size)).rgb;
#endif
}

// Irradiance (W/m^2) at p on the side of unit geometric normal n: flux over the texel's footprint on the receiver, of all views
// that hold a share of it.
vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    ivec2 size = textureSize(maps_map, 0).xy;
    vec3 sum = vec3(0.0);
    for (int k = 0; k < maps_views.data.length(); k++) {
        if (!map_is_of(k, receiver, ANY)) continue;
        MapView map = maps_views.data[k];
        vec2 xy01;
        if (!(map_share(map, p, n, xy01) > 0.0)) continue;
        // What lands outside is counted as outside, and not in the map.
        if (any(lessThan(xy01, map.low)) || any(greaterThan(xy01, map.high))) continue;
        sum += texel_flux(xy01, int(map.layer), size) / view_texel_area(map.view, size, xy01, p, n);
    }
    return sum;
}

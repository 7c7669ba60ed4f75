// Light samples over an emission view: one a texel, at its centre, or anywhere.
#ifndef SAMPLE_GLSL
#define SAMPLE_GLSL

#include "shared/photon.glsl"
#include "shared/scene.glsl"
#include "shared/view.glsl"

layout(set = 0, binding = 7, scalar) readonly buffer LightViews { View data[]; } light_views;

layout(push_constant, scalar) uniform Push {
    ivec2 size; // samples of the photon image that lie in the view: of a tile at its end fewer than the image has
    uint light;
    uint view;
    ivec2 first; // the view's sample that is the image's first
    int whole;   // samples a side of the view
#ifdef PUSH_MORE
    PUSH_MORE
#endif
} push;

LightSample light_sample_at(vec2 xy01, float footprint) {
    Light light = scene_lights.data[push.light];
    LightSample s;
    view_ray(light_views.data[push.view], xy01, s.origin, s.direction);
    s.footprint = footprint;
    s.flux = light.power * (light_share(light, s.direction) * s.footprint);
    s.media = light.media;
    return s;
}

// Where a place of the image, in texels that are each cut into so many a side, lies in the view.
vec2 place_in_view(vec2 at, int finer) {
    return (vec2(finer * push.first) + at) / float(finer * push.whole);
}

// Of a texel of the image, each cut into so many a side. The same of a view and of its tiles, bit by bit.
LightSample light_sample(ivec2 texel, int finer) {
    View v = light_views.data[push.view];
    ivec2 size = ivec2(finer * push.whole), at = finer * push.first + texel;
    float footprint =
        v.perspective != 0u ? view_texel_solid_angle(v, size, at) : view_texel_cross_section(v, size);
    return light_sample_at((vec2(at) + 0.5) / vec2(size), footprint);
}

LightSample light_sample(ivec2 texel) {
    return light_sample(texel, 1);
}

// At a corner of such parts of texels, with the footprint of the part after it.
LightSample light_corner(ivec2 at, int finer) {
    float footprint = light_sample(min(at, finer * push.size - 1), finer).footprint;
    return light_sample_at(place_in_view(vec2(at), finer), footprint);
}

#ifdef BLOCK_LEVELS
// Of all slots from `low` on to before `high`, through their middle.
LightSample light_sample_of(ivec2 low, ivec2 high) {
    View v = light_views.data[push.view];
    vec2 whole = vec2(push.whole), from = vec2(push.first + low) / whole, to = vec2(push.first + high) / whole;
    ivec2 slots = high - low;
    float footprint = v.perspective != 0u ? view_solid_angle(v, from, to)
                                          : float(slots.x * slots.y) * view_texel_cross_section(v, ivec2(push.whole));
    return light_sample_at((vec2(2 * push.first + low + high)) / (2.0 * whole), footprint);
}
#endif

#endif

// Light samples over an emission view: one a texel, at its centre, or anywhere.
#ifndef SAMPLE_GLSL
#define SAMPLE_GLSL

#include "shared/photon.glsl"
#include "shared/scene.glsl"
#include "shared/view.glsl"

layout(set = 0, binding = 7, scalar) readonly buffer LightViews { View data[]; } light_views;

layout(push_constant, scalar) uniform Push {
    ivec2 size; // texels of the view
    uint light;
    uint view;
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

// Of a texel, where the view has so many.
LightSample light_sample(ivec2 texel, ivec2 size) {
    View v = light_views.data[push.view];
    float footprint =
        v.perspective != 0u ? view_texel_solid_angle(v, size, texel) : view_texel_cross_section(v, size);
    return light_sample_at((vec2(texel) + 0.5) / vec2(size), footprint);
}

LightSample light_sample(ivec2 texel) {
    return light_sample(texel, push.size);
}

#endif

// Light samples over an emission view: one a texel, at its centre.
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
} push;

LightSample light_sample(ivec2 texel) {
    View v = light_views.data[push.view];
    Light light = scene_lights.data[push.light];
    LightSample s;
    view_ray(v, (vec2(texel) + 0.5) / vec2(push.size), s.origin, s.direction);
    s.footprint = v.perspective != 0u ? view_texel_solid_angle(v, push.size, texel)
                                      : view_texel_cross_section(v, push.size);
    s.flux = light.power * (light_share(light, s.direction) * s.footprint);
    s.media = light.media;
    return s;
}

#endif

// Direct light at a surface, on the side the eye sees; specular objects cast full shadows.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL

#include "shared/interface.glsl"
#include "shared/transport.glsl"

#ifdef AREA_SAMPLES
int eye_sample, eye_samples; // of a pixel: each asks other points of the lights that have a size
#endif

// Irradiance (W/m^2) of one light without size at s, where the geometric normal on the eye's side is `normal`.
vec3 irradiance_by(Light light, Surface s, vec3 normal) {
    vec3 towards = -light.vector;
    float reach = FAR;
    vec3 facing = light.power; // irradiance of a plane that faces the light
    if (light.kind != LIGHT_DIRECTIONAL) {
        vec3 way = light.vector - s.p;
        towards = safe_normalize(way, vec3(0.0));
        reach = dot(way, towards);
        if (!(reach > 0.0)) return vec3(0.0); // the light is at the point: it has no direction
        facing = light.power * light_share(light, -towards);
        facing *= medium_transmits(innermost(light.media), reach) / max(reach * reach, 1e-30);
    }
    float cosine = dot(normal, towards);
    if (!(cosine > 0.0)) return vec3(0.0);
    vec3 o = leave(s, towards);
    if (light.kind != LIGHT_DIRECTIONAL) reach = max(dot(light.vector - o, towards), 0.0);
    return occluded(o, towards, reach, MASK_ALL) ? vec3(0.0) : facing * cosine;
}

// Irradiance of all lights at s, seen along d: flux over area, so the cosine is the geometric normal's.
// (Interpolated normals bend rays; to shade with them would make direct light and caustic disagree.)
vec3 direct_irradiance(Surface s, vec3 d) {
    vec3 normal = facing_normal(s, d);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < LIGHT_COUNT; k++) sum += irradiance_by(scene_lights.data[k], s, normal);
#ifdef AREA_SAMPLES
    // Points of all lights that have a size, one in so many of theirs: a pixel asks them all.
    vec3 by_points = vec3(0.0);
    for (int k = 0; k < AREA_SAMPLES; k++) {
        by_points += irradiance_by(scene_lights.data[AREA_FIRST + k * eye_samples + eye_sample], s, normal);
    }
    sum += by_points * float(eye_samples);
#endif
    return sum;
}

#endif

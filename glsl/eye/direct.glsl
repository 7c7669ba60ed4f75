// Direct light at a surface, on the side the eye sees; specular objects cast full shadows.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL

#include "shared/interface.glsl"
#include "shared/transport.glsl"

// Irradiance (W/m^2) of all lights at s, seen along d: flux over area, so the cosine is the geometric normal's.
// (Interpolated normals bend rays; to shade with them would make direct light and caustic disagree.)
vec3 direct_irradiance(Surface s, vec3 d) {
    vec3 geometric = facing_normal(s, d);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < LIGHT_COUNT; k++) {
        Light light = scene_lights.data[k];
        vec3 towards = -light.vector;
        float reach = FAR;
        vec3 facing = light.power; // irradiance of a plane that faces the light
        if (light.kind == LIGHT_POINT) {
            vec3 way = light.vector - s.p;
            towards = safe_normalize(way, vec3(0.0));
            reach = dot(way, towards);
            if (!(reach > 0.0)) continue; // the light is at the point: it has no direction
            facing = light.power * light_share(light, -towards);
            facing *= medium_transmits(innermost(light.media), reach) / max(reach * reach, 1e-30);
        }
        float cosine = dot(geometric, towards);
        if (!(cosine > 0.0)) continue;
        vec3 o = leave(s, towards);
        if (light.kind == LIGHT_POINT) reach = max(dot(light.vector - o, towards), 0.0);
        if (occluded(o, towards, reach, MASK_ALL)) continue;
        sum += facing * cosine;
    }
    return sum;
}

#endif

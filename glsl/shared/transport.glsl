// Light on its way: through which medium, and how much of it is left.
#ifndef TRANSPORT_GLSL
#define TRANSPORT_GLSL

#include "shared/optics.glsl"
#include "shared/scene.glsl"

const float PI = 3.14159265358979;
const float FAR = 3.0e38;            // m, beyond everything
const uint MEDIUM_AIR = 0xffffffffu; // a medium is named by its material; air has none

// What a medium lets pass on a way.
vec3 medium_transmits(uint medium, float metres) {
    return medium == MEDIUM_AIR ? vec3(1.0) : absorb(scene_materials.data[medium].absorption, metres);
}

#endif

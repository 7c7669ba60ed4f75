// Push constants of the stages that fill grids over the water's rectangle.
#ifndef WAVES_GRID_GLSL
#define WAVES_GRID_GLSL

#include "waves/sun.glsl"

layout(push_constant, scalar) uniform Push {
    int side;  // cells along u and v, or texels
    int level; // of the texture
} push;

// Of the rectangle: 0 to 1.
vec2 water_place(vec2 share) {
    return (2.0 * share - 1.0) * water_frame().half_size;
}

#endif

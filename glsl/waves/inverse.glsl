// waves.variant = inverse: what its stages share. Rays of each light go on below the water from the corners of a grid of cells;
// between corners they are linear on two triangles a cell, as meshes and their normals are.
//
// The host defines ACROSS x ALONG cells, LIGHTS, LEVELS of bounds above the cells (cells are level 0, the last is one) and
// OFFSETS, where each begins; INVERSE_BANDS where bands are bent apart, DISCS where a sun has a width.
#ifndef WAVES_INVERSE_GLSL
#define WAVES_INVERSE_GLSL

#include "shared/scene.glsl"
#include "shared/water.glsl"

#ifndef INVERSE_BANDS
#define INVERSE_BANDS 1
#endif

// Along u, v and n from the water's centre; m.
struct WaterRay {
    vec3 start;
    vec3 passes; // share of the flux that goes on below, of each band; below zero where nothing can
    vec2 slope[INVERSE_BANDS]; // what it goes along u and v for each metre down
#ifdef DISCS
    vec4 spread[INVERSE_BANDS]; // change of the slope by the sun's direction, rad, along the axes of its disc
#endif
};

// Where rays of a light below some cells are at the least and at the greatest depth of all receivers; xy: least, zw: greatest.
// Rays are straight: between the two they lie within what is between.
struct WaterBounds {
    vec4 near;
    vec4 far;
};

struct WaterLight {
    Light light;
    float radius; // of a sun's disc, rad; 0: none
    vec3 x; // axes of the disc
    vec3 y;
    vec2 depths; // of all receivers below the plane, m
    vec3 attenuation; // by the water, 1/m
};

layout(set = 0, binding = 35, scalar) INVERSE_RAYS buffer WaterRays { WaterRay at[]; } water_rays;
layout(set = 0, binding = 37, scalar) readonly buffer WaterLights { WaterLight at[]; } water_lights;

const uint BOUNDS_OFFSETS[LEVELS] = uint[](OFFSETS);

ivec2 level_size(int level) {
    return (ivec2(ACROSS, ALONG) + (1 << level) - 1) >> level;
}

uint ray_at(uint light, ivec2 corner) {
    return (light * (ALONG + 1u) + uint(corner.y)) * (ACROSS + 1u) + uint(corner.x);
}

uint bounds_at(uint light, int level, ivec2 at) {
    return light * BOUNDS_ALL + BOUNDS_OFFSETS[level] + uint(at.y * level_size(level).x + at.x);
}

// By the slopes of the disc's rim.
vec2 slope_reach(WaterRay ray, int band, float radius) {
#ifdef DISCS
    vec4 s = ray.spread[band];
    return radius * vec2(length(s.xz), length(s.yw));
#else
    return vec2(0.0);
#endif
}

#endif

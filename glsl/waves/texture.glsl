// Slot `surface` of waves.variant = texture: the target of fixed resolution, looked up as hardware does (linear between texels and
// levels, along the longer axis of the pixel's footprint in as many probes as it is longer), in full precision.
#include "eye/gbuffer.glsl"
#include "waves/atlas.glsl"
#include "waves/place.glsl"

layout(set = 0, binding = 36) uniform sampler2D waves_texture;

vec4 texel(ivec2 at, int level) {
    int last = level_side(WAVES_SIDE, level) - 1;
    return texelFetch(waves_texture, level_place(WAVES_SIDE, level, clamp(at, ivec2(0), ivec2(last))), 0);
}

#ifdef WAVES_CUBIC
// Of Catmull and Rom: exact where what is between texels is a parabola. Straight lines between them leave copies of the picture's
// spectrum along the axes, a cross about every bright spot; these have a 45th of its power.
vec4 cubic(float f) {
    float a = 1.0 - f;
    return 0.5 * vec4(-f * a * a, 2.0 - f * f * (5.0 - 3.0 * f), 2.0 - a * a * (5.0 - 3.0 * a), -a * f * f);
}

vec4 in_level(vec2 share, int level) {
    vec2 at = share * float(level_side(WAVES_SIDE, level)) - 0.5;
    ivec2 low = ivec2(floor(at)) - 1;
    vec4 x = cubic(fract(at.x)), y = cubic(fract(at.y)), sum = vec4(0.0);
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 4; column++) {
            sum += x[column] * y[row] * texel(low + ivec2(column, row), level);
        }
    }
    return vec4(max(sum.rgb, 0.0), sum.a); // it swings below zero beside what is bright
}
#else
vec4 in_level(vec2 share, int level) {
    vec2 at = share * float(level_side(WAVES_SIDE, level)) - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 f = at - vec2(low);
    vec4 top = mix(texel(low, level), texel(low + ivec2(1, 0), level), f.x);
    vec4 bottom = mix(texel(low + ivec2(0, 1), level), texel(low + ivec2(1, 1), level), f.x);
    return mix(top, bottom, f.y);
}
#endif

vec4 between_levels(vec2 share, float lod) {
    int level = int(lod);
    vec4 fine = in_level(share, level);
    return lod > float(level) ? mix(fine, in_level(share, level + 1), lod - float(level)) : fine;
}

// Along one axis of the screen, how far the next sample of the eye lies in the texture, texels. What is seen in a mirror or
// through water is taken as if it were seen straight; nothing where that has no answer.
vec2 stride(vec3 p, vec3 n, vec2 xy01) {
    vec3 o, d;
    view_ray(frame.data.eye, xy01, o, d);
    float towards = dot(n, d);
    float t = dot(n, p - o) / towards;
    if (!(abs(towards) > 1e-6 && abs(t) < 1e9)) return vec2(0.0);
    Water w = water_frame();
    vec3 q = o + t * d - p;
    return 0.5 * vec2(dot(q, w.u), dot(q, w.v)) / w.half_size * float(WAVES_SIDE);
}

vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    vec2 at, xy01;
    float above;
    if (!water_over(p, n, at, above)) return vec3(0.0);
    vec2 share = 0.5 + 0.5 * at / water_frame().half_size, along = vec2(0.0), across = vec2(0.0);
    if (view_project(frame.data.eye, p, xy01)) {
        vec2 step = 1.0 / vec2(push.size * push.samples);
        along = stride(p, n, xy01 + vec2(step.x, 0.0));
        across = stride(p, n, xy01 + vec2(0.0, step.y));
    }
    if (dot(across, across) > dot(along, along)) {
        vec2 shorter = along;
        along = across;
        across = shorter;
    }
    float longest = min(length(along), float(WAVES_SIDE)), shortest = length(across);
    const float SLACK = 0.01; // a footprint that is round but for rounding takes one probe
    float probes = clamp(ceil(longest / max(shortest, 1e-3) - SLACK), 1.0, float(WAVES_ANISOTROPY));
    float lod = clamp(log2(max(longest / probes, 1.0)), 0.0, float(WAVES_LEVELS - 1));
    vec4 sum = vec4(0.0);
    for (float k = 0.5; k < probes; k++) {
        sum += between_levels(share + (k / probes - 0.5) * along / float(WAVES_SIDE), lod);
    }
    sum /= probes;
    return sunlight(sum.rgb, sum.a - above);
}

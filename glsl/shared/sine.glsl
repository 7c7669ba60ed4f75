// Rays against z = sin(wave x + phase) over [-1, 1]^2, in object space, with the conventions of `intersect.glsl`. Float32 twin of the
// Rust room `scene/sine`: between the places where a ray's height over the sheet turns, which are known, lies one crossing
// at most, so that none is stepped over.
#ifndef SINE_GLSL
#define SINE_GLSL

#include "shared/intersect.glsl"

const float SINE_TURN = 6.2831853;

// wave.x x + wave.y is the angle.
float sine_height(vec3 o, vec3 d, vec2 wave, float t) {
    return o.z + t * d.z - sin(wave.x * (o.x + t * d.x) + wave.y);
}

// The root between two places of unlike sign: Newton's steps, halves where they leave the interval.
float sine_root(vec3 o, vec3 d, vec2 wave, float low, float high) {
    bool below = sine_height(o, d, wave, low) < 0.0;
    float t = 0.5 * (low + high);
    for (int k = 0; k < 32; k++) {
        float height = sine_height(o, d, wave, t);
        if ((height < 0.0) == below) low = t; else high = t;
        float slope = d.z - wave.x * d.x * cos(wave.x * (o.x + t * d.x) + wave.y);
        float newton = t - height / slope;
        float next = newton > low && newton < high ? newton : 0.5 * (low + high);
        if (next == t) break;
        t = next;
    }
    return t;
}

// uv: x and y. t counts from where the ray enters the sheet's box: heights there are of order one.
float hit_sine(LocalRay ray, vec2 wave, float t_max, out vec2 uv) {
    const float ROOM = 9.5367432e-7; // crests touch the box: 16 roundings of the way to it, and of the sheet's own
    uv = vec2(0.0);
    vec3 around = vec3(1.0, 1.0, 1.0 + ROOM * (8.0 + dot(abs(ray.o), vec3(1.0))));
    vec3 t1 = (-around - ray.o) * ray.inverse;
    vec3 t2 = (around - ray.o) * ray.inverse;
    vec3 first = min(t1, t2), last = max(t1, t2);
    float start = max(max(first.x, max(first.y, first.z)), 0.0);
    float leave = min(min(last.x, min(last.y, last.z)), t_max) - start;
    if (!(leave > 0.0)) return NO_HIT;
    vec3 o = ray.o + start * ray.d, d = ray.d;
    float pace = wave.x * abs(d.x);
    float phase = (wave.x * o.x + wave.y) * (d.x < 0.0 ? -1.0 : 1.0);
    // A ray steeper than the sheet never turns.
    bool turns = abs(d.z) < pace;
    float angle = turns ? atan(sqrt(max(pace * pace - d.z * d.z, 0.0)), d.x < 0.0 ? -d.z : d.z) : 0.0;
    float cycle = floor((phase + angle) / SINE_TURN);
    bool rising = false; // the first turn of a cycle has been passed
    float from = 0.0;
    bool below = sine_height(o, d, wave, 0.0) < 0.0;
    while (from < leave) {
        float to = leave;
        if (turns) {
            float turn = (SINE_TURN * cycle + (rising ? angle : -angle) - phase) / pace;
            if (rising) cycle += 1.0;
            rising = !rising;
            if (turn <= from) continue;
            to = min(turn, leave);
        }
        bool under = sine_height(o, d, wave, to) < 0.0;
        if (under != below) {
            float t = sine_root(o, d, wave, from, to);
            uv = clamp(o.xy + t * d.xy, -1.0, 1.0);
            t += start;
            return t > 0.0 && t < t_max ? t : NO_HIT;
        }
        if (to >= leave) break;
        from = to;
        below = under;
    }
    return NO_HIT;
}

#endif

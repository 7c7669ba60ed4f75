// Where a ray lands on what the image of the receivers shows: marched texel by texel, bisected, then taken on the tangent
// plane of the texel found, which is exact on flat receivers. A ray that leaves the image has left the scene.
//
// One layer of depth knows nothing of what lies behind it: a ray that goes in behind an edge goes on until it comes out
// again.
#ifndef LANDING_GLSL
#define LANDING_GLSL

#include "light/image_views.glsl"
#include "shared/surface.glsl"

layout(set = 0, binding = 18) uniform usampler2D light_receivers; // as the eye's G-buffer
layout(set = 0, binding = 19) uniform sampler2D light_receivers_depth;

const int HALVINGS = 12;     // of a step: a four-thousandth of a texel
const float OFF_TEXEL = 1.5; // texels that the tangent plane of one may carry a landing away from it
const float OUTLINE = 1e-5;  // of a receiver: rounding of a place on it

struct Landing {
    View view;
    ivec2 size;
    vec3 o;
    vec3 d;
};

float depth_shown(ivec2 texel) {
    return texelFetch(light_receivers_depth, texel, 0).r;
}

// The texel beneath the ray; where it shows nothing, one of the other three about the place that does: the edge of a
// receiver may lie up to half a texel beyond the last centre that is on it.
ivec2 receiver_texel(Landing ray, float t) {
    vec2 xy01;
    view_project(ray.view, ray.o + t * ray.d, xy01);
    vec2 at = xy01 * vec2(ray.size);
    ivec2 most = ray.size - 1;
    ivec2 texel = clamp(ivec2(floor(at)), ivec2(0), most);
    if (depth_shown(texel) < 1.0) return texel;
    ivec2 other = clamp(texel + ivec2(mix(vec2(-1.0), vec2(1.0), greaterThan(at - vec2(texel), vec2(0.5)))), ivec2(0), most);
    if (depth_shown(ivec2(other.x, texel.y)) < 1.0) return ivec2(other.x, texel.y);
    if (depth_shown(ivec2(texel.x, other.y)) < 1.0) return ivec2(texel.x, other.y);
    return depth_shown(other) < 1.0 ? other : texel;
}

// Whether the ray is behind what the image shows beneath it: between four texels of one receiver bilinear, since a ray
// that is nearly parallel to it would cross a staircase texels away; else the ray's own texel. Most steps lie before all
// four texels, or behind them, and need no more.
bool is_behind(Landing ray, float t) {
    vec2 xy01;
    vec3 p = ray.o + t * ray.d;
    view_project(ray.view, p, xy01);
    float depth = (dot(p - ray.view.origin, ray.view.forward) - ray.view.near) / (ray.view.far - ray.view.near);
    vec2 at = clamp(xy01, 0.0, 1.0) * vec2(ray.size) - 0.5;
    ivec2 most = ray.size - 1;
    ivec2 low = ivec2(floor(at));
    ivec2 a = clamp(low, ivec2(0), most), d = clamp(low + 1, ivec2(0), most);
    ivec2 b = ivec2(d.x, a.y), c = ivec2(a.x, d.y);
    vec4 shown = vec4(depth_shown(a), depth_shown(b), depth_shown(c), depth_shown(d));
    if (depth < min(min(shown.x, shown.y), min(shown.z, shown.w))) return false;
    bool whole = all(lessThan(shown, vec4(1.0)));
    if (whole && depth >= max(max(shown.x, shown.y), max(shown.z, shown.w))) return true;
    uvec4 seen = uvec4(texelFetch(light_receivers, a, 0).x, texelFetch(light_receivers, b, 0).x,
                       texelFetch(light_receivers, c, 0).x, texelFetch(light_receivers, d, 0).x);
    if (whole && all(equal(seen, seen.xxxx))) {
        vec2 f = at - vec2(low);
        return depth >= mix(mix(shown.x, shown.y, f.x), mix(shown.z, shown.w, f.x), f.y);
    }
    float own = depth_shown(receiver_texel(ray, t));
    return own < 1.0 && depth >= own;
}

// Whether a place on a flat shape's plane is on the shape.
bool is_within_outline(uint instance, vec3 p) {
    Instance shape = scene_instances.data[instance];
    vec2 at = map_point(shape.to_object, p).xy;
    if (shape.kind == SHAPE_QUAD) return max(abs(at.x), abs(at.y)) <= 1.0 + OUTLINE;
    return shape.kind != SHAPE_DISK || dot(at, at) <= 1.0 + 2.0 * OUTLINE;
}

// The surface that a texel shows.
bool receiver_at(Landing ray, ivec2 texel, out Surface s) {
    uvec4 seen = texelFetch(light_receivers, texel, 0);
    s = Surface(vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0), 0u, 0u, 0.0);
    if (seen.x == 0u) return false;
    vec3 o, d;
    view_ray(ray.view, (vec2(texel) + 0.5) / vec2(ray.size), o, d);
    s = surface_seen(seen, o, d);
    return true;
}

// The landing near t on the tangent plane of the texel there, taken twice, since the plane may carry it to the next.
bool land_near(Landing ray, float t, out Surface s, out float way) {
    const int TIMES = 2;
    way = t;
    ivec2 texel;
    for (int k = 0; k < TIMES; k++) {
        texel = receiver_texel(ray, way);
        if (!receiver_at(ray, texel, s)) return false;
        float along = dot(ray.d, s.ng);
        if (along == 0.0) return false;
        way = dot(s.p - ray.o, s.ng) / along;
        vec2 xy01;
        if (!view_project(ray.view, ray.o + way * ray.d, xy01)) return false;
        vec2 off = abs(xy01 * vec2(ray.size) - (vec2(texel) + 0.5));
        if (!(max(off.x, off.y) <= OFF_TEXEL)) return false;
    }
    // Off the receiver's own roundings a ray may start a little behind it.
    if (!(way >= -max(s.eps, 1e-5 * abs(t)))) return false;
    way = max(way, 0.0);
    s.p = ray.o + way * ray.d;
    return is_within_outline(texelFetch(light_receivers, texel, 0).x - 1u, s.p);
}

bool land(vec3 o, vec3 d, out Surface s, out float way) {
    Landing ray = Landing(receiving_view(), textureSize(light_receivers, 0), o, d);
    s = Surface(vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0), 0u, 0u, 0.0);
    way = 0.0;
    vec2 ends = within_view(ray.view, o, d);
    if (!(ends.x < ends.y)) return false;
    vec2 first, last;
    view_project(ray.view, o + ends.x * d, first);
    view_project(ray.view, o + ends.y * d, last);
    vec2 texels = abs(last - first) * vec2(ray.size);
    int steps = int(clamp(ceil(max(texels.x, texels.y)), 1.0, float(2 * max(ray.size.x, ray.size.y))));
    // Even steps in the image are even in t only where rays of the view are parallel.
    bool cone = ray.view.perspective != 0u;
    float w0 = cone ? dot(o + ends.x * d - ray.view.origin, ray.view.forward) : 1.0;
    float w1 = cone ? dot(o + ends.y * d - ray.view.origin, ray.view.forward) : 1.0;
    float low = ends.x;
    bool now_behind = is_behind(ray, low);
    if (now_behind && land_near(ray, low, s, way)) return true; // it starts on the receiver
    for (int k = 1; k <= steps; k++) {
        float share = float(k) / float(steps);
        float high = mix(ends.x, ends.y, share * w0 / mix(w1, w0, share));
        bool was_behind = now_behind;
        now_behind = is_behind(ray, high);
        if (now_behind && !was_behind) {
            float a = low, b = high;
            for (int n = 0; n < HALVINGS; n++) {
                float middle = 0.5 * (a + b);
                if (is_behind(ray, middle)) b = middle; else a = middle;
            }
            if (land_near(ray, b, s, way)) return true;
        }
        low = high;
    }
    return false;
}

#endif

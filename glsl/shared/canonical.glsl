// Rays against the analytic shapes with edges or a rim, in object space, with the conventions of `intersect.glsl`.
// Float32 twin of the Rust room `scene/canonical`. A hit also says where it is, so that the surface is made from that
// place and not from the ray: its error does not grow with the ray's length.
#ifndef CANONICAL_GLSL
#define CANONICAL_GLSL

#include "shared/intersect.glsl"

// [-1, 1]^3: one interval along the ray, so that none passes between two faces. face: twice its axis, and one on the
// lower side; uv: the two coordinates after the axis.
float hit_box(LocalRay ray, float t_max, out uint face, out vec2 uv) {
    face = 0u;
    uv = vec2(0.0);
    vec3 t1 = (vec3(-1.0) - ray.o) * ray.inverse;
    vec3 t2 = (vec3(1.0) - ray.o) * ray.inverse;
    vec3 first = min(t1, t2), last = max(t1, t2);
    float enter = max(first.x, max(first.y, first.z));
    float leave = min(last.x, min(last.y, last.z));
    bool outside = enter > 0.0;
    float t = outside ? enter : leave;
    if (!(enter <= leave && t > 0.0 && t < t_max)) return NO_HIT;
    vec3 sides = outside ? first : last;
    uint axis = sides.x == t ? 0u : sides.y == t ? 1u : 2u;
    float along = axis == 0u ? ray.inverse.x : axis == 1u ? ray.inverse.y : ray.inverse.z;
    face = 2u * axis + ((along > 0.0) == outside ? 1u : 0u);
    vec3 at = ray.o + t * ray.d;
    uv = clamp(axis == 0u ? at.yz : axis == 1u ? at.zx : at.xy, -1.0, 1.0);
    return t;
}

vec3 box_place(uint face, vec2 uv) {
    float side = (face & 1u) == 0u ? 1.0 : -1.0;
    uint axis = face >> 1;
    return axis == 0u ? vec3(side, uv) : axis == 1u ? vec3(uv.y, side, uv.x) : vec3(uv, side);
}

vec3 box_normal(uint face) {
    return box_place(face, vec2(0.0));
}

// The unit disk in the xy-plane; uv: x and y.
float hit_disk(LocalRay ray, float t_max, out vec2 uv) {
    uv = vec2(0.0);
    if (ray.d.z == 0.0) return NO_HIT;
    float t = -ray.o.z / ray.d.z;
    vec2 at = ray.o.xy + t * ray.d.xy;
    if (!(t > 0.0 && t < t_max && dot(at, at) <= 1.0)) return NO_HIT;
    uv = at;
    return t;
}

// The nearer of two crossings at 0 < t < t_max that lies on the part that is there: x >= cut, and the height from 0 to 1.
// A bowl's height is that of its equation: at the vertex a rounded z would leave a hole.
float nearer_part(LocalRay ray, vec2 crossings, bool bowl, float cut, float t_max, out vec3 at) {
    float near = min(crossings.x, crossings.y), far = max(crossings.x, crossings.y);
    for (int k = 0; k < 2; k++) {
        float t = k == 0 ? near : far;
        at = ray.o + t * ray.d;
        float height = bowl ? dot(at.xy, at.xy) : at.z;
        if (t > 0.0 && t < t_max && height >= 0.0 && height <= 1.0 && at.x >= cut) return t;
    }
    return NO_HIT;
}

// The open tube x^2 + y^2 = 1 from z = 0 to 1, where x >= cut. quarter: which of x and y is the larger, and its sign;
// uv: the smaller one, and z. The roots are those of `hit_sphere` across the axis; a ray along it meets nothing.
float hit_cylinder(LocalRay ray, float cut, float t_max, out uint quarter, out vec2 uv) {
    quarter = 0u;
    uv = vec2(0.0);
    vec2 o = ray.o.xy, d = ray.d.xy;
    float a = dot(d, d);
    float b = -dot(o, d);
    if (!(a > 0.0)) return NO_HIT;
    vec2 nearest = o + (b / a) * d;
    float discriminant = 1.0 - dot(nearest, nearest);
    if (!(discriminant >= 0.0)) return NO_HIT;
    float root = sqrt(a * discriminant);
    float q = b + (b < 0.0 ? -root : root);
    float other = q != 0.0 ? (dot(o, o) - 1.0) / q : q / a;
    vec3 at;
    float t = nearer_part(ray, vec2(q / a, other), false, cut, t_max, at);
    if (!(t < NO_HIT)) return NO_HIT;
    vec2 on = at.xy / sqrt(dot(at.xy, at.xy));
    bool steep = abs(on.y) > abs(on.x);
    float larger = steep ? on.y : on.x;
    quarter = (steep ? 2u : 0u) + (larger < 0.0 ? 1u : 0u);
    uv = vec2(steep ? on.x : on.y, at.z);
    return t;
}

// Of a place that `hit_cylinder` names; unit.
vec3 cylinder_normal(uint quarter, float smaller) {
    float larger = sqrt(max(1.0 - smaller * smaller, 0.0)) * ((quarter & 1u) == 0u ? 1.0 : -1.0);
    return quarter < 2u ? vec3(larger, smaller, 0.0) : vec3(smaller, larger, 0.0);
}

// The bowl z = x^2 + y^2 up to 1, where x >= cut; uv: x and y.
// Roots of a t^2 + 2 h t + c by the sum that does not cancel, so that a = 0, a ray along the axis, is no case of its own.
// From afar c is a difference of squares of the distance: then t counts from the point nearest to the vertex. From
// nearby it must not, since the sign of c says on which side of the bowl the ray starts.
float hit_paraboloid(LocalRay ray, float cut, float t_max, out vec2 uv) {
    const float NEARBY = 4.0; // squared: beyond every point of the bowl, and of its rounding
    uv = vec2(0.0);
    float start = dot(ray.o, ray.o) > NEARBY ? -dot(ray.o, ray.d) / dot(ray.d, ray.d) : 0.0;
    vec3 o = ray.o + start * ray.d, d = ray.d;
    float a = dot(d.xy, d.xy);
    float h = dot(o.xy, d.xy) - 0.5 * d.z;
    float c = dot(o.xy, o.xy) - o.z;
    float discriminant = h * h - a * c;
    if (!(discriminant >= 0.0)) return NO_HIT;
    float root = sqrt(discriminant);
    float q = -(h + (h < 0.0 ? -root : root));
    if (q == 0.0) return NO_HIT; // a direction of no length, or a touch of the vertex's plane there
    vec3 at;
    float t = nearer_part(ray, start + vec2(q / a, c / q), true, cut, t_max, at);
    if (!(t < NO_HIT)) return NO_HIT;
    uv = at.xy;
    return t;
}

#endif

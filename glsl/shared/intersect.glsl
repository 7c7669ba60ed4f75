// Rays against boxes and the canonical shapes, in object space. A direction is not unit there: t counts in lengths
// of d, which the affine map keeps, so it stays metres of the world. A hit lies at 0 < t < t_max; NaN never hits.
#ifndef INTERSECT_GLSL
#define INTERSECT_GLSL

struct LocalRay {
    vec3 o, d;
    vec3 inverse;         // of d, guarded: boxes
    vec3 across_u, across_v, along; // the plane across the ray and the distance along it: triangles
};

// 1/x for slabs. A component that is nothing beside the others keeps a finite inverse (0 times it is 0, not NaN),
// so large that an origin one rounding step inside a slab stays inside for 10^10 lengths.
float slab_inverse(float x, float largest) {
    float least = largest * 8.6736174e-19; // 2^-60
    return abs(x) > least ? 1.0 / x : (x < 0.0 ? -1.0 : 1.0) / least;
}

// Shear that takes d to an axis. Based on: Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2(1),
// 2013.
// Differs: the axes are kept as vectors instead of permuted indices, and what lies on an edge hits both sides.
LocalRay local_ray(vec3 o, vec3 d) {
    LocalRay ray;
    ray.o = o;
    ray.d = d;
    vec3 size = abs(d);
    float largest = max(size.x, max(size.y, size.z));
    ray.inverse = vec3(slab_inverse(d.x, largest), slab_inverse(d.y, largest), slab_inverse(d.z, largest));
    if (size.z == largest) {
        ray.across_u = vec3(1.0, 0.0, -d.x / d.z);
        ray.across_v = vec3(0.0, 1.0, -d.y / d.z);
        ray.along = vec3(0.0, 0.0, 1.0 / d.z);
    } else if (size.y == largest) {
        ray.across_u = vec3(0.0, -d.z / d.y, 1.0);
        ray.across_v = vec3(1.0, -d.x / d.y, 0.0);
        ray.along = vec3(0.0, 1.0 / d.y, 0.0);
    } else {
        ray.across_u = vec3(-d.y / d.x, 1.0, 0.0);
        ray.across_v = vec3(-d.z / d.x, 0.0, 1.0);
        ray.along = vec3(1.0 / d.x, 0.0, 0.0);
    }
    return ray;
}

const float NO_HIT = 3.4028235e38;

// Where the ray enters the box (negative inside), NO_HIT if it passes by.
// The exit is put off by a few roundings (Ize, Robust BVH Ray Traversal, JCGT 2(2), 2013), so that no box is
// missed by one.
float enter_box(LocalRay ray, vec3 lo, vec3 hi) {
    vec3 t1 = (lo - ray.o) * ray.inverse;
    vec3 t2 = (hi - ray.o) * ray.inverse;
    vec3 first = min(t1, t2);
    vec3 last = max(t1, t2);
    float enter = max(first.x, max(first.y, first.z));
    float leave = min(last.x, min(last.y, last.z)) * 1.000001;
    return leave >= enter && leave >= 0.0 ? enter : NO_HIT;
}

// Unit sphere at the origin; the nearer of its crossings in (0, t_max), or NO_HIT.
// Based on: Haines et al., Precision Improvements for Ray/Sphere Intersection, Ray Tracing Gems ch. 7, 2019.
float hit_sphere(LocalRay ray, float t_max) {
    float a = dot(ray.d, ray.d);
    float b = -dot(ray.o, ray.d);
    vec3 nearest = ray.o + (b / a) * ray.d; // the ray's point nearest to the centre
    float discriminant = 1.0 - dot(nearest, nearest);
    if (!(discriminant >= 0.0)) return NO_HIT;
    float root = sqrt(a * discriminant);
    float q = b + (b < 0.0 ? -root : root);
    float t_far = q / a;
    float t_near = q != 0.0 ? (dot(ray.o, ray.o) - 1.0) / q : t_far;
    if (t_near > t_far) {
        float swap = t_near;
        t_near = t_far;
        t_far = swap;
    }
    if (t_near > 0.0 && t_near < t_max) return t_near;
    return t_far > 0.0 && t_far < t_max ? t_far : NO_HIT;
}

float hit_quad(LocalRay ray, float t_max, out vec2 uv) {
    uv = vec2(0.0);
    if (ray.d.z == 0.0) return NO_HIT;
    float t = -ray.o.z / ray.d.z;
    vec2 at = ray.o.xy + t * ray.d.xy;
    if (!(t > 0.0 && t < t_max && abs(at.x) <= 1.0 && abs(at.y) <= 1.0)) return NO_HIT;
    uv = at;
    return t;
}

// Two-sided. uv: barycentric weights of b and c. Neighbours see the same bits for a shared edge (`precise` forbids
// to fuse what has to cancel), so no ray passes between them.
float hit_triangle(LocalRay ray, vec3 pa, vec3 pb, vec3 pc, float t_max, out vec2 uv) {
    uv = vec2(0.0);
    vec3 a = pa - ray.o, b = pb - ray.o, c = pc - ray.o;
    precise vec2 a2 = vec2(dot(a, ray.across_u), dot(a, ray.across_v));
    precise vec2 b2 = vec2(dot(b, ray.across_u), dot(b, ray.across_v));
    precise vec2 c2 = vec2(dot(c, ray.across_u), dot(c, ray.across_v));
    precise float u = c2.x * b2.y - c2.y * b2.x;
    precise float v = a2.x * c2.y - a2.y * c2.x;
    precise float w = b2.x * a2.y - b2.y * a2.x;
    if (min(u, min(v, w)) < 0.0 && max(u, max(v, w)) > 0.0) return NO_HIT;
    float area = u + v + w;
    if (area == 0.0) return NO_HIT;
    float t = (u * dot(a, ray.along) + v * dot(b, ray.along) + w * dot(c, ray.along)) / area;
    if (!(t > 0.0 && t < t_max)) return NO_HIT;
    uv = clamp(vec2(v, w) / area, 0.0, 1.0);
    return t;
}

#endif

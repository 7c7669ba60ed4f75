// Interpolated normals, by one convention: they bend the ray; the geometric normal decides on which side it goes
// on. A ray that the interpolated normal cannot bend (it faces away), or that it would bend through the surface,
// is bent by the geometric normal and counted in `bent`.
#ifndef INTERFACE_GLSL
#define INTERFACE_GLSL

#include "shared/surface.glsl"

// The geometric normal on the side the ray comes from.
vec3 facing_normal(Surface s, vec3 d) {
    return dot(d, s.ng) <= 0.0 ? s.ng : -s.ng;
}

// The interpolated normal on the side the ray comes from; the geometric one, counted, where it faces away.
vec3 bending_normal(Surface s, vec3 d, inout uint bent) {
    vec3 n = dot(d, s.ng) <= 0.0 ? s.ns : -s.ns;
    if (dot(d, n) < 0.0) return n;
    vec3 geometric = facing_normal(s, d);
    if (n != geometric) bent++;
    return geometric;
}

// Refraction from index n_from into n_to; fresnel_r is the reflectance at the normal used. False on total
// reflection: then t is d and fresnel_r is one.
bool bend_refract(Surface s, vec3 d, float n_from, float n_to, out vec3 t, out float fresnel_r, inout uint bent) {
    vec3 geometric = facing_normal(s, d);
    vec3 n = bending_normal(s, d, bent);
    float eta = n_from / n_to;
    fresnel_r = 1.0;
    if (!refract_ray(d, n, eta, t)) return false;
    if (n != geometric && !(dot(t, geometric) < 0.0)) {
        bent++;
        n = geometric;
        if (!refract_ray(d, n, eta, t)) return false;
    }
    fresnel_r = fresnel(-dot(d, n), n_from, n_to);
    return true;
}

// Mirror reflection; fresnel_r is the reflectance between the indices at the normal used (of no meaning to a mirror).
void bend_reflect(Surface s, vec3 d, float n_from, float n_to, out vec3 r, out float fresnel_r, inout uint bent) {
    vec3 geometric = facing_normal(s, d);
    vec3 n = bending_normal(s, d, bent);
    r = reflect_ray(d, n);
    if (n != geometric && !(dot(r, geometric) > 0.0)) {
        bent++;
        n = geometric;
        r = reflect_ray(d, n);
    }
    fresnel_r = fresnel(-dot(d, n), n_from, n_to);
}

#endif

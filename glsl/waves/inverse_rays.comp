#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The ray of each light that goes on below each corner of the grid. SHADED: where something may stand between the light and the
// water, or the water is steep enough to stand in its own light.

#define INVERSE_RAYS writeonly
#include "waves/inverse.glsl"
#include "shared/optics.glsl"
#ifdef SHADED
#include "shared/bvh.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;

const float LEVEL_RAY = 1e-3; // metres down for one along, below which a ray goes on beside the water

// The slope below of light along d above, all along u, v and n; false where none goes on.
bool slope_below(vec3 d, vec3 normal, float ior, out vec2 slope) {
    vec3 t;
    slope = vec2(0.0);
    if (!(dot(d, normal) < 0.0) || !refract_ray(d, normal, 1.0 / ior, t) || !(-t.z > LEVEL_RAY)) return false;
    slope = t.xy / -t.z;
    return true;
}

vec3 in_frame(vec3 d) {
    Water w = water_frame();
    return vec3(dot(d, w.u), dot(d, w.v), dot(d, w.n));
}

void main() {
    ivec2 corner = ivec2(gl_GlobalInvocationID.xy);
    uint index = gl_GlobalInvocationID.z;
    if (any(greaterThan(corner, ivec2(ACROSS, ALONG)))) return;
    WaterLight from = water_lights.at[index];
    Water w = water_frame();
    vec2 at = (2.0 * vec2(corner) / vec2(ACROSS, ALONG) - 1.0) * w.half_size;
    vec2 gradient = water_gradient(at);
    vec3 normal = vec3(-gradient, 1.0) / sqrt(1.0 + dot(gradient, gradient));
    WaterRay ray;
    ray.start = vec3(at, water_height(at));
    vec3 p = w.center + at.x * w.u + at.y * w.v + ray.start.z * w.n;
    vec3 way = from.light.kind == LIGHT_DIRECTIONAL ? from.light.vector : p - from.light.vector;
    vec3 d = safe_normalize(way, -w.n);
    vec3 local = in_frame(d);
    ray.passes = light_share(from.light, d);
    bool goes = true;
    for (int band = 0; band < INVERSE_BANDS; band++) {
        goes = slope_below(local, normal, w.ior[band], ray.slope[band]) && goes;
        float share = 1.0 - fresnel(-dot(local, normal), 1.0, w.ior[band]);
#if INVERSE_BANDS == 1
        ray.passes *= share;
#else
        ray.passes[band] *= share;
#endif
#ifdef DISCS
        // Across the whole disc, or where it is small a milliradian, at which float32 has four digits.
        float reach = max(from.radius, 1e-3);
        vec2 axis[4];
        for (int k = 0; k < 4; k++) {
            vec3 aside = d + (k < 2 ? from.x : from.y) * (k % 2 == 0 ? reach : -reach);
            if (!slope_below(in_frame(safe_normalize(aside, d)), normal, w.ior[band], axis[k])) axis[k] = ray.slope[band];
        }
        ray.spread[band] = from.radius > 0.0 ? vec4(axis[0] - axis[1], axis[2] - axis[3]) / (2.0 * reach) : vec4(0.0);
#endif
    }
#ifdef SHADED
    float off = 1e-3 * max(w.half_size.x / float(ACROSS), w.half_size.y / float(ALONG));
    vec3 out_of = normal.x * w.u + normal.y * w.v + normal.z * w.n;
    float far = from.light.kind == LIGHT_DIRECTIONAL ? NO_HIT : max(length(way) - off, 0.0);
    if (occluded(p + off * out_of, -d, far, MASK_ALL)) ray.passes = vec3(0.0);
#endif
    if (!goes) ray.passes = vec3(-1.0);
    water_rays.at[ray_at(index, corner)] = ray;
}

// A rectangular view of an eye or a light. Float32 twin of the Rust room `view`.
//
// xy01 runs over the window from 0 to 1 as texel rows do: (0, 0) is the corner (x0, y1), and y grows downwards.
#ifndef VIEW_GLSL
#define VIEW_GLSL

struct View {
    vec3 origin;
    float x0; // window: metres if orthographic, tangents if perspective
    vec3 right;
    float x1;
    vec3 up;
    float y0;
    vec3 forward;
    float y1;
    float near; // metres along forward
    float far;
    uint perspective;
    uint pad;
};

// What stands for an area that has no bound, m^2.
const float VIEW_NO_BOUND = 1e30;

vec2 view_window(View v, vec2 xy01) {
    return vec2(v.x0 * (1.0 - xy01.x) + v.x1 * xy01.x, v.y1 * (1.0 - xy01.y) + v.y0 * xy01.y);
}

// The ray through xy01; it starts on the near plane, d is unit.
void view_ray(View v, vec2 xy01, out vec3 o, out vec3 d) {
    vec2 w = view_window(v, xy01);
    vec3 across = v.right * w.x + v.up * w.y;
    if (v.perspective != 0u) {
        vec3 through = v.forward + across; // never shorter than one: right, up and forward are orthonormal
        o = v.origin + through * v.near;
        d = through / sqrt(dot(through, through));
    } else {
        o = v.origin + across + v.forward * v.near;
        d = v.forward;
    }
}

// Where p is seen. False before the near plane and where the answer is not finite; xy01 may lie outside 0..1.
bool view_project(View v, vec3 p, out vec2 xy01) {
    xy01 = vec2(-1.0);
    vec3 q = p - v.origin;
    float z = dot(q, v.forward);
    if (!(z >= v.near)) return false;
    vec2 w = vec2(dot(q, v.right), dot(q, v.up));
    if (v.perspective != 0u) {
        if (!(z > 0.0)) return false;
        w /= z;
    }
    vec2 extent = vec2(v.x1 - v.x0, v.y1 - v.y0);
    vec2 at = vec2(w.x - v.x0, v.y1 - w.y) / extent;
    if (!(abs(at.x) < 1e30 && abs(at.y) < 1e30)) return false;
    xy01 = at;
    return true;
}

// One texel of the window: m^2 if orthographic, else at unit distance.
float view_texel_window(View v, ivec2 size) {
    return (v.x1 - v.x0) / float(size.x) * ((v.y1 - v.y0) / float(size.y));
}

// Cross-section of one texel of an orthographic view, m^2.
float view_texel_cross_section(View v, ivec2 size) {
    return view_texel_window(v, size);
}

// Footprint (m^2) of one texel, as large as at p, on the plane through p with unit normal n.
// Perspective: omega r^2 / |n.D| with omega = a (z/r)^3 is a z^3 / |n.q|. Grazing planes have a large area, never
// infinite.
float view_texel_area(View v, ivec2 size, vec2 xy01, vec3 p, vec3 n) {
    float window = view_texel_window(v, size);
    const float LEAST_COSINE = 1e-7;
    if (v.perspective == 0u) return min(window / max(abs(dot(n, v.forward)), LEAST_COSINE), VIEW_NO_BOUND);
    vec3 q = p - v.origin;
    float z = dot(q, v.forward);
    float r = sqrt(dot(q, q));
    if (!(z > 0.0 && r > 0.0)) return VIEW_NO_BOUND;
    float along = z / r;
    float cosine = max(abs(dot(n, q / r)), LEAST_COSINE);
    return min(window * along * along * along * r * r / cosine, VIEW_NO_BOUND);
}

// Solid angle (sr) of a texel of a perspective view: dx dy / (1 + x^2 + y^2)^(3/2) at 2x2 Gauss nodes.
// The closed form in arctangents cancels in float32; the midpoint rule is 4e-3 off at 16 texels a side.
float view_texel_solid_angle(View v, ivec2 size, ivec2 texel) {
    const float NODE = 0.28867513; // 1 / (2 sqrt(3))
    float sum = 0.0;
    for (int k = 0; k < 4; k++) {
        vec2 node = vec2((k & 1) == 0 ? -NODE : NODE, (k & 2) == 0 ? -NODE : NODE);
        vec2 w = view_window(v, (vec2(texel) + 0.5 + node) / vec2(size));
        float s = 1.0 + dot(w, w);
        sum += 1.0 / (s * sqrt(s));
    }
    return view_texel_window(v, size) * 0.25 * sum;
}

// Solid angle (sr) of a part of the window of a perspective view, by the same rule.
float view_solid_angle(View v, vec2 from, vec2 to) {
    const float NODE = 0.28867513;
    float sum = 0.0;
    for (int k = 0; k < 4; k++) {
        vec2 node = vec2((k & 1) == 0 ? -NODE : NODE, (k & 2) == 0 ? -NODE : NODE);
        vec2 w = view_window(v, 0.5 * (from + to) + node * (to - from));
        float along = 1.0 / sqrt(1.0 + dot(w, w));
        sum += along * along * along;
    }
    return (v.x1 - v.x0) * (to.x - from.x) * ((v.y1 - v.y0) * (to.y - from.y)) * 0.25 * sum;
}

// Vulkan clip space: y downwards, depth 0 on the near plane, 1 on the far plane.
vec4 view_clip(View v, vec3 p) {
    vec3 q = p - v.origin;
    float z = dot(q, v.forward);
    float w = v.perspective != 0u ? z : 1.0;
    float x = (dot(q, v.right) - v.x0 * w) / (v.x1 - v.x0);
    float y = (v.y1 * w - dot(q, v.up)) / (v.y1 - v.y0);
    float depth = (z - v.near) / (v.far - v.near) * (v.perspective != 0u ? v.far : 1.0);
    return vec4(2.0 * x - w, 2.0 * y - w, depth, w);
}

#endif

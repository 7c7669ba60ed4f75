// Slot `surface` of waves.variant = vertex: the fine mesh's colours, linear on its triangles as rasterisers make them.
#include "waves/place.glsl"

layout(set = 0, binding = 36) uniform sampler2D waves_vertices;

vec3 surface_irradiance(vec3 p, vec3 n, uint receiver, vec2 uv) {
    vec2 at;
    float above;
    if (!water_over(p, n, at, above)) return vec3(0.0);
    vec2 place = clamp(0.5 + 0.5 * at / water_frame().half_size, 0.0, 1.0) * float(WAVES_MESH);
    ivec2 k = min(ivec2(place), ivec2(WAVES_MESH - 1));
    vec2 f = place - vec2(k);
    // Cells are cut from their first corner to the one across.
    bool lower = f.x >= f.y;
    vec4 a = texelFetch(waves_vertices, k, 0);
    vec4 b = texelFetch(waves_vertices, k + (lower ? ivec2(1, 0) : ivec2(0, 1)), 0);
    vec4 c = texelFetch(waves_vertices, k + 1, 0);
    vec2 w = lower ? f : f.yx;
    vec4 here = a * (1.0 - w.x) + b * (w.x - w.y) + c * w.y;
    return sunlight(here.rgb, here.a - above);
}

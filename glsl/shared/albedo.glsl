// The share of light that a diffuse surface sends back, of each band.
#ifndef ALBEDO_GLSL
#define ALBEDO_GLSL

#include "shared/surface.glsl"

#ifdef HAS_TEXTURES
// Bilinear between the middles of a picture's pixels, the picture repeated without end. Weights are float32, not a sampler's
// eighths of a bit; there are no smaller copies: what is finer than a pixel of the eye is averaged by `eye.samples`.
vec3 texture_at(Texture texture, vec2 place) {
    vec2 at = place * texture.repeat;
    at -= floor(at);
    if (!(at.x >= 0.0 && at.y >= 0.0)) at = vec2(0.0); // beyond what float32 tells apart
    vec2 size = vec2(texture.size);
    vec2 pixel = vec2(at.x, 1.0 - at.y) * size - 0.5;
    vec2 corner = floor(pixel);
    vec2 share = pixel - corner;
    uvec2 low = uvec2(corner + size) % texture.size, high = (low + 1u) % texture.size;
    uint upper = texture.first + low.y * texture.size.x, lower = texture.first + high.y * texture.size.x;
    vec3 above = mix(scene_texels.data[upper + low.x], scene_texels.data[upper + high.x], share.x);
    vec3 below = mix(scene_texels.data[lower + low.x], scene_texels.data[lower + high.x], share.x);
    return mix(above, below, share.y);
}
#endif

vec3 albedo(Surface s) {
    Material m = scene_materials.data[s.material];
#ifdef HAS_TEXTURES
    if (m.texture != 0u) return m.colour * texture_at(scene_textures.data[m.texture - 1u], s.place);
#endif
    return m.colour;
}

#endif

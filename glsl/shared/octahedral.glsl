// Unit vectors in two numbers, each in [-1, 1].
// Based on: Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 3(2), 2014,
// listing 1.
#ifndef OCTAHEDRAL_GLSL
#define OCTAHEDRAL_GLSL

vec2 octahedral_fold(vec2 p) {
    return (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
}

// The zero vector becomes (0, 0), which stands for +z.
vec2 octahedral_encode(vec3 v) {
    float sum = abs(v.x) + abs(v.y) + abs(v.z);
    if (!(sum > 0.0)) return vec2(0.0);
    vec2 p = v.xy / sum;
    return clamp(v.z >= 0.0 ? p : octahedral_fold(p), -1.0, 1.0);
}

vec3 octahedral_decode(vec2 e) {
    vec2 p = clamp(e, -1.0, 1.0);
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec3 v = vec3(z >= 0.0 ? p : octahedral_fold(p), z);
    return v / sqrt(dot(v, v)); // the octahedron is nowhere nearer to its centre than 1/sqrt(3)
}

// In one number, not negative: 12 bits an axis, exact in a float32 (0.05 degrees; the axes exactly, so that a wall is
// edge-on to a map above it).
float octahedral_pack(vec3 v) {
    uvec2 e = uvec2(round((octahedral_encode(v) * 0.5 + 0.5) * 4094.0));
    return float(e.x * 4096u + e.y);
}

vec3 octahedral_unpack(float packed) {
    uint bits = uint(clamp(packed, 0.0, 16777215.0));
    return octahedral_decode(vec2(bits / 4096u, bits % 4096u) / 4094.0 * 2.0 - 1.0);
}

// As above in what a float16 holds exactly, integers up to 2048: 63 steps an axis (2 degrees; the axes exactly).
float octahedral_pack_half(vec3 v) {
    ivec2 e = ivec2(round((octahedral_encode(v) * 0.5 + 0.5) * 62.0));
    return float(e.x * 63 + e.y - 1984);
}

vec3 octahedral_unpack_half(float packed) {
    int bits = clamp(int(packed), -1984, 1984) + 1984;
    return octahedral_decode(vec2(bits / 63, bits % 63) / 62.0 * 2.0 - 1.0);
}

#endif

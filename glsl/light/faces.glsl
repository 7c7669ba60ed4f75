// A surface in two texels, float32: position and 1 + instance (0: nothing); interpolated normal, and the geometric one
// packed, or SAME_NORMAL where it is the same.
#ifndef FACES_GLSL
#define FACES_GLSL

#include "shared/octahedral.glsl"
#include "shared/surface.glsl"

struct Face {
    vec4 position;
    vec4 normal;
};

const float SAME_NORMAL = -1.0;

Face face_of(Surface s, uint instance) {
    float geometric = s.ns == s.ng ? SAME_NORMAL : octahedral_pack(s.ng);
    return Face(vec4(s.p, float(instance + 1u)), vec4(s.ns, geometric));
}

bool is_face(Face face) {
    return face.position.w != 0.0;
}

vec3 geometric_normal(Face face) {
    return face.normal.w == SAME_NORMAL ? face.normal.xyz : octahedral_unpack(face.normal.w);
}

// The surface again; of a face that is there. Nothing is known of its (u, v), and no ray starts from it.
Surface surface_of_face(Face face) {
    Instance shape = scene_instances.data[uint(face.position.w) - 1u];
    vec3 n = face.normal.xyz;
    return Surface(face.position.xyz, geometric_normal(face), n, vec2(0.0), shape.object, shape.material, 0.0);
}

// Neighbours of one smooth sheet: of one instance, each near the other's tangent plane, bent less than a crease.
bool is_one_sheet(Face a, Face b) {
    const float STEEPEST = 0.5; // of the way between them against the plane: 27 degrees
    const float CREASE = 0.95;  // cosine, 18 degrees
    if (a.position.w != b.position.w || dot(a.normal.xyz, b.normal.xyz) < CREASE) return false;
    vec3 way = b.position.xyz - a.position.xyz;
    float off = dot(way, geometric_normal(a));
    return off * off <= STEEPEST * STEEPEST * dot(way, way);
}

// Beneath a point between texels: bilinear where the four about it are of one sheet, else the nearest of them that is
// there. Nothing is averaged over a silhouette, a crease or a step.
bool face_beneath(sampler2D positions, sampler2D normals, vec2 xy01, out Face face) {
    ivec2 size = textureSize(positions, 0);
    vec2 at = xy01 * vec2(size) - 0.5;
    face = Face(vec4(0.0), vec4(0.0));
    if (!(all(greaterThan(at, vec2(-1.0))) && all(lessThan(at, vec2(size))))) return false;
    ivec2 low = ivec2(floor(at));
    vec2 f = at - vec2(low);
    Face corner[4];
    float weight[4];
    int nearest = -1;
    for (int k = 0; k < 4; k++) {
        ivec2 step = ivec2(k & 1, k >> 1);
        ivec2 texel = clamp(low + step, ivec2(0), size - 1);
        corner[k] = Face(texelFetch(positions, texel, 0), texelFetch(normals, texel, 0));
        weight[k] = (step.x == 1 ? f.x : 1.0 - f.x) * (step.y == 1 ? f.y : 1.0 - f.y);
        if (is_face(corner[k]) && (nearest < 0 || weight[k] > weight[nearest])) nearest = k;
    }
    if (nearest < 0) return false;
    face = corner[nearest];
    bool whole = true;
    vec3 p = vec3(0.0), n = vec3(0.0);
    for (int k = 0; k < 4; k++) {
        whole = whole && is_face(corner[k]) && is_one_sheet(face, corner[k]);
        p += weight[k] * corner[k].position.xyz;
        n += weight[k] * corner[k].normal.xyz;
    }
    if (whole) {
        face.position.xyz = p;
        face.normal.xyz = safe_normalize(n, face.normal.xyz);
    }
    return true;
}

#endif

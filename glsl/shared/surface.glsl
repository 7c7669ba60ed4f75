// What a ray finds where it hits.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

#include "shared/bvh.glsl"
#include "shared/optics.glsl"

struct Surface {
    vec3 p;   // on the primitive, not on the ray: its error does not grow with the ray's length
    vec3 ng;  // unit geometric normal of the outside, whichever side the ray came from
    vec3 ns;  // unit interpolated normal, on ng's side
    // Quad, box, disk, sine: in [-1, 1]^2; sphere: longitude about +y from +z, latitude (radians); cylinder: angle about its
    // axis (radians), share of its height; paraboloid: across its axis, in rims; mesh: barycentric weights of b, c.
    vec2 uv;
    uint object;
    uint material;
    float eps; // how far along ng a ray must start to be off the surface, metres
#ifdef HAS_TEXTURES
    vec2 place; // texture coordinates: (0, 0) at a picture's lower left
#endif
};

// Bound on the rounding of one way object -> world -> object and of an intersection, in units of the coordinates
// that take part: 16 unit roundoffs of 2^-24 (each map is 4 products and their sums on both sides, stored entries
// included).
const float SURFACE_ROUNDING = 9.5367432e-7;

vec3 abs_map(vec4 rows[3], vec3 p) {
    return vec3(dot(abs(rows[0]), vec4(p, 1.0)), dot(abs(rows[1]), vec4(p, 1.0)), dot(abs(rows[2]), vec4(p, 1.0)));
}

// After: Solving Self-Intersection Artifacts in DirectX Raytracing (NVIDIA developer blog, 2023): the errors of the
// point, of the next ray's origin in object space and of the intersection there, as far as they lie along the normal.
// All terms grow with the scene, so scenes of any scale are treated alike.
float surface_rounding(Instance shape, vec3 p, vec3 ng, vec3 local, float intersection) {
    vec3 normal_of_local = abs(vec3(dot(ng, vec3(shape.to_world[0].x, shape.to_world[1].x, shape.to_world[2].x)),
                                    dot(ng, vec3(shape.to_world[0].y, shape.to_world[1].y, shape.to_world[2].y)),
                                    dot(ng, vec3(shape.to_world[0].z, shape.to_world[1].z, shape.to_world[2].z))));
    float of_point = dot(abs(ng), abs_map(shape.to_world, abs(local)));
    float of_origin = dot(normal_of_local, abs_map(shape.to_object, abs(p)) + vec3(intersection));
    return SURFACE_ROUNDING * (of_point + of_origin);
}

#ifdef HAS_SPHERES
Surface surface_of_sphere(Instance shape, vec3 local) {
    Surface s;
    vec3 n = safe_normalize(local, vec3(0.0, 1.0, 0.0));
    s.p = map_point(shape.to_world, n);
    s.ng = safe_normalize(map_normal(shape.to_object, n), vec3(0.0, 1.0, 0.0));
    s.ns = s.ng;
    float around = sqrt(n.x * n.x + n.z * n.z);
    s.uv = vec2(around > 0.0 ? atan(n.x, n.z) : 0.0, atan(n.y, around));
    s.eps = surface_rounding(shape, s.p, s.ng, n, 1.0);
    return s;
}
#endif

#ifdef HAS_QUADS
Surface surface_of_quad(Instance shape, vec2 uv) {
    Surface s;
    vec3 local = vec3(clamp(uv, -1.0, 1.0), 0.0);
    s.p = map_point(shape.to_world, local);
    s.ng = safe_normalize(map_normal(shape.to_object, vec3(0.0, 0.0, 1.0)), vec3(0.0, 1.0, 0.0));
    s.ns = s.ng;
    s.uv = local.xy;
    s.eps = surface_rounding(shape, s.p, s.ng, local, 0.0);
    return s;
}
#endif

// On a canonical shape, with the normal of its outside, of any length; `intersection`: the size of what its equation adds.
Surface surface_of_canonical(Instance shape, vec3 local, vec3 normal, vec2 uv, float intersection) {
    Surface s;
    s.p = map_point(shape.to_world, local);
    s.ng = safe_normalize(map_normal(shape.to_object, normal), vec3(0.0, 1.0, 0.0));
    s.ns = s.ng;
    s.uv = uv;
    s.eps = surface_rounding(shape, s.p, s.ng, local, intersection);
    return s;
}

#ifdef HAS_BOXES
// Off the box's edges by the rounding of the way back, so that a ray that goes on inside starts inside.
Surface surface_of_box(Instance shape, uint face, vec2 uv) {
    vec3 p = map_point(shape.to_world, box_place(face, uv));
    vec3 back = SURFACE_ROUNDING * (abs_map(shape.to_object, abs(p)) + 1.0);
    uint axis = face >> 1;
    vec2 room = max(1.0 - (axis == 0u ? back.yz : axis == 1u ? back.zx : back.xy), 0.0);
    vec2 inner = clamp(uv, -room, room);
    return surface_of_canonical(shape, box_place(face, inner), box_normal(face), inner, 0.0);
}
#endif

#ifdef HAS_MESHES
Surface surface_of_triangle(Instance shape, uint primitive, vec2 uv) {
    Surface s;
    Triangle at = scene_triangles.data[primitive];
    TriangleNormals normals = scene_normals.data[primitive];
    vec3 ab = at.b - at.a, ac = at.c - at.a;
    vec3 local = at.a + uv.x * ab + uv.y * ac;
    float extent = max(max(abs(ab.x), abs(ac.x)), max(max(abs(ab.y), abs(ac.y)), max(abs(ab.z), abs(ac.z))));
    s.p = map_point(shape.to_world, local);
    vec3 normal = safe_normalize(cross(ab, ac), vec3(0.0, 1.0, 0.0));
    s.ng = safe_normalize(map_normal(shape.to_object, normal), vec3(0.0, 1.0, 0.0));
    vec3 bent = (1.0 - uv.x - uv.y) * normals.a + uv.x * normals.b + uv.y * normals.c;
    s.ns = safe_normalize(map_normal(shape.to_object, bent), s.ng);
    if (dot(s.ns, s.ng) < 0.0) s.ns = -s.ns;
    s.uv = uv;
    s.eps = surface_rounding(shape, s.p, s.ng, abs(at.a) + abs(ab) + abs(ac), extent);
    return s;
}
#endif

#ifdef HAS_TEXTURES
// Texture coordinates of a place on a shape; around spheres and tubes a picture goes once.
vec2 texture_place(uint kind, uint primitive, vec2 uv) {
    const float TURN = 6.2831853;
    if (kind == SHAPE_SPHERE) return vec2(uv.x / TURN + 0.5, uv.y / (0.5 * TURN) + 0.5);
    if (kind == SHAPE_CYLINDER) return vec2(uv.x / TURN + 0.5, uv.y);
#ifdef HAS_COORDINATES
    if (kind == SHAPE_MESH) {
        TriangleCoordinates at = scene_coordinates.data[primitive];
        return (1.0 - uv.x - uv.y) * at.a + uv.x * at.b + uv.y * at.c;
    }
#endif
    return 0.5 + 0.5 * uv;
}
#endif

// Of a hit that `trace` found for this ray.
Surface surface_at(vec3 o, vec3 d, Hit hit) {
    Instance shape = scene_instances.data[hit.instance];
    Surface s;
    s.p = o;
    s.ng = s.ns = -d;
    s.uv = vec2(0.0);
    s.eps = 0.0;
#ifdef HAS_SPHERES
    if (shape.kind == SHAPE_SPHERE) {
        s = surface_of_sphere(shape, map_point(shape.to_object, o) + hit.t * map_vector(shape.to_object, d));
    }
#endif
#ifdef HAS_QUADS
    if (shape.kind == SHAPE_QUAD) s = surface_of_quad(shape, hit.uv);
#endif
#ifdef HAS_BOXES
    if (shape.kind == SHAPE_BOX) s = surface_of_box(shape, hit.primitive, hit.uv);
#endif
#ifdef HAS_DISKS
    if (shape.kind == SHAPE_DISK) {
        s = surface_of_canonical(shape, vec3(hit.uv, 0.0), vec3(0.0, 0.0, 1.0), hit.uv, 0.0);
    }
#endif
#ifdef HAS_CYLINDERS
    if (shape.kind == SHAPE_CYLINDER) {
        vec3 out_of = cylinder_normal(hit.primitive, hit.uv.x);
        vec2 uv = vec2(atan(out_of.y, out_of.x), hit.uv.y);
        s = surface_of_canonical(shape, vec3(out_of.xy, hit.uv.y), out_of, uv, 1.0);
    }
#endif
#ifdef HAS_PARABOLOIDS
    if (shape.kind == SHAPE_PARABOLOID) {
        vec3 local = vec3(hit.uv, dot(hit.uv, hit.uv));
        s = surface_of_canonical(shape, local, vec3(2.0 * hit.uv, -1.0), hit.uv, 1.0);
    }
#endif
#ifdef HAS_SINES
    if (shape.kind == SHAPE_SINE) {
        float wave = uintBitsToFloat(shape.detail);
        float angle = wave * hit.uv.x + shape.phase;
        vec3 local = vec3(hit.uv, sin(angle));
        vec3 normal = vec3(-wave * cos(angle), 0.0, 1.0);
        s = surface_of_canonical(shape, local, normal, hit.uv, 1.0 + wave);
    }
#endif
#ifdef HAS_MESHES
    if (shape.kind == SHAPE_MESH) s = surface_of_triangle(shape, hit.primitive, hit.uv);
#endif
    s.object = shape.object;
    s.material = shape.material;
#ifdef HAS_TEXTURES
    s.place = texture_place(shape.kind, hit.primitive, s.uv);
#endif
    return s;
}

// What a texel of `eye/gbuffer.frag` holds of the ray through it: 1 + instance, primitive, and (u, v).
Surface surface_seen(uvec4 seen, vec3 o, vec3 d) {
    Hit hit = Hit(0.0, seen.x - 1u, seen.y, uintBitsToFloat(seen.zw));
#ifdef HAS_SPHERES
    Instance at = scene_instances.data[hit.instance];
    if (at.kind == SHAPE_SPHERE) {
        hit.t = hit_sphere(local_ray(map_point(at.to_object, o), map_vector(at.to_object, d)), NO_HIT);
    }
#endif
    return surface_at(o, d, hit);
}

// Where a ray that goes on along d starts: off the surface, on the side it goes to.
vec3 leave(Surface s, vec3 d) {
    return s.p + (dot(d, s.ng) < 0.0 ? -s.eps : s.eps) * s.ng;
}

#endif

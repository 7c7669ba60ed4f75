// Rays through the scene: a tree over the instances, and one in object space for each mesh.
//
// The order is that of obvhs 0.4 (`Bvh2::ray_traverse_dynamic`): the nearer child first, leaves before inner nodes.
// Differs: a child put off is dropped when it comes up if a hit has been found before it. With COUNT_NODES the global
// `nodes_visited` counts inner nodes opened.
#ifndef BVH_GLSL
#define BVH_GLSL

#include "shared/intersect.glsl"
#include "shared/scene.glsl"

struct Hit {
    float t;        // metres
    uint instance;  // in scene_instances
    uint primitive; // in scene_triangles; 0 for analytic shapes
    vec2 uv;        // triangle: barycentric weights of b, c; quad: in [-1, 1]^2
};

#ifdef COUNT_NODES
uint nodes_visited = 0u;
#endif

// One entry for each level of both trees together; the host refuses deeper trees, and an entry too many is dropped.
const int TRAVERSAL_STACK = 64;

// A node on the stack: its count above its first index. The host holds counts below 16 and indices below 2^28.
uint node_reference(Node node) {
    return node.count << 28 | node.first;
}

vec3 map_point(vec4 rows[3], vec3 p) {
    return vec3(dot(rows[0].xyz, p) + rows[0].w, dot(rows[1].xyz, p) + rows[1].w, dot(rows[2].xyz, p) + rows[2].w);
}

vec3 map_vector(vec4 rows[3], vec3 v) {
    return vec3(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
}

// Normals go by the inverse transposed: the columns of to_object.
vec3 map_normal(vec4 to_object[3], vec3 n) {
    return n.x * to_object[0].xyz + n.y * to_object[1].xyz + n.z * to_object[2].xyz;
}

// A sphere or quad against the nearest hit so far.
bool test_shape(Instance shape, uint index, LocalRay ray, inout Hit hit) {
    vec2 uv = vec2(0.0);
    float t = shape.kind == SHAPE_SPHERE ? hit_sphere(ray, hit.t) : hit_quad(ray, hit.t, uv);
    if (!(t < hit.t)) return false;
    hit = Hit(t, index, 0u, uv);
    return true;
}

bool test_triangles(uint first, uint count, uint instance, LocalRay ray, inout Hit hit) {
    bool found = false;
    for (uint k = first; k < first + count; k++) {
        Triangle triangle = scene_triangles.data[k];
        vec2 uv;
        float t = hit_triangle(ray, triangle.a, triangle.b, triangle.c, hit.t, uv);
        if (!(t < hit.t)) continue;
        hit = Hit(t, instance, k, uv);
        found = true;
    }
    return found;
}

bool is_leaf(uint reference) {
    return reference >> 28 != 0u;
}

// The children of an inner node in the order they are gone into, and where the ray enters them: the nearer first, but a
// leaf before an inner node, since what it holds is soon tested and may hide the other.
void open_node(uint first, LocalRay ray, float t_max, out uvec2 children, out vec2 enter) {
#ifdef COUNT_NODES
    nodes_visited++;
#endif
    Node left = scene_nodes.data[first];
    Node right = scene_nodes.data[first + 1u];
    enter = vec2(enter_box(ray, left.lo, left.hi), enter_box(ray, right.lo, right.hi));
    children = uvec2(node_reference(left), node_reference(right));
    bool leaf_left = is_leaf(children.x) && enter.x < t_max;
    bool leaf_right = is_leaf(children.y) && enter.y < t_max;
    if (leaf_left != leaf_right ? leaf_right : enter.x > enter.y) {
        enter = enter.yx;
        children = children.yx;
    }
}

// One loop for both trees: it opens a node, tests a leaf's triangles or one instance of an upper leaf, or takes the
// next node from the stack. Inside a mesh the stack above mesh_base is the mesh's.
bool traverse(vec3 o, vec3 d, float t_max, uint mask, bool any_hit, out Hit hit) {
    hit = Hit(min(t_max, NO_HIT), 0u, 0u, vec2(0.0));
    LocalRay world = local_ray(o, d);
    Node top = scene_nodes.data[0];
    if (!(dot(abs(d), vec3(1.0)) > 0.0) || !(enter_box(world, top.lo, top.hi) < hit.t)) return false;

    uint stack[TRAVERSAL_STACK];
    float stack_enter[TRAVERSAL_STACK];
    int height = 0, mesh_base = 0;
    uint instance = 0u, instance_end = 0u; // of an upper leaf, still to test
    uint mesh_instance = 0u;
    bool in_mesh = false, have_node = true, found = false;
    LocalRay ray = world;
    uint node = node_reference(top);
    while (!(found && any_hit)) {
        if (!have_node) {
            if (in_mesh && height == mesh_base) {
                in_mesh = false;
                ray = world;
            }
            if (!in_mesh && instance < instance_end) {
                uint index = instance++;
                Instance shape = scene_instances.data[index];
                if ((material_mask(shape.material) & mask) == 0u) continue;
                LocalRay local = local_ray(map_point(shape.to_object, o), map_vector(shape.to_object, d));
                if (shape.kind != SHAPE_MESH) {
                    if (test_shape(shape, index, local, hit)) found = true;
                    continue;
                }
                Node root = scene_nodes.data[shape.root];
                if (!(enter_box(local, root.lo, root.hi) < hit.t)) continue;
                ray = local;
                in_mesh = true;
                mesh_instance = index;
                mesh_base = height;
                node = node_reference(root);
            } else {
                if (height == 0) break;
                height--;
                if (!(stack_enter[height] < hit.t)) continue;
                node = stack[height];
            }
        }
        have_node = false;
        uint count = node >> 28, first = node & 0x0fffffffu;
        if (count == 0u) {
            uvec2 children;
            vec2 enter;
            open_node(first, ray, hit.t, children, enter);
            if (enter.y < hit.t && height < TRAVERSAL_STACK) {
                stack[height] = children.y;
                stack_enter[height++] = enter.y;
            }
            have_node = enter.x < hit.t;
            node = children.x;
        } else if (in_mesh) {
            if (test_triangles(first, count, mesh_instance, ray, hit)) found = true;
        } else {
            instance = first;
            instance_end = first + count;
        }
    }
    return found;
}

// The nearest hit at 0 < t < t_max on an object whose class is in the mask; d is unit, t in metres.
bool trace(vec3 o, vec3 d, float t_max, uint mask, out Hit hit) {
    return traverse(o, d, t_max, mask, false, hit);
}

bool occluded(vec3 o, vec3 d, float t_max, uint mask) {
    Hit hit;
    return traverse(o, d, t_max, mask, true, hit);
}

#endif

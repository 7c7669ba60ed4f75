// Rays through the scene: a tree over the instances, and one in object space for each mesh.
//
// The order is that of obvhs 0.4 (`Bvh2::ray_traverse_dynamic`): the nearer child first, leaves before inner nodes.
// Differs: a child put off is dropped when it comes up if a hit has been found before it. With COUNT_NODES the global
// `nodes_visited` counts inner nodes opened.
#ifndef BVH_GLSL
#define BVH_GLSL

#include "shared/canonical.glsl"
#include "shared/intersect.glsl"
#include "shared/scene.glsl"
#include "shared/sine.glsl"

struct Hit {
    float t;        // metres
    uint instance;  // in scene_instances
    uint primitive; // in scene_triangles; box: its face; cylinder: its quarter; else 0
    vec2 uv;        // triangle: barycentric weights of b, c; else as `hit_shape` names the place; sphere: nothing
};

#ifdef COUNT_NODES
uint nodes_visited = 0u;
#endif

// One entry for each level of both trees together; the host refuses deeper trees, and an entry too many is dropped.
const int TRAVERSAL_STACK = 64;

Grid grid_of(uint tree) {
    return Grid(uintBitsToFloat(scene_nodes.data[tree].corners), uintBitsToFloat(scene_nodes.data[tree + 1u].corners));
}

float enter_node(LocalRay ray, Grid grid, Node node) {
    vec3 lo = grid.origin + grid.cell * vec3(node.corners & 0xffffu);
    vec3 hi = grid.origin + grid.cell * vec3(node.corners >> 16);
    return enter_box(ray, lo, hi);
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

// The nearest crossing with an analytic shape at 0 < t < t_max, or NO_HIT, and what names the place.
float hit_shape(Instance shape, LocalRay ray, float t_max, out uint primitive, out vec2 uv) {
    primitive = 0u;
    uv = vec2(0.0);
    float t = NO_HIT;
#ifdef HAS_SPHERES
    if (shape.kind == SHAPE_SPHERE) t = hit_sphere(ray, t_max);
#endif
#ifdef HAS_QUADS
    if (shape.kind == SHAPE_QUAD) t = hit_quad(ray, t_max, uv);
#endif
#ifdef HAS_BOXES
    if (shape.kind == SHAPE_BOX) t = hit_box(ray, t_max, primitive, uv);
#endif
#ifdef HAS_DISKS
    if (shape.kind == SHAPE_DISK) t = hit_disk(ray, t_max, uv);
#endif
#ifdef HAS_CYLINDERS
    if (shape.kind == SHAPE_CYLINDER) t = hit_cylinder(ray, uintBitsToFloat(shape.detail), t_max, primitive, uv);
#endif
#ifdef HAS_PARABOLOIDS
    if (shape.kind == SHAPE_PARABOLOID) t = hit_paraboloid(ray, uintBitsToFloat(shape.detail), t_max, uv);
#endif
#ifdef HAS_SINES
    if (shape.kind == SHAPE_SINE) t = hit_sine(ray, vec2(uintBitsToFloat(shape.detail), shape.phase), t_max, uv);
#endif
    return t;
}

// An analytic shape against the nearest hit so far.
bool test_shape(Instance shape, uint index, LocalRay ray, inout Hit hit) {
    uint primitive;
    vec2 uv;
    float t = hit_shape(shape, ray, hit.t, primitive, uv);
    if (!(t < hit.t)) return false;
    hit = Hit(t, index, primitive, uv);
    return true;
}

#ifdef HAS_MESHES
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
#endif

bool is_leaf(uint reference) {
    return reference >> 28 != 0u;
}

// The children of an inner node in the order they are gone into, and where the ray enters them: the nearer first, but a
// leaf before an inner node, since what it holds is soon tested and may hide the other.
void open_node(uint first, Grid grid, LocalRay ray, float t_max, out uvec2 children, out vec2 enter) {
#ifdef COUNT_NODES
    nodes_visited++;
#endif
    Node left = scene_nodes.data[first];
    Node right = scene_nodes.data[first + 1u];
    enter = vec2(enter_node(ray, grid, left), enter_node(ray, grid, right));
    children = uvec2(left.reference, right.reference);
    bool leaf_left = is_leaf(children.x) && enter.x < t_max;
    bool leaf_right = is_leaf(children.y) && enter.y < t_max;
    if (leaf_left != leaf_right ? leaf_right : enter.x > enter.y) {
        enter = enter.yx;
        children = children.yx;
    }
}

// What is still to visit: references, and where the ray enters their boxes.
uint pending[TRAVERSAL_STACK];
float pending_enter[TRAVERSAL_STACK];

void put_off(uint node, float enter, inout int height) {
    if (height >= TRAVERSAL_STACK) return;
    pending[height] = node;
    pending_enter[height++] = enter;
}

// The next node above `base` that may still hold a nearer hit; false if there is none.
bool take_up(int base, float t_max, inout int height, out uint node) {
    node = 0u;
    while (height > base) {
        height--;
        node = pending[height];
        if (pending_enter[height] < t_max) return true;
    }
    return false;
}

// Goes down from `node` to the next leaf on the ray; false if there is none above `base`. Opening nodes and testing
// leaves are loops of their own, so that rays of one group do the same thing at the same time.
// Based on: Aila and Laine, Understanding the Efficiency of Ray Traversal on GPUs, HPG 2009 (while-while).
bool next_leaf(LocalRay ray, Grid grid, float t_max, int base, inout int height, inout uint node) {
    bool have = true;
    while (have && !is_leaf(node)) {
        uvec2 children;
        vec2 enter;
        open_node(node & NODE_INDEX, grid, ray, t_max, children, enter);
        if (enter.y < t_max) put_off(children.y, enter.y, height);
        node = children.x;
        if (!(enter.x < t_max)) have = take_up(base, t_max, height, node);
    }
    return have;
}

#ifdef HAS_MESHES
// A mesh against the nearest hit so far, with the part of the stack above `height`.
bool traverse_mesh(LocalRay ray, uint instance, uint tree, bool any_hit, int height, inout Hit hit) {
    Grid grid = grid_of(tree);
    Node root = scene_nodes.data[tree + GRID_ENTRIES];
    if (!(enter_node(ray, grid, root) < hit.t)) return false;
    uint node = root.reference;
    int base = height;
    bool found = false;
    while (next_leaf(ray, grid, hit.t, base, height, node)) {
        if (test_triangles(node & NODE_INDEX, node >> 28, instance, ray, hit)) found = true;
        if (found && any_hit) break;
        if (!take_up(base, hit.t, height, node)) break;
    }
    return found;
}
#endif

bool test_instance(uint index, vec3 o, vec3 d, uint mask, bool any_hit, int height, inout Hit hit) {
    Instance shape = scene_instances.data[index];
    if ((material_mask(shape.material) & mask) == 0u) return false;
    LocalRay ray = local_ray(map_point(shape.to_object, o), map_vector(shape.to_object, d));
#ifdef HAS_MESHES
    if (shape.kind == SHAPE_MESH) return traverse_mesh(ray, index, shape.detail, any_hit, height, hit);
#endif
    return test_shape(shape, index, ray, hit);
}

// The tree over the instances, and in its leaves each instance's own.
bool traverse(vec3 o, vec3 d, float t_max, uint mask, bool any_hit, out Hit hit) {
    hit = Hit(min(t_max, NO_HIT), 0u, 0u, vec2(0.0));
    LocalRay world = local_ray(o, d);
    Grid grid = grid_of(0u);
    Node root = scene_nodes.data[GRID_ENTRIES];
    if (!(dot(abs(d), vec3(1.0)) > 0.0) || !(enter_node(world, grid, root) < hit.t)) return false;
    uint node = root.reference;
    int height = 0;
    bool found = false;
    while (next_leaf(world, grid, hit.t, 0, height, node)) {
        uint first = node & NODE_INDEX, end = first + (node >> 28);
        for (uint index = first; index < end && !(found && any_hit); index++) {
            if (test_instance(index, o, d, mask, any_hit, height, hit)) found = true;
        }
        if (found && any_hit) break;
        if (!take_up(0, hit.t, height, node)) break;
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

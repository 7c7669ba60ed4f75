// The scene as the shaders read it: buffers in scalar layout, filled by `passes/accel`.
#ifndef SCENE_GLSL
#define SCENE_GLSL

// DISPERSIVE is defined where materials bend the bands apart: they are then traced apart.
// The host defines HAS_SPHERES, HAS_QUADS, HAS_MESHES, HAS_BOXES, HAS_DISKS, HAS_CYLINDERS, HAS_PARABOLOIDS and
// HAS_SINES where a scene has any, HAS_PATCHES where it has surfaces that shine, and NO_SPOTS where it has no spot: what it
// lacks is not compiled.
#if defined(HAS_SPHERES) || defined(HAS_BOXES) || defined(HAS_DISKS) || defined(HAS_CYLINDERS) || \
    defined(HAS_PARABOLOIDS) || defined(HAS_SINES)
#define HAS_CAST // shapes that the eye casts rays at; quads and meshes are rasterised as they are
#endif

// A node of a binary tree. `corners` is its box along x, y and z in cells of the tree's grid: the least corner in the low
// half, the greatest in the high half. `reference` has a count in its upper four bits. 0: inner, its children are the
// nodes from the index in the others on; else a leaf of so many primitives from that index on. All indices are absolute.
struct Node {
    uvec3 corners;
    uint reference;
};

// A tree begins with its grid, origin and cell as the bits of floats in the corners of two nodes, and then its root. Cells
// are powers of two, and the origin a whole number of them: float32 makes the corners exactly (`passes/accel/grid.rs`).
// The tree over the instances begins at 0.
struct Grid {
    vec3 origin;
    vec3 cell;
};

const uint GRID_ENTRIES = 2u;
const uint NODE_INDEX = 0x0fffffffu;

struct Triangle {
    vec3 a, b, c;
};

struct TriangleNormals {
    vec3 a, b, c;
};

// A canonical shape under an affine map; rows of 3x4 matrices.
struct Instance {
    vec4 to_object[3];
    vec4 to_world[3];
    uint kind;
    uint material;
    uint object; // index of the object in the scene
    uint detail; // mesh: where its tree begins in scene_nodes; cylinder, paraboloid: the bits of its cut; sine: of its wave
    float phase; // sine: radians
};

const uint SHAPE_SPHERE = 0u; // unit sphere at the origin
const uint SHAPE_QUAD = 1u;   // [-1, 1]^2 in the xy-plane, normal +z
const uint SHAPE_MESH = 2u;
const uint SHAPE_BOX = 3u;        // [-1, 1]^3
const uint SHAPE_DISK = 4u;       // unit disk in the xy-plane, normal +z
const uint SHAPE_CYLINDER = 5u;   // x^2 + y^2 = 1, 0 <= z <= 1, x >= cut
const uint SHAPE_PARABOLOID = 6u; // z = x^2 + y^2 <= 1, x >= cut
const uint SHAPE_SINE = 7u;       // z = sin(wave x + phase) over [-1, 1]^2

struct Material {
    uint kind;
    vec3 ior;        // of each band; of a conductor, the real part
    vec3 colour;     // albedo, or a mirror's reflectance
    vec3 absorption; // 1/m; of a conductor, the imaginary part of its index
    uint texture;    // 1 + index in scene_textures; 0: none
};

const uint MATERIAL_DIFFUSE = 0u;
const uint MATERIAL_DIELECTRIC = 1u;
const uint MATERIAL_MIRROR = 2u;
const uint MATERIAL_CONDUCTOR = 3u;

struct Light {
    uint kind;
    vec3 vector; // directional: unit direction of travel; else position
    vec3 power;  // directional: irradiance of a plane facing it, W/m^2; else intensity, W/sr (on the axis)
    uint media;  // about a light that has a place (transport.glsl)
    vec3 axis;   // spot, patch: unit
    float inner; // 1 - cosine of the half angle up to which all of the power goes; above 2: everywhere
    float outer; // 1 - cosine of the half angle beyond which none does
    uint slide;  // spot: 1 + index in scene_slides; 0: none
};

const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_PATCH = 2u; // a point of a surface that shines

layout(set = 0, binding = 0, scalar) readonly buffer SceneNodes { Node data[]; } scene_nodes;
#ifdef HAS_MESHES
layout(set = 0, binding = 1, scalar) readonly buffer SceneTriangles { Triangle data[]; } scene_triangles;
layout(set = 0, binding = 2, scalar) readonly buffer SceneNormals { TriangleNormals data[]; } scene_normals;
#endif
layout(set = 0, binding = 3, scalar) readonly buffer SceneInstances { Instance data[]; } scene_instances;
layout(set = 0, binding = 4, scalar) readonly buffer SceneMaterials { Material data[]; } scene_materials;
#ifdef HAS_TEXTURES // passes that show colours, of a scene that has any
struct Texture {
    uint first;   // in scene_texels, rows from the top
    uvec2 size;   // pixels
    vec2 repeat;  // how often it is within 0 to 1
};
layout(set = 0, binding = 25, scalar) readonly buffer SceneTextures { Texture data[]; } scene_textures;
layout(set = 0, binding = 26, scalar) readonly buffer SceneTexels { vec3 data[]; } scene_texels;
#ifdef HAS_COORDINATES // of meshes
struct TriangleCoordinates {
    vec2 a, b, c;
};
layout(set = 0, binding = 27, scalar) readonly buffer SceneCoordinates { TriangleCoordinates data[]; } scene_coordinates;
#endif
#endif
layout(set = 0, binding = 5, scalar) readonly buffer SceneLights { Light data[]; } scene_lights;

#ifdef HAS_SLIDES
// A picture that a spot projects. Products of a direction with `right` and `up`, over that with the axis, are -1 to 1 on it.
struct Slide {
    uint first; // in scene_slide_texels, rows from the top
    uvec2 size; // pixels
    vec3 right;
    vec3 up;
};
layout(set = 0, binding = 28, scalar) readonly buffer SceneSlides { Slide data[]; } scene_slides;
layout(set = 0, binding = 29, scalar) readonly buffer SceneSlideTexels { vec3 data[]; } scene_slide_texels;

// Bilinear between the middles of pixels; nothing beside the picture and behind the light.
vec3 slide_share(Slide slide, vec3 axis, vec3 d) {
    float along = dot(axis, d);
    if (!(along > 0.0)) return vec3(0.0);
    vec2 at = vec2(dot(slide.right, d), dot(slide.up, d)) / along;
    if (!(abs(at.x) <= 1.0 && abs(at.y) <= 1.0)) return vec3(0.0);
    vec2 last = vec2(slide.size - 1u);
    vec2 pixel = clamp(vec2(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y) * vec2(slide.size) - 0.5, vec2(0.0), last);
    uvec2 low = uvec2(pixel), high = min(low + 1u, slide.size - 1u);
    vec2 share = fract(pixel);
    uint upper = slide.first + low.y * slide.size.x, lower = slide.first + high.y * slide.size.x;
    vec3 above = mix(scene_slide_texels.data[upper + low.x], scene_slide_texels.data[upper + high.x], share.x);
    vec3 below = mix(scene_slide_texels.data[lower + low.x], scene_slide_texels.data[lower + high.x], share.x);
    return mix(above, below, share.y);
}
#endif

// Share of a light's power that goes along unit d: of a spot, a smooth step between its two half angles. The height
// 1 - cosine by the difference of the vectors keeps its digits in narrow beams.
float beam_share(Light light, vec3 d) {
#ifdef NO_SPOTS
    return 1.0;
#else
    vec3 beside = d - light.axis;
    float height = 0.5 * dot(beside, beside);
    if (height <= light.inner) return 1.0;
    if (!(height < light.outer)) return 0.0;
    float t = (light.outer - height) / (light.outer - light.inner);
    return t * t * (3.0 - 2.0 * t);
#endif
}

// The same of each band, by the colours of what the light projects.
vec3 light_share(Light light, vec3 d) {
#ifdef HAS_PATCHES
    if (light.kind == LIGHT_PATCH) return vec3(max(dot(light.axis, d), 0.0));
#endif
    vec3 share = vec3(beam_share(light, d));
#ifdef HAS_SLIDES
    if (light.slide != 0u && share.x > 0.0) share *= slide_share(scene_slides.data[light.slide - 1u], light.axis, d);
#endif
    return share;
}

// Classes of objects a ray asks for.
const uint MASK_DIFFUSE = 1u;
const uint MASK_SPECULAR = 2u;
const uint MASK_ALL = 3u;

uint material_mask(uint material) {
    return scene_materials.data[material].kind == MATERIAL_DIFFUSE ? MASK_DIFFUSE : MASK_SPECULAR;
}

#endif

//! The structs of `glsl/shared/scene.glsl`, field by field, in scalar layout.
use bytemuck::{Pod, Zeroable};

/// A node of a binary tree, or, in the first two of a tree, its grid: origin and cell as the bits of float32.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Node {
    /// Of the box, along x, y and z: the least corner in the low half, the greatest in the high half, in cells of the grid.
    pub corners: [u32; 3],
    /// Primitives of a leaf in the upper four bits, 0 for an inner node; below, the first of them or the first child.
    pub reference: u32,
}

/// Entries of a tree before its root.
pub const GRID_ENTRIES: u32 = 2;
/// Bits of a node's reference that hold an index.
pub const INDEX_BITS: u32 = 28;

impl Node {
    /// Primitives of a leaf; 0 for an inner node.
    pub fn count(&self) -> u32 {
        self.reference >> INDEX_BITS
    }

    /// First child, or first primitive.
    pub fn first(&self) -> u32 {
        self.reference & ((1 << INDEX_BITS) - 1)
    }
}

/// Corners in object units, or their normals.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    /// First corner; counter-clockwise from outside.
    pub a: [f32; 3],
    /// Second corner.
    pub b: [f32; 3],
    /// Third corner.
    pub c: [f32; 3],
}

/// Normals at the corners of a triangle, object space, of any length.
pub type TriangleNormals = Triangle;

/// A canonical shape under an affine map; the matrices are rows of 3×4.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Instance {
    /// World to canonical shape.
    pub to_object: [[f32; 4]; 3],
    /// Canonical shape to world, m.
    pub to_world: [[f32; 4]; 3],
    /// One of `SHAPE_*`.
    pub kind: u32,
    /// Index in [`Scene::materials`](crate::scene::Scene::materials).
    pub material: u32,
    /// Index in [`Scene::objects`](crate::scene::Scene::objects).
    pub object: u32,
    /// Of a mesh, where its tree begins in the nodes; of a cylinder or paraboloid its cut, of a sine its wave, as the bits of a float32.
    pub detail: u32,
    /// Of a sine, radians.
    pub phase: f32,
}

/// Of one object or more; a medium's identity is its index.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Material {
    /// One of `MATERIAL_*`.
    pub kind: u32,
    /// Index of refraction; 1 for what has none.
    pub ior: [f32; 3],
    /// Albedo, or a mirror's reflectance.
    pub colour: [f32; 3],
    /// 1/m
    pub absorption: [f32; 3],
    /// 1 + index of its texture; 0 for none.
    pub texture: u32,
}

/// A picture among the texels of all.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Texture {
    /// First of its texels, rows from the top.
    pub first: u32,
    /// Pixels.
    pub size: [u32; 2],
    /// How often it is within 0 to 1.
    pub repeat: [f32; 2],
}

/// Texture coordinates at the corners of a triangle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TriangleCoordinates {
    /// First corner.
    pub a: [f32; 2],
    /// Second corner.
    pub b: [f32; 2],
    /// Third corner.
    pub c: [f32; 2],
}

/// What shines.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Light {
    /// One of `LIGHT_*`.
    pub kind: u32,
    /// Directional: unit direction of travel; of others, position, m.
    pub vector: [f32; 3],
    /// Directional: W/m² on a plane facing it; point: W/sr; spot and patch: W/sr on the axis.
    pub power: [f32; 3],
    /// About a point light ([`packed_media`]).
    pub media: u32,
    /// Spot and patch: unit axis.
    pub axis: [f32; 3],
    /// 1 − cosine of the half angle up to which all of the power goes; of a light that is no spot, of all directions.
    pub inner: f32,
    /// 1 − cosine of the half angle beyond which none does.
    pub outer: f32,
    /// 1 + index of the picture that it projects; 0 for none.
    pub slide: u32,
}

/// A picture that a spot projects, among the texels of all slides.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Slide {
    /// First of its texels, rows from the top.
    pub first: u32,
    /// Pixels.
    pub size: [u32; 2],
    /// Across it to the right, over its half width a unit along the axis.
    pub right: [f32; 3],
    /// Upwards, over its half height.
    pub up: [f32; 3],
}

/// 1 − cosine beyond that of every direction.
pub const ALL_DIRECTIONS: f32 = 3.0;

/// Materials that a byte names, one value less, which means air.
pub const MOST_MATERIALS: usize = 255;

/// The media about a point by material, outermost first, in the bytes of the shaders: the innermost lowest; of more than
/// four the outermost are left out.
pub fn packed_media(outermost_first: &[usize]) -> u32 {
    outermost_first.iter().fold(u32::MAX, |media, material| media << 8 | *material as u32)
}

/// Unit sphere at the origin.
pub const SHAPE_SPHERE: u32 = 0;
/// [-1, 1]² in the xy-plane, normal +z.
pub const SHAPE_QUAD: u32 = 1;
/// Triangles under a root.
pub const SHAPE_MESH: u32 = 2;
/// [-1, 1]³.
pub const SHAPE_BOX: u32 = 3;
/// Unit disk in the xy-plane, normal +z.
pub const SHAPE_DISK: u32 = 4;
/// x² + y² = 1, z from 0 to 1, x from the cut on.
pub const SHAPE_CYLINDER: u32 = 5;
/// z = x² + y², up to 1, x from the cut on.
pub const SHAPE_PARABOLOID: u32 = 6;
/// z = sin(wave x + phase) over [-1, 1]².
pub const SHAPE_SINE: u32 = 7;

/// A receiver.
pub const MATERIAL_DIFFUSE: u32 = 0;
/// Glass, water.
pub const MATERIAL_DIELECTRIC: u32 = 1;
/// Reflects a share.
pub const MATERIAL_MIRROR: u32 = 2;
/// A mirror whose complex index stands in `ior` and `absorption`.
pub const MATERIAL_CONDUCTOR: u32 = 3;

/// Parallel light.
pub const LIGHT_DIRECTIONAL: u32 = 0;
/// Light from a point.
pub const LIGHT_POINT: u32 = 1;
/// Light from a point of a surface: it falls with the cosine to the axis.
pub const LIGHT_PATCH: u32 = 2;

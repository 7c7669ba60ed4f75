//! The structs of `glsl/shared/scene.glsl`, field by field, in scalar layout.
use bytemuck::{Pod, Zeroable};

/// A node of a binary tree: `count` 0 for an inner node with children `first` and `first + 1`, else a leaf.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Node {
    pub lo: [f32; 3],
    pub count: u32,
    pub hi: [f32; 3],
    pub first: u32,
}

/// Corners in object units, or their normals.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    pub a: [f32; 3],
    pub b: [f32; 3],
    pub c: [f32; 3],
}

/// Normals at the corners of a triangle, object space, of any length.
pub type TriangleNormals = Triangle;

/// A canonical shape under an affine map; the matrices are rows of 3×4.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Instance {
    pub to_object: [[f32; 4]; 3],
    pub to_world: [[f32; 4]; 3],
    pub kind: u32,
    pub material: u32,
    /// Index in [`Scene::objects`](crate::scene::Scene::objects).
    pub object: u32,
    /// Of a mesh, in the nodes.
    pub root: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Material {
    pub kind: u32,
    pub ior: f32,
    /// Albedo, or a mirror's reflectance.
    pub colour: [f32; 3],
    /// 1/m
    pub absorption: [f32; 3],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Light {
    pub kind: u32,
    /// Directional: unit direction of travel; point: position, m.
    pub vector: [f32; 3],
    /// Directional: W/m² on a plane facing it; point: W/sr.
    pub power: [f32; 3],
}

/// Unit sphere at the origin.
pub const SHAPE_SPHERE: u32 = 0;
/// [-1, 1]² in the xy-plane, normal +z.
pub const SHAPE_QUAD: u32 = 1;
pub const SHAPE_MESH: u32 = 2;

pub const MATERIAL_DIFFUSE: u32 = 0;
pub const MATERIAL_DIELECTRIC: u32 = 1;
pub const MATERIAL_MIRROR: u32 = 2;

pub const LIGHT_DIRECTIONAL: u32 = 0;
pub const LIGHT_POINT: u32 = 1;

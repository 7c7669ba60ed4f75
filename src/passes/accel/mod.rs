//! The scene as arrays for `glsl/shared/scene.glsl` and `bvh.glsl`: canonical shapes under affine instances, one tree
//! for each distinct mesh, one over the instances.
//!
//! Trees: binary, by obvhs 0.4 (parallel locally-ordered clustering, Meister and Bittner 2018, then reinsertion).
//! Analytic shapes stay what they are: a sphere is a unit sphere under its instance, never triangles.
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use obvhs::aabb::Aabb;

use crate::scene::{Canonical, LightKind, Material as SceneMaterial, MaterialKind, Mesh, Object, Scene, Shape};

mod error;
mod grid;
mod layout;
mod meshes;
#[cfg(test)]
mod tests;
mod textures;
mod tree;

pub use error::AccelError;
pub use layout::*;
use meshes::Meshes;
pub use meshes::{Trees, WORN};
pub use textures::Textures;
use tree::{Branch, Tree, roomy_box};

/// Levels of both trees together that the shaders' stack holds (`TRAVERSAL_STACK` in `bvh.glsl`).
pub const TRAVERSAL_STACK: usize = 64;
/// Levels of the tree over the instances.
const TOP_LEVELS: usize = 24;
/// A balanced tree over as many instances needs no more levels than that.
const MOST_INSTANCES: usize = 1 << (TOP_LEVELS - 1);
/// As far as the reference of a node goes (`bvh.glsl`).
const LARGEST_INDEX: usize = (1 << INDEX_BITS) - 1;
/// Lengths, factors and their inverses up to here can be squared, and boxes' areas summed, within float32.
const LARGEST: f64 = 1e15;

/// What the shaders read; no array is empty, since no Vulkan buffer may be.
#[derive(Clone, Debug)]
pub struct SceneArrays {
    /// The tree over the instances, then one tree for each distinct mesh.
    pub nodes: Vec<Node>,
    /// Object units, in the order of the leaves.
    pub triangles: Vec<Triangle>,
    /// Beside the triangles.
    pub normals: Vec<TriangleNormals>,
    /// Texture coordinates beside the triangles; empty where no texture is on a mesh.
    pub coordinates: Vec<TriangleCoordinates>,
    /// In the order of the leaves; an object without triangles has none.
    pub instances: Vec<Instance>,
    /// As [`Scene::materials`].
    pub materials: Vec<Material>,
    /// As [`Scene::lights`], those without a size.
    pub lights: Vec<Light>,
    /// Of the materials, the slides and the sky.
    pub textures: Arc<Textures>,
    /// What spots project; empty where none does.
    pub slides: Vec<Slide>,
}

impl SceneArrays {
    /// Builds all trees; the same scene gives the same bytes.
    pub fn build(scene: &Scene) -> Result<SceneArrays, AccelError> {
        Self::build_with(scene, &mut Trees::default())
    }

    /// As [`Self::build`], with the trees of another time of the same scene: those of meshes that keep their shape are
    /// taken as they are. Of a scene that moves, every array is as long at one time as at another, and its instances are
    /// in the order of the objects.
    pub fn build_with(scene: &Scene, trees: &mut Trees) -> Result<SceneArrays, AccelError> {
        let textures = trees.textures(scene)?;
        let shown =
            |object: &Object| matches!(object.shape, Shape::Mesh { .. }) && textures.of_material[object.material] > 0;
        let mut meshes = Meshes::new(scene.objects.iter().any(shown));
        let mut add = |object: usize, name: &str, mesh: &Arc<Mesh>| {
            meshes.add(trees, name, mesh, scene.deforms(object).then_some(object))
        };
        let placed: Vec<Placed> = scene
            .objects
            .iter()
            .enumerate()
            .filter_map(|(i, o)| place(i, o, &mut add).transpose())
            .collect::<Result<_, _>>()?;
        check_count("objects", placed.len(), MOST_INSTANCES)?;
        let dielectric = |m: &SceneMaterial| matches!(m.kind, MaterialKind::Dielectric { .. });
        let named = scene.materials.iter().rposition(dielectric).map_or(0, |last| last + 1);
        check_count("materials up to the last dielectric by name", named, MOST_MATERIALS)?;
        let boxes: Vec<Aabb> = placed.iter().map(|p| p.bounds).collect();
        let top = match boxes.len() {
            0 => nowhere(),
            _ if scene.moves() => Tree::apart(&boxes, TOP_LEVELS),
            _ => Tree::over(&boxes, TOP_LEVELS),
        };
        let base = top.entries() as u32;
        let instance = |&i: &u32| {
            let p = &placed[i as usize];
            Instance { detail: p.mesh.map_or(p.instance.detail, |m| base + meshes.all[m].root), ..p.instance }
        };
        let (slides, slide_of) = textures::thrown(scene);
        let arrays = SceneArrays {
            instances: filled(top.order.iter().filter(|&&i| (i as usize) < placed.len()).map(instance).collect()),
            nodes: top.packed(0, 0).chain(meshes.nodes(base)).collect(),
            triangles: filled(meshes.triangles),
            normals: filled(meshes.normals),
            coordinates: meshes.coordinates,
            materials: filled(
                (scene.materials.iter().zip(&textures.of_material))
                    .map(|(one, texture)| Ok(Material { texture: *texture, ..material(one)? }))
                    .collect::<Result<_, AccelError>>()?,
            ),
            lights: filled(
                (scene.lights.iter().zip(slide_of))
                    .filter(|(one, _)| !one.kind.has_area())
                    .map(|(one, slide)| Ok(Light { slide, ..light(scene, &one.name, &one.kind)? }))
                    .collect::<Result<_, AccelError>>()?,
            ),
            slides,
            textures,
        };
        check_count("nodes", arrays.nodes.len(), LARGEST_INDEX)?;
        Ok(arrays)
    }
}

/// An array with at least one element.
fn filled<T: Default>(mut array: Vec<T>) -> Vec<T> {
    if array.is_empty() {
        array.push(T::default());
    }
    array
}

/// A tree that no ray enters: one leaf beyond every t; the instance it names is filler.
fn nowhere() -> Tree {
    Tree { nodes: vec![Branch { lo: [f32::MAX; 3], count: 1, hi: [f32::MAX; 3], first: 0 }], order: vec![] }
}

fn check_count(what: &'static str, count: usize, limit: usize) -> Result<(), AccelError> {
    if count > limit { Err(AccelError::Count { what, count, limit }) } else { Ok(()) }
}

/// An instance before its place in the order is known.
struct Placed {
    instance: Instance,
    mesh: Option<usize>,
    bounds: Aabb,
}

/// None for a mesh without triangles: there is nothing to hit. `add` gives a mesh its place among the others.
fn place(
    index: usize,
    object: &Object,
    add: &mut impl FnMut(usize, &str, &Arc<Mesh>) -> Result<usize, AccelError>,
) -> Result<Option<Placed>, AccelError> {
    let name = &object.name;
    let (mut mesh, mut detail, mut phase) = (None, 0, 0.0);
    let (kind, to_world, (lo, hi)) = match &object.shape {
        Shape::Sphere { center, radius } => {
            let reach = DVec3::splat(*radius);
            let map = DAffine3::from_mat3_translation(DMat3::from_diagonal(reach), *center);
            (SHAPE_SPHERE, map, (*center - reach.abs(), *center + reach.abs()))
        }
        Shape::Quad { center, u, v } => {
            let normal = u.cross(*v);
            // A third axis of the size of the other two keeps the inverse well conditioned.
            let w = normal / normal.length().sqrt();
            let map = DAffine3::from_mat3_translation(DMat3::from_cols(*u, *v, w), *center);
            let reach = u.abs() + v.abs();
            (SHAPE_QUAD, map, (*center - reach, *center + reach))
        }
        Shape::Mesh { mesh, .. } if mesh.triangles.is_empty() => return Ok(None),
        Shape::Canonical { kind, to_world } => {
            let (kind, more, of) = canonical(kind);
            (detail, phase) = (more.to_bits(), of);
            let [lo, hi] = object.shape.bounds().unwrap_or_default();
            (kind, *to_world, (lo, hi))
        }
        Shape::Mesh { mesh: triangles, to_world } => {
            mesh = Some(add(index, name, triangles)?);
            (SHAPE_MESH, *to_world, bounds(triangles, to_world))
        }
    };
    let to_object = to_world.inverse();
    if !(to_world.is_finite() && to_object.is_finite()) {
        return Err(AccelError::Flat { name: name.clone() });
    }
    let instance = Instance {
        to_world: rows(name, "its place or size", to_world)?,
        to_object: rows(name, "the inverse of its size", to_object)?,
        kind,
        material: object.material as u32,
        object: index as u32,
        detail,
        phase,
    };
    Ok(Some(Placed { instance, mesh, bounds: roomy_box(lo, hi) }))
}

/// Its number, what more it needs to know, and its phase.
fn canonical(kind: &Canonical) -> (u32, f32, f32) {
    match *kind {
        Canonical::Box => (SHAPE_BOX, 0.0, 0.0),
        Canonical::Disk => (SHAPE_DISK, 0.0, 0.0),
        Canonical::Cylinder { cut } => (SHAPE_CYLINDER, cut as f32, 0.0),
        Canonical::Paraboloid { cut } => (SHAPE_PARABOLOID, cut as f32, 0.0),
        Canonical::Sine { wave, phase } => (SHAPE_SINE, wave as f32, phase as f32),
    }
}

/// World box of the triangles.
fn bounds(mesh: &Mesh, to_world: &DAffine3) -> (DVec3, DVec3) {
    let none = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    let corners = mesh.triangles.iter().flatten().filter_map(|&i| mesh.positions.get(i as usize));
    corners.map(|p| to_world.transform_point3(p.as_dvec3())).fold(none, |(lo, hi), p| (lo.min(p), hi.max(p)))
}

fn material(material: &SceneMaterial) -> Result<Material, AccelError> {
    let name = &material.name;
    let (kind, ior, colour, absorption) = match material.kind {
        MaterialKind::Diffuse { albedo, .. } => (MATERIAL_DIFFUSE, [1.0; 3], albedo, [0.0; 3]),
        MaterialKind::Dielectric { ior, absorption } => (MATERIAL_DIELECTRIC, ior, [1.0; 3], absorption),
        MaterialKind::Mirror { reflectance } => (MATERIAL_MIRROR, [1.0; 3], reflectance, [0.0; 3]),
        MaterialKind::Conductor { eta, k } => (MATERIAL_CONDUCTOR, eta, [1.0; 3], k),
    };
    Ok(Material {
        kind,
        ior: vector(name, "its index", ior.into())?,
        colour: vector(name, "its colour", colour.into())?,
        absorption: vector(name, "its absorption", absorption.into())?,
        texture: 0,
    })
}

/// Parallel light has no place: it comes through air. A spot is a point light with a beam. What has a size is as its middle.
pub fn light(scene: &Scene, name: &str, light: &LightKind) -> Result<Light, AccelError> {
    let (kind, at) = match light {
        LightKind::Directional { direction, .. } | LightKind::Sun { direction, .. } => (LIGHT_DIRECTIONAL, *direction),
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => (LIGHT_POINT, *position),
        LightKind::Patch { position, .. } => (LIGHT_PATCH, *position),
        LightKind::Lamp { face, .. } => (LIGHT_PATCH, face.center),
    };
    let (axis, inner, outer) = match light {
        LightKind::Spot { beam, .. } => (beam.axis, beam.inner as f32, beam.outer as f32),
        LightKind::Patch { normal, .. } => (*normal, ALL_DIRECTIONS, ALL_DIRECTIONS),
        _ => (DVec3::Y, ALL_DIRECTIONS, ALL_DIRECTIONS),
    };
    Ok(Light {
        kind,
        vector: vector(name, "its place or direction", at)?,
        power: vector(name, "its power", light.power().into())?,
        media: packed_media(&light.position().map_or(vec![], |p| scene.media_at(p))),
        axis: vector(name, "its axis", axis)?,
        inner,
        outer,
        slide: 0,
    })
}

fn rows(name: &str, what: &'static str, map: DAffine3) -> Result<[[f32; 4]; 3], AccelError> {
    let row = |k: usize| -> Result<[f32; 4], AccelError> {
        let [x, y, z] = vector(name, what, map.matrix3.row(k))?;
        Ok([x, y, z, number(name, what, map.translation[k])?])
    };
    Ok([row(0)?, row(1)?, row(2)?])
}

fn vector(name: &str, what: &'static str, v: DVec3) -> Result<[f32; 3], AccelError> {
    Ok([number(name, what, v.x)?, number(name, what, v.y)?, number(name, what, v.z)?])
}

fn number(name: &str, what: &'static str, value: f64) -> Result<f32, AccelError> {
    if value.abs() <= LARGEST {
        return Ok(value as f32);
    }
    Err(AccelError::Range { name: name.to_owned(), what, value, limit: LARGEST })
}

//! Meshes as trees over their triangles: built at their first use, kept from one time of a scene to the next, and refitted
//! or built again where a mesh is deformed, whichever the measured quality of the tree says.
use std::{collections::HashMap, sync::Arc};

use glam::Vec3;
use obvhs::aabb::Aabb;

use super::{
    AccelError, GRID_ENTRIES, LARGEST_INDEX, Node, TOP_LEVELS, TRAVERSAL_STACK, Textures, Triangle,
    TriangleCoordinates, TriangleNormals, check_count,
    tree::{Tree, most_nodes},
    vector,
};
use crate::scene::{Mesh, Scene};

/// A refitted tree is built again once a ray is expected to cost this many times what it did when the tree was built: a
/// third more boxes and triangles. The knot of `bending` (5,760 triangles) is laid out in 1.0 ms with its tree refitted and
/// in 2.5 to 3.6 ms with it built (one core); its twist of 45° a metre never wears it so far, eleven turns a metre do.
pub const WORN: f64 = 1.3;

/// The trees of a scene's meshes, at the time at which it was last laid out.
#[derive(Default)]
pub struct Trees {
    /// Of meshes that keep their shape, by address: the `Arc` keeps the address theirs.
    rigid: HashMap<*const Mesh, (Arc<Mesh>, Arc<MeshTree>)>,
    /// Of meshes that are deformed, by object.
    bent: HashMap<usize, Arc<MeshTree>>,
    /// Time does not change them.
    textures: Option<Arc<Textures>>,
    /// How often a tree was refitted, and how often built for want of quality.
    pub refitted: u64,
    /// As above.
    pub rebuilt: u64,
}

/// A mesh as the shaders read it, from its own first node and triangle on.
pub struct MeshTree {
    tree: Tree,
    /// In the order of the leaves.
    triangles: Vec<Triangle>,
    normals: Vec<TriangleNormals>,
    /// What a ray was expected to cost when the tree was built.
    built_cost: f64,
}

impl Trees {
    /// Those of the scene, made at their first use.
    pub(super) fn textures(&mut self, scene: &Scene) -> Result<Arc<Textures>, AccelError> {
        let made = self.textures.take().map_or_else(|| Textures::of(scene).map(Arc::new), Ok)?;
        self.textures = Some(made.clone());
        Ok(made)
    }

    /// The tree of a mesh that has at least one triangle; of one that its object deforms, fitted to it as it is now.
    fn of(&mut self, name: &str, mesh: &Arc<Mesh>, deformed: Option<usize>) -> Result<Arc<MeshTree>, AccelError> {
        let Some(object) = deformed else {
            if let Some((_, known)) = self.rigid.get(&Arc::as_ptr(mesh)) {
                return Ok(known.clone());
            }
            let built = Arc::new(MeshTree::build(mesh, &corners(name, mesh)?));
            self.rigid.insert(Arc::as_ptr(mesh), (mesh.clone(), built.clone()));
            return Ok(built);
        };
        let corners = corners(name, mesh)?;
        let refitted = self.bent.remove(&object).map(|old| MeshTree::refit(old, mesh, &corners));
        let fitted = match refitted {
            Some(tree) if tree.tree.cost() <= WORN * tree.built_cost => {
                self.refitted += 1;
                tree
            }
            worn => {
                self.rebuilt += u64::from(worn.is_some());
                MeshTree::build(mesh, &corners)
            }
        };
        let fitted = Arc::new(fitted);
        self.bent.insert(object, fitted.clone());
        Ok(fitted)
    }
}

impl MeshTree {
    fn build(mesh: &Mesh, corners: &[Triangle]) -> Self {
        let tree = Tree::over(&boxes(corners), TRAVERSAL_STACK - TOP_LEVELS);
        let built_cost = tree.cost();
        Self::filled(tree, built_cost, mesh, corners)
    }

    /// The same tree over the triangles where they are now.
    fn refit(old: Arc<Self>, mesh: &Mesh, corners: &[Triangle]) -> Self {
        let mut tree = Tree { nodes: old.tree.nodes.clone(), order: old.tree.order.clone() };
        tree.refit(&boxes(corners));
        Self::filled(tree, old.built_cost, mesh, corners)
    }

    fn filled(tree: Tree, built_cost: f64, mesh: &Mesh, corners: &[Triangle]) -> Self {
        let triangles = tree.order.iter().map(|&t| corners[t as usize]).collect();
        let normals = tree.order.iter().map(|&t| corner_normals(mesh, t as usize)).collect();
        Self { tree, triangles, normals, built_cost }
    }
}

/// The meshes of one layout of a scene, one after the other.
#[derive(Default)]
pub struct Meshes {
    pub all: Vec<PlacedMesh>,
    /// Of those that keep their shape: objects share a mesh through one `Arc`.
    known: HashMap<*const Mesh, usize>,
    nodes: u32,
    pub triangles: Vec<Triangle>,
    pub normals: Vec<TriangleNormals>,
    /// Whether texture coordinates are asked for.
    placed: bool,
    /// If they are, one for each triangle; zeros for a mesh that has none.
    pub coordinates: Vec<TriangleCoordinates>,
}

/// A mesh among others.
pub struct PlacedMesh {
    mesh: Arc<MeshTree>,
    /// Where its tree begins, counted from that of the first mesh.
    pub root: u32,
    /// First of its triangles.
    triangle: u32,
    /// Nodes that it may come to have.
    room: usize,
}

impl Meshes {
    /// None yet; `placed` asks for texture coordinates.
    pub fn new(placed: bool) -> Self {
        Self { placed, ..Self::default() }
    }

    /// Index of the mesh; it has at least one triangle.
    pub fn add(
        &mut self,
        trees: &mut Trees,
        name: &str,
        mesh: &Arc<Mesh>,
        deformed: Option<usize>,
    ) -> Result<usize, AccelError> {
        if let Some(&known) = self.known.get(&Arc::as_ptr(mesh)).filter(|_| deformed.is_none()) {
            return Ok(known);
        }
        check_count("triangles", self.triangles.len() + mesh.triangles.len(), LARGEST_INDEX)?;
        let tree = trees.of(name, mesh, deformed)?;
        let triangle = self.triangles.len() as u32;
        self.triangles.extend(&tree.triangles);
        self.normals.extend(&tree.normals);
        if self.placed {
            self.coordinates.extend(tree.tree.order.iter().map(|&t| corner_coordinates(mesh, t as usize)));
        }
        let room = deformed.map_or(tree.tree.entries(), |_| GRID_ENTRIES as usize + most_nodes(mesh.triangles.len()));
        self.all.push(PlacedMesh { mesh: tree, root: self.nodes, triangle, room });
        self.nodes += room as u32;
        if deformed.is_none() {
            self.known.insert(Arc::as_ptr(mesh), self.all.len() - 1);
        }
        Ok(self.all.len() - 1)
    }

    /// All nodes, moved behind `base` others; a mesh that is deformed has room for a tree of any shape.
    pub fn nodes(&self, base: u32) -> impl Iterator<Item = Node> {
        self.all.iter().flat_map(move |placed| {
            let packed = placed.mesh.tree.packed(base + placed.root, placed.triangle);
            packed.chain(std::iter::repeat(Node::default())).take(placed.room)
        })
    }
}

fn boxes(corners: &[Triangle]) -> Vec<Aabb> {
    corners.iter().map(|t| Aabb::from_points(&[t.a.into(), t.b.into(), t.c.into()])).collect()
}

fn corners(name: &str, mesh: &Mesh) -> Result<Vec<Triangle>, AccelError> {
    (0..mesh.triangles.len()).map(|t| triangle(name, mesh, t)).collect()
}

fn triangle(name: &str, mesh: &Mesh, index: usize) -> Result<Triangle, AccelError> {
    let missing = || AccelError::Vertex { name: name.to_owned(), file: mesh.file.clone(), triangle: index };
    let corner = |k: usize| -> Result<[f32; 3], AccelError> {
        let position = mesh.positions.get(mesh.triangles[index][k] as usize).ok_or_else(missing)?;
        vector(name, "a vertex", position.as_dvec3())
    };
    Ok(Triangle { a: corner(0)?, b: corner(1)?, c: corner(2)? })
}

fn corner_coordinates(mesh: &Mesh, index: usize) -> TriangleCoordinates {
    let at = |k: usize| mesh.coordinates.get(mesh.triangles[index][k] as usize).copied().unwrap_or_default().to_array();
    TriangleCoordinates { a: at(0), b: at(1), c: at(2) }
}

/// A vertex without a normal gets zero, which the shaders answer with the geometric normal.
fn corner_normals(mesh: &Mesh, index: usize) -> TriangleNormals {
    let at = |k: usize| mesh.normals.get(mesh.triangles[index][k] as usize).copied().unwrap_or(Vec3::ZERO).to_array();
    TriangleNormals { a: at(0), b: at(1), c: at(2) }
}

//! What an import leaves out, in words.
use std::collections::BTreeSet;

use crate::scene::{
    MaterialKind,
    gltf::{Body, Document, Look, READ},
};

/// Counts of what is not read, and the materials that lose something.
#[derive(Default)]
pub struct Told {
    /// Assets of a node that it leaves nothing of.
    pub flat: usize,
    /// Lights that say how far they reach.
    pub ranges: usize,
    thin: usize,
    morphs: usize,
    mended: usize,
    coloured: usize,
    skins: usize,
    animations: usize,
    extensions: BTreeSet<String>,
    materials: Vec<String>,
}

impl Told {
    pub fn of(document: &Document) -> Self {
        let json = &document.json;
        let of_nodes = json.nodes.iter().flat_map(|node| node.extensions.others.keys());
        let of_primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|p| p.extensions.keys());
        let named = json.extensions_used.iter().chain(of_nodes).chain(of_primitives);
        // Those of materials are told with the materials that have them.
        let unread = named.filter(|name| !READ.contains(&name.as_str()) && !name.starts_with("KHR_materials_"));
        Self {
            skins: json.nodes.iter().filter(|node| node.skin.is_some()).count(),
            animations: json.animations.len(),
            extensions: unread.cloned().collect(),
            ..Self::default()
        }
    }

    /// Of a mesh.
    pub fn body(&mut self, body: &Body) {
        self.thin += body.thin;
        self.morphs += usize::from(body.morphs);
        self.mended += body.mended;
        self.coloured += body.groups.iter().filter(|group| group.coloured).count();
    }

    /// Of a material, by the scene's name for it.
    pub fn material(&mut self, name: &str, look: &Look) {
        let kind = match look.kind {
            MaterialKind::Diffuse { .. } => "diffuse",
            MaterialKind::Dielectric { .. } => "a dielectric",
            MaterialKind::Mirror { .. } | MaterialKind::Conductor { .. } => "a mirror",
        };
        if !look.missing.is_empty() {
            self.materials.push(format!("`{name}` is {kind}, without {}", look.missing.join(", ")));
        }
    }

    /// One sentence each, of what is named.
    pub fn warnings(self, of: &str) -> Vec<String> {
        let count = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            more => Some(format!("{more} {many}")),
        };
        let counts = [
            count(self.thin, "primitive of points or lines is left out", "primitives of points or lines are left out"),
            count(
                self.flat,
                "mesh is scaled to nothing by its node and left out",
                "meshes are scaled to nothing by their nodes and left out",
            ),
            count(
                self.mended,
                "normal was zero: it is made from the triangles about it",
                "normals were zero: they are made from the triangles about them",
            ),
            count(
                self.coloured,
                "mesh has colours of its vertices, which are not read",
                "meshes have colours of their vertices, which are not read",
            ),
            count(self.morphs, "mesh is read without its morph targets", "meshes are read without their morph targets"),
            count(
                self.skins,
                "node is read without its skin, as its mesh stands",
                "nodes are read without their skins, as their meshes stand",
            ),
            count(self.animations, "animation is not played", "animations are not played"),
            count(
                self.ranges,
                "light is given without end: its `range` is not read",
                "lights are given without end: their `range` is not read",
            ),
        ];
        let extensions: Vec<_> = self.extensions.iter().map(|name| format!("{name:?}")).collect();
        let extensions = (!extensions.is_empty()).then(|| format!("without {}", extensions.join(", ")));
        let all = counts.into_iter().flatten().chain(extensions).chain(self.materials);
        all.map(|what| format!("{of}: {what}")).collect()
    }
}

//! A whole file as one mesh.
use std::{collections::HashMap, rc::Rc};

use super::{Body, Document, GltfFault, fault, mapped};
use crate::scene::Mesh;

impl Document {
    /// All triangles of the scene where its nodes put them; each body that was read is told.
    pub fn flattened(&self, file: &str, mut told: impl FnMut(&Body)) -> Result<Mesh, GltfFault> {
        let mut bodies = HashMap::<usize, Rc<Body>>::new();
        let mut all = Mesh { file: file.to_owned(), ..Mesh::default() };
        let mut bare = false;
        for node in self.placed()? {
            let Some(index) = self.json.nodes[node.node].mesh else { continue };
            let path = format!("nodes[{}]", node.node);
            let body = match bodies.get(&index) {
                Some(body) => body.clone(),
                None => {
                    let body = Rc::new(self.body(file, index, &format!("{path}.mesh"))?);
                    told(&body);
                    bodies.entry(index).or_insert(body).clone()
                }
            };
            for group in &body.groups {
                self.spend(&path, group.mesh.triangles.len())?;
                let mesh = mapped(&group.mesh, &node.world);
                let first = all.positions.len() as u32;
                if let Some(beyond) = mesh.positions.iter().find(|p| !p.is_finite()) {
                    let remedy = "scale the node down, or move it nearer";
                    return Err(fault(path, "coordinates of single precision", beyond.to_string(), remedy));
                }
                bare |= mesh.coordinates.is_empty();
                all.coordinates.extend(mesh.coordinates);
                all.positions.extend(mesh.positions);
                all.normals.extend(mesh.normals);
                all.triangles.extend(mesh.triangles.into_iter().map(|corners| corners.map(|k| first + k)));
            }
        }
        if all.triangles.is_empty() {
            let remedy = "check that this is the right file";
            return Err(fault("", "triangles in the nodes of the scene", "none", remedy));
        }
        if bare {
            all.coordinates.clear();
        }
        Ok(all)
    }
}

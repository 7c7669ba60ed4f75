//! The nodes of a scene, in the world.
use glam::{DAffine3, DMat4, DQuat, DVec3};

use super::{Document, EXPORT, GltfFault, fault, json::Node, named};

/// A node and where it is; in the units of the file.
pub struct Placed {
    pub node: usize,
    pub world: DAffine3,
}

/// How far a matrix's last row may be from (0, 0, 0, 1): single precision.
const AFFINE: f64 = 1e-5;

impl Document {
    /// Every node of the scene that the file names, else of its first, else of all; parents before their children.
    pub fn placed(&self) -> Result<Vec<Placed>, GltfFault> {
        let json = &self.json;
        let mut seen = vec![false; json.nodes.len()];
        let mut open: Vec<(usize, DAffine3, String)> = Vec::new();
        let mut all = Vec::new();
        for (path, root) in self.roots()?.into_iter().rev() {
            open.push((root, DAffine3::IDENTITY, path));
        }
        while let Some((node, parent, path)) = open.pop() {
            let written = named(&json.nodes, node, &path, "nodes")?;
            if std::mem::replace(&mut seen[node], true) {
                let found = format!("node {node} a second time, in two places or below itself");
                return Err(fault(path, "a tree of nodes", found, EXPORT));
            }
            let world = parent * own(node, written)?;
            if !world.is_finite() {
                let expected = "a place in the world";
                return Err(fault(format!("nodes[{node}]"), expected, "numbers without end", EXPORT));
            }
            all.push(Placed { node, world });
            let children = written.children.iter().enumerate().rev();
            open.extend(children.map(|(k, child)| (*child, world, format!("nodes[{node}].children[{k}]"))));
        }
        Ok(all)
    }

    fn roots(&self) -> Result<Vec<(String, usize)>, GltfFault> {
        let json = &self.json;
        if json.scene.is_none() && json.scenes.is_empty() {
            let mut below = vec![false; json.nodes.len()];
            for child in json.nodes.iter().flat_map(|node| &node.children) {
                below.get_mut(*child).map(|below| *below = true).unwrap_or_default();
            }
            return Ok((0..json.nodes.len()).filter(|k| !below[*k]).map(|k| ("nodes".to_owned(), k)).collect());
        }
        let index = json.scene.unwrap_or(0);
        let scene = named(&json.scenes, index, "scene", "scenes")?;
        Ok(scene.nodes.iter().enumerate().map(|(k, root)| (format!("scenes[{index}].nodes[{k}]"), *root)).collect())
    }
}

/// From the node to its parent.
fn own(index: usize, node: &Node) -> Result<DAffine3, GltfFault> {
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix);
        let row = matrix.row(3) - glam::DVec4::W;
        if row.abs().max_element() > AFFINE {
            let expected = "a matrix whose last row is 0, 0, 0, 1";
            return Err(fault(format!("nodes[{index}].matrix"), expected, matrix.row(3).to_string(), EXPORT));
        }
        return Ok(DAffine3::from_mat4(matrix));
    }
    let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
    let longest = rotation.to_array().into_iter().fold(0.0, |longest: f64, x| longest.max(x.abs()));
    let rotation = (longest > 0.0).then(|| DQuat::from_array(rotation.to_array().map(|x| x / longest)).normalize());
    let rotation = rotation
        .filter(|turn| turn.is_finite())
        .ok_or_else(|| fault(format!("nodes[{index}].rotation"), "a quaternion that is not zero", "zero", EXPORT))?;
    let [scale, translation] = [node.scale.unwrap_or([1.0; 3]), node.translation.unwrap_or([0.0; 3])];
    Ok(DAffine3::from_scale_rotation_translation(DVec3::from_array(scale), rotation, DVec3::from_array(translation)))
}

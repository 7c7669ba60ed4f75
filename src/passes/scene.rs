//! The scene's six buffers in a plan (`glsl/shared/scene.glsl`).

use super::accel::{Instance, SHAPE_MESH, SHAPE_QUAD, SHAPE_SPHERE, SceneArrays};
use crate::{
    gpu::{BufferId, Draw, Plan, Resource},
    scene::{Camera, Scene},
};

/// Vertices of the box about a sphere (`glsl/eye/gbuffer.vert`).
const BOX_VERTICES: u32 = 36;
/// Vertices of a quad.
const QUAD_VERTICES: u32 = 6;

/// The buffers, and what is drawn from them.
#[derive(Clone, Copy, Debug)]
pub struct SceneBuffers {
    nodes: BufferId,
    triangles: BufferId,
    normals: BufferId,
    instances: BufferId,
    materials: BufferId,
    lights: BufferId,
}

impl SceneBuffers {
    /// Adds them to the plan with their contents.
    pub fn upload(plan: &mut Plan, arrays: &SceneArrays) -> Self {
        Self {
            nodes: plan.upload("scene/nodes", &arrays.nodes),
            triangles: plan.upload("scene/triangles", &arrays.triangles),
            normals: plan.upload("scene/normals", &arrays.normals),
            instances: plan.upload("scene/instances", &arrays.instances),
            materials: plan.upload("scene/materials", &arrays.materials),
            lights: plan.upload("scene/lights", &arrays.lights),
        }
    }

    /// What a pass that makes surfaces from hits reads.
    pub fn surfaces(&self) -> Vec<(&'static str, Resource)> {
        vec![
            ("scene_triangles", Resource::Buffer(self.triangles)),
            ("scene_normals", Resource::Buffer(self.normals)),
            ("scene_instances", Resource::Buffer(self.instances)),
            ("scene_materials", Resource::Buffer(self.materials)),
        ]
    }

    /// What a pass that traces rays reads.
    pub fn tracing(&self) -> Vec<(&'static str, Resource)> {
        let mut all = self.surfaces();
        all.push(("scene_nodes", Resource::Buffer(self.nodes)));
        all
    }

    /// The lights.
    pub fn lights(&self) -> (&'static str, Resource) {
        ("scene_lights", Resource::Buffer(self.lights))
    }

    /// What the eye's rasteriser pulls vertices from.
    pub fn vertices(&self) -> Vec<(&'static str, Resource)> {
        vec![
            ("scene_triangles", Resource::Buffer(self.triangles)),
            ("scene_instances", Resource::Buffer(self.instances)),
        ]
    }
}

/// Draws of the instances that the camera sees.
pub fn visible_draws(scene: &Scene, camera: &Camera, arrays: &SceneArrays) -> Vec<Draw> {
    let seen = |instance: &Instance| {
        let object = scene.objects.get(instance.object as usize)?;
        let hidden = camera.hides_specular && scene.materials[object.material].is_specular();
        (object.visible_to_camera && !hidden).then_some(())
    };
    let draw = |(index, instance): (usize, &Instance)| {
        seen(instance)?;
        let (first_vertex, vertices) = match instance.kind {
            SHAPE_SPHERE => (0, BOX_VERTICES),
            SHAPE_QUAD => (0, QUAD_VERTICES),
            SHAPE_MESH => triangle_range(arrays, instance.root),
            _ => return None,
        };
        Some(Draw { vertices, first_vertex, instances: 1, first_instance: index as u32 })
    };
    if scene.objects.is_empty() {
        return Vec::new(); // the arrays then hold a filler that nothing may draw
    }
    arrays.instances.iter().enumerate().filter_map(draw).collect()
}

/// First vertex and count of the triangles below a node: a mesh's leaves lie together.
fn triangle_range(arrays: &SceneArrays, root: u32) -> (u32, u32) {
    let (mut first, mut count, mut pending) = (u32::MAX, 0, vec![root]);
    while let Some(node) = pending.pop().and_then(|n| arrays.nodes.get(n as usize)) {
        if node.count == 0 {
            pending.extend([node.first, node.first + 1]);
        } else {
            first = first.min(node.first);
            count += node.count;
        }
    }
    if count == 0 { (0, 0) } else { (3 * first, 3 * count) }
}

//! The scene's buffers in a plan (`glsl/shared/scene.glsl`).

use super::accel::{
    GRID_ENTRIES, Instance, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_DISK, SHAPE_MESH, SHAPE_PARABOLOID, SHAPE_QUAD,
    SHAPE_SINE, SHAPE_SPHERE, SceneArrays, Triangle,
};
use crate::{
    gpu::{BufferId, Draw, PassBuilder, Plan},
    scene::{Camera, LightKind, Object, Scene},
};

/// Kinds of shapes, and what is defined for shaders of a scene that has them.
const KINDS: [(u32, &str); 8] = [
    (SHAPE_SPHERE, "HAS_SPHERES"),
    (SHAPE_QUAD, "HAS_QUADS"),
    (SHAPE_MESH, "HAS_MESHES"),
    (SHAPE_BOX, "HAS_BOXES"),
    (SHAPE_DISK, "HAS_DISKS"),
    (SHAPE_CYLINDER, "HAS_CYLINDERS"),
    (SHAPE_PARABOLOID, "HAS_PARABOLOIDS"),
    (SHAPE_SINE, "HAS_SINES"),
];
/// Vertices of the box about a shape that the eye intersects itself (`glsl/eye/gbuffer.vert`).
const BOX_VERTICES: u32 = 36;
/// Vertices of a quad.
const QUAD_VERTICES: u32 = 6;

/// The buffers that the scene's shapes need.
#[derive(Clone, Debug)]
pub struct SceneBuffers {
    nodes: BufferId,
    /// Triangles and their normals, if there is a mesh.
    meshes: Option<(BufferId, BufferId)>,
    instances: BufferId,
    materials: BufferId,
    lights: Option<BufferId>,
    textures: Option<TextureBuffers>,
    /// What spots project, and its texels.
    slides: Option<(BufferId, BufferId)>,
    /// Kinds of shapes that there are.
    kinds: Vec<(u32, &'static str)>,
    has_spots: bool,
    has_patches: bool,
    is_dispersive: bool,
}

/// Of a scene with textures.
#[derive(Clone, Copy, Debug)]
struct TextureBuffers {
    textures: BufferId,
    texels: BufferId,
    /// If one is on a mesh.
    coordinates: Option<BufferId>,
}

impl SceneBuffers {
    /// Adds them to the plan with their contents.
    pub fn upload(plan: &mut Plan, scene: &Scene, arrays: &SceneArrays) -> Self {
        let any = |kind| !scene.objects.is_empty() && arrays.instances.iter().any(|i| i.kind == kind);
        let bent = (0..scene.objects.len()).any(|object| scene.deforms(object));
        let corners = |plan: &mut Plan, name: &str, items: &[Triangle]| match bent {
            true => plan.upload(name, items),
            false => plan.upload_once(name, items),
        };
        let mesh = |plan: &mut Plan| {
            let triangles = corners(plan, "scene/triangles", &arrays.triangles);
            (triangles, corners(plan, "scene/normals", &arrays.normals))
        };
        Self {
            nodes: plan.upload("scene/nodes", &arrays.nodes),
            meshes: any(SHAPE_MESH).then(|| mesh(plan)),
            instances: plan.upload("scene/instances", &arrays.instances),
            materials: plan.upload_once("scene/materials", &arrays.materials),
            lights: (!scene.lights.is_empty()).then(|| plan.upload("scene/lights", &arrays.lights)),
            textures: (!arrays.textures.all.is_empty()).then(|| TextureBuffers {
                textures: plan.upload_once("scene/textures", &arrays.textures.all),
                texels: plan.upload_shared("scene/texels", arrays.textures.texels.clone()),
                coordinates: (!arrays.coordinates.is_empty())
                    .then(|| plan.upload("scene/coordinates", &arrays.coordinates)),
            }),
            slides: (!arrays.slides.is_empty()).then(|| {
                let texels = plan.upload_shared("scene/slide-texels", arrays.textures.slides.clone());
                (plan.upload("scene/slides", &arrays.slides), texels)
            }),
            kinds: KINDS.into_iter().filter(|(kind, _)| any(*kind)).collect(),
            has_patches: scene.lights.iter().any(|l| matches!(l.kind, LightKind::Lamp { .. })),
            has_spots: scene.lights.iter().any(|l| matches!(l.kind, LightKind::Spot { .. })),
            is_dispersive: scene.is_dispersive(),
        }
    }

    /// For a pass that makes surfaces from hits.
    pub fn surfaces<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = self.shapes(pass).offer("scene_instances", self.instances).offer("scene_materials", self.materials);
        let pass = if self.is_dispersive { pass.define("DISPERSIVE", 1) } else { pass };
        match self.meshes {
            Some((triangles, normals)) => pass.offer("scene_triangles", triangles).offer("scene_normals", normals),
            None => pass,
        }
    }

    /// For a pass that traces rays, and makes surfaces of what they hit.
    pub fn tracing<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        self.surfaces(pass).offer("scene_nodes", self.nodes)
    }

    /// For a pass that shows the colours of surfaces, beside what makes them.
    pub fn colours<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let Some(TextureBuffers { textures, texels, coordinates }) = self.textures else { return pass };
        let pass = pass.define("HAS_TEXTURES", 1).read("scene_textures", textures).read("scene_texels", texels);
        match coordinates {
            Some(coordinates) => pass.define("HAS_COORDINATES", 1).read("scene_coordinates", coordinates),
            None => pass,
        }
    }

    /// For a pass that asks the lights; nothing where there are none.
    pub fn lights<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = if self.has_spots { pass } else { pass.define("NO_SPOTS", 1) };
        let pass = if self.has_patches { pass.define("HAS_PATCHES", 1) } else { pass };
        let pass = match self.slides {
            Some((slides, texels)) => {
                pass.define("HAS_SLIDES", 1).offer("scene_slides", slides).offer("scene_slide_texels", texels)
            }
            None => pass,
        };
        match self.lights {
            Some(lights) => pass.offer("scene_lights", lights),
            None => pass,
        }
    }

    /// For the eye's rasteriser, which pulls vertices.
    pub fn vertices<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        let pass = self.shapes(pass).offer("scene_instances", self.instances);
        match self.meshes {
            Some((triangles, _)) => pass.offer("scene_triangles", triangles),
            None => pass,
        }
    }

    /// Kinds of shapes that the scene lacks are not compiled.
    fn shapes<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        self.kinds.iter().fold(pass, |pass, (_, define)| pass.define(define, 1))
    }

    /// Whether the eye casts rays at any shape: at all but quads and meshes, which are rasterised as they are.
    pub(super) fn is_cast(&self) -> bool {
        self.kinds.iter().any(|(kind, _)| ![SHAPE_QUAD, SHAPE_MESH].contains(kind))
    }
}

/// Draws of the instances that the camera sees.
pub fn visible_draws(scene: &Scene, camera: &Camera, arrays: &SceneArrays) -> Vec<Draw> {
    draws(scene, arrays, |object| {
        let hidden = camera.hides_specular && scene.materials[object.material].is_specular();
        object.visible_to_camera && !hidden
    })
}

/// Draws of the instances of some objects (`glsl/eye/gbuffer.vert`).
pub fn draws(scene: &Scene, arrays: &SceneArrays, keep: impl Fn(&Object) -> bool) -> Vec<Draw> {
    let draw = |(index, instance): (usize, &Instance)| {
        scene.objects.get(instance.object as usize).filter(|object| keep(object))?;
        let (first_vertex, vertices) = match instance.kind {
            SHAPE_QUAD => (0, QUAD_VERTICES),
            SHAPE_MESH => triangle_range(arrays, instance.detail),
            _ => (0, BOX_VERTICES),
        };
        Some(Draw { vertices, first_vertex, instances: 1, first_instance: index as u32 })
    };
    if scene.objects.is_empty() {
        return Vec::new(); // the arrays then hold a filler that nothing may draw
    }
    arrays.instances.iter().enumerate().filter_map(draw).collect()
}

/// First vertex and count of the triangles of a tree: a mesh's leaves lie together.
fn triangle_range(arrays: &SceneArrays, tree: u32) -> (u32, u32) {
    let (mut first, mut count, mut pending) = (u32::MAX, 0, vec![tree + GRID_ENTRIES]);
    while let Some(node) = pending.pop().and_then(|n| arrays.nodes.get(n as usize)) {
        if node.count() == 0 {
            pending.extend([node.first(), node.first() + 1]);
        } else {
            first = first.min(node.first());
            count += node.count();
        }
    }
    if count == 0 { (0, 0) } else { (3 * first, 3 * count) }
}

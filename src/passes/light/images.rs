//! The images of a light's views that the image-space tracers read: the front of the specular objects, their back, what
//! blocks the light before them, and the receivers.
//!
//! All views share the images, which are drawn anew before each of them; views that differ in their band alone share
//! what is drawn. What is 16 bytes wide is float32, so that the images add no error of their own.

use super::{
    Emission, VIEW,
    emission::{sides, sized, view_name},
    tracer::BACK,
};
use crate::{
    gpu::{Blend, BufferId, Draw, Format, ImageId, Lifetime, PassBuilder, Phase, Plan, Resource, Topology},
    passes::{
        PlanError,
        accel::SceneArrays,
        extents,
        scene::{SceneBuffers, draws},
    },
    scene::{MaterialKind, Object, PathClass, Scene},
    settings::Settings,
    view::View,
};

/// Invocations along one side of `glsl/light/inward.comp`'s work groups.
const GROUP: u32 = 8;

/// What a tracer is planned with.
pub struct Bench<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its arrays.
    pub arrays: &'a SceneArrays,
    /// Its buffers.
    pub buffers: &'a SceneBuffers,
    /// The settings.
    pub settings: &'a Settings,
    /// The path class.
    pub class: PathClass,
    /// The emission views.
    pub emissions: &'a [Emission],
    /// The buffer of their views.
    pub views: BufferId,
    /// What the names of images and passes begin with.
    pub base: &'a str,
}

impl Bench<'_> {
    fn name(&self, of: &str) -> String {
        format!("{}/{of}", self.base)
    }

    /// The name of a pass over a view.
    fn view_name(&self, of: &str, index: usize) -> String {
        view_name(&self.name(of), self.scene, self.emissions, index)
    }
}

/// A surface in two images: position and instance, normals (`glsl/light/faces.glsl`).
#[derive(Clone, Copy)]
struct Faces {
    position: ImageId,
    normal: ImageId,
}

/// What is drawn from the light, and the tracer that reads it.
pub(super) struct Images {
    /// The file that takes the place of `far_side.glsl`.
    file: &'static str,
    /// Of each emission view: where its back and its receivers are seen from.
    views: BufferId,
    /// One for each size of view.
    sets: Vec<Set>,
    /// Of each emission view, where the tracer is `wyman2005`.
    inward: Vec<ImageId>,
}

/// The images of views of one size.
#[derive(Clone, Copy)]
struct Set {
    side: u32,
    /// Scratch of the passes that keep no depth.
    depth: ImageId,
    front: Faces,
    /// Where the class goes through a body.
    back: Option<Faces>,
    /// Where something diffuse can stand before the glass.
    blockers: Option<ImageId>,
    receivers: ImageId,
    receivers_depth: ImageId,
}

impl Set {
    fn plan(plan: &mut Plan, bench: &Bench<'_>, sides: &[u32], side: u32) -> Self {
        let mut image = |name: &str, format| {
            plan.image(&sized(&bench.name(name), sides, side), [side, side], format, Lifetime::Frame)
        };
        let mut faces = |name: &str| Faces {
            position: image(&format!("{name}.position"), Format::Rgba32f),
            normal: image(&format!("{name}.normal"), Format::Rgba32f),
        };
        let front = faces("front");
        let back = (bench.class == PathClass::Transmit2).then(|| faces("back"));
        Self {
            side,
            depth: image("depth", Format::Depth32f),
            front,
            back,
            blockers: can_block(bench).then(|| image("blockers", Format::Depth32f)),
            receivers: image("receivers", Format::Rgba32u),
            receivers_depth: image("receivers.depth", Format::Depth32f),
        }
    }
}

/// Push constants of `glsl/light/raster_view.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct RasterPush {
    size: [i32; 2],
    view: u32,
}

/// Push constants of `glsl/light/sample.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct SamplePush {
    size: [i32; 2],
    light: u32,
    view: u32,
}

impl Images {
    /// Adds the images, and the passes before the first frame.
    pub fn plan(plan: &mut Plan, bench: &Bench<'_>, tracer: &str) -> Result<Self, PlanError> {
        let views = image_views(bench, tracer)?;
        let sides = sides(bench.emissions);
        let mut images = Self {
            file: match tracer {
                "wyman2005" => "light/far_wyman2005.glsl",
                "march" => "light/far_march.glsl",
                _ => "light/far_fixed_point.glsl",
            },
            views: plan.upload(&bench.name("image_views"), &views.iter().map(View::data).collect::<Vec<_>>()),
            sets: sides.iter().map(|side| Set::plan(plan, bench, &sides, *side)).collect(),
            inward: Vec::new(),
        };
        let [back, blockers] = [bench.class == PathClass::Transmit2, can_block(bench)];
        if !back {
            plan.leave_out(&bench.name("back"), format!("light of class {} comes out of no body", bench.class));
        }
        if !blockers {
            plan.leave_out(&bench.name("blockers"), "all that is diffuse lies behind the specular objects");
        }
        if tracer == "wyman2005" && back {
            for index in 0..bench.emissions.len() {
                images.add_inward(plan, bench, index);
            }
        }
        Ok(images)
    }

    /// Those of a view.
    fn set(&self, emission: &Emission) -> &Set {
        self.sets.iter().find(|set| set.side == emission.side).unwrap_or(&self.sets[0])
    }

    /// The way against the normal, once for views that differ in their band alone.
    fn add_inward(&mut self, plan: &mut Plan, bench: &Bench<'_>, index: usize) {
        if let Some(&known) = self.inward.last().filter(|_| is_drawn(bench, index)) {
            self.inward.push(known);
            return;
        }
        let name = bench.view_name("inward", index);
        let Set { side, front, .. } = *self.set(&bench.emissions[index]);
        let image = plan.image(&name, [side; 2], Format::R32f, Lifetime::Persistent);
        self.inward.push(image);
        self.draw_front(plan, bench, Phase::Prepare, index);
        let push = SamplePush { size: [side as i32; 2], light: bench.emissions[index].lamp, view: index as u32 };
        bench
            .buffers
            .lights(bench.buffers.tracing(plan.pass(&name).phase(Phase::Prepare)))
            .read("light_views", bench.views)
            .with(front_of(front))
            .store("light_inward", image)
            .push(&push)
            .dispatch("light/inward.comp", [side.div_ceil(GROUP), side.div_ceil(GROUP), 1], GROUP * GROUP);
    }

    /// Draws what the dispatch over a view reads.
    pub fn draw(&self, plan: &mut Plan, bench: &Bench<'_>, phase: Phase, index: usize) {
        if is_drawn(bench, index) {
            return;
        }
        self.draw_front(plan, bench, phase, index);
        let set = *self.set(&bench.emissions[index]);
        if let Some(back) = set.back {
            let dielectric = |o: &Object| is_body(bench.scene, o);
            let pass = self.faces(plan, bench, "back", phase, index, (self.views, 2 * index)).define("BACK", 1);
            let pass = if bench.settings.choice(&BACK) == "farthest" { pass.define("FARTHEST", 1) } else { pass };
            draw_faces(pass.depth(set.depth, true), Some(back), draws(bench.scene, bench.arrays, dielectric));
        }
        if let Some(blockers) = set.blockers {
            let pass = self.faces(plan, bench, "blockers", phase, index, (bench.views, index));
            let pass = pass.define("DEPTH_ALONE", 1).depth(blockers, true);
            draw_faces(pass, None, draws(bench.scene, bench.arrays, |o| !is_specular(bench.scene, o)));
        }
        let name = bench.view_name("receivers", index);
        let push = RasterPush { size: [set.side as i32; 2], view: 2 * index as u32 + 1 };
        bench
            .buffers
            .vertices(plan.pass(&name).phase(phase))
            .provide("raster_view.glsl", "light/raster_view.glsl")
            .read("raster_views", self.views)
            .push(&push)
            .target(set.receivers, 0, Some([0.0; 4]), Blend::Replace)
            .depth(set.receivers_depth, true)
            .draw(
                &["eye/gbuffer.vert", "eye/gbuffer.frag"],
                Topology::Triangles,
                draws(bench.scene, bench.arrays, |o| receives(bench, &bench.emissions[index].view, o)),
            );
    }

    fn draw_front(&self, plan: &mut Plan, bench: &Bench<'_>, phase: Phase, index: usize) {
        let Set { depth, front, .. } = *self.set(&bench.emissions[index]);
        let pass = self.faces(plan, bench, "front", phase, index, (bench.views, index)).depth(depth, true);
        draw_faces(pass, Some(front), draws(bench.scene, bench.arrays, |o| is_specular(bench.scene, o)));
    }

    /// Begins a pass that draws faces from one of a list of views.
    fn faces<'p>(
        &self,
        plan: &'p mut Plan,
        bench: &Bench<'_>,
        base: &str,
        phase: Phase,
        index: usize,
        (views, view): (BufferId, usize),
    ) -> PassBuilder<'p> {
        let name = bench.view_name(base, index);
        let push = RasterPush { size: [self.set(&bench.emissions[index]).side as i32; 2], view: view as u32 };
        bench
            .buffers
            .surfaces(plan.pass(&name).phase(phase))
            .provide("raster_view.glsl", "light/raster_view.glsl")
            .read("raster_views", views)
            .push(&push)
    }

    /// Gives the tracer's dispatch over a view what it reads.
    pub fn give<'p>(&self, pass: PassBuilder<'p>, emission: &Emission, index: usize) -> PassBuilder<'p> {
        let set = self.set(emission);
        let pass = pass
            .provide("light/tracer.glsl", "light/image.glsl")
            .provide("far_side.glsl", self.file)
            .read("light_image_views", self.views)
            .with(front_of(set.front))
            .fetch("light_receivers", set.receivers)
            .fetch("light_receivers_depth", set.receivers_depth);
        let pass = match set.back {
            Some(back) => pass.fetch("light_back_position", back.position).fetch("light_back_normal", back.normal),
            None => pass,
        };
        let pass = match set.blockers {
            Some(blockers) => pass.define("BLOCKERS", 1).fetch("light_blockers", blockers),
            None => pass,
        };
        match self.inward.get(index) {
            Some(&inward) => pass.fetch("light_inward", inward),
            None => pass,
        }
    }
}

fn front_of(front: Faces) -> [(&'static str, Resource); 2] {
    [("light_front_position", front.position), ("light_front_normal", front.normal)]
        .map(|(n, i)| (n, Resource::Image(i)))
}

fn draw_faces(pass: PassBuilder<'_>, to: Option<Faces>, draws: Vec<Draw>) {
    let targets = to.into_iter().flat_map(|faces| [faces.position, faces.normal]);
    let pass = targets.fold(pass, |pass, image| pass.target(image, 0, Some([0.0; 4]), Blend::Replace));
    pass.draw(&["eye/gbuffer.vert", "light/faces.frag"], Topology::Triangles, draws);
}

fn is_specular(scene: &Scene, object: &Object) -> bool {
    scene.materials[object.material].is_specular()
}

/// Whether light goes into it.
fn is_body(scene: &Scene, object: &Object) -> bool {
    matches!(scene.materials[object.material].kind, MaterialKind::Dielectric { .. })
}

/// Whether a view is the one before it in another band: bands of one view follow each other.
fn is_drawn(bench: &Bench<'_>, index: usize) -> bool {
    matches!(bench.emissions[index].band, Some(band) if band > 0)
}

/// Whether anything diffuse may stand before a specular object: along parallel light what lies wholly behind cannot.
fn can_block(bench: &Bench<'_>) -> bool {
    let (specular, diffuse) = (extents::specular(bench.scene), extents::diffuse(bench.scene));
    bench.emissions.iter().any(|emission| {
        emission.view.perspective || diffuse.along(emission.view.forward).0 < specular.along(emission.view.forward).1
    })
}

/// Whether an object can receive what goes through the specular ones or is reflected by them: what lies wholly before
/// them would hide other receivers from the light, and gets only reflected light.
fn receives(bench: &Bench<'_>, view: &View, object: &Object) -> bool {
    let front = || extents::specular(bench.scene).along(view.forward).0;
    let behind = || extents::of_object(object).along(view.forward).1 > front();
    !is_specular(bench.scene, object) && (bench.class == PathClass::Reflect1 || behind())
}

/// Of each emission view, the views of its back and of its receivers.
///
/// The back is seen as the objects are lit, but whole, where a beam's view of them is narrower. The receivers are seen by
/// the light, all of them; from a light that has no one frustum on them, by parallel rays along its view.
fn image_views(bench: &Bench<'_>, tracer: &str) -> Result<Vec<View>, PlanError> {
    let scene = bench.scene;
    let (specular, diffuse, everything) =
        (extents::specular(scene), extents::diffuse(scene), extents::everything(scene));
    let shared = bench.settings.choice(&VIEW) == "shared";
    let mut views = Vec::new();
    for emission in bench.emissions {
        let forward = emission.view.forward;
        let parallel = |content| View::orthographic(forward, content, &everything);
        let [back, receivers] = match emission.position {
            None => [Some(View::orthographic(forward, &specular, &specular)), Some(parallel(&diffuse))],
            Some(p) => [View::perspective(p, &specular, &specular), View::perspective(p, &diffuse, &everything)],
        };
        let back = match back {
            Some(back) => back,
            None if bench.class == PathClass::Transmit2 => {
                return Err(PlanError::Refused {
                    what: format!("light.tracer={tracer} with the light '{}'", scene.lights[emission.light].name),
                    reason:
                        "no one frustum from there holds the objects, and light bent inside them would go from one \
                             view to another"
                            .into(),
                    remedy: "use light.tracer=bvh, or move the light away from them".into(),
                });
            }
            None => emission.view, // of no use to a class that comes out of no body
        };
        let receivers = if shared { emission.view } else { receivers.unwrap_or_else(|| parallel(&diffuse)) };
        views.extend([back, receivers]);
    }
    Ok(views)
}

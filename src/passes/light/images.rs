//! The images of a light's views that the image-space tracers read: the front of the specular objects, their back, what
//! blocks the light before them, and the receivers.
//!
//! All views share the images, which are drawn anew before each of them; views that differ in their band alone share
//! what is drawn, and the tiles of a view its back and its receivers. What is 16 bytes wide is float32, so that the images
//! add no error of their own.

use super::{
    Emission, LARGEST, VIEW,
    emission::{distinct, sides, sized, view_name},
    photons::SamplePush,
    tracer::{BACK, TOTAL_REFLECTION},
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
    /// One for each size of tile, or of view that is one tile.
    near: Vec<Near>,
    /// One for each size of whole view.
    far: Vec<Far>,
    /// Of each emission view, where the tracer is `wyman2005`.
    inward: Vec<ImageId>,
}

/// The images of a tile: texels of theirs are its samples.
#[derive(Clone, Copy)]
struct Near {
    side: u32,
    /// Scratch of the passes that keep no depth.
    depth: ImageId,
    front: Faces,
    /// Where something diffuse can stand before the glass.
    blockers: Option<ImageId>,
}

/// The images of a whole view, which light from any of its tiles goes through.
#[derive(Clone, Copy)]
struct Far {
    side: u32,
    depth: ImageId,
    /// Where the class goes through a body.
    back: Option<Faces>,
    /// Where light goes on inside a body: of a view that is one tile the tile's own.
    front: Option<Faces>,
    receivers: ImageId,
    receivers_depth: ImageId,
}

/// Texels a side of the images of a whole view: as many as it has photons, or as there can be.
fn far_side(emission: &Emission) -> u32 {
    emission.whole.min(LARGEST)
}

/// Adds images of one size, and those that show a surface.
fn image(plan: &mut Plan, bench: &Bench<'_>, name: &str, (sides, side): (&[u32], u32), format: Format) -> ImageId {
    plan.image(&sized(&bench.name(name), sides, side), [side, side], format, Lifetime::Frame)
}

fn faces(plan: &mut Plan, bench: &Bench<'_>, name: &str, size: (&[u32], u32)) -> Faces {
    Faces {
        position: image(plan, bench, &format!("{name}.position"), size, Format::Rgba32f),
        normal: image(plan, bench, &format!("{name}.normal"), size, Format::Rgba32f),
    }
}

impl Near {
    fn plan(plan: &mut Plan, bench: &Bench<'_>, sides: &[u32], side: u32) -> Self {
        let size = (sides, side);
        Self {
            side,
            depth: image(plan, bench, "depth", size, Format::Depth32f),
            front: faces(plan, bench, "front", size),
            blockers: can_block(bench).then(|| image(plan, bench, "blockers", size, Format::Depth32f)),
        }
    }
}

impl Far {
    fn plan(plan: &mut Plan, bench: &Bench<'_>, near: &[Near], sides: &[u32], side: u32) -> Self {
        let size = (sides, side);
        let tile = near.iter().find(|near| near.side == side);
        let depth = tile.map(|near| near.depth);
        let depth = depth.unwrap_or_else(|| image(plan, bench, "depth.whole", size, Format::Depth32f));
        let back = (bench.class == PathClass::Transmit2).then(|| faces(plan, bench, "back", size));
        let front = || tile.map_or_else(|| faces(plan, bench, "front.whole", size), |near| near.front);
        let front = (bench.settings.choice(&TOTAL_REFLECTION) == "follow").then(front);
        Self {
            side,
            depth,
            back,
            front,
            receivers: image(plan, bench, "receivers", size, Format::Rgba32u),
            receivers_depth: image(plan, bench, "receivers.depth", size, Format::Depth32f),
        }
    }
}

/// Push constants of `glsl/light/raster_view.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct RasterPush {
    size: [i32; 2],
    view: u32,
    first: [i32; 2],
    whole: i32,
}

impl RasterPush {
    /// All of a view.
    fn whole(side: u32, view: usize) -> Self {
        Self { size: [side as i32; 2], view: view as u32, first: [0; 2], whole: side as i32 }
    }

    /// The tile of an emission view in the list of those.
    fn tile(emission: &Emission, view: usize) -> Self {
        let first = emission.first.map(|n| n as i32);
        Self { first, whole: emission.whole as i32, ..Self::whole(emission.side, view) }
    }
}

impl Images {
    /// Adds the images, and the passes before the first frame.
    pub fn plan(plan: &mut Plan, bench: &Bench<'_>, tracer: &str) -> Result<Self, PlanError> {
        let views = image_views(bench, tracer)?;
        let (near, far) = (sides(bench.emissions), distinct(bench.emissions.iter().map(far_side)));
        let near: Vec<_> = near.iter().map(|&side| Near::plan(plan, bench, &near, side)).collect();
        let mut images = Self {
            file: match tracer {
                "wyman2005" => "light/far_wyman2005.glsl",
                "march" => "light/far_march.glsl",
                _ => "light/far_fixed_point.glsl",
            },
            views: plan.upload(&bench.name("image_views"), &views.iter().map(View::data).collect::<Vec<_>>()),
            far: far.iter().map(|&side| Far::plan(plan, bench, &near, &far, side)).collect(),
            near,
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

    /// Those of a tile.
    fn near(&self, emission: &Emission) -> &Near {
        self.near.iter().find(|near| near.side == emission.side).unwrap_or(&self.near[0])
    }

    /// Those of its view.
    fn far(&self, emission: &Emission) -> &Far {
        self.far.iter().find(|far| far.side == far_side(emission)).unwrap_or(&self.far[0])
    }

    /// The way against the normal, once for views that differ in their band alone.
    fn add_inward(&mut self, plan: &mut Plan, bench: &Bench<'_>, index: usize) {
        if let Some(&known) = self.inward.last().filter(|_| is_drawn(bench, index)) {
            self.inward.push(known);
            return;
        }
        let name = bench.view_name("inward", index);
        let Near { side, front, .. } = *self.near(&bench.emissions[index]);
        let image = plan.image(&name, [side; 2], Format::R32f, Lifetime::Persistent);
        self.inward.push(image);
        self.draw_front(plan, bench, Phase::Prepare, index);
        let push = SamplePush::of(&bench.emissions[index], index);
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
        let emission = &bench.emissions[index];
        if emission.begins_view() {
            self.draw_far(plan, bench, phase, index);
        }
        self.draw_front(plan, bench, phase, index);
        if let Some(blockers) = self.near(emission).blockers {
            let push = RasterPush::tile(emission, index);
            let pass = self.faces(plan, bench, "blockers", phase, index, (bench.views, push));
            let pass = pass.define("DEPTH_ALONE", 1).depth(blockers, true);
            draw_faces(pass, None, draws(bench.scene, bench.arrays, |o| !is_specular(bench.scene, o)));
        }
    }

    /// What all tiles of a view share.
    fn draw_far(&self, plan: &mut Plan, bench: &Bench<'_>, phase: Phase, index: usize) {
        let emission = &bench.emissions[index];
        let far = *self.far(emission);
        if let Some(back) = far.back {
            let dielectric = |o: &Object| is_body(bench.scene, o);
            let push = RasterPush::whole(far.side, 2 * index);
            let pass = self.faces(plan, bench, "back", phase, index, (self.views, push)).define("BACK", 1);
            let pass = if bench.settings.choice(&BACK) == "farthest" { pass.define("FARTHEST", 1) } else { pass };
            draw_faces(pass.depth(far.depth, true), Some(back), draws(bench.scene, bench.arrays, dielectric));
        }
        if let Some(front) = far.front.filter(|_| far.side != emission.side) {
            let push = RasterPush::whole(far.side, index);
            let pass = self.faces(plan, bench, "front.whole", phase, index, (bench.views, push)).depth(far.depth, true);
            draw_faces(pass, Some(front), draws(bench.scene, bench.arrays, |o| is_specular(bench.scene, o)));
        }
        let name = bench.view_name("receivers", index);
        let push = RasterPush::whole(far.side, 2 * index + 1);
        bench
            .buffers
            .vertices(plan.pass(&name).phase(phase))
            .provide("raster_view.glsl", "light/raster_view.glsl")
            .read("raster_views", self.views)
            .push(&push)
            .target(far.receivers, 0, Some([0.0; 4]), Blend::Replace)
            .depth(far.receivers_depth, true)
            .draw(
                &["eye/gbuffer.vert", "eye/gbuffer.frag"],
                Topology::Triangles,
                draws(bench.scene, bench.arrays, |o| receives(bench, &emission.view, o)),
            );
    }

    fn draw_front(&self, plan: &mut Plan, bench: &Bench<'_>, phase: Phase, index: usize) {
        let emission = &bench.emissions[index];
        let Near { depth, front, .. } = *self.near(emission);
        let push = RasterPush::tile(emission, index);
        let pass = self.faces(plan, bench, "front", phase, index, (bench.views, push)).depth(depth, true);
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
        (views, push): (BufferId, RasterPush),
    ) -> PassBuilder<'p> {
        let name = bench.view_name(base, index);
        bench
            .buffers
            .surfaces(plan.pass(&name).phase(phase))
            .provide("raster_view.glsl", "light/raster_view.glsl")
            .read("raster_views", views)
            .push(&push)
    }

    /// Gives the tracer's dispatch over a view what it reads.
    pub fn give<'p>(&self, pass: PassBuilder<'p>, emission: &Emission, index: usize) -> PassBuilder<'p> {
        let (near, far) = (self.near(emission), self.far(emission));
        let pass = pass
            .provide("light/tracer.glsl", "light/image.glsl")
            .provide("far_side.glsl", self.file)
            .read("light_image_views", self.views)
            .with(front_of(near.front))
            .fetch("light_receivers", far.receivers)
            .fetch("light_receivers_depth", far.receivers_depth);
        let pass = match far.back {
            Some(back) => pass.fetch("light_back_position", back.position).fetch("light_back_normal", back.normal),
            None => pass,
        };
        let pass = match near.blockers {
            Some(blockers) => pass.define("BLOCKERS", 1).fetch("light_blockers", blockers),
            None => pass,
        };
        let pass = match far.front {
            Some(front) => {
                pass.fetch("light_whole_front_position", front.position).fetch("light_whole_front_normal", front.normal)
            }
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

//! Variant `inverse`: for each point of a receiver all places of the water that light it, in W/m².
//!
//! Ours; the paper's wish, a "full Monte Carlo simulation … entirely on graphics hardware", without the Monte Carlo. Rays of each
//! light go on below the water from the corners of a grid of cells, the sheet's own where it is made of triangles; above the cells
//! stand levels of bounds on where their rays land, at any depth. A point goes down through the bounds to the cells that may
//! light it, and inverts each triangle of rays at its own depth: rays between corners are linear, so that what Newton's method
//! would find is one division away. Differs from a caustic map: nothing is projected, so any receiver at any depth is lit.

use glam::DVec3;

use super::{super::LeftOut, shade, suns, with};
use crate::{
    gpu::{BufferId, Lifetime, PassBuilder, Phase},
    passes::{
        PlanError, Work, accel,
        eye::{self, SurfaceProvider},
        light,
        water::{self, Water},
    },
    scene::{LightKind, PathClass, Scene},
    settings::{Settings, Whole},
};

/// Cells of rays.
pub static CELLS: Whole = Whole {
    key: "waves.cells",
    unit: "cells",
    default: 256,
    range: 1..=4096,
    doc: "with waves.variant = inverse, cells of rays along the water's longer side, at least; water of triangles has its own, or \
          whole parts of them",
};

/// A sun's disc up to this half angle, rad, is one kernel: its rays are linear in the direction to 1e-3 of its width. A wider one
/// is taken apart.
const DISC: f64 = 0.035;
/// Eye samples of a pixel along an axis beyond which llvmpipe may end its loops: it allows 65 536 steps in all. The paper's wave,
/// seen straight on, loses 15 % of its light by 8, none by 4; through water fewer are too many, which is counted.
const SAMPLES_MOST: u32 = 4;
/// Invocations along one side of work groups.
const GROUP: u32 = 8;
/// Bytes of `WaterRay` without bands, and of a band without and with a disc (`glsl/waves/inverse.glsl`).
const RAY_BYTES: u64 = 24;
const BAND_BYTES: [u64; 2] = [8, 24];
/// Invocations of work groups of one row, and bytes of `LeftRow` (`glsl/waves/inverse_left.comp`).
const ROWS: u32 = 64;
const LEFT_BYTES: u64 = 8;
/// Bytes of `WaterBounds`.
const BOUNDS_BYTES: u64 = 32;
/// The largest buffer that every device binds.
const BUFFER_MOST: u64 = 1 << 27;

/// Why a scene with water shows nothing.
const NO_LIGHT: &str = "there is no light with any power";

/// `WaterLight` of the shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct WaterLight {
    light: accel::Light,
    radius: f32,
    x: [f32; 3],
    y: [f32; 3],
    depths: [f32; 2],
    attenuation: [f32; 3],
}

/// What its stages share.
struct Inverse {
    water: Water,
    grid: Grid,
    defines: Vec<(&'static str, String)>,
    lights: BufferId,
    rays: BufferId,
    bounds: BufferId,
}

/// Adds the variant's buffers and stages; what fills the slot, if there is water.
///
/// # Errors
/// Where no buffer holds the rays.
pub fn plan(work: &mut Work<'_>) -> Result<Option<(SurfaceProvider, LeftOut)>, PlanError> {
    let Some(water) = Water::as_traced(work.plan, work.scene) else { return Ok(None) };
    let inverse = Inverse::plan(work, water)?;
    inverse.stages(work);
    let left_out = inverse.left_out(work);
    Ok(Some((inverse.provider(work.scene), left_out)))
}

impl Inverse {
    fn plan(work: &mut Work<'_>, water: Water) -> Result<Self, PlanError> {
        let lights = lights(work, &water)?;
        let bands: u64 = if work.scene.is_dispersive() { 3 } else { 1 };
        let discs = lights.iter().any(|light| light.radius > 0.0);
        let grid = Grid::of(&water, work.settings.whole(&CELLS), lights.len() as u64);
        let each = RAY_BYTES + bands * BAND_BYTES[usize::from(discs)];
        grid.check(each)?;
        let mut defines = grid.defines();
        if bands > 1 {
            defines = with(defines, "INVERSE_BANDS", bands as u32);
        }
        if discs {
            defines = with(defines, "DISCS", 1);
        }
        Ok(Self {
            rays: work.plan.buffer("waves/rays", grid.corners() * each, Lifetime::Frame),
            bounds: work.plan.buffer("waves/bounds", grid.bounds() * BOUNDS_BYTES, Lifetime::Frame),
            lights: work.plan.upload("waves/lights", &lights),
            water,
            grid,
            defines,
        })
    }

    fn give<'p>(&self, pass: PassBuilder<'p>) -> PassBuilder<'p> {
        self.water.provide(pass).defines(&self.defines).offer("water_lights", self.lights)
    }

    fn stages(&self, work: &mut Work<'_>) {
        let groups =
            |[x, y]: [u64; 2]| [(x as u32).div_ceil(GROUP), (y as u32).div_ceil(GROUP), self.grid.lights as u32];
        let pass = self.give(work.buffers.lights(work.plan.pass("waves/rays"))).write("water_rays", self.rays);
        let shades = shade::shades(work.scene, &self.water);
        let pass = if shades { work.buffers.tracing(pass).define("SHADED", 1) } else { pass };
        pass.dispatch("waves/inverse_rays.comp", groups(self.grid.cells.map(|n| n + 1)), GROUP * GROUP);
        for (level, size) in self.grid.levels.iter().enumerate() {
            let pass = self.give(work.plan.pass(&format!("waves/bounds.{level}"))).write("water_bounds", self.bounds);
            let pass = if level == 0 { pass.define("OF_CELLS", 1) } else { pass };
            let pass = pass.offer("water_rays", self.rays).push(&(level as i32));
            pass.dispatch("waves/inverse_bounds.comp", groups(*size), GROUP * GROUP);
        }
    }

    /// The pass that counts the triangles that light nothing, outside the timed frames.
    fn left_out(&self, work: &mut Work<'_>) -> LeftOut {
        let rows = self.grid.lights * self.grid.cells[1];
        let buffer = work.plan.buffer("waves/left", rows * LEFT_BYTES, Lifetime::Persistent);
        self.give(work.plan.pass("waves/left"))
            .phase(Phase::Account)
            .read("water_rays", self.rays)
            .write("water_left", buffer)
            .dispatch("waves/inverse_left.comp", [(rows as u32).div_ceil(ROWS), 1, 1], ROWS);
        LeftOut { buffer, pieces: 2 * rows * self.grid.cells[0] }
    }

    fn provider(&self, scene: &Scene) -> SurfaceProvider {
        let (mut defines, mut offers) = self.water.parts();
        defines.extend(self.defines.iter().cloned());
        defines.push(("SEARCHES", String::new()));
        if let Some(mask) = shade::blocks(scene, &self.water) {
            defines.push(("BLOCKED", mask.to_owned()));
        }
        offers.extend([("water_rays", self.rays), ("water_bounds", self.bounds), ("water_lights", self.lights)]);
        SurfaceProvider { file: "waves/inverse_surface.glsl", defines, reads: Vec::new(), offers }
    }
}

/// Why there is nothing to light; of a scene that moves, lights may have power later.
pub fn nothing(scene: &Scene) -> Option<&'static str> {
    (is_dark(scene) && !scene.moves()).then_some(NO_LIGHT)
}

fn is_dark(scene: &Scene) -> bool {
    scene.lights.iter().all(|light| light.kind.power() == [0.0; 3])
}

/// What its picture does not show.
pub fn warnings(scene: &Scene, settings: &Settings) -> Vec<String> {
    let dry = water::waters(scene).next().is_none().then_some(suns::NO_WATER);
    if let Some(reason) = dry.or(is_dark(scene).then_some(NO_LIGHT)) {
        return vec![format!("waves show nothing: {reason}")];
    }
    let mut all = Vec::new();
    let class = light::paths(scene, settings);
    if class != PathClass::Transmit1 {
        all.push(format!(
            "waves.variant=inverse finds the light that one water refracts once (transmit-1); of {class} it shows no other"
        ));
    }
    if let Some(name) = water::waters(scene).nth(1).map(|other| &scene.objects[other].name) {
        all.push(format!("waves know one water; '{name}' stands in the way of its light and makes none"));
    }
    if settings.whole(&eye::SAMPLES) > SAMPLES_MOST {
        all.push(format!(
            "waves.variant=inverse has the mean of a pixel from one eye sample; set eye.samples to 1 (at most {SAMPLES_MOST}): some \
             devices end what a pixel takes too long for, and lose its light"
        ));
    }
    all
}

/// The scene's lights: a sun as one, with its disc; what else has a size, in parts.
fn lights(work: &Work<'_>, water: &Water) -> Result<Vec<WaterLight>, PlanError> {
    let parts = work.settings.whole(&light::AREA_SAMPLES);
    let depths = shade::depths(work.scene, water).map(|depth| depth as f32);
    let attenuation = suns::attenuation(work.scene, water, work.settings).as_vec3().to_array();
    let mut all = Vec::new();
    // Those without a size, in their order; they alone know their slides.
    let mut plain = work.arrays.lights.iter();
    for light in &work.scene.lights {
        let (kinds, radius) = match light.kind {
            LightKind::Sun { radius, .. } if radius <= DISC => (vec![light.kind.clone()], radius),
            _ => (light.kind.samples(parts), 0.0),
        };
        let own = if light.kind.has_area() { None } else { plain.next() };
        for kind in kinds {
            let from = own.copied().map_or_else(|| accel::light(work.scene, &light.name, &kind), Ok)?;
            all.push(WaterLight { depths, attenuation, ..water_light(from, &kind, radius) });
        }
    }
    Ok(all)
}

fn water_light(light: accel::Light, kind: &LightKind, radius: f64) -> WaterLight {
    let (x, y) = match kind {
        LightKind::Sun { direction, .. } => {
            let x = direction.any_orthonormal_vector();
            (x, direction.cross(x))
        }
        _ => Default::default(),
    };
    let [x, y] = [x, y].map(|axis: DVec3| axis.as_vec3().to_array());
    WaterLight { light, radius: radius as f32, x, y, depths: [0.0; 2], attenuation: [0.0; 3] }
}

/// Cells of rays and the levels of bounds above them.
struct Grid {
    cells: [u64; 2],
    /// Sizes, the cells first, one node last.
    levels: Vec<[u64; 2]>,
    lights: u64,
}

impl Grid {
    /// The water's own cells, each in as many parts as make `least` along the longer side.
    fn of(water: &Water, least: u32, lights: u64) -> Self {
        let least = u64::from(least);
        let cells = match water.cells {
            Some(own) => {
                let own = own.map(|n| n as u64);
                own.map(|n| n * least.div_ceil(own[0].max(own[1])))
            }
            None => {
                let edges = [water.frame.u.length(), water.frame.v.length()];
                let longest = edges[0].max(edges[1]);
                edges.map(|edge| ((least as f64 * edge / longest).round() as u64).max(1))
            }
        };
        let halved = |size: &[u64; 2]| (*size != [1, 1]).then(|| size.map(|n| n.div_ceil(2)));
        Self { cells, levels: std::iter::successors(Some(cells), halved).collect(), lights }
    }

    fn corners(&self) -> u64 {
        self.lights * self.cells.iter().map(|n| n + 1).product::<u64>()
    }

    fn nodes(&self) -> impl Iterator<Item = u64> {
        self.levels.iter().map(|[x, y]| x * y)
    }

    fn bounds(&self) -> u64 {
        self.lights * self.nodes().sum::<u64>()
    }

    fn defines(&self) -> Vec<(&'static str, String)> {
        let offsets = self.nodes().scan(0, |next, nodes| Some(std::mem::replace(next, *next + nodes)));
        vec![
            ("ACROSS", format!("{}u", self.cells[0])),
            ("ALONG", format!("{}u", self.cells[1])),
            ("LIGHTS", format!("{}u", self.lights)),
            ("LEVELS", self.levels.len().to_string()),
            ("OFFSETS", offsets.map(|offset| format!("{offset}u")).collect::<Vec<_>>().join(",")),
            ("BOUNDS_ALL", format!("{}u", self.nodes().sum::<u64>())),
        ]
    }

    fn check(&self, each: u64) -> Result<(), PlanError> {
        let most = (self.corners() * each).max(self.bounds() * BOUNDS_BYTES);
        if most <= BUFFER_MOST {
            return Ok(());
        }
        let [across, along] = self.cells;
        Err(PlanError::Refused {
            what: format!("waves.variant=inverse with {across} x {along} cells and {} lights", self.lights),
            reason: format!("their rays take {} MiB, and a buffer of 128 MiB does not hold so many", most >> 20),
            remedy: "lower waves.cells, light.area_samples, or the `grid` of the water".into(),
        })
    }
}

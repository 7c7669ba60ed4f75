//! Stages that find the water's light once a frame, whatever is seen of it: on the vertices of a fine mesh, or in a target of
//! fixed resolution with its mip maps.

use super::{ANISOTROPY, FILTER, MESH, SIDE, Sky, with};
use crate::{
    gpu::{Format, ImageId, Lifetime, Resource},
    passes::{Work, eye::SurfaceProvider},
    settings::Settings,
};

/// Invocations along one side of work groups.
const GROUP: u32 = 8;

/// Push constants of `glsl/waves/grid.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct GridPush {
    side: i32,
    level: i32,
}

fn groups(side: u32) -> [u32; 3] {
    [side.div_ceil(GROUP), side.div_ceil(GROUP), 1]
}

/// Colours and heights of a mesh's vertices.
pub struct Mesh {
    cells: u32,
    vertices: ImageId,
}

impl Mesh {
    /// Adds its image and its stage.
    pub fn plan(work: &mut Work<'_>, sky: &Sky) -> Self {
        let cells = work.settings.whole(&MESH);
        let vertices = work.plan.image("waves/vertices", [cells + 1; 2], Format::Rgba32f, Lifetime::Frame);
        sky.give(work.plan.pass("waves/vertices"))
            .store("waves_vertices", vertices)
            .push(&GridPush { side: cells as i32, level: 0 })
            .dispatch("waves/vertices.comp", groups(cells + 1), GROUP * GROUP);
        Self { cells, vertices }
    }

    /// What looks it up.
    pub fn provider(&self, sky: &Sky) -> SurfaceProvider {
        let provider = sky.provider_of("waves/vertex.glsl", ("waves_vertices", Resource::Image(self.vertices)));
        SurfaceProvider { defines: with(provider.defines, "WAVES_MESH", self.cells), ..provider }
    }
}

/// The target of fixed resolution, all its levels in one image (`glsl/waves/atlas.glsl`).
pub struct Target {
    side: u32,
    image: ImageId,
}

impl Target {
    /// Adds its image and its stages, one a level.
    pub fn plan(work: &mut Work<'_>, sky: &Sky) -> Self {
        let side = work.settings.whole(&SIDE);
        let image = work.plan.image("waves/texture", [side + side.div_ceil(2), side], Format::Rgba32f, Lifetime::Frame);
        sky.give(work.plan.pass("waves/texture"))
            .store("waves_texture", image)
            .push(&GridPush { side: side as i32, level: 0 })
            .dispatch("waves/texture.comp", groups(side), GROUP * GROUP);
        for level in 1..levels(side) {
            work.plan
                .pass(&format!("waves/texture.{level}"))
                .store("waves_texture", image)
                .push(&GridPush { side: side as i32, level: level as i32 })
                .dispatch("waves/mips.comp", groups(side >> level), GROUP * GROUP);
        }
        Self { side, image }
    }

    /// What looks it up.
    pub fn provider(&self, sky: &Sky, settings: &Settings) -> SurfaceProvider {
        let provider = sky.provider_of("waves/texture.glsl", ("waves_texture", Resource::Image(self.image)));
        let defines = with(provider.defines, "WAVES_SIDE", self.side);
        let defines = with(defines, "WAVES_LEVELS", levels(self.side));
        let cubic = settings.choice(&FILTER) == "cubic";
        let defines = if cubic { with(defines, "WAVES_CUBIC", 1) } else { defines };
        SurfaceProvider { defines: with(defines, "WAVES_ANISOTROPY", settings.whole(&ANISOTROPY)), ..provider }
    }
}

/// Levels of a target, down to one texel.
fn levels(side: u32) -> u32 {
    side.ilog2() + 1
}

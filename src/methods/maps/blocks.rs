//! Emission in blocks, as splats ask for it: what their map tells of how dense photons must be.

use super::{Axes, Job, Splats};
use crate::{
    passes::{PlanError, light::Column, refused},
    settings::{Settings, Whole},
};

pub static BLOCKS: Whole = Whole {
    key: "maps.blocks",
    unit: "levels",
    default: 0,
    range: 0..=5,
    doc: "with maps.splat = fixed or elliptic, photons of blocks of 2^levels x 2^levels of the light's samples: as many in each as \
          its light needs, from one to all of them (adaptive emission); 0: light.side everywhere. With light.tracer = bvh",
};

/// Levels in force.
pub fn levels(settings: &Settings) -> u32 {
    settings.whole(&BLOCKS)
}

/// Columns that choosing needs.
pub fn columns(settings: &Settings) -> &'static [Column] {
    if levels(settings) > 0 { &[Column::Hit, Column::Flux, Column::Way] } else { &[] }
}

/// What blocks are of no use to.
///
/// # Errors
/// Axes that do not go with them.
pub fn check(settings: &Settings, axes: Axes<'_>) -> Result<(), PlanError> {
    if levels(settings) == 0 {
        return Ok(());
    }
    let (with, reason, remedy) = match axes {
        Axes { splat: "cells", .. } => (
            "maps.splat=cells".to_owned(),
            "cells have corners in common with their neighbours, and are traced finer by maps.adapt",
            "set maps.splat=fixed or elliptic, or maps.adapt in the place of maps.blocks",
        ),
        Axes { splat: splat @ ("varying" | "thin-lens" | "interpolated"), .. } => (
            format!("maps.splat={splat}"),
            "its splats are sized by photons one slot apart",
            "set maps.splat=fixed or elliptic",
        ),
        Axes { merge: merge @ ("last" | "all"), .. } => (
            format!("maps.merge={merge}"),
            "it takes photons of a cluster to be alike, one a slot",
            "set maps.merge=none or exact",
        ),
        Axes { traverse, .. } if traverse != "compute" => (
            format!("maps.traverse={traverse}"),
            "it is a column of the paper, whose photons are one a slot",
            "set maps.traverse=compute",
        ),
        _ => return Ok(()),
    };
    let what = format!("maps.blocks={} with {with}", levels(settings));
    refused(what, reason, remedy)
}

/// Texels that photons of a block may lie apart at most, and where light breaks: what a splat and a pixel of a picture of
/// the whole map blur together, in standard deviations.
///
/// Gaussians two deviations apart are even to 2 exp(-pi^2 / 2), 1.4 %. At an edge each photon is in or out: there fixed
/// splats err by a photon's flux, and ellipses, as wide as photons lie apart, blur it.
pub fn apart(job: &Job<'_>, splats: Splats) -> [f32; 2] {
    const APART: f32 = 2.0;
    const LEAST: f32 = 2.0; // an ellipse's diameter, as in `glsl/maps/elliptic.glsl`
    let (diameter, edge) = if splats.is_elliptic() { (LEAST, 0.3) } else { (splats.diameter() as f32, 2.0 / 3.0) };
    let pixel = splats.side as f32 / job.work.size[0].min(job.work.size[1]).max(1) as f32;
    let most = APART * (diameter * diameter / 16.0 + pixel * pixel / 12.0).sqrt();
    [most, edge * most]
}

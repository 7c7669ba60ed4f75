//! The corners of an emission view's texels, traced as their centres are: what lies between four of them is a cell of light.
//!
//! They are the centres of the texels of a view that is half a texel wider on every side, so that every tracer takes them
//! as it takes others.

use super::{Bench, Column, Emission, Photons, Tracer, Tracing, photons, sides, sized, view_name};
use crate::{
    gpu::{BufferId, Phase, Plan},
    passes::PlanError,
    view::View,
};

/// What the names of their images and passes begin with.
const BASE: &str = "light/corners";

/// The corners of all views, planned.
pub struct Corners {
    emissions: Vec<Emission>,
    views: BufferId,
    tracer: Tracer,
    /// Their photons, for each size of view.
    photons: Vec<Photons>,
}

impl Corners {
    /// Adds the buffers that all views share, and what the tracer needs.
    pub fn plan(plan: &mut Plan, bench: &Bench<'_>, columns: &[Column]) -> Result<Self, PlanError> {
        let wider =
            |e: &Emission| Emission { view: wider(e.view, e.whole), side: e.side + 1, whole: e.whole + 1, ..*e };
        let emissions: Vec<_> = bench.emissions.iter().map(wider).collect();
        let views = plan.upload("light/corners.views", &emissions.iter().map(|e| e.view.data()).collect::<Vec<_>>());
        let sides = sides(&emissions);
        let each = |&side: &u32| Photons::beside(plan, bench, &sized(BASE, &sides, side), side, columns);
        let photons = sides.iter().map(each).collect();
        let tracer = Tracer::plan(plan, &bench_of(bench, &emissions, views))?;
        Ok(Self { emissions, views, tracer, photons })
    }

    /// The corners of a view of so many texels a side: one more.
    pub fn photons(&self, side: u32) -> &Photons {
        self.photons.iter().find(|photons| photons.side == side + 1).unwrap_or(&self.photons[0])
    }

    /// Adds the passes that trace those of one view.
    pub fn trace(&self, plan: &mut Plan, bench: &Bench<'_>, index: usize) {
        let own = bench_of(bench, &self.emissions, self.views);
        self.tracer.images(plan, &own, Phase::Frame, index);
        let tracing = Tracing {
            scene: bench.buffers,
            views: self.views,
            tracer: &self.tracer,
            class: bench.class,
            photons: self.photons(bench.emissions[index].side),
            emission: &self.emissions[index],
            index,
            blocks: None,
        };
        photons(plan, &view_name(BASE, bench.scene, bench.emissions, index), &tracing);
    }
}

fn bench_of<'a>(bench: &Bench<'a>, emissions: &'a [Emission], views: BufferId) -> Bench<'a> {
    Bench { emissions, views, base: BASE, ..*bench }
}

/// Wider by half a texel on each side.
fn wider(view: View, side: u32) -> View {
    let half = 0.5 * (view.high - view.low) / f64::from(side);
    View { low: view.low - half, high: view.high + half, ..view }
}

#![doc = include_str!("README.md")]
//! Based on: C. Wyman, *Hierarchical Caustic Maps*, I3D 2008. Differs: exact tracer, own receiving view, weights that
//! sum to one, sums in fixed point; its own columns are presets (`maps.gather`).

mod axes;
mod blocks;
mod cells;
mod copied;
mod finer;
mod hierarchy;
mod large;
mod points;
mod pyramid;
mod sparse;
mod splats;
mod sums;
mod unused;
mod views;
mod windows;

use axes::{Axes, GATHER, MERGE, SPLAT, TARGET, TRAVERSE};
use blocks::BLOCKS;
use cells::Cells;
use copied::{COPY, Vertices};
use finer::{ADAPT, ENOUGH, MOST};
use hierarchy::Hierarchy;
use large::{Large, RASTER_FROM};
use points::Points;
use splats::{FOOTPRINT, LEVEL, LEVEL_THRESHOLD, Splats, Told};
use sums::Fixed;

use super::{Link, Method, Outcome, Planned, Provided, Shown, Slot};
use crate::{
    gpu::{Blend, BufferId, Draw, Feature, Format, ImageId, Lifetime, PassBuilder, Resource, Topology},
    passes::{
        PlanError, Work,
        eye::SurfaceProvider,
        light::{self, Column, Job, Measure, Photons, Taker, Wanted},
    },
    scene::Scene,
    settings::{Choice, Real, Setting, Settings, Whole},
};

/// Texels along each side of the caustic map.
pub static SIDE: Whole = Whole {
    key: "maps.side",
    unit: "texels",
    default: 512,
    range: 1..=16384,
    doc: "texels along each side of the caustic map",
};

static SPLAT_SIZE: Whole = Whole {
    key: "maps.splat_size",
    unit: "texels",
    default: 3,
    range: 1..=63,
    doc: "diameter of a photon's Gaussian splat; its standard deviation is a quarter of it",
};

static TOP: Whole = Whole {
    key: "maps.top",
    unit: "texels",
    default: 16,
    range: 1..=1024,
    doc: "with maps.traverse = hierarchical, or compute where photons merge, texels along a side of the level that it starts \
          from, at most",
};

static SPREAD: Real = Real {
    key: "maps.spread",
    unit: "",
    default: Some(4.0),
    range: 0.0..=8.0,
    doc: "with maps.merge = exact, how far photons of a cluster may land from each other, along rows or columns of the map, in \
          standard deviations of a splat (a quarter of maps.splat_size)",
};

static CULL: Choice = Choice {
    key: "maps.cull",
    default: "clip",
    words: &["clip", "geometry"],
    doc: "with maps.traverse = fetch, where photons that are none end: clip: outside the view; geometry: in a geometry shader",
};

static RECEIVERS: Choice = Choice {
    key: "maps.receivers",
    default: "all",
    words: &["all", "quads", "region"],
    doc: "what holds light that the camera may see: quads: a layer of the map for each diffuse quad; all: windows in further \
          layers for other diffuse shapes and the backs of quads, too; region: a layer for the region's receiver alone",
};

static BIND: Choice = Choice {
    key: "maps.bind",
    default: "none",
    words: &["none", "receiver"],
    doc: "with light.view = shared: none: a layer for each light, whose light falls on all that lies under a texel, as in the \
          paper; receiver: for each light, each receiver and each side of it, which holds its light and no one else's",
};

static SETTINGS: &[Setting] = &[
    Setting::Whole(&SIDE),
    Setting::Choice(&GATHER),
    Setting::Choice(&TRAVERSE),
    Setting::Choice(&MERGE),
    Setting::Choice(&SPLAT),
    Setting::Choice(&TARGET),
    Setting::Whole(&SPLAT_SIZE),
    Setting::Whole(&RASTER_FROM),
    Setting::Choice(&FOOTPRINT),
    Setting::Real(&LEVEL_THRESHOLD),
    Setting::Choice(&LEVEL),
    Setting::Whole(&TOP),
    Setting::Real(&SPREAD),
    Setting::Choice(&CULL),
    Setting::Choice(&COPY),
    Setting::Choice(&RECEIVERS),
    Setting::Choice(&BIND),
    Setting::Whole(&ADAPT),
    Setting::Whole(&MOST),
    Setting::Real(&ENOUGH),
    Setting::Whole(&BLOCKS),
];

static CHAIN: &[Link] = &[
    Link { shown: Shown::AllPaths, step: "", moved_by: &[] },
    Link { shown: Shown::PathClass, step: "path class", moved_by: &["light.paths"] },
    Link {
        shown: Shown::Landings,
        step: "tracer",
        moved_by: &[
            "light.tracer",
            "light.view",
            "light.back",
            "light.total_reflection",
            "light.layers",
            "light.area_samples",
        ],
    },
    Link {
        shown: Shown::Fine,
        step: "reconstruction",
        moved_by: &[
            "maps.side",
            "maps.splat_size",
            "maps.raster_from",
            "maps.gather",
            "maps.traverse",
            "maps.merge",
            "maps.splat",
            "maps.target",
            "maps.footprint",
            "maps.level_threshold",
            "maps.level",
            "maps.top",
            "maps.spread",
            "maps.cull",
            "maps.copy",
            "maps.receivers",
            "maps.bind",
            "maps.adapt",
            "maps.adapt_most",
            "maps.adapt_error",
            "maps.blocks",
            "light.tile",
            "eye.samples",
        ],
    },
    Link { shown: Shown::AsAsked, step: "light.side", moved_by: &["light.side"] },
];

/// Hierarchical caustic maps.
pub struct Maps;

impl Method for Maps {
    fn name(&self) -> &'static str {
        "maps"
    }

    fn title(&self) -> &'static str {
        "photons splatted into a caustic map that is projected on the receivers"
    }

    fn paper(&self) -> &'static str {
        "C. Wyman, Hierarchical Caustic Maps, I3D 2008"
    }

    fn slots(&self) -> &'static [Slot] {
        &[Slot::Surface]
    }

    fn warnings(&self, shown: &Outcome<'_>) -> Vec<String> {
        sparse::warning(shown).into_iter().collect()
    }

    fn needs(&self, settings: &Settings) -> Vec<Feature> {
        let mut needs = vec![Feature::Float32Blend, Feature::LargePoints];
        let axes = Axes::asked(settings);
        if axes.streams() {
            needs.extend([Feature::GeometryShader, Feature::TransformFeedback]);
        } else if culls(settings, axes) {
            needs.push(Feature::GeometryShader);
        }
        needs
    }

    fn settings(&self) -> &'static [Setting] {
        SETTINGS
    }

    fn decided(&self, settings: &Settings, scene: &Scene) -> Vec<(&'static str, String)> {
        Axes::of(settings, scene).pairs()
    }

    fn shoots(&self) -> bool {
        true
    }

    fn hangs_on_device(&self, settings: &Settings, scene: &Scene) -> bool {
        large::hangs_on_device(settings, Axes::of(settings, scene))
    }

    fn stages(&self) -> &'static [&'static str] {
        &["light/photons", "maps/gather", "maps/resolve", "light/account"]
    }

    fn chain(&self) -> &'static [Link] {
        CHAIN
    }

    fn plan(&self, work: &mut Work<'_>) -> Result<Planned, PlanError> {
        let settings = work.settings;
        let wanted = Wanted {
            columns: columns(settings, work.scene),
            halves: copied::halves(settings),
            blocks: blocks::levels(settings),
        };
        Ok(Planned::of(light::shoot(work, &wanted, PlannedMaps::begin)?, PlannedMaps::provide))
    }
}

/// The photon columns that are read, as set.
fn columns(settings: &Settings, scene: &Scene) -> Vec<Column> {
    let axes = Axes::of(settings, scene);
    let own = if axes.splat == "cells" { cells::COLUMNS } else { Splats::of(axes, settings).columns() };
    [own, blocks::columns(settings)].concat()
}

/// Whether a geometry shader discards what is no photon, as a traversal does by itself.
fn culls(settings: &Settings, axes: Axes<'_>) -> bool {
    axes.traverse == "fetch"
        && !["interpolated", "elliptic"].contains(&axes.splat)
        && settings.choice(&CULL) == "geometry"
}

struct PlannedMaps {
    splats: Splats,
    /// One, but for splats of several sizes.
    maps: Vec<ImageId>,
    views: BufferId,
    cells: Option<Cells>,
    fixed: Option<Fixed>,
    vertices: Option<Vertices>,
    /// One for each size of view, where photons are traversed so.
    hierarchies: Vec<Hierarchy>,
    /// The same, where a dispatch merges them.
    points: Vec<Points>,
    /// The same, where large splats are drawn.
    large: Vec<Large>,
    /// Of blocks' photons.
    apart: [f32; 2],
    culls: bool,
    drawn: bool,
}

impl PlannedMaps {
    /// Images and buffers that all views share.
    fn begin(job: &mut Job<'_>) -> Result<Self, PlanError> {
        let axes = Axes::checked(job.work.settings, job.work.scene)?;
        blocks::check(job.work.settings, axes)?;
        let side = job.work.settings.whole(&SIDE);
        let views = views::receiving(job, axes, side, job.work.settings.whole(&SPLAT_SIZE));
        let splats = Splats::of(axes, job.work.settings);
        let layers = views::layers(&views, splats.levels())?;
        if let Some(reason) = Axes::why_no_cells(job.work.settings, job.work.scene) {
            job.work.plan.leave_out("maps/cells", reason);
        }
        let views = job.work.plan.upload("maps/views", &views);
        let fixed = sums::fixed(job, axes, side, layers);
        cells::check(axes, &fixed, (side, layers))?;
        let cells = Cells::plan(job, axes, side, views)?;
        let mut map =
            |name: &&str| job.work.plan.image_array(name, [side, side], layers, Format::Rgba32f, Lifetime::Frame);
        Ok(Self {
            splats,
            maps: splats.maps().iter().map(&mut map).collect(),
            views,
            cells,
            vertices: Vertices::plan(job),
            points: Points::plan(job, axes, &fixed)?,
            large: Large::plan(job, axes, &fixed),
            fixed,
            hierarchies: Hierarchy::plan(job, axes),
            apart: blocks::apart(job, splats),
            culls: culls(job.work.settings, axes),
            drawn: false,
        })
    }

    /// What it offers to the eye.
    fn provide(&self) -> Provided {
        let maps = ["maps_map", "maps_map_1", "maps_map_2", "maps_map_3"].into_iter().zip(&self.maps);
        let reads = maps.map(|(name, &map)| (name, Resource::Image(map))).chain([self.views()]).collect();
        let surface =
            SurfaceProvider { file: "maps/surface.glsl", defines: self.splats.defines(), reads, offers: Vec::new() };
        Provided {
            surface: Some(surface),
            deposits: self.maps[..1].to_vec(),
            tally: self.cells.as_ref().map(Cells::counted),
            ..Provided::default()
        }
    }

    fn views(&self) -> (&'static str, Resource) {
        ("maps_views", Resource::Buffer(self.views))
    }

    fn hierarchy(&self, photons: &Photons) -> Option<&Hierarchy> {
        self.hierarchies.iter().find(|hierarchy| hierarchy.pyramid.side == photons.side)
    }

    /// Ends a pass over the photons of a view with points.
    fn draw(&self, photons: &Photons, pass: PassBuilder<'_>) {
        let (n, layers) = (photons.side, photons.layers());
        let points = |vertices, instances| vec![Draw { vertices, first_vertex: 0, instances, first_instance: 0 }];
        if let Some(vertices) = &self.vertices {
            let pass = vertices.attributes().into_iter().fold(pass, |pass, (b, format)| pass.attribute(b, format));
            let all = points((n * n).saturating_mul(layers), 1);
            return pass.draw(&["maps/gather_copy.vert", "maps/splat.frag"], Topology::Points, all);
        }
        let pass = pass.with(photons.fetch(self.splats.columns()));
        if let Some(hierarchy) = self.hierarchy(photons) {
            return hierarchy.draw(pass, &["maps/gather_stream.vert", "maps/splat.frag"]);
        }
        let all = points(n, n * layers);
        if self.culls {
            let shaders = ["maps/gather_fetch.vert", "maps/cull.geom", "maps/splat.frag"];
            return pass.define("CULL", 1).draw(&shaders, Topology::Points, all);
        }
        pass.draw(&["maps/gather_fetch.vert", "maps/splat.frag"], Topology::Points, all);
    }
}

impl Taker for PlannedMaps {
    fn capture(&self) -> (&'static str, Vec<(&'static str, Resource)>) {
        ("maps/capture.glsl", vec![self.views()])
    }

    fn measure(&self) -> Measure {
        Measure {
            file: "maps/measure.glsl",
            reads: vec![self.views()],
            side: self.splats.side as f32,
            apart: self.apart,
        }
    }

    fn gather(&mut self, job: &mut Job<'_>, view: usize, name_of: &dyn Fn(&str) -> String) {
        if let (Some(cells), Some(fixed)) = (&self.cells, &self.fixed) {
            cells.gather(job, fixed, view, name_of);
            if view + 1 == job.emissions.len() {
                cells.tally(job, fixed, job.work.plan.image_decl(self.maps[0]).layers);
                fixed.resolve(job, self.maps[0], self.splats.side, false);
            }
            return;
        }
        if let Some(vertices) = &self.vertices {
            vertices.fill(job, &name_of("maps/copy"));
        }
        let light = job.emissions[view].lamp;
        if let Some(hierarchy) = self.hierarchy(job.photons) {
            hierarchy.traverse(job, light, self.views, name_of);
        }
        let points = self.points.iter().find(|points| points.pyramid.side == job.photons.side);
        if let Some(points) = points {
            points.count(job, view, self.views, name_of);
        }
        let told = Told::of(job, view);
        let first = !std::mem::replace(&mut self.drawn, true);
        for (at, &map) in self.maps.iter().enumerate() {
            let number = if self.maps.len() > 1 { format!(".{at}") } else { String::new() };
            let name = name_of(&format!("maps/gather{number}"));
            let photons = job.photons;
            let pass = photons.define(job.work.plan.pass(&name)).with([self.views()]);
            let pass = self.splats.tell(told, at, pass);
            let clear = first.then_some([0.0; 4]);
            let Some(fixed) = &self.fixed else {
                self.draw(photons, pass.target_layers(map, clear, Blend::Add));
                continue;
            };
            let large = self.large.iter().find(|large| large.side == photons.side);
            let pass = pass.with(photons.fetch(self.splats.columns()));
            let pass = large.into_iter().fold(pass, |pass, large| large.mark(pass));
            match points {
                Some(points) => points.gather(fixed, pass, view),
                None => fixed.gather(pass, [photons.side, photons.layers()]),
            }
            if let Some(large) = large {
                large.count(job, points, view as u32, &name_of("maps/large"));
                let pass = photons.define(job.work.plan.pass(&name_of("maps/gather.large"))).with([self.views()]);
                let pass = self.splats.tell(told, at, pass).with(photons.fetch(self.splats.columns()));
                large.draw(pass.target_layers(map, clear, Blend::Add), points, view as u32);
            }
            if view + 1 == job.emissions.len() {
                fixed.resolve(job, map, self.splats.side, large.is_some());
            }
        }
    }
}

//! `nephroid.plan/1`: what a frame runs and holds, and what it leaves out.

use serde::Serialize;
use serde_json::{Map, Value};

use super::{Cell, Report, Table, provenance::in_force, render_report::method_name};
use crate::{
    gpu::{BufferDecl, Groups, ImageDecl, Lifetime, PassDecl, Phase, Plan, Work},
    renderer::Job,
};

/// The very list that is recorded.
#[derive(Debug, Serialize)]
pub struct PlanReport {
    schema: &'static str,
    scene: String,
    method: String,
    camera: String,
    size: [u32; 2],
    /// Every setting with the value in force.
    settings: Map<String, Value>,
    /// Along each axis of a pixel.
    #[serde(skip)]
    samples: u32,
    passes: Vec<PassRow>,
    resources: Vec<ResourceRow>,
    left_out: Vec<LeftOutRow>,
    resource_bytes: u64,
}

#[derive(Debug, Serialize)]
struct PassRow {
    name: String,
    phase: &'static str,
    kind: &'static str,
    shaders: Vec<String>,
    /// Work groups, or pixels of the first target.
    extent: [u32; 3],
    /// Invocations a work group; 0 for draws.
    local: u32,
    draws: usize,
    /// Over all draws and instances.
    vertices: u64,
    bytes_written: u64,
}

#[derive(Debug, Serialize)]
struct ResourceRow {
    name: String,
    kind: &'static str,
    /// Texels and array layers; null for a buffer.
    extent: Option<[u32; 3]>,
    format: Option<&'static str>,
    bytes: u64,
    lifetime: &'static str,
}

#[derive(Debug, Serialize)]
struct LeftOutRow {
    name: String,
    reason: String,
}

impl PlanReport {
    /// From a job and its plan.
    pub fn new(job: &Job, plan: &Plan) -> Self {
        let phases = [Phase::Prepare, Phase::Frame, Phase::Account];
        let of_phase = |phase| plan.passes.iter().filter(move |p| p.phase == phase);
        let images = plan.images.iter().map(ResourceRow::of_image);
        let staging = (plan.staging_bytes() > 0).then(|| ResourceRow::staging(plan.staging_bytes()));
        let left_out = plan.left_out.iter().map(|l| LeftOutRow { name: l.name.clone(), reason: l.reason.clone() });
        Self {
            schema: "nephroid.plan/1",
            scene: job.scene.name.clone(),
            method: method_name(&job.providers),
            camera: job.camera.clone(),
            size: job.size,
            settings: in_force(job),
            samples: job.eye_samples(),
            passes: phases.into_iter().flat_map(of_phase).map(|p| PassRow::new(plan, p)).collect(),
            resources: images.chain(plan.buffers.iter().map(ResourceRow::of_buffer)).chain(staging).collect(),
            left_out: left_out.collect(),
            resource_bytes: plan.bytes(),
        }
    }
}

impl PassRow {
    fn new(plan: &Plan, pass: &PassDecl) -> Self {
        let phase = match pass.phase {
            Phase::Prepare => "prepare",
            Phase::Frame => "frame",
            Phase::Account => "account",
        };
        let (kind, shaders, extent, local, draws) = match &pass.work {
            Work::Compute { shader, groups, local } => {
                let (kind, groups) = match groups {
                    Groups::Fixed(groups) => ("compute", *groups),
                    Groups::Counted(_) => ("counted", [0; 3]),
                };
                (kind, std::slice::from_ref(shader), groups, *local, [].as_slice())
            }
            Work::Copy { copies } => {
                let [width, height] = copies.first().map_or([0, 0], |(from, _)| plan.image_extent(*from));
                ("copy", [].as_slice(), [width, height, 1], 0, [].as_slice())
            }
            Work::Raster { shaders, targets, depth, draws, counted, drawn, .. } => {
                let target = targets.first().map(|t| t.image).or(depth.as_ref().map(|d| d.image));
                let [width, height] = target.map_or([0, 0], |t| plan.image_extent(t));
                let kind = match (drawn, counted) {
                    (Some(_), _) => "stream",
                    (_, Some(_)) => "counted raster",
                    _ => "raster",
                };
                (kind, shaders.as_slice(), [width, height, 1], 0, draws.as_slice())
            }
        };
        Self {
            name: pass.name.clone(),
            phase,
            kind,
            shaders: shaders.to_vec(),
            extent,
            local,
            draws: draws.len(),
            vertices: draws.iter().map(|d| u64::from(d.vertices) * u64::from(d.instances)).sum(),
            bytes_written: plan.bytes_written(pass),
        }
    }

    fn work(&self) -> String {
        let [x, y, z] = self.extent;
        match (self.kind, self.draws) {
            ("compute", _) => format!("{x}x{y}x{z} groups of {}", self.local),
            ("counted", _) => format!("as many groups of {} as are counted", self.local),
            ("counted raster", _) => format!("{x}x{y}, 1 draw of what is counted"),
            ("copy", _) => format!("{x}x{y} to buffers"),
            ("stream", _) => format!("{x}x{y}, 1 draw of the stream"),
            (_, 1) => format!("{x}x{y}, 1 draw of {} vertices", self.vertices),
            (_, n) => format!("{x}x{y}, {n} draws of {} vertices", self.vertices),
        }
    }
}

impl ResourceRow {
    fn of_image(image: &ImageDecl) -> Self {
        Self {
            name: image.name.clone(),
            kind: "image",
            extent: Some([image.extent[0], image.extent[1], image.layers]),
            format: Some(image.format.glsl()),
            bytes: image.bytes(),
            lifetime: lifetime(image.lifetime),
        }
    }

    fn of_buffer(buffer: &BufferDecl) -> Self {
        Self {
            name: buffer.name.clone(),
            kind: "buffer",
            extent: None,
            format: None,
            bytes: buffer.bytes,
            lifetime: lifetime(buffer.lifetime),
        }
    }

    /// The mapped memory through which the contents of a scene that moves change.
    fn staging(bytes: u64) -> Self {
        let name = "staging".to_owned();
        Self { name, kind: "memory", extent: None, format: None, bytes, lifetime: lifetime(Lifetime::Frame) }
    }

    fn extent_text(&self) -> String {
        match self.extent {
            Some([x, y, 1]) => format!("{x}x{y}"),
            Some([x, y, layers]) => format!("{x}x{y}, {layers} layers"),
            None => "-".to_owned(),
        }
    }
}

fn lifetime(lifetime: Lifetime) -> &'static str {
    match lifetime {
        Lifetime::Persistent => "persistent",
        Lifetime::Frame => "frame",
    }
}

impl Report for PlanReport {
    fn heading(&self) -> Vec<String> {
        let [width, height] = self.size;
        let (scene, method, camera, k) = (&self.scene, &self.method, &self.camera, self.samples);
        vec![format!("{scene}, method {method}, camera {camera}, {width}x{height} pixels of {k}x{k} samples")]
    }

    fn tables(&self) -> Vec<Table> {
        let passes = self.passes.iter().map(|p| {
            vec![Cell::text(&p.name), Cell::text(p.phase), Cell::text(p.work()), Cell::Count(p.bytes_written)]
        });
        let resources = self.resources.iter().map(|r| {
            vec![
                Cell::text(&r.name),
                Cell::text(r.extent_text()),
                Cell::text(r.format.unwrap_or(r.kind)),
                Cell::Count(r.bytes),
                Cell::text(r.lifetime),
            ]
        });
        let left_out = self.left_out.iter().map(|l| vec![Cell::text(&l.name), Cell::text(&l.reason)]);
        let columns = vec!["resource", "extent", "format", "bytes", "lifetime"];
        vec![
            Table { name: "passes", columns: vec!["pass", "phase", "work", "target bytes"], rows: passes.collect() },
            Table { name: "resources", columns, rows: resources.collect() },
            Table { name: "left out", columns: vec!["left out", "because"], rows: left_out.collect() },
        ]
    }

    fn notes(&self) -> Vec<String> {
        vec![format!("resources: {} bytes in all, before a device pads its images", self.resource_bytes)]
    }
}

//! Traverse `copy` (Wyman and Davis 2006): the photon image becomes a vertex buffer, from which N² points are drawn.
//!
//! Where both sides have the same bits the device copies (`vkCmdCopyImageToBuffer`). It never converts, and a blit
//! converts between images only: from 16 to 32 bits a compute pass reads the image and writes the buffer, once.

use super::{Axes, Column, Job};
use crate::{
    gpu::{BufferId, Format, Lifetime},
    settings::{Choice, Settings},
};

/// Invocations along one side of work groups.
const GROUP: u32 = 8;

pub static COPY: Choice = Choice {
    key: "maps.copy",
    default: "32-32",
    words: &["32-32", "16-32", "16-16"],
    doc: "with maps.traverse = copy, bits of a photon image's channel and of the vertex buffer's; 16-32 converts, as in 2006",
};

/// Whether photons are traced into float16.
pub fn halves(settings: &Settings) -> bool {
    Axes::asked(settings).traverse == "copy" && settings.choice(&COPY) != "32-32"
}

/// The photons as vertices: two attributes, in the order of the photon image's layers and rows.
pub struct Vertices {
    hit: BufferId,
    flux: BufferId,
    format: Format,
    converts: bool,
}

impl Vertices {
    /// The buffers, which all views share; `None` where nothing is copied.
    pub fn plan(job: &mut Job<'_>) -> Option<Self> {
        if Axes::asked(job.work.settings).traverse != "copy" {
            return None;
        }
        let (format, converts) = match job.work.settings.choice(&COPY) {
            "16-16" => (Format::Rgba16f, false),
            "16-32" => (Format::Rgba32f, true),
            _ => (Format::Rgba32f, false),
        };
        let bytes = u64::from(job.photons.side).pow(2) * u64::from(job.photons.layers()) * format.bytes();
        let mut buffer = |name| job.work.plan.buffer(name, bytes, Lifetime::Frame);
        Some(Self { hit: buffer("maps/vertices.hit"), flux: buffer("maps/vertices.flux"), format, converts })
    }

    /// Fills them from the photon image: a pass of its own, timed apart from the draw.
    pub fn fill(&self, job: &mut Job<'_>, name: &str) {
        let pairs = [(Column::Hit, self.hit), (Column::Flux, self.flux)];
        let images = pairs.into_iter().filter_map(|(column, to)| Some((job.photons.column(column)?, to)));
        let copies: Vec<_> = images.collect();
        let pass = job.work.plan.pass(name);
        if !self.converts {
            return pass.copy(copies);
        }
        let side = job.photons.side.div_ceil(GROUP);
        let pass = job.photons.define(pass).with(job.photons.fetch(&[Column::Hit, Column::Flux]));
        pass.write("maps_vertices_hit", self.hit).write("maps_vertices_flux", self.flux).dispatch(
            "maps/copy_convert.comp",
            [side, side, job.photons.layers()],
            GROUP * GROUP,
        );
    }

    /// What the vertex shader reads, by location.
    pub fn attributes(&self) -> [(BufferId, Format); 2] {
        [(self.hit, self.format), (self.flux, self.format)]
    }
}

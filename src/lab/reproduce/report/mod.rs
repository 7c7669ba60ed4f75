//! `nephroid.reproduce/1`: published beside measured, and the shape of both.

mod catalogue;
mod row;
mod shape;

use serde::Serialize;
use serde_json::{Map, Value};

use super::{
    Extent, columns,
    measure::{Measured, Run},
    strip::strip,
};
use crate::{
    image::to_png,
    lab::{
        Cell, DeviceRow, Format, LabError, Report, Table,
        papers::{Figure, Published},
    },
    whole::OutFolder,
};
use row::{Row, cells, short};
use shape::{Shape, gains, shape};

pub use catalogue::CatalogueReport;

/// Light that arrived with one variant at one N, where photons brought it.
#[derive(Clone, Debug, Serialize)]
struct Arrived {
    variant: String,
    n: u32,
    valid_photons: Option<f64>,
    valid_flux: Option<f64>,
    settings: Map<String, Value>,
}

/// A published table beside its run.
#[derive(Clone, Debug, Serialize)]
pub struct ReproduceReport {
    schema: &'static str,
    id: String,
    paper: String,
    platform: String,
    quick: bool,
    /// Those that stand in for the paper's.
    scene: Option<String>,
    deviations: Vec<&'static str>,
    device: Option<DeviceRow>,
    size: Option<[u32; 2]>,
    /// Timed frames behind each measured figure.
    repeats: Option<u32>,
    reference: Option<String>,
    /// In force for the first variant at the smallest N; what each other one sets stands beside its photons.
    settings: Map<String, Value>,
    photons: Vec<Arrived>,
    rows: Vec<Row>,
    shape: Vec<Shape>,
    /// What the paper's steps gain.
    gains: Vec<Shape>,
    warnings: Vec<String>,
    version: &'static str,
    commit: &'static str,
    #[serde(skip)]
    pictures: Vec<(String, Measured)>,
}

impl ReproduceReport {
    /// Of a table that nothing here can run.
    pub fn unrun(published: &Published, extent: &Extent) -> Self {
        let why = |figure: &Figure| columns::asked(published, figure).err();
        Self {
            schema: "nephroid.reproduce/1",
            id: published.id.clone(),
            paper: published.paper.clone(),
            platform: published.platform.clone(),
            quick: extent.quick,
            scene: None,
            deviations: Vec::new(),
            device: None,
            size: None,
            repeats: None,
            reference: None,
            settings: Map::new(),
            photons: Vec::new(),
            rows: published.figures.iter().map(|f| Row::missing(published, f, why(f))).collect(),
            shape: Vec::new(),
            gains: Vec::new(),
            warnings: Vec::new(),
            version: env!("CARGO_PKG_VERSION"),
            commit: env!("NEPHROID_COMMIT"),
            pictures: Vec::new(),
        }
    }

    pub(super) fn measured(published: &Published, extent: &Extent, run: Run) -> Self {
        let rows = published.figures.iter().map(|figure| Row::of(published, figure, &run)).collect();
        let (shape, gains) = (shape(published, &run), gains(published, &run));
        let first = run.all.first();
        let mut warnings = run.warnings.clone();
        let device = first.map(|m| m.provenance.device().clone());
        if device.as_ref().is_some_and(|device| device.software) {
            warnings.push("a software device: its times say how cost grows, not what a GPU takes".to_owned());
        }
        if extent.quick {
            warnings.push(format!(
                "--quick: N up to {}, {} frames: leave it out for the whole",
                extent.most_side, extent.rounds
            ));
        }
        Self {
            scene: first.map(|_| each(&run, |m| vec![m.variant.subject.scene()]).join(", ")),
            deviations: each(&run, |m| m.variant.subject.deviations()),
            device,
            size: Some(extent.size),
            repeats: Some(run.timed.rounds()),
            reference: Some(run.reference.clone()).filter(|file| !file.is_empty()),
            settings: first.map(|m| m.provenance.settings().clone()).unwrap_or_default(),
            photons: run.all.iter().map(Arrived::of).collect(),
            rows,
            shape,
            gains,
            warnings,
            pictures: run.all.into_iter().map(|m| (file_of(&m), m)).collect(),
            ..Self::unrun(published, extent)
        }
    }

    /// Writes `ID.json`, a picture of each variant and N, and `ID.svg`, where they stand side by side.
    pub fn write_files(&self, folder: &mut OutFolder) -> Result<(), LabError> {
        let json = self.write(Format::Json);
        folder.write(&format!("{}.json", self.id), |out| std::io::Write::write_all(out, &json?))?;
        for (file, m) in &self.pictures {
            let png = to_png(&m.layers, "radiance", m.exposure_ev, &m.provenance.attributes())?;
            folder.write(file, |out| std::io::Write::write_all(out, &png))?;
        }
        if let Some(strip) = strip(&self.id, &self.pictures) {
            folder.write(&format!("{}.svg", self.id), |out| std::io::Write::write_all(out, strip.as_bytes()))?;
        }
        Ok(())
    }
}

/// What the measured say, each once.
fn each(run: &Run, say: fn(&Measured) -> Vec<&'static str>) -> Vec<&'static str> {
    let mut said = Vec::new();
    run.all.iter().flat_map(say).for_each(|text| {
        if !said.contains(&text) {
            said.push(text);
        }
    });
    said
}

fn file_of(m: &Measured) -> String {
    format!("{}-{}.png", m.variant.name().replace(", ", "-").replace(' ', "-"), m.side)
}

impl Arrived {
    fn of(m: &Measured) -> Self {
        let [valid_photons, valid_flux] = [0, 1].map(|at| m.valid.map(|valid| valid[at]));
        let set = m.variant.set(m.side).into_iter().map(|(key, value)| (key, value.into()));
        Self { variant: m.variant.name(), n: m.side, valid_photons, valid_flux, settings: set.collect() }
    }
}

impl Report for ReproduceReport {
    fn heading(&self) -> Vec<String> {
        let mut lines = vec![format!("{}: {}", self.id, self.paper), format!("published: {}", self.platform)];
        if let (Some(scene), Some(device), Some([w, h]), Some(n)) = (&self.scene, &self.device, self.size, self.repeats)
        {
            let software = if device.software { ", a software device" } else { "" };
            lines.push(format!("here: {scene}, {w}x{h} pixels, {n} frames each, on {}{software}", device.name));
        }
        lines.extend(self.deviations.iter().map(|text| format!("differs: {text}")));
        lines
    }

    fn tables(&self) -> Vec<Table> {
        let rows = self.rows.iter().map(|r| {
            let [measured, interval] = cells(r.measured.as_ref());
            let ratio = r.ratio.map_or(Cell::None, |ratio| Cell::text(short(ratio)));
            let [relmse, _] = cells(r.relmse.as_ref());
            let [fitted, _] = cells(r.relmse_fitted.as_ref());
            let scale = r.scale.map_or(Cell::None, |scale| Cell::text(short(scale)));
            let kept = r.kept.map_or(Cell::None, |kept| Cell::Real(kept, 4));
            let points = r.points.map_or(Cell::None, Cell::Count);
            let missing = r.missing.as_ref().map_or(Cell::None, Cell::text);
            let (row, published) =
                (Cell::text(r.row.text()), r.published.map_or(Cell::None, |p| Cell::text(p.to_string())));
            vec![
                row,
                Cell::text(&r.column),
                Cell::text(r.unit),
                published,
                measured,
                interval,
                ratio,
                relmse,
                fitted,
                scale,
                kept,
                points,
                missing,
            ]
        });
        let shot = self.photons.iter().filter(|p| p.valid_photons.is_some());
        let photons = shot.map(|p| {
            let n = Cell::Count(p.n.into());
            let share = |share: Option<f64>| share.map_or(Cell::None, |share| Cell::Real(share, 4));
            vec![Cell::text(&p.variant), n, share(p.valid_photons), share(p.valid_flux)]
        });
        let of_rows = vec![
            "row",
            "column",
            "unit",
            "published",
            "measured",
            "99 %",
            "ratio",
            "relmse",
            "relmse fitted",
            "scale",
            "kept",
            "points",
            "missing",
        ];
        vec![
            Table { name: "rows", columns: of_rows, rows: rows.collect() },
            Shape::table("shape", &self.shape),
            Shape::table("gains", &self.gains),
            Table {
                name: "photons",
                columns: vec!["variant", "n", "valid photons", "valid flux"],
                rows: photons.collect(),
            },
        ]
    }

    fn notes(&self) -> Vec<String> {
        let reference = self.reference.iter().map(|text| format!("relmse against the {text}"));
        reference.chain(self.warnings.iter().map(|w| format!("warning: {w}"))).collect()
    }
}

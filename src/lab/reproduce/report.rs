//! `nephroid.reproduce/1`: published beside measured, and the shape of both.

use serde::Serialize;
use serde_json::{Map, Value};

use super::{
    Extent,
    columns::{self, Part},
    measure::{Measured, Run},
    strip::strip,
};
use crate::{
    gpu::FrameTimes,
    image::to_png,
    lab::{
        Cell, DeviceRow, Format, LabError, Report, Table,
        papers::{self, Figure, Label, Published},
        timing::{Ratio, Summary},
    },
    metrics::Measure,
    stats::write_number,
    whole::OutFolder,
};

/// A value and the interval that it lies in: of times 99 %, of errors 95 %.
#[derive(Clone, Debug, Serialize)]
struct Known {
    #[serde(serialize_with = "write_number")]
    value: f64,
    #[serde(serialize_with = "write_number")]
    low: f64,
    #[serde(serialize_with = "write_number")]
    high: f64,
}

impl From<Summary> for Known {
    fn from(s: Summary) -> Self {
        Self { value: s.median, low: s.low, high: s.high }
    }
}

impl From<Ratio> for Known {
    fn from(r: Ratio) -> Self {
        Self { value: r.interval.value, low: r.interval.low, high: r.interval.high }
    }
}

impl From<Measure> for Known {
    fn from(m: Measure) -> Self {
        Self { value: m.value, low: m.low.unwrap_or(0.0), high: m.high.unwrap_or(f64::INFINITY) }
    }
}

/// One published figure, and what it is here.
#[derive(Clone, Debug, Serialize)]
struct Row {
    row: Label,
    column: String,
    unit: &'static str,
    published: Option<f64>,
    measured: Option<Known>,
    /// Measured over published.
    ratio: Option<f64>,
    /// Of the picture of the frame that was timed.
    relmse: Option<Known>,
    /// Flux in the map over the flux that arrived in it: less where splats are dropped, more where clusters invent light.
    kept: Option<f64>,
    /// Points that gathering draws in all, where it draws points.
    points: Option<u64>,
    /// Why there is no `measured`.
    missing: Option<String>,
}

/// How one figure of the table compares with another: what does not depend on how fast the machine is.
#[derive(Clone, Debug, Serialize)]
struct Shape {
    /// `growth`: one column, from one N to the next; `columns`: two columns at one N.
    kind: &'static str,
    from: String,
    to: String,
    published: f64,
    measured: Known,
    /// Whether the published ratio lies in the measured interval.
    within: bool,
}

/// Light that arrived with one variant at one N.
#[derive(Clone, Debug, Serialize)]
struct Arrived {
    variant: String,
    n: u32,
    valid_photons: f64,
    valid_flux: f64,
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
    scene: Option<&'static str>,
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
    warnings: Vec<String>,
    version: &'static str,
    commit: &'static str,
    #[serde(skip)]
    pictures: Vec<(String, Measured)>,
}

/// Of times, but where a paper gives rates or counts.
fn unit(published: &Published, column: &str) -> &'static str {
    match (published.id.as_str(), column) {
        ("maps.table4" | "maps.table5" | "lines.table2", _) => "fps",
        (_, name) if name.ends_with("fps") => "fps",
        ("maps.table1" | "maps.table2" | "maps.table3" | "maps.figure7" | "lines.table1", _) => "ms",
        (_, "sun_disc_degrees") => "degrees",
        (_, "mental_ray_minutes") => "minutes",
        (_, "absorbed_per_metre") => "1/m",
        _ => "1",
    }
}

/// A figure's place in the run: which of the measured it is, and which part.
type Place = (usize, Part);

impl ReproduceReport {
    /// Of a table that nothing here can run.
    pub fn unrun(published: &Published, extent: &Extent) -> Self {
        let why = |figure: &Figure| columns::runs(published, figure).err();
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
            warnings: Vec::new(),
            version: env!("CARGO_PKG_VERSION"),
            commit: env!("NEPHROID_COMMIT"),
            pictures: Vec::new(),
        }
    }

    pub(super) fn measured(published: &Published, extent: &Extent, run: Run) -> Self {
        let rows = published.figures.iter().map(|figure| Row::of(published, figure, &run)).collect();
        let shape = shape(published, &run);
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
            scene: first.map(|m| m.variant.subject.scene()),
            deviations: first.map(|m| m.variant.subject.deviations()).unwrap_or_default(),
            device,
            size: Some(extent.size),
            repeats: Some(run.timed.rounds()),
            reference: Some(run.reference.clone()).filter(|file| !file.is_empty()),
            settings: first.map(|m| m.provenance.settings().clone()).unwrap_or_default(),
            photons: run.all.iter().map(Arrived::of).collect(),
            rows,
            shape,
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

fn file_of(m: &Measured) -> String {
    format!("{}-{}.png", m.variant.name().replace(' ', "-"), m.side)
}

impl Arrived {
    fn of(m: &Measured) -> Self {
        let [valid_photons, valid_flux] = m.valid;
        let set = m.variant.set(m.side).into_iter().map(|(key, value)| (key, value.into()));
        Self { variant: m.variant.name(), n: m.side, valid_photons, valid_flux, settings: set.collect() }
    }
}

impl Row {
    fn missing(published: &Published, figure: &Figure, missing: Option<String>) -> Self {
        Self {
            row: figure.row.clone(),
            column: figure.column.clone(),
            unit: unit(published, &figure.column),
            published: figure.value,
            measured: None,
            ratio: None,
            relmse: None,
            kept: None,
            points: None,
            missing,
        }
    }

    fn of(published: &Published, figure: &Figure, run: &Run) -> Self {
        match place(published, figure, run) {
            Err(why) => Self::missing(published, figure, Some(why)),
            Ok((at, part)) => {
                let (m, series) = (&run.all[at], &run.timed.series[at]);
                let samples = series.frames.iter().map(|frame| part.of(&m.stages, frame)).collect();
                let measured = Known::from(Summary::of(samples));
                let ratio = figure.value.map(|published| measured.value / published).filter(|ratio| ratio.is_finite());
                let relmse = m.relmse.map(Known::from);
                let (kept, points, none) = (m.kept, m.points, Self::missing(published, figure, None));
                Self { measured: Some(measured), ratio, relmse, kept, points, ..none }
            }
        }
    }
}

/// Where a figure was measured, or why it was not.
fn place(published: &Published, figure: &Figure, run: &Run) -> Result<Place, String> {
    let (variant, n, part) = columns::runs(published, figure)?;
    let found = run.all.iter().position(|m| m.variant == variant && m.side == n);
    let why = || run.left_out.iter().find(|(side, _)| *side == n).map(|(_, why)| why.clone());
    found.map(|at| (at, part)).ok_or_else(|| why().unwrap_or_else(|| "was not run".to_owned()))
}

/// Each column from one N to the next, and each column beside the table's first at the same N.
fn shape(published: &Published, run: &Run) -> Vec<Shape> {
    let placed: Vec<_> = published.figures.iter().filter_map(|f| Some((f, place(published, f, run).ok()?))).collect();
    let mut all = Vec::new();
    for pair in placed.windows(2).filter(|pair| pair[0].0.column == pair[1].0.column) {
        all.extend(Shape::of("growth", pair[0], pair[1], run));
    }
    let Some(first) = placed.first().map(|(f, _)| f.column.clone()) else { return all };
    for to in placed.iter().filter(|(f, _)| f.column != first) {
        let from = placed.iter().find(|(f, _)| f.column == first && f.row == to.0.row);
        all.extend(from.and_then(|from| Shape::of("columns", *from, *to, run)));
    }
    all
}

impl Shape {
    /// None where the published figure is zero.
    fn of(kind: &'static str, from: (&Figure, Place), to: (&Figure, Place), run: &Run) -> Option<Self> {
        let take = |(at, part): Place| move |frame: &FrameTimes| part.of(&run.all[at].stages, frame);
        let [a, b] = [from.1, to.1].map(take);
        let measured = run.timed.ratio((from.1.0, &a), (to.1.0, &b));
        let published = to.0.value? / from.0.value?;
        let name = |figure: &Figure| format!("{} {}", figure.column, figure.row.text());
        published.is_finite().then(|| Self {
            kind,
            from: name(from.0),
            to: name(to.0),
            published,
            within: measured.interval.contains(published),
            measured: measured.into(),
        })
    }
}

/// Three significant digits.
fn short(value: f64) -> String {
    match value.abs() {
        a if a >= 100.0 || a == 0.0 => format!("{value:.0}"),
        a if a >= 10.0 => format!("{value:.1}"),
        a if a >= 1.0 => format!("{value:.2}"),
        a if a >= 0.01 => format!("{value:.3}"),
        _ => format!("{value:.1e}"),
    }
}

impl Known {
    fn cells(&self) -> [Cell; 2] {
        [Cell::text(short(self.value)), Cell::text(format!("{} to {}", short(self.low), short(self.high)))]
    }
}

fn cells(known: Option<&Known>) -> [Cell; 2] {
    known.map_or([Cell::None, Cell::None], Known::cells)
}

impl Report for ReproduceReport {
    fn heading(&self) -> Vec<String> {
        let mut lines = vec![format!("{}: {}", self.id, self.paper), format!("published: {}", self.platform)];
        if let (Some(scene), Some(device), Some([w, h]), Some(n)) = (self.scene, &self.device, self.size, self.repeats)
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
                kept,
                points,
                missing,
            ]
        });
        let shape = self.shape.iter().map(|s| {
            let [measured, interval] = s.measured.cells();
            let within = Cell::text(if s.within { "yes" } else { "no" });
            vec![Cell::text(&s.from), Cell::text(&s.to), Cell::text(short(s.published)), measured, interval, within]
        });
        let photons = self.photons.iter().map(|p| {
            let n = Cell::Count(p.n.into());
            vec![Cell::text(&p.variant), n, Cell::Real(p.valid_photons, 4), Cell::Real(p.valid_flux, 4)]
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
            "kept",
            "points",
            "missing",
        ];
        let of_shape = vec!["from", "to", "published ratio", "measured ratio", "99 %", "within"];
        vec![
            Table { name: "rows", columns: of_rows, rows: rows.collect() },
            Table { name: "shape", columns: of_shape, rows: shape.collect() },
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

/// Every table and figure, and whether it runs here.
#[derive(Debug, Serialize)]
pub struct CatalogueReport {
    schema: &'static str,
    entries: Vec<Entry>,
}

#[derive(Debug, Serialize)]
struct Entry {
    id: String,
    paper: String,
    figures: usize,
    /// Figures whose column can be run.
    runs: usize,
    missing: Vec<String>,
}

impl Default for CatalogueReport {
    fn default() -> Self {
        Self { schema: "nephroid.reproductions/1", entries: papers::all().iter().map(Entry::of).collect() }
    }
}

impl Entry {
    fn of(published: &Published) -> Self {
        let why = published.figures.iter().map(|figure| columns::runs(published, figure).err());
        let why: Vec<Option<String>> = why.collect();
        let mut missing: Vec<String> = why.iter().flatten().cloned().collect();
        missing.sort();
        missing.dedup();
        let runs = why.iter().filter(|w| w.is_none()).count();
        let (id, paper) = (published.id.clone(), published.paper.clone());
        Self { id, paper, figures: why.len(), runs, missing }
    }
}

impl Report for CatalogueReport {
    fn tables(&self) -> Vec<Table> {
        let rows = self.entries.iter().map(|e| {
            let missing = if e.missing.is_empty() { Cell::None } else { Cell::text(e.missing.join("; ")) };
            let (figures, runs) = (Cell::Count(e.figures as u64), Cell::Count(e.runs as u64));
            vec![Cell::text(&e.id), figures, runs, Cell::text(&e.paper), missing]
        });
        vec![Table {
            name: "reproductions",
            columns: vec!["id", "figures", "run here", "paper", "missing"],
            rows: rows.collect(),
        }]
    }
}

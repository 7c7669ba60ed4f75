//! `nephroid.tracers/1`: how far each tracer is from the exact one, and what it takes.

use serde::Serialize;
use serde_json::{Map, Value};

use super::{Compared, Figures, REFERENCE, Spread};
use crate::lab::{Cell, Provenance, Report, Table};

/// The result of `nephroid tracers`.
#[derive(Debug, Serialize)]
pub struct TracersReport {
    schema: &'static str,
    scene: String,
    class: String,
    side: u32,
    map_texel_m: f64,
    frames: u32,
    provenance: Provenance,
    tracers: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct Row {
    tracer: &'static str,
    /// Why it cannot do the scene.
    refused: Option<String>,
    #[serde(flatten)]
    figures: Option<Figures>,
    /// Of all its stages together, ms.
    ms: Option<f64>,
    stages_ms: Map<String, Value>,
}

/// What was traced.
pub struct Subject {
    /// The scene's name.
    pub scene: String,
    /// The path class.
    pub class: String,
    /// Photons a side.
    pub side: u32,
    /// m
    pub map_texel: f64,
    /// Timed frames.
    pub frames: u32,
}

impl TracersReport {
    /// From what was compared.
    pub fn new(subject: Subject, compared: &[Compared], provenance: Provenance) -> Self {
        Self {
            schema: "nephroid.tracers/1",
            scene: subject.scene,
            class: subject.class,
            // Of a light with a size, each view has its share.
            side: compared.first().map_or(subject.side, |one| one.side as u32),
            map_texel_m: subject.map_texel,
            frames: subject.frames,
            provenance,
            tracers: compared.iter().map(Row::of).collect(),
        }
    }

    fn done(&self) -> impl Iterator<Item = (&Row, &Figures)> {
        self.tracers.iter().filter_map(|row| Some((row, row.figures.as_ref()?)))
    }

    fn exact_ms(&self) -> Option<f64> {
        self.tracers.iter().find(|row| row.tracer == REFERENCE)?.ms
    }
}

impl Row {
    fn of(compared: &Compared) -> Self {
        let figures = compared.result.as_ref().ok().cloned();
        // From +0: an empty sum of floats is −0.
        let ms = figures.is_some().then(|| 0.0 + compared.stages.iter().map(|(_, ms)| ms).sum::<f64>());
        Self {
            tracer: compared.tracer,
            refused: compared.result.as_ref().err().cloned(),
            figures,
            ms,
            stages_ms: compared.stages.iter().map(|(stage, ms)| (stage.clone(), (*ms).into())).collect(),
        }
    }
}

/// Median, 95 % and worst as they are shown.
fn shown(spread: Option<Spread>) -> [Cell; 3] {
    let cell = |value: f64| Cell::text(format!("{value:.1e}"));
    spread.map_or([Cell::None, Cell::None, Cell::None], |s| [s.median, s.p95, s.worst].map(cell))
}

/// The same with all digits.
fn whole(spread: Option<Spread>) -> [Cell; 3] {
    spread.map_or([Cell::None, Cell::None, Cell::None], |s| [s.median, s.p95, s.worst].map(|v| Cell::Real(v, 3)))
}

impl Report for TracersReport {
    fn heading(&self) -> Vec<String> {
        let (scene, class, side, device) = (&self.scene, &self.class, self.side, self.provenance.device());
        vec![
            format!("{scene}, class {class}, {side}x{side} photons a view; a map texel is {:.3e} m", self.map_texel_m),
            format!("{} ({}), {}, {} timed frames", device.name, device.kind, device.driver, self.frames),
        ]
    }

    fn tables(&self) -> Vec<Table> {
        let landings = self.done().map(|(row, f)| {
            let name = [Cell::text(row.tracer)];
            [&name[..], &shown(f.landing_m), &shown(f.landing_map_texels), &shown(f.direction_deg)].concat()
        });
        let losses = self.done().map(|(row, f)| {
            let percent = |share: f64| Cell::Real(100.0 * share, 3);
            let total = f.lost_to.get("total_internal_reflection").and_then(Value::as_f64);
            let [ms, exact] = [row.ms, self.exact_ms()].map(Option::unwrap_or_default);
            let times = if exact > 0.0 { Cell::Real(ms / exact, 2) } else { Cell::None };
            let total = total.unwrap_or_default();
            let shares = [f.false_loss, total, f.false_loss_photons, f.false_hits].map(percent);
            [&[Cell::text(row.tracer)][..], &shares, &[Cell::Real(ms, 1), times]].concat()
        });
        let stages = self.tracers.iter().flat_map(|row| {
            let ms = |value: &Value| Cell::Real(value.as_f64().unwrap_or(f64::NAN), 1);
            row.stages_ms.iter().map(move |(stage, v)| vec![Cell::text(row.tracer), Cell::text(stage), ms(v)])
        });
        let refused =
            self.tracers.iter().filter_map(|row| Some(vec![Cell::text(row.tracer), Cell::text(row.refused.as_ref()?)]));
        let columns = vec![
            "tracer",
            "landing median m",
            "95 % m",
            "worst m",
            "median texels",
            "95 % texels",
            "worst texels",
            "direction median °",
            "95 % °",
            "worst °",
        ];
        let lost = vec![
            "tracer",
            "flux falsely lost %",
            "to total reflection %",
            "photons lost %",
            "flux falsely arrived %",
            "ms",
            "times bvh",
        ];
        vec![
            Table { name: "errors", columns, rows: landings.collect() },
            Table { name: "losses", columns: lost, rows: losses.collect() },
            Table { name: "stages", columns: vec!["tracer", "stage", "ms"], rows: stages.collect() },
            Table { name: "refused", columns: vec!["tracer", "refused because"], rows: refused.collect() },
        ]
    }

    /// One row a tracer.
    fn csv_tables(&self) -> Vec<Table> {
        let rows = self.tracers.iter().map(|row| {
            let f = row.figures.as_ref();
            let spreads = [
                whole(f.and_then(|f| f.landing_m)),
                whole(f.and_then(|f| f.landing_map_texels)),
                whole(f.and_then(|f| f.direction_deg)),
            ];
            let real = |value: Option<f64>| value.map_or(Cell::None, |value| Cell::Real(value, 6));
            let shares =
                [f.map(|f| f.false_loss), f.map(|f| f.false_loss_photons), f.map(|f| f.false_hits), row.ms].map(real);
            let refused = row.refused.as_ref().map_or(Cell::None, Cell::text);
            [&[Cell::text(row.tracer)][..], &spreads.concat(), &shares, &[refused]].concat()
        });
        let columns = vec![
            "tracer",
            "landing_median_m",
            "landing_p95_m",
            "landing_worst_m",
            "landing_median_texels",
            "landing_p95_texels",
            "landing_worst_texels",
            "direction_median_deg",
            "direction_p95_deg",
            "direction_worst_deg",
            "false_loss",
            "false_loss_photons",
            "false_hits",
            "ms",
            "refused",
        ];
        vec![Table { name: "tracers", columns, rows: rows.collect() }]
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = vec![
            "errors: of the texels whose photons arrive with bvh too; shares: of the flux that arrives with bvh"
                .to_owned(),
        ];
        if self.provenance.device().software {
            notes.push("times are those of a software device: they compare tracers on it, and nothing else".to_owned());
        }
        notes
    }
}

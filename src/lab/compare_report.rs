//! `nephroid.compare/1`: how wrong pictures are, and how well that is known.

use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

use super::{
    Cell, Report, Table,
    compare::{Comparison, Constants, DEBIASED, FITTED, MEASURES},
};
use crate::{
    metrics::{Fitted, Measure},
    stats::Number,
};

/// The result of `nephroid compare`.
#[derive(Debug, Serialize)]
pub struct CompareReport {
    schema: &'static str,
    reference: String,
    results: Vec<Row>,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Row {
    image: String,
    reference: String,
    layer: String,
    pixels: usize,
    masked: usize,
    constants: Constants,
    #[serde(serialize_with = "by_name")]
    measures: [Measure; 8],
    /// Of a picture that is right up to a scale.
    #[serde(skip_serializing_if = "Option::is_none")]
    fitted: Option<FittedRow>,
    /// The judged figure without what the reference's noise adds; its `truth_noise` is its standard error.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "some")]
    relmse_debiased: Option<Measure>,
}

/// The best scale, and the judged figure with it.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct FittedRow {
    pub scale: f64,
    #[serde(serialize_with = "one")]
    pub relmse: Measure,
}

impl From<Fitted> for FittedRow {
    fn from(Fitted { scale, relmse }: Fitted) -> Self {
        Self { scale, relmse }
    }
}

/// A limit that a measure may not exceed.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// One of [`limited`].
    pub measure: &'static str,
    /// The largest value allowed; for the ratio of energies, the largest distance from one.
    pub most: f64,
}

/// The measures that limits can be set for.
pub fn limited() -> impl Iterator<Item = &'static str> {
    MEASURES.into_iter().chain([DEBIASED, FITTED])
}

impl CompareReport {
    /// Of pictures compared, each with its own reference; `reference` is what was asked for.
    pub fn new(reference: &str, comparisons: &[Comparison]) -> Self {
        let row = |c: &Comparison| Row {
            image: c.image.clone(),
            reference: c.reference.clone(),
            layer: c.layer.clone(),
            pixels: c.pixels,
            masked: c.masked,
            constants: c.constants,
            measures: c.measures,
            fitted: c.fitted.map(FittedRow::from),
            relmse_debiased: c.debiased,
        };
        Self {
            schema: "nephroid.compare/1",
            reference: reference.to_owned(),
            results: comparisons.iter().map(row).collect(),
            warnings: comparisons.iter().flat_map(|c| c.warnings.clone()).collect(),
        }
    }

    /// What differs between the pictures and the reference that should not.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Every limit exceeded, as a sentence. What is not finite exceeds any.
    pub fn exceeded(&self, limits: &[Limit]) -> Vec<String> {
        let mut exceeded = Vec::new();
        for (row, limit) in self.results.iter().flat_map(|row| limits.iter().map(move |limit| (row, limit))) {
            let Some(measure) = row.judged(limit.measure) else {
                let Row { image, reference, .. } = row;
                exceeded.push(format!(
                    "{} of {image} is not known: {reference} says no noise, as photons do",
                    limit.measure
                ));
                continue;
            };
            // Below zero, where noise was taken off, is not above anything.
            let off = if measure.perfect == 0.0 { measure.value } else { (measure.value - measure.perfect).abs() };
            if off <= limit.most {
                continue;
            }
            let (name, value, most) = (limit.measure, figure(measure.value), limit.most);
            let from = if measure.perfect == 0.0 { "above" } else { "further from 1 than" };
            exceeded.push(format!("{name} of {} is {value}, {from} {most}", row.image));
        }
        exceeded
    }
}

fn by_name<S: Serializer>(measures: &[Measure; 8], serializer: S) -> Result<S::Ok, S::Error> {
    let by_name = MEASURES.iter().zip(measures).map(|(name, measure)| (name.to_string(), json(measure)));
    by_name.collect::<Map<_, _>>().serialize(serializer)
}

fn one<S: Serializer>(measure: &Measure, serializer: S) -> Result<S::Ok, S::Error> {
    json(measure).serialize(serializer)
}

fn some<S: Serializer>(measure: &Option<Measure>, serializer: S) -> Result<S::Ok, S::Error> {
    measure.as_ref().map(json).serialize(serializer)
}

pub(super) fn json(measure: &Measure) -> Value {
    let bound = |bound: Option<f64>| bound.map_or(Value::Null, |x| Number(x).into());
    serde_json::json!({
        "value": Number(measure.value),
        "low": bound(measure.low),
        "high": bound(measure.high),
        "truth_noise": bound(measure.truth_noise),
        "below_noise": measure.is_noise(),
    })
}

/// Five digits, at any scale.
pub(super) fn figure(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if !value.is_finite() => "infinite".to_owned(),
        value if (1e-3..1e4).contains(&value.abs()) => format!("{value:.5}"),
        value => format!("{value:.4e}"),
    }
}

impl Report for CompareReport {
    fn heading(&self) -> Vec<String> {
        match self.results.as_slice() {
            [first, rest @ ..] if rest.iter().any(|row| row.reference != first.reference) => {
                self.results.iter().map(|row| format!("{} against {}", row.image, row.reference)).collect()
            }
            rows => rows.first().map(|row| format!("against {}", row.reference)).into_iter().collect(),
        }
    }

    fn tables(&self) -> Vec<Table> {
        let shown = |measure: &Measure| {
            let bound = |bound: Option<f64>| bound.map_or(Cell::None, |bound| Cell::text(figure(bound)));
            let value = if measure.is_noise() { "lost in noise".to_owned() } else { figure(measure.value) };
            vec![Cell::text(value), bound(measure.low), bound(measure.high), bound(measure.truth_noise)]
        };
        vec![self.table(shown)]
    }

    fn csv_tables(&self) -> Vec<Table> {
        let plain = |measure: &Measure| {
            let bound = |bound: Option<f64>| bound.map_or(Cell::None, |bound| Cell::Real(bound, 0));
            vec![Cell::Real(measure.value, 0), bound(measure.low), bound(measure.high), bound(measure.truth_noise)]
        };
        let mut table = self.table(plain);
        table.columns.push("reference");
        let references = self.results.iter().flat_map(|row| row.named().map(|_| Cell::text(&row.reference)));
        table.rows.iter_mut().zip(references).for_each(|(row, reference)| row.push(reference));
        vec![table]
    }

    fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = self.results.iter().map(note).collect();
        notes.dedup();
        if self.results.iter().any(|row| row.fitted.is_some()) {
            notes.push(
                "a relative picture, right only up to a scale: relmse_fitted is relmse with the best one".to_owned(),
            );
        }
        if self.results.iter().any(|row| row.relmse_debiased.is_some()) {
            notes.push(
                "relmse_debiased: without what the reference's noise adds; its noise is its standard error".to_owned(),
            );
        }
        let lost = |row: &Row| row.measures.iter().any(Measure::is_noise);
        if self.results.iter().any(lost) {
            notes.push("lost in noise: below twice what a perfect image would score against this reference".to_owned());
        }
        notes
    }
}

impl CompareReport {
    fn table(&self, values: impl Fn(&Measure) -> Vec<Cell>) -> Table {
        let columns = vec!["image", "layer", "pixels", "masked", "measure", "value", "low", "high", "truth noise"];
        let mut rows = Vec::new();
        for row in &self.results {
            for (name, measure) in row.named() {
                let of = [
                    Cell::text(&row.image),
                    Cell::text(&row.layer),
                    Cell::Count(row.pixels as u64),
                    Cell::Count(row.masked as u64),
                    Cell::text(name),
                ];
                rows.push([of.to_vec(), values(&measure)].concat());
            }
        }
        Table { name: "measures", columns, rows }
    }
}

impl Row {
    /// What a limit is for: of a picture in W/m², whose scale is one, `relmse_fitted` is `relmse`.
    fn judged(&self, name: &str) -> Option<Measure> {
        let found = self.named().find(|(known, _)| *known == name).map(|(_, measure)| measure);
        found.or_else(|| (name == FITTED).then_some(self.measures[0]))
    }

    /// The measures by name; of a relative picture those of the fit too, and what is left without noise where that is known.
    fn named(&self) -> impl Iterator<Item = (&'static str, Measure)> {
        let fit = |FittedRow { scale, relmse }: FittedRow| {
            let scale = Measure { value: scale, low: None, high: None, truth_noise: None, perfect: 1.0 };
            [("scale", scale), (FITTED, relmse)]
        };
        let all = MEASURES.into_iter().zip(self.measures).chain(self.fitted.into_iter().flat_map(fit));
        all.chain(self.relmse_debiased.map(|measure| (DEBIASED, measure)))
    }
}

fn note(row: &Row) -> String {
    let c = &row.constants;
    format!(
        "E0 {} W/m2; relmse: epsilon (0.1 E0)^2 = {}; relmse_standard, _trimmed: {} mean^2; mape: {} mean; flip: \
         exposure {} EV, {} pixels per degree",
        figure(c.e0),
        figure(c.relmse_epsilon),
        c.relmse_standard_epsilon,
        c.mape_epsilon,
        c.flip_exposure,
        c.flip_pixels_per_degree
    )
}

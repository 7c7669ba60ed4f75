//! `nephroid.budget/1`: what each step of the chain adds to the error.

use std::io::Write;

use serde::Serialize;

use super::{Budget, Chain, Step, title};
use crate::{
    image::{Layers, rgb_to_png, to_png},
    lab::{
        Cell, LabError, Provenance, Report, Table,
        colour_bar::with_bar,
        compare_maps::{MASKED, SCALE_PERCENTILE, diverging},
        compare_report::{FittedRow, figure},
        report::Format,
    },
    passes::light,
    renderer::Job,
    stats,
    whole::OutFolder,
};

/// From here on photons of the picture lie no less dense than those that stand for many.
const FINER: u32 = 2;
/// A truth of this much of a step's figure cannot be told from it.
const NOISY: f64 = 0.5;
/// Of a diffuse white surface, EV: its radiance is the irradiance over π.
const WHITE_EV: f64 = -1.651_496_129_472_318_8;

/// The result of `nephroid budget`.
#[derive(Serialize)]
pub struct BudgetReport {
    schema: &'static str,
    scene: String,
    method: &'static str,
    size: [usize; 2],
    paths: String,
    all_paths: String,
    /// Where photons are shot.
    light_side: Option<u32>,
    fine_side: Option<u32>,
    seed: u64,
    pixels: usize,
    masked: usize,
    /// W/m²
    e0: f64,
    steps: Vec<Row>,
    whole: Step,
    /// Of a picture that is right only up to a scale.
    fitted: Option<FittedRow>,
    provenance: Provenance,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct Row {
    from: String,
    to: String,
    #[serde(flatten)]
    step: Step,
}

impl BudgetReport {
    /// Of a chain made on a job.
    pub fn new(budget: &Budget, job: &Job, method: &'static str, chain: &Chain, provenance: Provenance) -> Self {
        let (class, sides) = (light::paths(&job.scene, &job.settings), budget.sides(job));
        let titles: Vec<String> = chain.shots.iter().map(|shot| title(shot.link, budget.all, class, sides)).collect();
        let row =
            |(step, ends): (&Step, &[String])| Row { from: ends[0].clone(), to: ends[1].clone(), step: step.clone() };
        let pixels = chain.judged.iter().filter(|kept| **kept).count();
        Self {
            schema: "nephroid.budget/1",
            scene: job.scene.name.clone(),
            method,
            size: chain.size,
            paths: class.to_string(),
            all_paths: budget.all.to_string(),
            light_side: sides.map(|[_, side]| side),
            fine_side: sides.map(|[fine, _]| fine),
            seed: budget.seed,
            pixels,
            masked: chain.judged.len() - pixels,
            e0: chain.e0,
            steps: chain.steps.iter().zip(titles.windows(2)).map(row).collect(),
            whole: chain.whole.clone(),
            fitted: chain.fitted.map(FittedRow::from),
            warnings: warnings(sides, chain),
            provenance,
        }
    }

    fn device(&self) -> String {
        let device = self.provenance.device();
        format!("{}{}", device.name, if device.software { ", a software device" } else { "" })
    }

    /// What makes these figures less than they seem, and what to do about it.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

fn warnings(sides: Option<[u32; 2]>, chain: &Chain) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some([fine, side]) = sides.filter(|[fine, side]| side * FINER > *fine) {
        let least = side * FINER;
        warnings.push(format!("light.side {side} is not much coarser than the fine grid of {fine}: the step light.side means little; ask for --fine {least} or more"));
    }
    for step in &chain.steps {
        let (value, noise) = (step.relmse.value, step.relmse.truth_noise.unwrap_or(0.0));
        if noise > NOISY * value && value > 0.0 {
            let name = &step.name;
            warnings.push(format!(
                "{name}: relMSE {} is mostly noise of the truths ({}): ask for a lower --until, or more --photons",
                figure(value),
                figure(noise)
            ));
        }
    }
    warnings
}

impl Report for BudgetReport {
    fn heading(&self) -> Vec<String> {
        let [width, height] = self.size;
        let sides = self.light_side.zip(self.fine_side);
        let sides = sides.map(|(side, fine)| format!(", light.side {side}; fine grid {fine}²")).unwrap_or_default();
        vec![
            format!(
                "{}, {}, {width}x{height} pixels of the region{sides}; E0 {:.4} W/m²; {}",
                self.scene,
                self.method,
                self.e0,
                self.device()
            ),
            "each step against the picture before it; shares of the whole squared error sum to 1".to_owned(),
        ]
    }

    fn tables(&self) -> Vec<Table> {
        let columns = vec![
            "step",
            "from",
            "to",
            "energy, W/m2",
            "energy, % of all",
            "relMSE",
            "low 95 %",
            "high 95 %",
            "truth noise",
            "share",
            "moved by",
        ];
        let bound = |x: Option<f64>| x.map_or(Cell::None, |x| Cell::text(figure(x)));
        let row = |step: &Step, from: &str, to: &str| {
            vec![
                Cell::text(&step.name),
                Cell::text(from),
                Cell::text(to),
                Cell::Real(step.energy.gain, 6),
                step.energy.relative.map_or(Cell::None, |share| Cell::Real(100.0 * share, 3)),
                Cell::text(figure(step.relmse.value)),
                bound(step.relmse.low),
                bound(step.relmse.high),
                bound(step.relmse.truth_noise),
                step.share.map_or(Cell::None, |share| Cell::Real(share, 3)),
                Cell::text(step.moved_by.join(" ")),
            ]
        };
        let mut rows: Vec<_> = self.steps.iter().map(|r| row(&r.step, &r.from, &r.to)).collect();
        let ends = [self.steps.first().map(|r| &r.from), self.steps.last().map(|r| &r.to)].map(|end| end.cloned());
        let [first, last] = ends.map(Option::unwrap_or_default);
        rows.push(row(&self.whole, &first, &last));
        vec![Table { name: "steps", columns, rows }]
    }

    fn notes(&self) -> Vec<String> {
        let fitted = self.fitted.as_ref().map(|fit| {
            let (scale, relmse) = (figure(fit.scale), figure(fit.relmse.value));
            format!("the picture is right only up to a scale: multiplied by {scale}, which fits best, its relMSE is {relmse}")
        });
        fitted.into_iter().chain(self.warnings.iter().map(|warning| format!("warning: {warning}"))).collect()
    }
}

/// Writes `budget.json`, `budget.exr` with every picture and every step, and a PNG of each. The maps of all steps have one
/// scale.
pub fn write_budget(folder: &mut OutFolder, report: &BudgetReport, chain: &Chain, ev: f64) -> Result<(), LabError> {
    let json = report.write(Format::Json).expect("a report of numbers and words is JSON");
    folder.write("budget.json", |out| out.write_all(&json))?;
    let about = report.provenance.attributes();
    let [width, height] = chain.size;
    let mut layers = Layers::new(width, height);
    for (at, shot) in chain.shots.iter().enumerate() {
        let name = format!("picture.{at}");
        layers.push(&name, 3, shot.irradiance.clone())?;
        let png = to_png(&layers, &name, ev + WHITE_EV, &about)?;
        folder.write(&format!("{name}.png"), |out| out.write_all(&png))?;
    }
    let named = chain.steps.iter().map(|step| (format!("step.{}", step.name.replace(' ', "-")), step));
    let named: Vec<_> = named.chain([("whole".to_owned(), &chain.whole)]).collect();
    let scale = scale(chain);
    for (name, step) in named {
        layers.push(&name, 3, step.gain.iter().map(|x| *x as f32).collect())?;
        let means = step.gain.chunks_exact(3).map(|bands| bands.iter().sum::<f64>() / 3.0);
        let coloured = means.zip(&chain.judged).map(|(x, judged)| if *judged { diverging(x / scale) } else { MASKED });
        let (size, colours) = with_bar(chain.size, coloured.collect(), diverging, [scale, 0.0, -scale]);
        let png = rgb_to_png(size, &colours, &about)?;
        folder.write(&format!("{name}.png"), |out| out.write_all(&png))?;
    }
    let exr = layers.to_exr(&about)?;
    folder.write("budget.exr", |out| out.write_all(&exr))?;
    Ok(())
}

/// The gain that has full colour in the maps, W/m²: what few pixels exceed in the largest step.
fn scale(chain: &Chain) -> f64 {
    let of = |step: &Step| {
        let means = step.gain.chunks_exact(3).map(|bands| (bands.iter().sum::<f64>() / 3.0).abs());
        let judged = means.zip(&chain.judged).filter(|(x, judged)| **judged && x.is_finite()).map(|(x, _)| x);
        stats::percentile(&judged.collect::<Vec<_>>(), SCALE_PERCENTILE)
    };
    let scale = chain.steps.iter().map(of).filter(|x| x.is_finite()).fold(0.0, f64::max);
    if scale > 0.0 { scale } else { 1.0 }
}

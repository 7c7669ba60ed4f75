//! Pictures of a chain, and what lies between two of them.

use serde::{Serialize, Serializer};

use super::{CAUSTIC, Chain, LabError, Picture};
use crate::{
    lab::compare_report::json,
    methods::Link,
    metrics::{self, Correlation, Measure, NORMAL_95, Pair, RELATIVE_TO_E0},
};

const BANDS: usize = 3;

/// A picture of the chain.
pub struct Shot {
    /// What it is.
    pub link: &'static Link,
    /// W/m², three bands a pixel, rows from the top.
    pub irradiance: Vec<f32>,
    /// Of a truth, (W/m²)².
    variance: Option<Vec<f32>>,
    correlation: Correlation,
}

impl Shot {
    pub(super) fn of(link: &'static Link, picture: &Picture) -> Result<Self, LabError> {
        Ok(Self {
            link,
            irradiance: picture.layer(CAUSTIC)?.data().to_vec(),
            variance: picture.variance(CAUSTIC).map(|layer| layer.data().to_vec()),
            correlation: picture.correlation(CAUSTIC),
        })
    }

    pub(super) fn bare(link: &'static Link, irradiance: Vec<f32>) -> Self {
        Self { link, irradiance, variance: None, correlation: Correlation::default() }
    }
}

/// What changes from one picture of the chain to another.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    /// Its name.
    pub name: String,
    /// The settings that move it and none of the steps before.
    pub moved_by: &'static [&'static str],
    /// W/m² each pixel gains, mean over the pixels judged and the bands.
    pub energy: Energy,
    /// Against the picture before.
    #[serde(serialize_with = "as_compared")]
    pub relmse: Measure,
    /// The part of the whole squared error that goes along with this step: the shares of a chain sum to 1. Negative
    /// where the step undoes part of the others; nothing where the whole is nothing.
    pub share: Option<f64>,
    /// W/m² that each pixel and band gains: the later picture less the earlier one.
    #[serde(skip)]
    pub gain: Vec<f64>,
}

fn as_compared<S: Serializer>(measure: &Measure, serializer: S) -> Result<S::Ok, S::Error> {
    json(measure).serialize(serializer)
}

/// A mean over the region, with the interval (95 %) that the truths' noise leaves to it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Energy {
    /// W/m²
    pub gain: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Relative to the mean of the truth of all paths; nothing where that is dark.
    pub relative: Option<f64>,
}

impl Chain {
    pub(super) fn new(size: [usize; 2], shots: Vec<Shot>, judged: Vec<bool>, e0: f64) -> Self {
        let between = Between { judged: &judged, e0, truth: &shots[0] };
        let mut whole = between.step("whole", &[], &shots[0], shots.last().unwrap_or(&shots[0]));
        let pairs = shots.iter().zip(&shots[1..]);
        let mut steps: Vec<Step> =
            pairs.map(|(from, to)| between.step(to.link.step, to.link.moved_by, from, to)).collect();
        let all = between.along(&whole.gain, &whole.gain);
        let share = |step: &Step| (all > 0.0).then(|| between.along(&step.gain, &whole.gain) / all);
        steps.iter_mut().for_each(|step| step.share = share(step));
        whole.share = share(&whole);
        Self { size, shots, steps, whole, judged, e0, fitted: None }
    }

    /// With the scale that fits the last picture to the first best.
    pub(super) fn fit(self) -> Self {
        let between = Between { judged: &self.judged, e0: self.e0, truth: &self.shots[0] };
        let last = self.shots.last().unwrap_or(&self.shots[0]);
        let fitted = metrics::fitted(&between.pair(&self.shots[0], last), self.e0);
        Self { fitted: Some(fitted), ..self }
    }
}

struct Between<'a> {
    judged: &'a [bool],
    e0: f64,
    truth: &'a Shot,
}

impl Between<'_> {
    fn step(&self, name: &str, moved_by: &'static [&'static str], from: &Shot, to: &Shot) -> Step {
        let gain = from.irradiance.iter().zip(&to.irradiance).map(|(a, b)| f64::from(*b) - f64::from(*a)).collect();
        let energy = self.energy(from, to);
        Step { name: name.to_owned(), moved_by, energy, relmse: self.relmse(from, to), share: None, gain }
    }

    /// Noise of both pictures counts as that of the earlier one: their errors are independent, and the judged figure
    /// feels either alike to first order.
    fn relmse(&self, from: &Shot, to: &Shot) -> Measure {
        let relmse = metrics::relmse(&self.pair(from, to), self.e0);
        // Between two pictures of the device nothing is uncertain.
        let known = from.variance.is_some() || to.variance.is_some();
        if known { relmse } else { Measure { low: Some(relmse.value), high: Some(relmse.value), ..relmse } }
    }

    fn pair(&self, from: &Shot, to: &Shot) -> Pair {
        let kept = |values: &[f32]| self.kept(values).collect::<Vec<f64>>();
        let noises: Vec<Vec<f64>> = [from, to].iter().filter_map(|s| s.variance.as_deref()).map(kept).collect();
        let noise = noises.into_iter().reduce(|a, b| a.iter().zip(b).map(|(a, b)| a + b).collect());
        let pair = Pair::new(BANDS, kept(&to.irradiance), kept(&from.irradiance), noise);
        let pair = pair.expect("pictures of one chain are of one size");
        let freedom = [from, to].iter().filter_map(|s| s.correlation.freedom).reduce(f64::min);
        pair.correlated(Correlation { freedom, total: None })
    }

    fn energy(&self, from: &Shot, to: &Shot) -> Energy {
        let mean = |shot: &Shot| {
            let (sum, count) = self.kept(&shot.irradiance).fold((0.0, 0usize), |(sum, count), x| (sum + x, count + 1));
            sum / count.max(1) as f64
        };
        let error = |shot: &Shot| shot.correlation.total.unwrap_or(0.0) * mean(shot);
        let gain = mean(to) - mean(from);
        let spread = NORMAL_95 * error(from).hypot(error(to));
        let all = mean(self.truth);
        Energy { gain, low: gain - spread, high: gain + spread, relative: (all > 0.0).then(|| gain / all) }
    }

    /// Of two differences, the part that they have in common, weighed as the judged figure weighs pixels.
    fn along(&self, a: &[f64], b: &[f64]) -> f64 {
        let epsilon = (RELATIVE_TO_E0 * self.e0).powi(2);
        let weight = |r: &f32| 1.0 / (f64::from(*r).powi(2) + epsilon);
        let values = a.iter().zip(b).zip(&self.truth.irradiance).enumerate();
        let judged = values.filter(|(at, _)| self.judged[at / BANDS]);
        judged.map(|(_, ((a, b), r))| a * b * weight(r)).filter(|x| x.is_finite()).sum()
    }

    fn kept<'v>(&'v self, values: &'v [f32]) -> impl Iterator<Item = f64> + 'v {
        values.iter().enumerate().filter(|(at, _)| self.judged[at / BANDS]).map(|(_, x)| f64::from(*x))
    }
}

//! Squared measures. Their noise is found by expanding each term f(r) to second order about the truth that is known.

use super::{Measure, NORMAL_95, Pair, RELATIVE_TO_MEAN};

/// √ε of the judged measure, relative to E₀.
pub const RELATIVE_TO_E0: f64 = 0.1;
/// The share of pixels that the trimmed measure leaves out, rounded up to whole pixels.
const TRIMMED: f64 = 1e-3;

/// Mean of (x − r)²/(r² + ε), ε = (0.1 E₀)²: the judged figure. `e0` in the unit of the values.
pub fn relmse(pair: &Pair, e0: f64) -> Measure {
    measure(pair, |x, r| Term::relative(x, r, (RELATIVE_TO_E0 * e0).powi(2)), 0.0)
}

/// [`relmse`] with what the truth's noise adds taken off: what the image scores against a truth without noise. `None` where the
/// noise is not known.
///
/// Of (x − r)² it is v, whatever the noise: taking it off leaves the mean of (x − rᵢ)(x − rⱼ) over all pairs of independent
/// parts that r is the mean of. The weight's share is expanded to second order. The value may fall below zero, as an estimate
/// about nothing must; its interval is two-sided, and its `truth_noise` its standard error, about a fifth of the noise.
pub fn relmse_debiased(pair: &Pair, e0: f64) -> Option<Measure> {
    let epsilon = (RELATIVE_TO_E0 * e0).powi(2);
    pair.has_variance().then(|| {
        if !pair.is_sound() {
            return Measure::infinite(0.0, true);
        }
        let Mean { value, raised, error, .. } = Mean::of(pair, |x, r| Term::relative(x, r, epsilon), 0.0);
        let (value, half) = (value - raised, NORMAL_95 * error);
        let (low, high) = (Some(value - half), Some(value + half));
        Measure { value, low, high, truth_noise: Some(error), perfect: 0.0 }.finite()
    })
}

/// Mean of (x − r)²/(r² + ε), ε = 10⁻² mean(r)².
pub fn relmse_standard(pair: &Pair) -> Measure {
    let epsilon = standard_epsilon(pair);
    measure(pair, |x, r| Term::relative(x, r, epsilon), 0.0)
}

/// [`relmse_standard`] without the worst 0.1 % of pixels (at least one): how much of it outliers make.
///
/// The noise is that of the pixels kept, as if others had never been candidates.
pub fn relmse_trimmed(pair: &Pair) -> Measure {
    let epsilon = standard_epsilon(pair);
    measure(pair, |x, r| Term::relative(x, r, epsilon), TRIMMED)
}

/// Root of the mean of (x − r)², in the unit of the values.
pub fn rmse(pair: &Pair) -> Measure {
    let squared = measure(pair, Term::plain, 0.0);
    Measure {
        value: squared.value.sqrt(),
        low: squared.low.map(f64::sqrt),
        high: squared.high.map(f64::sqrt),
        truth_noise: squared.truth_noise.map(f64::sqrt),
        ..squared
    }
}

fn standard_epsilon(pair: &Pair) -> f64 {
    RELATIVE_TO_MEAN * pair.reference_mean(|r| r).powi(2)
}

/// One term of a sum as a function of the truth: f, f′ and f″/2.
#[derive(Clone, Copy)]
struct Term {
    value: f64,
    slope: f64,
    bend: f64,
}

impl Term {
    /// f(r) = (x − r)².
    fn plain(x: f64, r: f64) -> Self {
        let d = x - r;
        Self { value: d * d, slope: -2.0 * d, bend: 1.0 }
    }

    /// f(r) = (x − r)² w, w = 1/(r² + ε), w′ = −2 r w², w″/2 = 4 r² w³ − w².
    fn relative(x: f64, r: f64, epsilon: f64) -> Self {
        let d = x - r;
        let w = 1.0 / (r * r + epsilon);
        let w1 = -2.0 * r * w * w;
        let w2 = 4.0 * r * r * w.powi(3) - w * w;
        Self { value: d * d * w, slope: -2.0 * d * w + d * d * w1, bend: w - 2.0 * d * w1 + d * d * w2 }
    }
}

/// What one pixel adds: its figure, by how much noise raises it, its standard deviation, and a perfect pixel's figure.
#[derive(Clone, Copy, Default)]
struct Share {
    value: f64,
    raised: f64,
    deviation: f64,
    perfect: f64,
}

fn measure(pair: &Pair, term: impl Fn(f64, f64) -> Term, trimmed: f64) -> Measure {
    if !pair.is_sound() {
        return Measure::infinite(0.0, pair.has_variance());
    }
    let Mean { value, raised, most_error, perfect, .. } = Mean::of(pair, term, trimmed);
    let spread = NORMAL_95 * most_error;
    let known = |bound: f64| pair.has_variance().then_some(bound.max(0.0));
    Measure {
        value,
        low: known(value - raised - spread),
        high: known(value - raised + spread),
        truth_noise: pair.has_variance().then_some(perfect),
        perfect: 0.0,
    }
    .finite()
}

/// Means over pixels: the figure, by how much noise raises it, the standard error of what is left without that, and what a
/// perfect image would score.
struct Mean {
    value: f64,
    raised: f64,
    error: f64,
    /// That with the noise of the deviations themselves in it, which makes it up to √2 too large.
    most_error: f64,
    perfect: f64,
}

impl Mean {
    fn of(pair: &Pair, term: impl Fn(f64, f64) -> Term, trimmed: f64) -> Self {
        let mut shares: Vec<Share> = pair.each().map(|values| share(values, &term, pair.channels())).collect();
        shares.sort_unstable_by(|a, b| a.value.total_cmp(&b.value));
        let worst = (trimmed * shares.len() as f64).ceil() as usize;
        shares.truncate((shares.len() - worst).max(1));
        let count = shares.len() as f64;
        let mean = |of: fn(&Share) -> f64| shares.iter().map(of).sum::<f64>() / count;
        let (value, raised) = (mean(|s| s.value), mean(|s| s.raised));
        let common = pair.common_scatter() * raised * raised;
        // Of a pixel the variance is 4 w² d² v + 2 w² v² at the noiseless d; at the noisy one 4 w² v² are too much.
        let (deviations, noise) = (mean(|s| s.deviation * s.deviation), mean(|s| s.raised * s.raised));
        // Errors that move together may do so along what the image is wrong by: at worst that is as if there were as few of it.
        let along = 2.0 * pair.common_scatter() * (value - raised).max(0.0) * raised.max(0.0);
        let error = ((deviations - 2.0 * noise).max(2.0 * noise) / count + common + along).sqrt();
        let most_error = (deviations / count + common).sqrt();
        Self { value, raised, error, most_error, perfect: mean(|s| s.perfect) }
    }
}

/// f′²v, taken at the noisy d, holds the fourth-order part of the variance (2 f″²v²/4) already, and as much again.
fn share(values: impl Iterator<Item = super::pair::Value>, term: &impl Fn(f64, f64) -> Term, channels: usize) -> Share {
    let mut sum = Share::default();
    for at in values {
        let here = term(at.x, at.r);
        sum.value += here.value;
        sum.raised += here.bend * at.v;
        sum.deviation += here.slope.abs() * at.v.sqrt();
        sum.perfect += term(at.r, at.r).bend * at.v;
    }
    let n = channels as f64;
    Share { value: sum.value / n, raised: sum.raised / n, deviation: sum.deviation / n, perfect: sum.perfect / n }
}

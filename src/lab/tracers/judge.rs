//! One tracer's photons against another's, texel by texel.

use serde::Serialize;
use serde_json::{Map, Value};

use super::keep::End;
use crate::{passes::account::BUCKETS, stats};

/// `PHOTON_VALID` of `glsl/shared/photon.glsl`.
const VALID: usize = 1;

/// Median, 95th percentile and the greatest of errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Half of the texels are below it.
    pub median: f64,
    /// 95 of 100 texels are below it.
    pub p95: f64,
    /// The greatest.
    pub worst: f64,
}

impl Spread {
    /// Of no texel: nothing.
    fn of(errors: &[f64]) -> Option<Self> {
        let at = |percent| stats::percentile(errors, percent);
        (!errors.is_empty()).then(|| Self { median: at(50.0), p95: at(95.0), worst: at(100.0) })
    }

    /// In a unit of which there are so many.
    fn scaled(self, by: f64) -> Self {
        Self { median: self.median * by, p95: self.p95 * by, worst: self.worst * by }
    }
}

/// How far a tracer is off. Errors are of the texels whose photons arrive with both tracers, each counted alike; shares
/// are of the flux that arrives with the reference.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Between the landings, m.
    pub landing_m: Option<Spread>,
    /// The same, in texels of the caustic map.
    pub landing_map_texels: Option<Spread>,
    /// Between the directions from exit to landing, degrees.
    pub direction_deg: Option<Spread>,
    /// Arrives with the reference alone.
    pub false_loss: f64,
    /// The same as a share of the photons that arrive with the reference: what Fresnel takes on the way does not weigh.
    pub false_loss_photons: f64,
    /// Of the flux lost, by how the photons end instead.
    pub lost_to: Map<String, Value>,
    /// Arrives with this tracer alone.
    pub false_hits: f64,
}

/// What a texel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Both arrive, so far apart (map texels).
    Off(f64),
    /// Arrives with the reference alone.
    Lost,
    /// Arrives with this tracer alone.
    Invented,
    /// Neither arrives.
    Nothing,
}

/// Judges the texels of all views; `map_texel` in metres.
pub fn judge(tested: &[Vec<End>], reference: &[Vec<End>], map_texel: f64) -> (Figures, Vec<Vec<Verdict>>) {
    let (mut landings, mut directions) = (Vec::new(), Vec::new());
    let (mut arrived, mut lost, mut invented, mut photons) = (0.0, [0.0; BUCKETS.len()], 0.0, 0usize);
    let mut verdict = |(tested, reference): (&End, &End)| {
        if reference.status == VALID {
            arrived += reference.flux;
        }
        match (tested.status == VALID, reference.status == VALID) {
            (true, true) => {
                let metres = tested.hit.distance(reference.hit);
                landings.push(metres);
                directions.push(angle(tested, reference));
                Verdict::Off(metres / map_texel)
            }
            (false, true) => {
                lost[tested.status.min(BUCKETS.len() - 1)] += reference.flux;
                photons += 1;
                Verdict::Lost
            }
            (true, false) => {
                invented += tested.flux;
                Verdict::Invented
            }
            (false, false) => Verdict::Nothing,
        }
    };
    let views = tested.iter().zip(reference);
    let verdicts = views.map(|(t, r)| t.iter().zip(r).map(&mut verdict).collect()).collect();
    // Where nothing arrives, nothing can be lost, and what is invented has no end.
    let share = |flux: f64| if flux == 0.0 { 0.0 } else { flux / arrived };
    let named = BUCKETS.iter().enumerate().skip(1).zip(&lost[1..]).filter(|(_, flux)| **flux > 0.0);
    let landing_m = Spread::of(&landings);
    let figures = Figures {
        landing_m,
        landing_map_texels: landing_m.map(|spread| spread.scaled(1.0 / map_texel)),
        direction_deg: Spread::of(&directions),
        false_loss: share(lost.iter().sum()),
        false_loss_photons: photons as f64 / ((landings.len() + photons) as f64).max(1.0),
        lost_to: named.map(|((_, name), flux)| ((*name).to_owned(), share(*flux).into())).collect(),
        false_hits: share(invented),
    };
    (figures, verdicts)
}

/// Between the ways that two photons went last, degrees; of a way without length, none.
fn angle(a: &End, b: &End) -> f64 {
    let (a, b) = (a.hit - a.exit, b.hit - b.exit);
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn end(status: usize, x: f64, flux: f64) -> End {
        End { status, hit: DVec3::new(x, 0.0, 0.0), exit: DVec3::Y, flux }
    }

    #[test]
    fn errors_losses_and_hits_by_hand() {
        let reference = vec![vec![end(1, 0.0, 2.0), end(1, 0.0, 1.0), end(2, 0.0, 0.0), end(0, 0.0, 0.0)]];
        let tested = vec![vec![end(1, 1.0, 2.0), end(2, 0.0, 0.0), end(1, 0.0, 0.6), end(0, 0.0, 0.0)]];
        let (figures, verdicts) = judge(&tested, &reference, 0.5);
        let one = |v: f64| Some(Spread { median: v, p95: v, worst: v });
        assert_eq!((figures.landing_m, figures.landing_map_texels), (one(1.0), one(2.0)));
        assert!((figures.direction_deg.unwrap().worst - 45.0).abs() < 1e-12, "{:?}", figures.direction_deg);
        assert!((figures.false_loss - 1.0 / 3.0).abs() < 1e-15 && (figures.false_hits - 0.2).abs() < 1e-15);
        assert_eq!(figures.false_loss_photons, 0.5);
        assert_eq!(figures.lost_to.keys().collect::<Vec<_>>(), ["total_internal_reflection"]);
        assert_eq!(verdicts, [[Verdict::Off(2.0), Verdict::Lost, Verdict::Invented, Verdict::Nothing]]);
    }

    #[test]
    fn where_nothing_arrives_there_is_no_error_and_what_is_invented_has_no_end() {
        let none = vec![vec![end(2, 0.0, 0.0)]];
        let (figures, _) = judge(&none, &none, 1.0);
        assert_eq!((figures.landing_m, figures.false_loss, figures.false_hits), (None, 0.0, 0.0));
        let (figures, _) = judge(&[vec![end(1, 0.0, 1.0)]], &none, 1.0);
        assert_eq!(figures.false_hits, f64::INFINITY);
    }
}

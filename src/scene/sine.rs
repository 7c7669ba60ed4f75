//! Where rays meet z = sin(wave x + phase): exact, since the places where a ray's height over the sheet turns are known.

use glam::DVec3;
use std::f64::consts::TAU;

use super::canonical::slabs;

/// The sheet's box is higher by this share, so that no crest is lost to rounding.
const ROOM: f64 = 1e-9;
/// Steps after which a root between two neighbouring numbers has long been found.
const STEPS: usize = 200;

/// A line's height over the sheet.
struct Height {
    o: DVec3,
    d: DVec3,
    wave: f64,
    phase: f64,
}

impl Height {
    fn angle(&self, t: f64) -> f64 {
        self.wave * (self.o.x + t * self.d.x) + self.phase
    }

    fn at(&self, t: f64) -> f64 {
        self.o.z + t * self.d.z - self.angle(t).sin()
    }

    fn slope(&self, t: f64) -> f64 {
        self.d.z - self.wave * self.d.x * self.angle(t).cos()
    }

    /// Where it turns between `from` and `to`, in order: cos(wave x + phase) is the quotient of the two slopes there.
    fn turns(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let pace = self.wave * self.d.x.abs();
        let phase = self.angle(0.0) * self.d.x.signum();
        let angle = (self.d.z / (self.wave * self.d.x)).acos();
        let first = ((phase + pace * from + angle) / TAU).floor();
        let at = move |k: usize| {
            let turn = TAU * (first + (k / 2) as f64) + if k.is_multiple_of(2) { -angle } else { angle };
            (turn - phase) / pace
        };
        // A line steeper than the sheet has no such angle (NaN), and never turns.
        (0..).map(at).skip_while(move |t| *t <= from).take_while(move |t| *t < to)
    }

    /// The root between two places of unlike sign: Newton's steps, halves where they leave the interval.
    fn root(&self, mut low: f64, mut high: f64) -> f64 {
        let below = self.at(low) < 0.0;
        let mut t = 0.5 * (low + high);
        for _ in 0..STEPS {
            let height = self.at(t);
            if (height < 0.0) == below {
                low = t
            } else {
                high = t
            }
            let newton = t - height / self.slope(t);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if next == t {
                break;
            }
            t = next;
        }
        t
    }
}

/// As [`Canonical::meet`](super::Canonical::meet). Between two turns there is one crossing at most; where a ray starts on
/// the sheet it is the start.
pub fn meet([wave, phase]: [f64; 2], o: DVec3, d: DVec3, near: f64, starts_here: bool) -> Option<f64> {
    let shrink = DVec3::new(1.0, 1.0, 1.0 / (1.0 + ROOM));
    let [enter, leave] = slabs(o * shrink, d * shrink);
    let start = if starts_here { 0.0 } else { enter.max(near) };
    if !(start < leave && leave.is_finite()) {
        return None;
    }
    let height = Height { o, d, wave, phase };
    let ends = height.turns(start, leave).chain([leave]);
    let mut from = start;
    for (k, to) in ends.enumerate() {
        let crosses = (height.at(from) < 0.0) != (height.at(to) < 0.0);
        if crosses && !(starts_here && k == 0) {
            return Some(height.root(from, to)).filter(|t| *t > near);
        }
        from = to;
    }
    None
}

//! Seas as scene files write them.
use std::sync::Arc;

use glam::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    Ripple, Sea, Shape,
    error::SceneError,
    file::Floats,
    locate::Key,
    measure::LARGEST,
    sea::Swell,
    sheet::{Relief, sheet},
    sheet_files::{TIMES, WAVE_CELLS, cells},
};

/// Where the file does not say.
const WIND: f64 = 1.0;
const SPREAD: f64 = 8.0;
const COUNT: u32 = 64;
/// The shortest wave has as many cells, where the file does not say how long it is.
const CELLS_A_WAVE: f64 = 8.0;
/// m/s; stronger ones have not been measured.
const WINDS: std::ops::RangeInclusive<f64> = 0.01..=100.0;
/// Beyond it waves all go the same way.
const SPREADS: std::ops::RangeInclusive<f64> = 0.0..=100.0;
const COUNTS: std::ops::RangeInclusive<f64> = 1.0..=1024.0;
const FACTORS: std::ops::RangeInclusive<f64> = 0.0..=1e3;

/// Waves of deep water by an ocean's spectrum.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeaFile {
    /// Of the rectangle.
    pub center: Floats<3>,
    /// Half edge.
    pub u: Floats<3>,
    /// Half edge, at right angles to u.
    pub v: Floats<3>,
    /// m/s, 19.5 m above the water.
    pub wind: Option<f64>,
    /// Where the wind blows to, degrees from u towards v.
    #[serde(default)]
    pub direction: f64,
    /// s: energy falls about the wind as cos²ˢ of half the angle.
    pub spread: Option<f64>,
    /// Waves that are summed.
    pub count: Option<u32>,
    /// Of the waves; else eight cells.
    pub shortest: Option<f64>,
    /// Of the waves; else the longer edge.
    pub longest: Option<f64>,
    /// Times the spectrum's heights; 0 is a calm.
    pub factor: Option<f64>,
    /// Times the waves' own speed; 0 stands still.
    pub speed: Option<f64>,
    /// Another one is another sea of the same kind.
    #[serde(default)]
    pub seed: u32,
    /// s, where the scene's time is 0.
    #[serde(default)]
    pub time: f64,
    /// Cells along the longer side.
    pub grid: Option<u32>,
}

/// A sea over a rectangle, at any time.
#[derive(Clone, Debug)]
pub struct SeaSheet {
    sea: Sea,
    /// s, at the scene's time 0.
    time: f64,
    /// Seconds of its own a second.
    pub speed: f64,
    sides: [DVec3; 3],
    cells: [usize; 2],
}

impl SeaSheet {
    /// At a time of the scene, s.
    pub fn at(&self, time: f64) -> Shape {
        let waves: Arc<[_]> = self.sea.at(self.time + self.speed * time).into();
        let [_, u, v] = self.sides;
        let size = DVec2::new(u.length(), v.length());
        let surface = |at: DVec2| (Ripple::height(&waves, at * size), Ripple::gradient(&waves, at * size));
        sheet(self.cells, Relief::Sea(waves.clone()), String::new(), self.sides, &surface)
    }
}

pub fn sea(key: &Key, file: &SeaFile, sides: [DVec3; 3], unit: f64) -> Result<SeaSheet, SceneError> {
    let number = |name: &str, given: Option<f64>, usual: f64, range, what: &str, remedy: &str| {
        key.key(name).number(given.unwrap_or(usual), range, what, remedy)
    };
    let [_, u, v] = sides;
    let edge = 2.0 * u.length().max(v.length());
    let grid = file.grid.unwrap_or(WAVE_CELLS);
    let cells = cells(&key.key("grid"), grid, sides)?;
    let length =
        |name: &str, given: Option<f64>, usual: f64| given.map_or(Ok(usual), |length| key.key(name).size(length, unit));
    let longest = length("longest", file.longest, edge)?;
    let shortest = length("shortest", file.shortest, (CELLS_A_WAVE * edge / f64::from(grid)).min(longest))?;
    if shortest > longest {
        let found = format!("{shortest} m, where the longest is {longest} m");
        return Err(key.key("shortest").fault(
            "a length up to `longest`",
            found,
            "make it shorter, or `longest` longer",
        ));
    }
    let count = file.count.unwrap_or(COUNT);
    key.key("count").number(count.into(), COUNTS, "waves", "64 is usual")?;
    let degrees = key.key("direction").number(file.direction, -360.0..=360.0, "degrees", "a full turn is 360")?;
    let swell = Swell {
        wind: number("wind", file.wind, WIND, WINDS, "a wind in m/s", "a breeze on a pool is 1, a gale 20")?,
        direction: degrees.to_radians(),
        spread: number("spread", file.spread, SPREAD, SPREADS, "an exponent s of the spread", "8 is usual")?,
        count,
        lengths: [shortest, longest],
        factor: number("factor", file.factor, 1.0, FACTORS, "a factor of the heights", "1 is the spectrum's own")?,
        seed: file.seed,
    };
    let speed = number("speed", file.speed, 1.0, -1e3..=1e3, "a factor of the speed", "0 stands still")?;
    let time = key.key("time").number(file.time, TIMES, "a time in seconds", "correct it")?;
    let sea = Sea::of(&swell);
    let highest = sea.0.iter().map(|wave| wave.first.amplitude).sum();
    key.key("factor").number(highest, 0.0..=LARGEST, "heights in metres", "make it smaller")?;
    Ok(SeaSheet { sea, time, speed, sides, cells })
}

//! Sheets as scene files write them: heights from a picture, and the wave function.
use glam::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    Shape, Wave, WaveAt,
    error::SceneError,
    file::Floats,
    locate::Key,
    measure::LARGEST,
    sheet::{Relief, sheet},
};
use crate::image::Raster;

/// Cells along a sheet's longer side: more would be eight million triangles.
const CELLS: std::ops::RangeInclusive<f64> = 1.0..=2048.0;
/// Cells of a wave where the file does not say: the finest of the paper's waves then has seven.
pub const WAVE_CELLS: u32 = 256;
const FEWER: &str = "set `grid`, which samples the picture more coarsely";
/// A factor, a size or a speed of the wave function.
const CONSTANTS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;
/// Of the wave's plane; their product is a phase.
const COORDINATES: std::ops::RangeInclusive<f64> = 0.0..=1e3;
/// s
pub const TIMES: std::ops::RangeInclusive<f64> = -1e9..=1e9;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeightsFile {
    /// A grey PNG, or an EXR of one channel.
    pub file: String,
    /// Of the rectangle.
    pub center: Floats<3>,
    /// Half edge.
    pub u: Floats<3>,
    /// Half edge, at right angles to u; the picture's upper edge is at +v.
    pub v: Floats<3>,
    /// Of a pixel of value 1; of PNG, white.
    pub height: f64,
    /// Height of a pixel of value 0.
    #[serde(default)]
    pub base: f64,
    /// Cells along the longer side; without it one between two pixels.
    pub grid: Option<u32>,
}

/// Constants that are left out are the paper's.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveFile {
    /// Of the rectangle.
    pub center: Floats<3>,
    /// Half edge.
    pub u: Floats<3>,
    /// Half edge, at right angles to u.
    pub v: Floats<3>,
    /// Of one unit of the wave; else the edge along u.
    pub length: Option<f64>,
    /// The wave's own coordinates at the centre.
    pub middle: Option<Floats<2>>,
    /// Terms of the sum.
    pub octaves: Option<u32>,
    /// WAVESIZE of the paper.
    pub wave_size: Option<f64>,
    /// FACTOR of the paper: of the first term; each next has half.
    pub factor: Option<f64>,
    /// SPEED of the paper, radians a second.
    pub speed: Option<f64>,
    /// VTXSIZE of the paper.
    pub vertex_size: Option<f64>,
    /// s, where the scene's time is 0.
    #[serde(default)]
    pub time: f64,
    /// Cells along the longer side.
    pub grid: Option<u32>,
}

/// Heights of a grey picture over a rectangle, its upper edge at +v: linear between pixels, of which the outermost lie on
/// the edges.
pub fn heights(key: &Key, file: &HeightsFile, bytes: &[u8], sides: [DVec3; 3], unit: f64) -> Result<Shape, SceneError> {
    let raster = grey(key, &file.file, bytes)?;
    let scale = key.key("height").number(file.height * unit, -LARGEST..=LARGEST, "a height in metres", "correct it")?;
    let base = key.key("base").number(file.base * unit, -LARGEST..=LARGEST, "a height in metres", "correct it")?;
    let field = Field { raster: &raster, scale, base };
    let highest = raster.samples.iter().fold(0.0_f64, |most, s| most.max((f64::from(*s) * scale + base).abs()));
    key.key("height").number(highest, 0.0..=LARGEST, "heights in metres", "make `height` smaller")?;
    let cells = match file.grid {
        Some(grid) => cells(&key.key("grid"), grid, sides)?,
        None => {
            let between = [raster.width, raster.height].map(|side| (side - 1).max(1));
            for side in between {
                key.key("file").number(side as f64, CELLS, "cells between pixels", FEWER)?;
            }
            between
        }
    };
    let [_, u, v] = sides;
    let size = DVec2::new(u.length(), v.length());
    let surface = |at: DVec2| (field.at(at), field.slope(at, cells) / size);
    Ok(sheet(cells, Relief::Heights, file.file.clone(), sides, &surface))
}

fn grey(key: &Key, file: &str, bytes: &[u8]) -> Result<Raster, SceneError> {
    let key = key.key("file");
    let remedy = "save it again as greyscale PNG of 8 or 16 bits, or as EXR of one channel";
    let fault = |found: String| key.fault("a grey picture of heights", found, remedy);
    let raster = Raster::read(bytes).map_err(|error| fault(format!("{file}: {error}")))?;
    if raster.channels != 1 {
        return Err(fault(format!("{file}, which has {} channels", raster.channels)));
    }
    if let Some([x, y]) = raster.first_not_finite() {
        return Err(fault(format!("{file}, whose pixel {x} from the left, {y} from the top is no finite number")));
    }
    Ok(raster)
}

struct Field<'a> {
    raster: &'a Raster,
    scale: f64,
    base: f64,
}

impl Field<'_> {
    /// m, at a place in [−1, 1]².
    fn at(&self, at: DVec2) -> f64 {
        let Raster { width, height, .. } = *self.raster;
        let along = |share: f64, pixels: usize| share.clamp(0.0, 1.0) * (pixels - 1) as f64;
        let (x, y) = (along(0.5 + 0.5 * at.x, width), along(0.5 - 0.5 * at.y, height));
        let ([left, top], [right, bottom]) = ([x as usize, y as usize], [x.ceil() as usize, y.ceil() as usize]);
        let pixel = |x: usize, y: usize| f64::from(self.raster.pixel(x, y)[0]);
        let row = |y: usize| pixel(left, y) + (x - left as f64) * (pixel(right, y) - pixel(left, y));
        self.base + self.scale * (row(top) + (y - top as f64) * (row(bottom) - row(top)))
    }

    /// By differences over a cell on each side, or on one at the edge; m a half edge.
    fn slope(&self, at: DVec2, cells: [usize; 2]) -> DVec2 {
        let along = |axis: DVec2, cells: usize| {
            let step = axis * (2.0 / cells as f64);
            let [from, to] = [at - step, at + step].map(|p| p.clamp(DVec2::NEG_ONE, DVec2::ONE));
            (self.at(to) - self.at(from)) / (to - from).dot(axis)
        };
        DVec2::new(along(DVec2::X, cells[0]), along(DVec2::Y, cells[1]))
    }
}

/// The wave function over a rectangle, at any time.
#[derive(Clone, Debug)]
pub struct WaveSheet {
    /// At the scene's time 0.
    first: WaveAt,
    sides: [DVec3; 3],
    cells: [usize; 2],
}

impl WaveSheet {
    /// rad/s
    pub fn speed(&self) -> f64 {
        self.first.wave.speed
    }

    /// At a time of the scene, s.
    pub fn at(&self, time: f64) -> Shape {
        let wave = WaveAt { time: self.first.time + time, ..self.first };
        let [_, u, v] = self.sides;
        let size = DVec2::new(u.length(), v.length());
        let surface = |at: DVec2| (wave.height(at * size), wave.gradient(at * size));
        sheet(self.cells, Relief::Wave(wave), String::new(), self.sides, &surface)
    }
}

/// The wave function over a rectangle.
pub fn wave(key: &Key, file: &WaveFile, sides: [DVec3; 3], unit: f64) -> Result<WaveSheet, SceneError> {
    let constant = |name: &str, given: Option<f64>, paper: f64| {
        key.key(name).number(
            given.unwrap_or(paper),
            CONSTANTS,
            "a constant of the wave",
            "the paper's are the defaults; with vertex_size = 1e-6 the water has no waves",
        )
    };
    let octaves = file.octaves.unwrap_or(Wave::PAPER.octaves);
    key.key("octaves").number(octaves.into(), 1.0..=16.0, "octaves", "each is half as long as the one before")?;
    let wave = Wave {
        octaves,
        wave_size: constant("wave_size", file.wave_size, Wave::PAPER.wave_size)?,
        factor: constant("factor", file.factor, Wave::PAPER.factor)?,
        speed: key.key("speed").number(
            file.speed.unwrap_or(Wave::PAPER.speed),
            -*CONSTANTS.end()..=*CONSTANTS.end(),
            "a speed in rad/s",
            "0 stands still",
        )?,
        vertex_size: constant("vertex_size", file.vertex_size, Wave::PAPER.vertex_size)?,
    };
    let time = key.key("time").number(file.time, TIMES, "a time in seconds", "correct it")?;
    let [_, u, v] = sides;
    let size = DVec2::new(u.length(), v.length());
    let length = file.length.map_or(Ok(2.0 * size.x), |length| key.key("length").size(length, unit))?;
    let middle = DVec2::from(file.middle.unwrap_or(Floats([0.5, 0.5])).0);
    let reach = middle.abs() + size / length;
    for end in reach.to_array() {
        let remedy = "choose a place nearer to the wave's origin, or a greater `length`";
        key.key("middle").number(end, COORDINATES, "coordinates of the wave", remedy)?;
    }
    // The factors sum to less than twice the first.
    let highest = 4.0 * length * wave.vertex_size * wave.factor * reach.length();
    key.key("vertex_size").number(highest, 0.0..=LARGEST, "heights in metres", "make it smaller")?;
    let cells = cells(&key.key("grid"), file.grid.unwrap_or(WAVE_CELLS), sides)?;
    Ok(WaveSheet { first: WaveAt { wave, time, length, middle }, sides, cells })
}

/// As many along the longer side, and along the other what makes them square.
pub fn cells(key: &Key, grid: u32, [_, u, v]: [DVec3; 3]) -> Result<[usize; 2], SceneError> {
    let grid = key.number(grid.into(), CELLS, "cells along the longer side", "256 is usual")?;
    let longest = u.length().max(v.length());
    Ok([u, v].map(|edge| (grid * edge.length() / longest).round().max(1.0) as usize))
}

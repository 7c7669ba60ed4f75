//! Surfaces that are functions of time themselves: waves that travel.
use std::f64::consts::TAU;

use super::{
    Canonical, Shape, error::SceneError, file::ObjectFile, locate::Key, object, sea_files::SeaSheet,
    sheet_files::WaveSheet,
};

/// Metres a second. Of what is fast, short and late float64 no longer tells the phase: beyond 10¹⁵ waves it is 0.
const SPEEDS: std::ops::RangeInclusive<f64> = -1e9..=1e9;

/// How a surface flows in its place.
#[derive(Clone, Debug)]
pub enum Flow {
    /// A sine along u.
    Sine {
        /// Waves a second.
        rate: f64,
    },
    /// The wave function of rendered water.
    Wave(WaveSheet),
    /// A sum of waves.
    Sea(SeaSheet),
}

impl Flow {
    /// The shape that rests as `rest` does, at a time, s.
    pub fn at(&self, rest: &Shape, time: f64) -> Shape {
        match (self, rest) {
            (Self::Sine { rate }, Shape::Canonical { kind: Canonical::Sine { wave, .. }, to_world }) => {
                // Whole waves are left out before the sine, which keeps late times exact.
                let phase = -TAU * (rate * time).fract();
                Shape::Canonical { kind: Canonical::Sine { wave: *wave, phase }, to_world: *to_world }
            }
            (Self::Wave(sheet), _) => sheet.at(time),
            (Self::Sea(sheet), _) => sheet.at(time),
            _ => rest.clone(),
        }
    }

    /// Whether its triangles change.
    pub fn deforms(&self) -> bool {
        matches!(self, Self::Wave(_) | Self::Sea(_))
    }
}

/// How an object's surface flows; `None` where it stands still. Everything else of it was checked with the shape.
pub fn flow(key: &Key, file: &ObjectFile, unit: f64) -> Result<Option<Flow>, SceneError> {
    if let Some(sine) = &file.sine {
        let key = key.key("sine");
        let speed =
            key.key("speed").number(sine.speed * unit, SPEEDS, "a speed in metres a second", "0 stands still")?;
        let rate = speed / (sine.wavelength * unit);
        return Ok((rate != 0.0).then_some(Flow::Sine { rate }));
    }
    if let Some(sea) = &file.sea {
        let sheet = object::sea(&key.key("sea"), sea, unit)?;
        return Ok((sheet.speed != 0.0).then_some(Flow::Sea(sheet)));
    }
    let Some(wave) = &file.wave else { return Ok(None) };
    let sheet = object::wave(&key.key("wave"), wave, unit)?;
    Ok((sheet.speed() != 0.0).then_some(Flow::Wave(sheet)))
}

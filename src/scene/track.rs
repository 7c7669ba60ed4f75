//! Keys in time, and what lies between them.
use glam::{DQuat, DVec3};

/// Sine of the angle between directions below which the way between them is straight.
const STRAIGHT: f64 = 1e-9;

/// A value that can be had part of the way from one to another.
pub trait Between: Copy {
    /// At a share from 0, `self`, to below 1 of the way to `next`.
    fn between(self, next: Self, share: f64) -> Self;
}

impl Between for f64 {
    fn between(self, next: Self, share: f64) -> Self {
        self + (next - self) * share
    }
}

impl Between for DVec3 {
    fn between(self, next: Self, share: f64) -> Self {
        self + (next - self) * share
    }
}

impl Between for [f64; 3] {
    fn between(self, next: Self, share: f64) -> Self {
        std::array::from_fn(|k| self[k].between(next[k], share))
    }
}

/// Turns evenly about one axis, the shorter way (Shoemake 1985, "Animating rotation with quaternion curves").
impl Between for DQuat {
    fn between(self, next: Self, share: f64) -> Self {
        self.slerp(next, share)
    }
}

/// A unit vector that turns evenly, the shorter way; opposite ones have none, and are refused in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction(pub DVec3);

impl Between for Direction {
    fn between(self, next: Self, share: f64) -> Self {
        let sine = self.0.cross(next.0).length();
        let angle = sine.atan2(self.0.dot(next.0));
        if sine < STRAIGHT {
            return Self(self.0.between(next.0, share).normalize_or(self.0));
        }
        let mixed = self.0 * ((1.0 - share) * angle).sin() + next.0 * (share * angle).sin();
        Self(mixed.normalize_or(self.0))
    }
}

/// Values at times: exact at the keys, between them as the value's kind says, held before the first and after the last.
#[derive(Clone, Debug)]
pub struct Track<T> {
    /// Times grow strictly; there is at least one.
    keys: Vec<(f64, T)>,
}

impl<T: Between> Track<T> {
    /// None without keys, or where a time is not above the one before it.
    pub fn new(keys: Vec<(f64, T)>) -> Option<Self> {
        let grow = keys.windows(2).all(|pair| pair[0].0 < pair[1].0);
        (grow && !keys.is_empty()).then_some(Self { keys })
    }

    /// The value at a time; what is no number is before the first key.
    pub fn at(&self, time: f64) -> T {
        let after = self.keys.partition_point(|(key, _)| *key <= time);
        match (after.checked_sub(1).map(|last| self.keys[last]), self.keys.get(after)) {
            (Some((key, value)), Some(&(next, to))) if key < time => value.between(to, (time - key) / (next - key)),
            (Some((_, value)), _) => value,
            (None, _) => self.keys[0].1,
        }
    }

    /// The first and the last time.
    pub fn span(&self) -> [f64; 2] {
        [self.keys[0].0, self.keys[self.keys.len() - 1].0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// A few roundings of numbers of order one.
    const ROUNDING: f64 = 1e-15;

    #[test]
    fn numbers_run_straight_between_keys_and_are_held_beyond() {
        let track = Track::new(vec![(1.0, 2.0), (2.0, 4.0), (4.0, -4.0)]).unwrap();
        for (time, value) in [(-1e6, 2.0), (1.0, 2.0), (1.25, 2.5), (2.0, 4.0), (3.0, 0.0), (4.0, -4.0), (1e6, -4.0)] {
            assert_eq!(track.at(time), value, "at {time}");
        }
        assert_eq!([track.at(f64::NAN), track.at(f64::INFINITY), track.at(f64::NEG_INFINITY)], [2.0, -4.0, 2.0]);
        assert_eq!(track.span(), [1.0, 4.0]);
    }

    #[test]
    fn keys_must_be_there_and_grow() {
        assert!(Track::<f64>::new(vec![]).is_none());
        assert!(Track::new(vec![(1.0, 0.0), (1.0, 1.0)]).is_none());
        assert!(Track::new(vec![(2.0, 0.0), (1.0, 1.0)]).is_none());
        assert!(Track::new(vec![(0.0, 0.0), (f64::NAN, 1.0)]).is_none());
    }

    #[test]
    fn rotations_turn_evenly_and_the_shorter_way() {
        let by = |angle: f64| DQuat::from_rotation_z(angle);
        let track = Track::new(vec![(0.0, by(0.0)), (1.0, by(FRAC_PI_2)), (2.0, by(-3.0))]).unwrap();
        let turned = |time: f64| track.at(time) * DVec3::X;
        assert_eq!(track.at(1.0), by(FRAC_PI_2), "a key is exact");
        for share in [0.1, 0.25, 0.5, 0.9] {
            let angle = share * FRAC_PI_2;
            assert!((turned(share) - DVec3::new(angle.cos(), angle.sin(), 0.0)).length() < 4.0 * ROUNDING);
            // From 90° to −172° it is 98° the shorter way, on through 180°.
            let on = FRAC_PI_2 + share * (2.0 * std::f64::consts::PI - 3.0 - FRAC_PI_2);
            assert!((turned(1.0 + share) - DVec3::new(on.cos(), on.sin(), 0.0)).length() < 4.0 * ROUNDING);
        }
    }

    #[test]
    fn directions_turn_evenly_and_stay_units() {
        let track = Track::new(vec![(0.0, Direction(DVec3::NEG_Y)), (2.0, Direction(DVec3::X))]).unwrap();
        for time in [0.0, 0.3, 1.0, 1.9, 2.0] {
            let angle = 0.5 * time * FRAC_PI_2;
            let expected = DVec3::new(angle.sin(), -angle.cos(), 0.0);
            assert!((track.at(time).0 - expected).length() < 4.0 * ROUNDING, "at {time}");
        }
        let near = Track::new(vec![(0.0, Direction(DVec3::Y)), (1.0, Direction(DVec3::Y))]).unwrap();
        assert_eq!(near.at(0.5).0, DVec3::Y);
    }
}

//! The specular events of a photon, and the classes they belong to.

use crate::scene::PathClass;

/// Reflections and transmissions in their order: a photon's class is decided when it lands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chain {
    events: u32,
    /// Bit k: event k is a transmission.
    transmissions: u64,
}

impl Chain {
    /// How many events.
    pub fn len(&self) -> u32 {
        self.events
    }

    /// Straight from the light.
    pub fn is_empty(&self) -> bool {
        self.events == 0
    }

    /// One event more; at most [`PathClass::LONGEST`] of them are told apart.
    pub fn then(&self, transmission: bool) -> Self {
        let bit = u64::from(transmission).checked_shl(self.events).unwrap_or(0);
        Self { events: self.events + 1, transmissions: self.transmissions | bit }
    }

    /// Whether a photon that landed after this chain is of the class.
    pub fn is_of(&self, class: PathClass) -> bool {
        match class {
            PathClass::Reflect1 => (self.events, self.transmissions) == (1, 0b0),
            PathClass::Transmit1 => (self.events, self.transmissions) == (1, 0b1),
            PathClass::Transmit2 => (self.events, self.transmissions) == (2, 0b11),
            PathClass::All(most) => (1..=most).contains(&self.events),
        }
    }

    /// Whether a photon of the class can begin with this chain.
    pub fn begins(&self, class: PathClass) -> bool {
        let all = |longest: u32, kind: u64| self.events <= longest && self.transmissions == kind & low(self.events);
        match class {
            PathClass::Reflect1 => all(1, 0),
            PathClass::Transmit1 => all(1, u64::MAX),
            PathClass::Transmit2 => all(2, u64::MAX),
            PathClass::All(most) => self.events <= most,
        }
    }
}

/// The lowest `count` bits.
fn low(count: u32) -> u64 {
    1u64.checked_shl(count).map_or(u64::MAX, |bit| bit - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_by_hand() {
        let none = Chain::default();
        let (t, r) = (none.then(true), none.then(false));
        let (tt, tr) = (t.then(true), t.then(false));
        use PathClass::{All, Reflect1, Transmit1, Transmit2};
        for (chain, of) in [
            (none, [false, false, false, false]),
            (r, [true, false, false, true]),
            (t, [false, true, false, true]),
            (tt, [false, false, true, true]),
            (tr, [false, false, false, true]),
            (tt.then(true), [false, false, false, false]),
        ] {
            assert_eq!([Reflect1, Transmit1, Transmit2, All(2)].map(|class| chain.is_of(class)), of, "{chain:?}");
        }
        assert!(t.begins(Transmit2) && tt.begins(Transmit2) && !tr.begins(Transmit2) && !r.begins(Transmit2));
        assert!(!tt.then(true).begins(Transmit2) && !tt.begins(Transmit1) && tr.begins(All(2)));
        let longest = (0..64).fold(none, |chain, _| chain.then(true));
        assert!(longest.is_of(All(64)) && longest.begins(All(64)) && !longest.then(false).begins(All(64)));
    }
}

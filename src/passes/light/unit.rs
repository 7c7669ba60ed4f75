//! The unit of sums in fixed point: fine enough for the faintest photon, coarse enough for all of the brightest.

use super::Emission;

/// Bits by which the faintest view's photons are told apart, unless the brightest ones' ask for more room.
const FINE: i32 = 31;
/// Bits that the brightest photon takes at most: 2^25 of it fit above.
const COARSE: i32 = 38;
/// Exponents of float32.
const EXPONENTS: std::ops::RangeInclusive<i32> = -126..=126;

/// The flux that a unit of sums in fixed point (`glsl/shared/flux_sums.glsl`) stands for, W: a power of two, so that
/// scaling by it rounds nothing.
pub fn flux_unit(emissions: &[Emission]) -> f64 {
    let fluxes = emissions.iter().map(Emission::most).filter(|flux| *flux > 0.0);
    let [least, most] = fluxes.fold([f64::INFINITY, 0.0], |[least, most], flux| [least.min(flux), most.max(flux)]);
    let exponent = |flux: f64, bits: i32| (flux.log2().ceil() as i32).saturating_sub(bits);
    let exponent = exponent(least, FINE).max(exponent(most, COARSE)); // of nothing: the least and the most integer
    f64::from(exponent.clamp(*EXPONENTS.start(), *EXPONENTS.end())).exp2()
}

//! Integrals and roots of smooth functions of one variable.

/// Gauss–Legendre nodes and weights of order 5 on [−1, 1] (Abramowitz & Stegun, table 25.4).
const NODES: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// ∫ f over [a, b] in one panel: exact for polynomials up to degree 9.
pub fn panel(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    let (centre, half) = (0.5 * (a + b), 0.5 * (b - a));
    half * NODES.iter().map(|(x, w)| w * f(centre + half * x)).sum::<f64>()
}

/// The point of [a, b] where `low` turns from true (at a) to false (at b), to the last bit that float64 can halve.
pub fn bisect(low: impl Fn(f64) -> bool, mut a: f64, mut b: f64) -> f64 {
    loop {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            return middle;
        }
        *if low(middle) { &mut a } else { &mut b } = middle;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panel_is_exact_to_degree_nine() {
        let integral = panel(|x| 10.0 * x.powi(9) - 3.0 * x * x, -0.5, 2.0);
        let exact = (2f64.powi(10) - 0.5f64.powi(10)) - (8.0 + 0.125);
        assert!((integral / exact - 1.0).abs() < 1e-14, "{integral} against {exact}");
    }

    #[test]
    fn bisect_finds_a_root_to_the_last_bit() {
        let root = bisect(|x| x * x < 2.0, 0.0, 2.0);
        assert!((root - 2f64.sqrt()).abs() <= f64::EPSILON, "{root}");
    }
}

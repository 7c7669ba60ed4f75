//! Shares of quads and triangles in unit squares, against clipping in float64.

use crate::common::{Probe, gpu, random::Random};
use glam::DVec2;

/// Texels a side of the map that pieces are spread over.
const SIDE: usize = 12;
/// A share of a piece: float32 coordinates up to 30 texels off, over areas down to 1/64 of a length.
const SHARE: f64 = 1e-4;

/// What lies on one side of a line across an axis (Sutherland and Hodgman 1974).
fn cut(polygon: &[DVec2], axis: usize, line: f64, sign: f64) -> Vec<DVec2> {
    let beyond = |p: DVec2| sign * (p[axis] - line);
    let mut kept = Vec::new();
    for (k, &p) in polygon.iter().enumerate() {
        let next = polygon[(k + 1) % polygon.len()];
        let (here, there) = (beyond(p), beyond(next));
        if here >= 0.0 {
            kept.push(p);
        }
        if here * there < 0.0 {
            kept.push(p.lerp(next, here / (here - there)));
        }
    }
    kept
}

fn area(polygon: &[DVec2]) -> f64 {
    let next = |k: usize| polygon[(k + 1) % polygon.len()];
    polygon.iter().enumerate().map(|(k, p)| 0.5 * p.perp_dot(next(k))).sum::<f64>().abs()
}

fn within(polygon: &[DVec2], x: f64, y: f64, side: f64) -> f64 {
    let steps = [(0, x, 1.0), (0, x + side, -1.0), (1, y, 1.0), (1, y + side, -1.0)];
    area(&steps.iter().fold(polygon.to_vec(), |p, &(axis, line, sign)| cut(&p, axis, line, sign)))
}

/// Shares by texel as the shader puts them, and the share that it says is in the map.
fn spread(pieces: &[[f32; 8]]) -> Vec<([f32; SIDE * SIDE], f32)> {
    let probe = Probe {
        includes: &["maps/spread.glsl"],
        input: "vec4 x; vec4 y;",
        output: "float share[144]; float inside;",
        before: "float shares[144];\
                 void put(ivec2 texel, int layer, vec3 flux) { shares[12 * texel.y + texel.x] += flux.g; }",
        body: "for (int k = 0; k < 144; k++) shares[k] = 0.0;\
               Flat t = Flat(q.x, q.y);\
               spread(t, 12, 0, vec3(0.0, 1.0, 0.0));\
               r.inside = share_within(t, 12.0);\
               r.share = shares;",
        ..Default::default()
    };
    let out: Vec<[[f32; 5]; 29]> = probe.run(&gpu(), pieces);
    let split = |o: &[[f32; 5]; 29]| (o.as_flattened()[..SIDE * SIDE].try_into().unwrap(), o[28][4]);
    out.iter().map(split).collect()
}

fn corners(piece: &[f32; 8]) -> Vec<DVec2> {
    (0..4).map(|k| DVec2::new(piece[k].into(), piece[4 + k].into())).collect()
}

fn triangle([a, b, c]: [[f32; 2]; 3]) -> [f32; 8] {
    [a[0], b[0], c[0], c[0], a[1], b[1], c[1], c[1]]
}

#[test]
fn shares_are_what_clipping_leaves() {
    let mut random = Random(7);
    let mut pieces = Vec::new();
    for k in 0..1500 {
        let reach = [0.3, 2.0, 9.0, 40.0][k % 4];
        let middle = [random.within(-2.0, 14.0), random.within(-2.0, 14.0)];
        let mut at = || middle.map(|m| (m + random.within(-reach, reach)) as f32);
        let (a, b, c) = (at(), at(), at());
        // A quad that turns one way: the fourth corner beyond the side a–c, as far as b is before it.
        let d = [a[0] + c[0] - b[0], a[1] + c[1] - b[1]];
        pieces.push(match k % 3 {
            0 => [a[0], b[0], c[0], d[0], a[1], b[1], c[1], d[1]],
            _ => triangle([a, b, c]),
        });
    }
    let wide = |p: &[f32; 8]| {
        let c = corners(p);
        let longest = (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).map(|(i, j)| (c[i] - c[j]).length());
        2.0 * area(&c) > longest.fold(0.0, f64::max) / 32.0
    };
    pieces.retain(wide);
    assert!(pieces.len() > 1300, "{}", pieces.len());
    let (mut worst, mut sum_off) = (0f64, 0f64);
    for (piece, (shares, inside)) in pieces.iter().zip(spread(&pieces)) {
        let polygon = corners(piece);
        let whole = area(&polygon);
        for (k, &share) in shares.iter().enumerate() {
            let expected = within(&polygon, (k % SIDE) as f64, (k / SIDE) as f64, 1.0) / whole;
            let off = (f64::from(share) - expected).abs();
            worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
        }
        let sum: f64 = shares.iter().map(|&s| f64::from(s)).sum();
        sum_off = sum_off.max((sum - f64::from(inside)).abs());
        assert!((f64::from(inside) - within(&polygon, 0.0, 0.0, 12.0) / whole).abs() <= SHARE, "{piece:?}: {inside}");
    }
    println!("worst share {worst:.1e}, sums {sum_off:.1e} of {SHARE:e}");
    assert!(worst <= SHARE && sum_off <= SHARE, "{worst} {sum_off}");
}

#[test]
fn what_has_no_area_is_a_line_or_a_point_and_is_all_there() {
    let mut random = Random(11);
    // By hand first: a point; a point on a texel's corner; lines along a texel's edge, across and along; a tent's half.
    let mut pieces = vec![
        triangle([[3.5, 4.5]; 3]),
        triangle([[3.0, 4.0]; 3]),
        triangle([[3.0, 1.0], [3.0, 5.0], [3.0, 2.0]]),
        triangle([[1.0, 7.0], [5.0, 7.0], [5.0, 7.0]]),
        triangle([[0.5, 0.5], [2.5, 0.5], [1.5, 0.5]]),
        triangle([[0.0, 0.0], [1e-30, 1e-38], [0.0, 1e-38]]),
    ];
    for _ in 0..300 {
        let mut at = || [random.within(-3.0, 15.0) as f32, random.within(-3.0, 15.0) as f32];
        let (a, b) = (at(), at());
        let s = random.within(0.0, 1.0) as f32;
        let third = [0, 1].map(|k| a[k] + s * (b[k] - a[k]));
        pieces.extend([triangle([a, b, third]), triangle([b, third, a]), triangle([a, a, b])]);
    }
    let out = spread(&pieces);
    for (piece, (shares, inside)) in pieces.iter().zip(&out) {
        let sum: f64 = shares.iter().map(|&s| f64::from(s)).sum();
        assert!((sum - f64::from(*inside)).abs() <= SHARE, "{piece:?}: {sum} of {inside}");
    }
    let at = |piece: usize, x: usize, y: usize| f64::from(out[piece].0[y * SIDE + x]);
    assert_eq!((at(0, 3, 4), at(1, 3, 4)), (1.0, 1.0));
    // Along an edge a line is its right or lower texels'; a tent with its top a quarter of the way.
    assert!((at(2, 3, 1) - 0.25).abs() < SHARE && (at(3, 1, 7) - 0.0625).abs() < SHARE, "{}", at(3, 1, 7));
    let tent = [at(4, 0, 0), at(4, 1, 0), at(4, 2, 0)];
    assert!([0.125, 0.75, 0.125].iter().zip(tent).all(|(want, got)| (want - got).abs() < SHARE), "{tent:?}");
    assert!(out[5].0[0] == 1.0);
}

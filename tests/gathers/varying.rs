//! Varying splats (Wyman 2008, section 3.3): what is not bent has splats of the printed size; levels hold what they should.

use nephroid::{gpu::Gpu, renderer::Dump};

use super::common::{
    gpu,
    picture::{Picture, job_of, picture, scene},
};

/// Photons lie half a map's texels apart or less: nothing is dropped, and what is in no level is lost.
const KEPT: f64 = 1e-4;
/// Of the mean: splats twice as wide as photons lie apart, lowered to zero at their edge, sum to 0.865 over a photon and to 0.942
/// between two along an axis, which is uneven by 4 % in the plane; texels make it 5.6 %.
const EVEN: f64 = 0.07;

/// Ellipses longer than a point can be wide, which are made shorter: float32 sums of a few hundred texels; measured 1.2·10⁻⁷. With texels
/// outside the window taken, where a side is one texel wide, the strip has 255 times its light.
const LONG: f64 = 1e-6;

/// Light straight down through flat water, of some half size (m), over a floor of 2 m: photons stay as far apart as they
/// were sent.
fn rendered(gpu: &Gpu, half: &str, set: &[(&str, &str)]) -> Picture {
    let sides = [format!("[{half}, 0.0, 0.0]"), format!("[0.0, 0.0, -{half}]")];
    let water = scene("flat-water", &[("objects.water.quad.u", &sides[0]), ("objects.water.quad.v", &sides[1])]);
    let all: Vec<_> = set.iter().copied().chain([("maps.side", "128"), ("eye.samples", "2")]).collect();
    picture(gpu, &job_of(water, &all, "region", [61, 61]))
}

/// Mean and unevenness, but for a border as wide as the widest splats: what falls beside the floor is no photon of it.
fn spread(picture: &Picture) -> (f64, f64) {
    const BORDER: usize = 12;
    let all = picture.mean("irradiance.caustic");
    let side = all.len().isqrt();
    let inner = BORDER..side - BORDER;
    let caustic: Vec<f64> = inner.clone().flat_map(|y| &all[y * side..][inner.clone()]).copied().collect();
    let mean = caustic.iter().sum::<f64>() / caustic.len() as f64;
    let squares = caustic.iter().map(|v| (v / mean - 1.0).powi(2)).sum::<f64>() / caustic.len() as f64;
    (mean, squares.sqrt())
}

#[test]
fn splats_of_unbent_light_meet_without_gaps() {
    let gpu = gpu();
    for side in ["48", "37", "23"] {
        let [fixed, single, multires, area, lens, elliptic] = [
            [("maps.splat", "fixed"), ("maps.target", "single"), ("maps.footprint", "distance")],
            [("maps.splat", "varying"), ("maps.target", "single"), ("maps.footprint", "distance")],
            [("maps.splat", "varying"), ("maps.target", "multires"), ("maps.footprint", "distance")],
            [("maps.splat", "varying"), ("maps.target", "single"), ("maps.footprint", "area")],
            [("maps.splat", "thin-lens"), ("maps.target", "single"), ("maps.footprint", "distance")],
            [("maps.splat", "elliptic"), ("maps.target", "single"), ("maps.footprint", "distance")],
        ]
        .map(|set| rendered(&gpu, "2.0", &[set.as_slice(), &[("light.side", side)]].concat()));
        let gaps = spread(&fixed).1;
        assert!(gaps > 5.0 * EVEN, "or the others show nothing: {gaps}");
        let between = [("maps.splat", "interpolated"), ("maps.traverse", "fetch"), ("light.side", side)];
        let between = rendered(&gpu, "2.0", &between);
        for picture in [&single, &multires, &area, &lens, &elliptic, &between] {
            let (mean, uneven) = spread(picture);
            println!("{side}²: uneven by {uneven:.4}, fixed by {gaps:.3}");
            assert!(uneven < EVEN, "{side}² photons: {uneven}");
            assert!((mean / spread(&single).0 - 1.0).abs() < EVEN, "{side}² photons");
            let kept = picture.energy.ratio.expect("light arrives");
            assert!((kept - 1.0).abs() < KEPT, "{side}² photons: {kept}");
        }
    }
}

/// Flux in each level's layer of the map, and whether any lies beyond the level's corner.
fn levels(picture: &Picture) -> ([f64; 4], bool) {
    let Dump::Image { extent, layers, .. } = picture.renderer.dump("maps/map").unwrap() else { panic!("an image") };
    let mut beyond = false;
    let mut sums = [0.0; 4];
    for (level, texels) in layers.iter().take(4).enumerate() {
        let side = (extent[0] as usize).div_ceil(1 << level);
        for (at, texel) in texels.chunks_exact(4).enumerate() {
            let (x, y) = (at % extent[0] as usize, at / extent[0] as usize);
            beyond |= texel[0] != 0.0 && (x >= side || y >= side);
            sums[level] += f64::from(texel[0]);
        }
    }
    (sums, beyond)
}

#[test]
fn each_diameter_goes_to_the_level_that_is_printed() {
    let gpu = gpu();
    // 16² photons over 128² texels: D = 16, log2(D / 5) = 1.7; 4²: D = 64, 3.7; 2²: D = 128, 4.7.
    let cases = [
        ("16", "trunc", Some(1)),
        ("16", "ceil", Some(2)),
        ("4", "trunc", Some(3)),
        ("4", "ceil", None),
        ("2", "trunc", None),
    ];
    for (side, level, expected) in cases {
        for traverse in ["compute", "fetch"] {
            let set = [
                ("maps.splat", "varying"),
                ("maps.target", "multires"),
                ("maps.traverse", traverse),
                ("maps.level", level),
                ("light.side", side),
            ];
            let picture = rendered(&gpu, "1.0", &set);
            let (sums, beyond) = levels(&picture);
            assert!(!beyond, "light beyond a level's corner");
            let filled: Vec<usize> = (0..4).filter(|&l| sums[l] > 0.0).collect();
            assert_eq!(
                filled,
                expected.into_iter().collect::<Vec<_>>(),
                "{side}² photons, {level}, {traverse}: {sums:?}"
            );
            let kept = picture.energy.ratio.expect("light arrives");
            let whole = if expected.is_some() { 1.0 } else { 0.0 };
            assert!((kept - whole).abs() < KEPT, "what is dropped is missing in the energy: {kept}");
        }
    }
}

/// Neighbours land hundreds of texels apart in one direction and together in the other: no light is lost or made where such
/// ellipses are drawn, nor where they are summed.
#[test]
fn ellipses_longer_than_a_point_keep_their_light() {
    let gpu = gpu();
    for traverse in ["fetch", "compute"] {
        let ratio = |scene, light, map| {
            let set =
                [("maps.traverse", traverse), ("maps.splat", "elliptic"), ("light.side", light), ("maps.side", map)];
            picture(&gpu, &job_of(scene, &set, "region", [16, 16])).energy.ratio.expect("light arrives")
        };
        let bunny = ratio(scene("bunny", &[]), "32", "512");
        // Seven columns of photons some 290 texels apart, three over the floor, whose rows lie within a texel.
        let strip = [("objects.water.quad.u", "[2.0, 0.0, 0.0]"), ("objects.water.quad.v", "[0.0, 0.0, -0.0005]")];
        let strip = ratio(scene("flat-water", &strip), "7", "1024");
        println!("{traverse}: bunny {:+.1e}, strip {:+.1e}", bunny - 1.0, strip - 1.0);
        assert!((bunny - 1.0).abs() <= LONG && (strip - 1.0).abs() <= LONG, "{traverse}: {bunny}, {strip}");
    }
}

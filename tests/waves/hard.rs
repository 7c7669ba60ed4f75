//! Where equations end: no pixel may be without a number, and the validation layers say nothing (`picture` holds both).

use nephroid::{methods::Outcome, passes::account::Account, renderer::plan};

use crate::{
    PAPER, VARIANTS,
    common::{gpu, picture::picture},
    shown, sized, waves,
};

/// Odd, so that a pixel looks at the region's very middle.
const SIZE: [u32; 2] = [15, 15];

#[test]
fn every_variant_has_an_answer_everywhere() {
    let gpu = gpu();
    const FLOOR: &str = "scene.objects.floor.quad.center";
    const SUN: &str = "scene.lights.sun.directional.direction";
    let cases: [(&str, &[(&str, &str)]); 9] = [
        ("the origin, where the wave is a cone's tip", &[("scene.objects.water.wave.middle", "[0, 0]")]),
        ("a depth of nothing", &[("scene.objects.water.wave.vertex_size", "1e-6"), (FLOOR, "[0, 0, 0]")]),
        ("a depth of 10^4 m", &[(FLOOR, "[0, -1e4, 0]")]),
        ("a floor above the troughs", &[(FLOOR, "[0, 0, 0]")]),
        ("slopes past total reflection", &[("scene.objects.water.wave.vertex_size", "0.1")]),
        ("an octave finer than pixels", &[("scene.objects.water.wave.octaves", "16")]),
        ("the sun at 89.9 degrees", &[(SUN, "[1, -0.001745, 0]")]),
        ("10^6 s later", &[("scene.objects.water.wave.time", "1e6")]),
        ("a sea without waves", &[("scene.objects.water.wave.vertex_size", "1e-6")]),
    ];
    for variant in VARIANTS {
        for (case, set) in &cases {
            let set = [*set, &[("waves.variant", variant)], sized(variant, "16", "32").as_slice()].concat();
            let (light, _) = shown(&gpu, &waves(PAPER, &set, "region", SIZE));
            let (dark, lit) = (light.iter().filter(|x| **x == 0.0).count(), light.iter().filter(|x| **x > 0.0).count());
            // The listing knows neither depth nor refraction.
            match *case {
                _ if variant == "listing" => {}
                "a depth of 10^4 m" => assert_eq!(lit, 0, "{variant}"),
                "a floor above the troughs" => assert!(dark > 0 && lit > 0, "{variant}: {dark} dark, {lit} lit"),
                "slopes past total reflection" => assert!(dark > 0, "{variant}"),
                "a sea without waves" => {
                    let expected = (-0.24f64 * 0.8).exp();
                    assert!(light.iter().all(|x| (x - expected).abs() < 1e-5), "{variant}: {light:?}");
                }
                _ => assert!(lit > 0, "{variant}: {case}"),
            }
        }
    }
}

#[test]
fn a_camera_in_the_water_sees_it_and_twice_the_same() {
    let gpu = gpu();
    for variant in VARIANTS.into_iter().chain(["inverse"]) {
        let set = [
            ("scene.cameras.main.pinhole.position", "[0, 0, 0]"),
            ("scene.cameras.main.pinhole.target", "[0.1, -0.4, 0]"),
            ("waves.variant", variant),
            ("eye.samples", "1"),
        ];
        let job = waves(PAPER, &[&set, sized(variant, "16", "32").as_slice()].concat(), "main", SIZE);
        let [once, twice] = [0, 1].map(|_| picture(&gpu, &job));
        assert!(once.sum("irradiance.caustic") + once.sum("caustic") > 0.0, "{variant}");
        assert_eq!(once.layers, twice.layers, "{variant}");
    }
}

/// Black pictures are warned of by every variant, and nothing is planned for them.
#[test]
fn what_shows_nothing_is_said() {
    const DARK: (&str, &str) = ("scene.lights.sun.directional.irradiance", "0");
    for variant in ["inverse", "pixel"] {
        for (scene, set, why) in [
            ("diffuse", None, Some("no water")),
            ("flat-water", Some(DARK), Some("with any power")),
            ("flat-water", None, None),
        ] {
            let set: Vec<_> = [("waves.variant", variant)].into_iter().chain(set).collect();
            let job = waves(scene, &set, "region", SIZE);
            let (scene, settings, account) = (&*job.scene, &job.settings, &Account::default());
            let shown = Outcome { scene, receiver: &scene.region, settings, account };
            let told = job.providers.surface.expect("waves").warnings(&shown);
            let nothing = told.iter().find(|line| line.contains("waves show nothing"));
            let left = plan(&job).unwrap().plan.left_out;
            let left = left.iter().find(|left| left.name == "eye/surface");
            for said in [nothing.map(String::as_str), left.map(|left| left.reason.as_str())] {
                assert_eq!(said.is_some(), why.is_some(), "{variant}: {told:?}");
                assert!(said.zip(why).is_none_or(|(said, why)| said.contains(why)), "{variant}: {said:?}");
            }
        }
    }
}

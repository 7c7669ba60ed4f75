//! Every method on every shipped scene against a reference that is kept, each with a bound of its own.

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use nephroid::{
    image::Layers,
    lab::{self, Comparison, MEASURES, Picture},
    methods,
    scene::{PathClass, Scene},
    settings::Settings,
    truth,
};

/// The judged relMSE that each method had on each scene (lavapipe, `light.side` 256 where light is spread by cells, 1024 in class
/// `all:N`, where it is by splats, defaults else).
const MEASURED: [(&str, &str, f64); 14] = [
    ("bending", "maps", 9.7e-5), // at 0 s
    ("bunny", "maps", 7.6e-4),
    ("diffuse", "maps", 6.6e-4), // the reference's own noise along the shadow's edge
    ("flat-water", "maps", 5.3e-13),
    ("gem", "maps", 1.8e-3), // its reference is of photons too: 1e-4 of it is their noise
    ("glass-sphere", "maps", 3.3e-5),
    ("knot", "maps", 1.4e-3),
    ("moving-sphere", "maps", 4.7e-6), // at 0 s
    ("null", "maps", 2.1e-4),
    // One pixel has it all, and next to nothing lies beside it.
    ("paraboloid", "maps", 7.2e-3),
    ("ring", "maps", 2.5e-3),
    ("room", "maps", 3.3e-3),
    ("sine-water", "maps", 2.7e-6),
    ("water", "maps", 1.3e-3),
];
/// How much more than measured is allowed: other devices round other photons over a texel's edge.
const MARGIN: f64 = 1.25;
/// What is allowed however little was measured: float32 roundings of some thousand photons a texel.
const ROUNDING: f64 = 1e-10;
/// Share of the caustic's energy that may be lost or made.
const ENERGY: f64 = 0.01;

fn place(scene: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/references").join(format!("{scene}.exr"))
}

fn reference(scene: &str) -> Picture {
    Picture::read(&place(scene))
        .unwrap_or_else(|error| panic!("{error}; tests/references/README.md says how it is made"))
}

fn rendered(scene: &str, method: &str) -> Picture {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.args(["render", scene, "--method", method, "--camera", "region", "--size", "128x128", "--validation"]);
    let all = matches!(Scene::load(scene, &[]).expect("a shipped scene").paths, PathClass::All(_));
    let side = if all { "light.side=1024" } else { "light.side=256" };
    command.args(["--set", side, "--warmup", "0", "--repeat", "1", "--out"]).arg(folder.path().join("out"));
    let output = command.output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Picture::read(&folder.path().join("out/image.exr")).expect("a picture")
}

fn value(comparison: &Comparison, measure: &str) -> f64 {
    let at = MEASURES.iter().position(|name| *name == measure).expect("a measure");
    comparison.measures[at].value
}

#[test]
fn every_method_on_every_scene_is_as_right_as_it_was() {
    let mut wrong = Vec::new();
    for (scene, _) in Scene::shipped() {
        let reference = reference(scene);
        // What is right only up to a scale is held to its own equations (`tests/waves`).
        for method in methods::ALL.iter().filter(|method| !method.is_relative(&Settings::default())) {
            let Some((_, _, measured)) = MEASURED.iter().find(|(s, m, _)| *s == scene && *m == method.name()) else {
                wrong.push(format!("{scene}, {}: no bound; add what was measured", method.name()));
                continue;
            };
            // Where nothing is specular there is direct light alone.
            let caustic = Scene::load(scene, &[]).expect("a shipped scene").has_specular();
            let layer = if caustic { "irradiance.caustic" } else { "irradiance.direct" };
            let comparison = lab::compare(&rendered(scene, method.name()), &reference, layer).expect("comparable");
            let (relmse, energy) = (value(&comparison, "relmse"), value(&comparison, "energy_ratio"));
            let bound = (MARGIN * measured).max(ROUNDING);
            println!("{scene:13} {:6} relmse {relmse:.3e} of {bound:.1e}, energy {energy:.5}", method.name());
            wrong.extend(comparison.warnings.iter().map(|warning| format!("{scene}: {warning}")));
            // What is no number is not right.
            let (alike, whole) = (relmse <= bound, (energy - 1.0).abs() <= ENERGY);
            if !alike {
                wrong.push(format!("{scene}, {}: relmse {relmse:e}, above {bound:e}", method.name()));
            }
            if !whole {
                wrong.push(format!("{scene}, {}: energy {energy}", method.name()));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn references_are_of_these_scenes_and_of_this_truth() {
    for (name, _) in Scene::shipped() {
        let scene = Scene::load(name, &[]).expect("a shipped scene");
        let bytes = std::fs::read(place(name)).expect("a reference");
        let (_, about) = Layers::from_exr(&bytes).expect("an EXR file");
        let of = |key: &str| about.get(key).cloned().unwrap_or_default();
        assert_eq!(of("scene.hash"), scene.source.hash, "{name}: the scene has changed since its reference was made");
        assert_eq!(of("truth.version"), truth::VERSION.to_string(), "{name}: made by another version of the truth");
        assert_eq!(
            (of("camera").as_str(), of("size").as_str(), of("finished").as_str()),
            ("region", "128x128", "true")
        );
    }
}

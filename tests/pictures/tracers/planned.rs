//! What is planned for which tracer, and what each refuses, with its reason and remedy.

use nephroid::{
    gpu::{Phase, Plan},
    renderer,
    scene::Scene,
};

use super::tracers;
use crate::common::picture::{job_of, rewritten, scene, written};

fn planned(scene: Scene, set: &[(&str, &str)]) -> Result<Plan, String> {
    renderer::plan(&job_of(scene, set, "region", [8, 8])).map(|planned| planned.plan).map_err(|e| e.to_string())
}

fn names(plan: &Plan, phase: Phase) -> Vec<&str> {
    plan.passes.iter().filter(|p| p.phase == phase && p.name.starts_with("light/")).map(|p| p.name.as_str()).collect()
}

#[test]
fn only_what_the_tracer_needs_is_planned() {
    let plan = |name: &str, tracer: &str| planned(scene(name, &[]), &[("light.tracer", tracer)]).unwrap();
    let bvh = plan("glass-sphere", "bvh");
    assert_eq!(names(&bvh, Phase::Frame), ["light/photons"]);
    assert!(bvh.images.iter().all(|i| i.name.starts_with("light/photons") || !i.name.starts_with("light/")));
    let march = plan("glass-sphere", "march"); // what all tiles of a view share comes first
    assert_eq!(names(&march, Phase::Frame), ["light/back", "light/receivers", "light/front", "light/photons"]);
    assert_eq!(names(&march, Phase::Account), ["light/back", "light/receivers", "light/front", "light/account"]);
    assert!(names(&march, Phase::Prepare).is_empty());
    assert!(march.left_out.iter().any(|l| l.name == "light/blockers"), "the floor lies behind the ball");
    let wyman = plan("glass-sphere", "wyman2005");
    assert_eq!(names(&wyman, Phase::Prepare), ["light/front", "light/inward"]);
    let bunny = plan("bunny", "march");
    assert!(names(&bunny, Phase::Frame).contains(&"light/blockers"), "seen from the side the floor begins before it");
    let ring = plan("ring", "wyman2005");
    assert!(!names(&ring, Phase::Frame).contains(&"light/back") && names(&ring, Phase::Prepare).is_empty());
    assert!(ring.left_out.iter().any(|l| l.name == "light/back"));
}

#[test]
fn what_no_image_shows_is_refused_with_a_remedy() {
    let lamp = |position: &str| {
        let sun = "[lights.sun.directional]\ndirection = [0.0, -1.0, 0.0]   # in which the light travels\n\
                   irradiance = 1.0               # W/m² on a plane that faces the light\n";
        let lamp = format!("[lights.lamp.point]\nposition = {position}\nintensity = 1.0\n");
        written(&rewritten("glass-sphere", &[(sun, &lamp)], ""), &[])
    };
    let bubble = "[objects.bubble]\nmaterial = \"air\"\n[objects.bubble.sphere]\ncenter = [0, 0, 0]\nradius = 0.5\n\
                  [materials.air.dielectric]\nior = 1.0\n";
    let cases = [
        (written(&rewritten("glass-sphere", &[], bubble), &[]), "the object 'bubble'", "lies in 'glass'"),
        (lamp("[0.0, 0.2, 0.0]"), "the light 'lamp'", "inside a body"),
        (lamp("[0.0, 1.01, 0.0]"), "the light 'lamp'", "no one frustum"),
    ];
    for (scene, what, why) in cases {
        for tracer in tracers() {
            let text = planned(scene.clone(), &[("light.tracer", tracer)]).unwrap_err();
            let said = [what, why, tracer, "use light.tracer=bvh"].iter().all(|part| text.contains(part));
            assert!(said, "{what}: {text}");
        }
        planned(scene, &[]).unwrap();
    }
    for tracer in tracers() {
        let text = planned(scene("ring", &[]), &[("light.tracer", tracer), ("light.paths", "all:4")]).unwrap_err();
        assert!(text.contains("class all:4") && text.contains("use light.tracer=bvh"), "{text}");
    }
    let text = planned(scene("flat-water", &[]), &[("light.total_reflection", "follow")]).unwrap_err();
    assert!(text.contains("class transmit-1") && text.contains("light.total_reflection=drop"), "{text}");
}

/// A lamp under water, or one with six views, is no trouble to a class of one surface.
#[test]
fn one_surface_is_never_refused() {
    let sun = "[lights.sun.directional]\ndirection = [0.0, -1.0, 0.0]\nirradiance = 1.0";
    for height in ["-0.5", "0.01"] {
        let lamp = format!("[lights.lamp.point]\nposition = [0.0, {height}, 0.0]\nintensity = 1.0\n");
        let water = written(&rewritten("flat-water", &[(sun, &lamp)], ""), &[]);
        for tracer in tracers() {
            planned(water.clone(), &[("light.tracer", tracer)]).unwrap();
        }
    }
}

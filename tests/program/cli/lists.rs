//! Commands that render nothing.

use super::{column, nephroid, rendered};

const FORMATS: [&str; 4] = ["table", "json", "csv", "md"];

#[test]
fn every_list_has_every_format() {
    for (command, wanted) in
        [("scenes", "glass-sphere"), ("methods", "light.side"), ("devices", "maps"), ("plan null", "light/photons")]
    {
        for format in FORMATS {
            let ran = nephroid(&format!("{command} --format {format}")).ok();
            assert!(ran.out.contains(wanted), "{command} --format {format}: {}", ran.out);
            assert!(ran.out.ends_with('\n'), "{command} --format {format}");
            match format {
                "json" => assert!(ran.json()["schema"].as_str().unwrap().starts_with("nephroid."), "{}", ran.out),
                "csv" => assert!(ran.rows().len() > 1, "{}", ran.out),
                "md" => assert!(ran.out.lines().any(|l| l.starts_with("|--")), "{}", ran.out),
                _ => assert!(ran.out.lines().any(|l| l.len() > 2 && l.chars().all(|c| c == '-')), "{}", ran.out),
            }
        }
    }
}

#[test]
fn methods_list_every_setting_with_unit_default_range_and_meaning() {
    let methods = nephroid("methods --format json").ok().json();
    assert_eq!(column(&methods["methods"], "name"), ["maps", "waves"]);
    let known: Vec<_> = nephroid::renderer::all_settings();
    assert_eq!(column(&methods["settings"], "setting"), known.iter().map(|s| s.key()).collect::<Vec<_>>());
    for key in ["default", "range", "doc"] {
        assert!(column(&methods["settings"], key).iter().all(|text| !text.is_empty()), "a setting without {key}");
    }
    let side = methods["settings"].as_array().unwrap().iter().find(|s| s["setting"] == "light.side").unwrap();
    assert_eq!([&side["unit"], &side["default"], &side["range"]], ["texels", "512", "1 to 16384"]);
}

#[test]
fn devices_say_which_methods_run_there() {
    let devices = nephroid("devices --format json").ok().json();
    let first = &devices["devices"][0];
    assert_eq!(first["uuid"].as_str().unwrap().len(), 32);
    assert_eq!(first["methods"][0]["name"], "maps");
    let (runs, lacks) = (&first["methods"][0]["runs"], first["methods"][0]["lacks"].as_array().unwrap());
    let missing = first["missing"].as_array().unwrap();
    assert_eq!(runs.as_bool().unwrap(), lacks.is_empty() && missing.is_empty());
}

#[test]
fn the_plan_of_a_diffuse_scene_says_what_it_leaves_out_and_why() {
    let plan = nephroid("plan diffuse --format json").ok().json();
    for name in ["light/photons", "maps/gather", "eye/surface", "eye/trace"] {
        assert!(column(&plan["left_out"], "name").contains(&name), "{name} is not said to be left out");
        assert!(!column(&plan["passes"], "name").contains(&name), "{name} is planned");
    }
    assert!(column(&plan["left_out"], "reason").iter().all(|why| *why == "nothing in the scene is specular"));
    assert!(column(&plan["resources"], "name").iter().all(|name| !name.starts_with("maps/")));
    let table = nephroid("plan diffuse").ok().out;
    assert!(table.contains("left out") && table.contains("nothing in the scene is specular"), "{table}");
}

#[test]
fn a_plan_needs_no_device() {
    let ran = super::program()
        .args(["plan", "glass-sphere", "--method", "maps"])
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .output()
        .unwrap();
    assert!(super::Ran::from(ran).ok().out.contains("light/photons"));
}

#[test]
fn what_is_planned_is_what_is_timed() {
    for scene in ["glass-sphere", "flat-water --surface maps", "diffuse", "bunny --method none"] {
        let plan = nephroid(&format!("plan {scene} {} --format json", "--size 48x32")).ok().json();
        let passes = plan["passes"].as_array().unwrap().iter().filter(|p| p["phase"] == "frame");
        let planned: Vec<_> = passes.map(|p| p["name"].as_str().unwrap()).collect();
        let result = rendered(&format!("{scene} --format json")).2.json();
        assert_eq!(planned, column(&result["stages"], "path"), "{scene}");
    }
}

#[test]
fn help_and_version_are_no_errors() {
    for (arguments, wanted) in [("--help", "render"), ("--version", env!("CARGO_PKG_VERSION")), ("render -h", "--set")]
    {
        assert!(nephroid(arguments).ok().out.contains(wanted), "{arguments}");
    }
}

#[test]
fn the_schema_is_printed_for_editors() {
    let schema = nephroid("schema").ok().json();
    assert_eq!(schema, nephroid::scene::Scene::schema());
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

//! The JSON schema for editors says yes where the reader does, and no to what has the wrong shape.
use nephroid::scene::Scene;
use serde_json::Value;

use super::{BASE, Folder};

/// What is wrong of `BASE` with one passage changed; where the reader finds a fault too, it is the same one.
#[rustfmt::skip]
const WRONG: &[(&str, &str, &str)] = &[
    ("a version of the future", "version = 1", "version = 2"),
    ("no title", "title = \"Test\"\n", ""),
    ("a title that is a number", "title = \"Test\"", "title = 3"),
    ("a class that there is not", "paths = \"transmit-2\"", "paths = \"refract-2\""),
    ("an unknown table", "[region]", "[regoin]"),
    ("an unknown key", "radius = 1", "radius = 1\nradus = 1"),
    ("a key too few", "radius = 1", ""),
    ("a number in quotes", "radius = 1", "radius = \"1\""),
    ("two numbers for three", "center = [0, 0, 0]", "center = [0, 0]"),
    ("four numbers for three", "center = [0, 0, 0]", "center = [0, 0, 0, 0]"),
    ("no such shape", "[objects.ball.sphere]", "[objects.ball.spheer]"),
    ("a material of no kind", "[materials.silver.mirror]\nreflectance = 0.9", "[materials.silver]"),
    ("a material of two kinds", "albedo = 0.8", "albedo = 0.8\n[materials.white.mirror]\nreflectance = 1"),
    ("an index of no known material", "ior = 1.5", "ior = \"galss\""),
    ("an index by no known equation", "ior = 1.5", "ior = { sellmeier = [1, 2] }"),
    ("a key without a time", "material = \"glass\"", "material = \"glass\"\nmotion.scale = [{ value = 2 }]"),
    ("a sky of no kind", "[region]", "[sky]\n[region]"),
    ("a sky of two kinds", "[region]", "[sky]\ngradient = { zenith = 1, horizon = 1 }\nimage = { file = \"s.exr\" }\n[region]"),
    ("an unknown key of motion", "material = \"glass\"", "material = \"glass\"\nmotion.size = []"),
];

fn json(scene: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(scene).expect("TOML")).expect("JSON")
}

fn validator() -> jsonschema::Validator {
    jsonschema::draft202012::new(&Scene::schema()).expect("a JSON schema")
}

#[test]
fn every_shipped_scene_fits_the_schema() {
    let schema = validator();
    for (name, _) in Scene::shipped() {
        let text = Scene::load(name, &[]).expect("a shipped scene").source.text;
        if let Err(fault) = schema.validate(&json(&text)) {
            panic!("{name}: {fault}, at {}", fault.instance_path());
        }
    }
}

#[test]
fn what_the_reader_would_refuse_for_its_shape_the_schema_refuses() {
    let (schema, folder) = (validator(), Folder::new());
    assert!(schema.is_valid(&json(BASE)));
    for (what, from, to) in WRONG {
        let text = BASE.replacen(from, to, 1);
        assert_ne!(text, BASE, "{what}: `{from}` is not in the base scene");
        assert!(!schema.is_valid(&json(&text)), "the schema takes {what}");
        assert!(folder.load(&text, &[]).is_err(), "the reader takes {what}");
    }
}

#[test]
fn each_way_of_writing_an_index_or_a_colour_fits() {
    let schema = validator();
    for ior in ["2", "1.5", "[1.5, 1.51, 1.52]", "\"water\"", "{ cauchy = [1.5, 0.004] }"] {
        assert!(schema.is_valid(&json(&BASE.replacen("ior = 1.5", &format!("ior = {ior}"), 1))), "{ior}");
    }
    for albedo in ["1", "0.8", "[0.8, 0.1, 0]"] {
        assert!(schema.is_valid(&json(&BASE.replacen("albedo = 0.8", &format!("albedo = {albedo}"), 1))), "{albedo}");
    }
}

/// What an editor shows beside a key: its meaning, and its unit.
#[test]
fn every_key_says_what_it_means() {
    fn walk(at: &str, schema: &Value, dumb: &mut Vec<String>) {
        let properties = schema["properties"].as_object();
        for (key, property) in properties.into_iter().flatten() {
            if property["description"].as_str().is_none_or(str::is_empty) {
                dumb.push(format!("{at}.{key}"));
            }
        }
    }
    let (schema, mut dumb) = (Scene::schema(), Vec::new());
    walk("", &schema, &mut dumb);
    let parts = schema["$defs"].as_object().expect("definitions");
    parts.iter().for_each(|(name, part)| walk(name, part, &mut dumb));
    assert!(parts.len() > 20 && dumb.is_empty(), "without a word: {dumb:?}");
}

//! What is written or typed wrongly is told with its place, before anything is rendered.

use std::fs;

use super::Place;

#[test]
fn each_wrong_key_or_value_is_told_with_its_line() {
    // TINY has five lines.
    for (more, line, words) in [
        ("[set]\nlight.sied = 3\n", 7, "did you mean `light.side`?"),
        ("[set]\nlight.side = [64, 0]\n", 7, "expected 1 to 16384 texels, found 0"),
        ("[set]\nlight.side = []\n", 7, "found an empty list"),
        ("colour = 1\n", 6, "the unknown key `colour`"),
        ("camera = \"mian\"\nreference = \"none\"\n", 6, "did you mean `main`?"),
        ("camera = \"main\"\n", 6, "reference = \"none\""),
        ("layer = \"caustics\"\n", 6, "did you mean `caustic`?"),
        ("reference = \"nothing.exr\"\n", 6, "nephroid truth"),
        ("flicker = \"0..1\"\n", 6, "FROM..TO@FPS"),
        ("flicker = \"0..1@1\"\n", 6, "two frames or more"),
        ("flicker = \"0..1@9\"\nreference = \"none\"\n", 6, "a truth for each frame"),
        ("seconds = nan\n", 6, "expected a number of seconds"),
        ("[set]\nscene.materials.glas.ior = 1.5\n", 7, "materials.glass.dielectric.ior"),
        ("[set\n", 6, "expected TOML"),
        ("[set]\nscene.objects.ball.sphere.radius = [1, -1]\n", 7, "found -1"),
    ] {
        let place = Place::new(more);
        place.run("run").code(1).says(&[&format!("tiny.toml:{line}:"), words]);
        assert!(!place.store().exists(), "{more}: found too late");
    }
    for (from, to, words) in [
        ("version = 1", "version = 2", "expected version 1, found 2"),
        ("\"glass-sphere\"", "\"glas-sphere\"", "did you mean `glass-sphere`?"),
        ("[\"glass-sphere\"]", "[]", "found an empty list"),
        ("[\"maps\"]", "[\"map\"]", "did you mean `maps`?"),
        ("[\"maps\"]", "[]", "found an empty list"),
        ("[8, 8]", "[8, 0]", "expected sides of 1 to 65536 pixels"),
        ("rounds = 2", "rounds = 0", "expected one round or more"),
    ] {
        let place = Place::new("");
        let text = fs::read_to_string(&place.file).unwrap();
        fs::write(&place.file, text.replace(from, to)).unwrap();
        let line = 1 + text[..text.find(from).unwrap()].matches('\n').count();
        place.run("status").code(1).says(&[&format!("tiny.toml:{line}:"), words]);
    }
}

#[test]
fn a_file_that_is_none_is_told() {
    let place = Place::new("");
    fs::write(&place.file, b"version = 1\n\xff").unwrap();
    place.run("run").code(1).says(&["tiny.toml:2:1", "UTF-8"]);
    fs::write(&place.file, "").unwrap();
    place.run("run").code(1).says(&["tiny.toml:1:1", "expected the key"]);
    fs::remove_file(&place.file).unwrap();
    place.run("run").code(2).says(&["tiny.toml", "check the path"]);
}

#[test]
fn shards_that_are_none_are_refused() {
    let place = Place::new("");
    for shard in ["0/2", "3/2", "1", "a/b", "1/0"] {
        place.run(&format!("run --shard {shard}")).code(2).says(&["1/4"]);
    }
    place.run("run --patience -1").code(2);
    place.run("run --patience 1e300").code(2);
    place.run("status --shards 0").code(2);
}

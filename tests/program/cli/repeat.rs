//! The same command gives the same bytes, whatever the number of threads.

use std::{fs, path::Path};

use super::{Ran, SMALL, names, place, program};

/// Files that hold times, so differ.
const TIMED: [&str; 2] = ["result.json", "timings.csv"];

fn render(arguments: &str, threads: &[(&str, &str)], out: &Path) {
    let mut command = program();
    command.args(["render"]).args(arguments.split(' ')).arg("--out").arg(out).envs(threads.iter().copied());
    Ran::from(command.output().unwrap()).ok();
}

#[test]
fn the_same_command_gives_the_same_bytes() {
    let threads: [&[(&str, &str)]; 4] = [
        &[],
        &[("LP_NUM_THREADS", "1"), ("RAYON_NUM_THREADS", "1")],
        &[("LP_NUM_THREADS", "2"), ("RAYON_NUM_THREADS", "3")],
        &[("RAYON_NUM_THREADS", "2")],
    ];
    for scene in ["glass-sphere --dump maps/map,light/account", "bunny --set eye.samples=2", "diffuse"] {
        let arguments = format!("{scene} {SMALL}");
        let (_first, reference) = place();
        render(&arguments, threads[0], &reference);
        for variant in threads {
            let (_folder, out) = place();
            render(&arguments, variant, &out);
            assert_eq!(names(&out), names(&reference));
            for name in names(&out).iter().filter(|name| !TIMED.contains(&name.as_str())) {
                let same = fs::read(out.join(name)).unwrap() == fs::read(reference.join(name)).unwrap();
                assert!(same, "{scene}: {name} differs with {variant:?}");
            }
        }
    }
}

//! Nothing is lost but the point in hand, and nothing is counted twice.

use std::{
    process::{Child, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::Value;

use super::{Place, truth};

const SHARDS: usize = 4;
const KILLS: usize = 20;
const POINTS: usize = 200;
/// From a point's end to a kill, ms: about as long as a point takes.
const LATER: std::ops::Range<u64> = 0..60;

/// Ten times what it takes on two busy cores.
const LONGEST: Duration = Duration::from_secs(300);

/// What a clock makes of a point, and nothing else does.
const TIMES: [&str; 4] = ["time", "stages", "alone", "warnings"];

fn start(place: &Place, shard: usize) -> Child {
    let mut command = place.command(&format!("run --patience 0 --shard {}/{SHARDS}", shard + 1));
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Points that are whole; what a killed writer left beside them is none.
fn done(place: &Place) -> usize {
    place.entries().iter().filter(|path| !path.to_string_lossy().contains(".writing-")).count()
}

fn timeless(points: Vec<Value>) -> Vec<Value> {
    let without = |mut point: Value| {
        let fields = point.as_object_mut().unwrap();
        assert!(fields.contains_key("time") && fields.contains_key("error"), "{fields:?}");
        fields.retain(|name, _| !TIMES.contains(&name.as_str()));
        // The two places differ in the path of one and the same file.
        fields["error"]["reference"].take();
        point
    };
    points.into_iter().map(without).collect()
}

#[test]
fn two_hundred_points_survive_twenty_kills() {
    let sides: Vec<String> = (4..24).map(|side| side.to_string()).collect();
    let sides = sides.join(", ");
    let sweep = format!(
        "reference = \"truth.exr\"\n[set]\neye.samples = 1\nlight.side = [{sides}]\n\
         maps.side = [4, 5, 6, 7, 8, 9, 10, 11, 12, 13]\n"
    );
    let [calm, killed] = [(); 2].map(|()| Place::warm(&sweep));
    truth(calm.folder.path());
    std::fs::copy(calm.folder.path().join("truth.exr"), killed.folder.path().join("truth.exr")).unwrap();
    calm.run("run").code(0);

    let begun = Instant::now();
    let mut random = Pcg64Mcg::seed_from_u64(6);
    let mut running: Vec<Child> = (0..SHARDS).map(|shard| start(&killed, shard)).collect();
    for kill in 1..=KILLS {
        // Spread over the whole sweep, however fast it goes.
        while done(&killed) < POINTS * kill / (KILLS + 1) {
            assert!(begun.elapsed() < LONGEST, "the shards got stuck");
            sleep(Duration::from_millis(5));
        }
        sleep(Duration::from_millis(random.random_range(LATER)));
        let shard = random.random_range(0..SHARDS);
        running[shard].kill().unwrap();
        running[shard].wait().unwrap();
        running[shard] = start(&killed, shard);
    }
    for child in &mut running {
        assert!(child.wait().unwrap().success());
    }
    assert_eq!(done(&killed), POINTS);
    let [calm, killed] = [calm, killed].map(|place| timeless(place.merged()));
    assert_eq!((calm.len(), killed.len()), (POINTS, POINTS));
    assert!(calm == killed, "what was killed differs from what was not");
}

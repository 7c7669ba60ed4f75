//! Nothing is lost but the point in hand, and nothing is counted twice.

use std::{
    process::{Child, Stdio},
    thread::sleep,
    time::Duration,
};

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde_json::Value;

use crate::{Place, truth};

const SHARDS: usize = 4;
const KILLS: usize = 20;
/// Between two kills, ms: about as long as some points take, starting included.
const BETWEEN: std::ops::Range<u64> = 50..500;

/// What a clock makes of a point, and nothing else does.
const TIMES: [&str; 4] = ["time", "stages", "alone", "warnings"];

fn start(place: &Place, shard: usize) -> Child {
    let mut command = place.command(&format!("run --patience 0 --shard {}/{SHARDS}", shard + 1));
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
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

fn survive(axes: &str, points: usize, kills: usize) {
    let sweep = format!("reference = \"truth.exr\"\n[set]\neye.samples = 1\n{axes}");
    let [calm, killed] = [(); 2].map(|()| Place::warm(&sweep));
    truth(calm.folder.path());
    std::fs::copy(calm.folder.path().join("truth.exr"), killed.folder.path().join("truth.exr")).unwrap();
    calm.run("run").code(0);

    let mut random = Pcg64Mcg::seed_from_u64(6);
    let mut running: Vec<Child> = (0..SHARDS).map(|shard| start(&killed, shard)).collect();
    for _ in 0..kills {
        sleep(Duration::from_millis(random.random_range(BETWEEN)));
        let shard = random.random_range(0..SHARDS);
        running[shard].kill().unwrap();
        running[shard].wait().unwrap();
        running[shard] = start(&killed, shard);
    }
    for child in &mut running {
        assert!(child.wait().unwrap().success());
    }
    let done = killed.entries().into_iter().filter(|path| !path.to_string_lossy().contains(".writing-"));
    assert_eq!(done.count(), points);
    let [calm, killed] = [calm, killed].map(|place| timeless(place.merged()));
    assert_eq!((calm.len(), killed.len()), (points, points));
    assert!(calm == killed, "what was killed differs from what was not");
}

#[test]
fn points_of_shards_that_are_killed_equal_the_uninterrupted() {
    survive("light.side = [4, 5, 6, 7, 8, 9]\nmaps.side = [4, 8, 16, 32]\n", 24, KILLS / 4);
}

#[test]
#[ignore = "two minutes on a software device"]
fn two_hundred_points_survive_twenty_kills() {
    let sides: Vec<String> = (4..24).map(|side| side.to_string()).collect();
    survive(
        &format!("light.side = [{}]\nmaps.side = [4, 5, 6, 7, 8, 9, 10, 11, 12, 13]\n", sides.join(", ")),
        200,
        KILLS,
    );
}

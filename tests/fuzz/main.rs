//! Damaged files: whatever a scene, a mesh or a picture holds, reading it comes back in bounded time and memory.
//!
//! Files are damaged by a seed, word by word or number by number, and read as a user's would be. Each lies on disk before it is
//! read, so that one that ends the process is still there. `scripts/fuzz` runs longer, with another seed each time.
//!
//! * `NEPHROID_FUZZ_SECONDS`: how long (60; the same inputs in the same order however long).
//! * `NEPHROID_FUZZ_SEED`: which inputs (1).
//! * `NEPHROID_FUZZ_INPUT`: one file to read, by its ending.

#[path = "../common/gltf.rs"]
mod gltf;
mod mutate;
#[path = "../common/random.rs"]
#[allow(dead_code)] // directions are for others
mod random;
mod readers;

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    sync::mpsc::{RecvTimeoutError, channel},
    thread,
    time::{Duration, Instant},
};

use peak_alloc::PeakAlloc;
use random::Random;
use readers::{Found, READERS, ROOM, Reader, go_on};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Longest that one file may take: the slowest seen took 0.3 s on one busy core, in the test profile.
const LIMIT: Duration = Duration::from_secs(20);
/// Inputs of one reader before the next one's turn.
const TURN: u64 = 50;

/// A figure from the environment.
fn asked(name: &str, default: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|_| panic!("{name}={text}: a whole number is needed")),
        Err(_) => default,
    }
}

/// Reads one file, and says what is wrong with how.
fn judge(reader: &Reader, path: &Path) -> Result<bool, String> {
    let size = std::fs::metadata(path).expect("the input is there").len() as usize;
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let read = catch_unwind(|| (reader.read)(path)).map_err(|_| "panicked while reading".to_owned())?;
    let held = MEMORY.peak_usage().saturating_sub(before);
    let allowed = reader.multiple * size + ROOM;
    if held > allowed {
        return Err(format!("held {held} bytes for a file of {size}, where {allowed} are allowed"));
    }
    let sound = read.is_ok();
    if let Ok(found) = read {
        catch_unwind(AssertUnwindSafe(|| go_on(found))).map_err(|_| "panicked while planning".to_owned())?;
    }
    Ok(sound)
}

/// As [`judge`], or that it took too long; the thread that did is left behind.
fn judge_in_time(reader: &'static Reader, path: &Path) -> Result<bool, String> {
    let (send, receive) = channel();
    let owned = path.to_owned();
    let reading = thread::spawn(move || send.send(judge(reader, &owned)));
    match receive.recv_timeout(LIMIT) {
        Ok(judged) => {
            let _ = reading.join();
            judged
        }
        Err(RecvTimeoutError::Timeout) => Err(format!("took longer than {} s", LIMIT.as_secs())),
        Err(RecvTimeoutError::Disconnected) => Err("ended without an answer".to_owned()),
    }
}

/// Where inputs lie; what failed stays there.
fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz");
    std::fs::create_dir_all(&folder).expect("a folder for the inputs");
    folder
}

/// What sound scenes name is there: the files that ship beside them.
fn lay_what_scenes_name() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = std::fs::read_dir(scenes).expect("the scenes").map(|entry| entry.expect("a file").path());
    for file in files.filter(|file| file.extension().is_some_and(|ending| ending == "obj" || ending == "png")) {
        std::fs::copy(&file, folder().join(file.file_name().expect("a name"))).expect("a file is laid");
    }
}

/// What one reader was given.
#[derive(Default)]
struct Tally {
    inputs: u64,
    sound: u64,
    longest: Duration,
}

/// Damages and reads input `number` of a reader.
fn one(reader: &'static Reader, seeds: &[Vec<u8>], seed: u64, number: u64, tally: &mut Tally) {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ number);
    let input = mutate::damaged(&mut random, seeds, reader.parts);
    let path = folder().join(format!("input.{}", reader.ending));
    std::fs::write(&path, &input).expect("the input is written");
    let start = Instant::now();
    let sound = judge_in_time(reader, &path).unwrap_or_else(|why| {
        let kept = folder().join(format!("failed-{seed}-{number}.{}", reader.ending));
        std::fs::copy(&path, &kept).expect("the input is kept");
        panic!(
            "seed {seed}, input {number}: {why}\nkept as {}\nagain: NEPHROID_FUZZ_INPUT={} cargo test --test fuzz",
            kept.display(),
            kept.display()
        )
    });
    tally.inputs += 1;
    tally.sound += u64::from(sound);
    tally.longest = tally.longest.max(start.elapsed());
}

/// Sound files are read: a reader that refused all would pass every other check.
fn read_the_sound_ones(reader: &'static Reader, seeds: &[Vec<u8>]) {
    for seed in seeds {
        let path = folder().join(format!("sound.{}", reader.ending));
        std::fs::write(&path, seed).expect("the input is written");
        (reader.read)(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        assert_eq!(judge_in_time(reader, &path), Ok(true), "{}", path.display());
    }
}

/// The one test of this binary: memory is counted for the process as a whole.
#[test]
fn no_reader_panics_hangs_or_hoards() {
    if let Some(input) = std::env::var_os("NEPHROID_FUZZ_INPUT").map(PathBuf::from) {
        let ending = input.extension().unwrap_or_default();
        let reader = READERS.iter().find(|r| ending == r.ending).expect("a reader of files with this ending");
        println!("{}: {:?}", input.display(), (reader.read)(&input).map(|_: Found| "read"));
        judge_in_time(reader, &input).unwrap_or_else(|why| panic!("{}: {why}", input.display()));
        return;
    }
    let (seconds, seed) = (asked("NEPHROID_FUZZ_SECONDS", 60), asked("NEPHROID_FUZZ_SEED", 1));
    // On stderr and at once: an input that ends the process is the last one written.
    eprintln!("seed {seed}, {seconds} s; the input that is being read lies in {}", folder().display());
    lay_what_scenes_name();
    let until = Instant::now() + Duration::from_secs(seconds);
    let seeds: Vec<_> = READERS.iter().map(|reader| (reader.seeds)()).collect();
    READERS.iter().zip(&seeds).for_each(|(reader, seeds)| read_the_sound_ones(reader, seeds));
    let mut tallies: Vec<_> = READERS.iter().map(|_| Tally::default()).collect();
    'time: for turn in 0.. {
        for ((reader, seeds), tally) in READERS.iter().zip(&seeds).zip(&mut tallies) {
            for number in turn * TURN..(turn + 1) * TURN {
                if Instant::now() >= until {
                    break 'time;
                }
                one(reader, seeds, seed, number, tally);
            }
        }
    }
    for (Reader { ending, .. }, Tally { inputs, sound, longest }) in READERS.iter().zip(&tallies) {
        println!("{ending}: {inputs} inputs, {sound} of them still sound, the slowest took {longest:.1?}");
        assert!(*inputs > 0 && sound < inputs, "{ending}: damage was done, and found");
    }
}

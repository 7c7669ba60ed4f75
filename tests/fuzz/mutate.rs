//! Damage to files: the same seed does the same damage.

use serde_json::Value;

use crate::{gltf::glb, random::Random};

/// What a file is made of.
#[derive(Clone, Copy)]
pub enum Parts {
    /// Words and numbers of a text.
    Words,
    /// Bytes and the numbers that they spell.
    Numbers,
    /// Values of JSON, which stays JSON; that of a GLB with its chunks in order.
    Values,
}

/// Numbers at which readers have been known to stumble.
const NUMBERS: [&str; 24] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "1e-320",
    "1e-9",
    "1e9",
    "1e30",
    "-1e38",
    "1e308",
    "-1e309",
    "nan",
    "inf",
    "-inf",
    "1e15",
    "2147483648",
    "-2147483649",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "0x7fffffff",
    "1_000",
    "00",
];
/// What joins, opens or ends something in one of the formats.
const MARKS: [&str; 16] =
    ["[", "]", "[[", "{", "}", "\"", "'''", "\\", "=", ".", ",", "#", "\n", "/", "//", "\u{feff}\u{0}"];
/// Whole numbers as four bytes say them.
const INTEGERS: [u32; 14] = [
    0,
    1,
    2,
    0xff,
    0xffff,
    0x1_0000,
    0x100_0000,
    0x7fff_ffff,
    0x8000_0000,
    0x8000_0001,
    0xffff_fffe,
    0xffff_ffff,
    0x7fc0_0000,
    0x7f80_0000,
];
/// How often a file is only random bytes.
const ONE_IN: usize = 50;
/// Damages done to one file.
const MOST_DAMAGES: usize = 4;
/// Where a binary file says what the rest is: damage there bites deeper than in pixels.
const HEADER: usize = 1024;
/// Copies that a passage repeats in, to make a file long or deep.
const MOST_COPIES: usize = 300;

/// A damaged file, of one of the sound ones and passages of the others.
pub fn damaged(random: &mut Random, seeds: &[Vec<u8>], parts: Parts) -> Vec<u8> {
    if random.below(ONE_IN) == 0 {
        let length = random.below(4096);
        return (0..length).map(|_| random.below(256) as u8).collect();
    }
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..=random.below(MOST_DAMAGES) {
        if bytes.is_empty() {
            break;
        }
        let other = &seeds[random.below(seeds.len())];
        match (parts, random.below(10)) {
            (Parts::Words, 0..7) | (Parts::Values, 0) => damage_words(random, &mut bytes, other),
            (Parts::Numbers, 0..7) | (Parts::Values, 1) => damage_numbers(random, &mut bytes),
            (Parts::Values, 2..9) => damage_values(random, &mut bytes),
            _ => damage_bytes(random, &mut bytes, other),
        }
    }
    bytes
}

fn choose<'a>(random: &mut Random, from: &[&'a str]) -> &'a str {
    from[random.below(from.len())]
}

/// Words (numbers, names, marks) of a text, as ranges of its bytes.
fn words(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let kind = |b: u8| match b {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'_' | b'.' | b'-' | b'+' => 0,
        b' ' | b'\n' | b'\t' | b'\r' => 1,
        _ => 2,
    };
    let mut found = Vec::new();
    let mut start = 0;
    for at in 1..=bytes.len() {
        if at == bytes.len() || kind(bytes[at]) != kind(bytes[start]) {
            if kind(bytes[start]) != 1 {
                found.push(start..at);
            }
            start = at;
        }
    }
    found
}

/// Puts a number, a mark or another word in the place of one; takes it out, doubles it, moves its line.
fn damage_words(random: &mut Random, bytes: &mut Vec<u8>, other: &[u8]) {
    let all = words(bytes);
    if all.is_empty() {
        return;
    }
    let numeric = |word: &&std::ops::Range<usize>| bytes[word.start].is_ascii_digit() || bytes[word.start] == b'-';
    let numbers: Vec<_> = all.iter().filter(numeric).cloned().collect();
    let word = all[random.below(all.len())].clone();
    match random.below(7) {
        0 | 1 if !numbers.is_empty() => {
            let number = numbers[random.below(numbers.len())].clone();
            bytes.splice(number, choose(random, &NUMBERS).bytes());
        }
        2 => drop(bytes.splice(word, choose(random, &MARKS).bytes())),
        3 => drop(bytes.splice(word, [])),
        4 => {
            let theirs = words(other);
            let theirs = theirs[random.below(theirs.len())].clone();
            bytes.splice(word, other[theirs].to_vec());
        }
        5 => damage_lines(random, bytes, other),
        _ => {
            let copies = 1 + random.below(MOST_COPIES);
            let again = bytes[word.clone()].repeat(copies);
            bytes.splice(word.end..word.end, again);
        }
    }
}

/// Takes a line out, repeats it, or puts one of another file in its place.
fn damage_lines(random: &mut Random, bytes: &mut Vec<u8>, other: &[u8]) {
    let lines = |text: &[u8]| text.split_inclusive(|b| *b == b'\n').map(<[u8]>::to_vec).collect::<Vec<_>>();
    let (mut ours, theirs) = (lines(bytes), lines(other));
    let (at, from) = (random.below(ours.len()), random.below(ours.len()));
    match random.below(4) {
        0 => drop(ours.remove(at)),
        1 => {
            let again = ours[from].repeat(1 + random.below(MOST_COPIES));
            ours.insert(at, again);
        }
        2 => ours.swap(at, from),
        _ => ours[at].clone_from(&theirs[random.below(theirs.len())]),
    }
    *bytes = ours.concat();
}

/// Writes a whole number over four bytes, in the header or anywhere.
fn damage_numbers(random: &mut Random, bytes: &mut [u8]) {
    let reach = if random.below(4) == 0 { bytes.len() } else { bytes.len().min(HEADER) };
    let at = random.below(reach);
    let number = match random.below(3) {
        0 => random.below(1 << 16) as u32,
        _ => INTEGERS[random.below(INTEGERS.len())],
    };
    for (place, byte) in bytes[at..].iter_mut().zip(number.to_le_bytes()) {
        *place = byte;
    }
}

/// Flips a bit, cuts the file short, takes a passage out, or puts one of another file in.
fn damage_bytes(random: &mut Random, bytes: &mut Vec<u8>, other: &[u8]) {
    let at = random.below(bytes.len());
    match random.below(4) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes.truncate(at),
        2 => drop(bytes.drain(at..(at + 1 + random.below(64)).min(bytes.len()))),
        _ => {
            let from = random.below(other.len());
            let passage = other[from..(from + 1 + random.below(256)).min(other.len())].to_vec();
            bytes.splice(at..at, passage);
        }
    }
}

/// Changes a value of the JSON, and leaves what no longer is any.
fn damage_values(random: &mut Random, bytes: &mut Vec<u8>) {
    const HEAD: usize = 20;
    let chunk = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let boxed = bytes.starts_with(b"glTF");
    let range = if boxed { HEAD..HEAD.saturating_add(chunk(12).unwrap_or(0)) } else { 0..bytes.len() };
    let Some(mut json) = bytes.get(range.clone()).and_then(|json| serde_json::from_slice(json).ok()) else { return };
    damage_value(random, &mut json);
    *bytes = if boxed {
        let rest = bytes.get(range.end + 8..).unwrap_or_default().to_vec();
        glb(&[(b"JSON", json.to_string().as_bytes()), (b"BIN\0", &rest)])
    } else {
        serde_json::to_vec_pretty(&json).unwrap_or_default()
    };
}

/// Puts a number or something else in the place of one value; takes it out, or repeats it.
fn damage_value(random: &mut Random, json: &mut Value) {
    let mut all = Vec::new();
    pointers(json, &mut String::new(), &mut all);
    let numbers: Vec<&String> = all.iter().filter(|at| json.pointer(at).is_some_and(Value::is_number)).collect();
    let any = all[random.below(all.len())].clone();
    let at =
        if numbers.is_empty() || random.below(3) == 0 { any } else { numbers[random.below(numbers.len())].clone() };
    let other = json.pointer(&all[random.below(all.len())]).cloned().unwrap_or_default();
    let Some((parent, name)) = at.rsplit_once('/') else { return };
    let new = match random.below(8) {
        0..3 => serde_json::from_str(choose(random, &NUMBERS)).unwrap_or_default(),
        3..5 => Value::from(random.below(8)),
        5 => other,
        6 => Value::from(""),
        _ => return take_out_or_repeat(random, json, parent, name),
    };
    if let Some(slot) = json.pointer_mut(&at) {
        *slot = new;
    }
}

fn take_out_or_repeat(random: &mut Random, json: &mut Value, parent: &str, name: &str) {
    match json.pointer_mut(parent) {
        Some(Value::Object(keys)) => drop(keys.remove(name)),
        Some(Value::Array(items)) => {
            let at = name.parse().unwrap_or(0);
            let copies = random.below(2) * (1 + random.below(MOST_COPIES));
            let item = items.remove(at);
            items.splice(at..at, std::iter::repeat_n(item, copies));
        }
        _ => {}
    }
}

/// Pointers to every value, from the outermost in.
fn pointers(value: &Value, at: &mut String, all: &mut Vec<String>) {
    all.push(at.clone());
    let length = at.len();
    let mut below = |name: &str, value: &Value| {
        *at += &format!("/{}", name.replace('~', "~0").replace('/', "~1"));
        pointers(value, at, all);
        at.truncate(length);
    };
    match value {
        Value::Array(items) => items.iter().enumerate().for_each(|(k, value)| below(&k.to_string(), value)),
        Value::Object(keys) => keys.iter().for_each(|(name, value)| below(name, value)),
        _ => {}
    }
}

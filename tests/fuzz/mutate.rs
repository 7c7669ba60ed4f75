//! Damage to files: the same seed does the same damage.

use crate::random::Random;

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
pub fn damaged(random: &mut Random, seeds: &[Vec<u8>], text: bool) -> Vec<u8> {
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
        match (text, random.below(10)) {
            (true, 0..7) => damage_words(random, &mut bytes, other),
            (false, 0..7) => damage_numbers(random, &mut bytes),
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

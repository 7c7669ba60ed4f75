//! One entry's file: a magic word, a checksum, the content.

use super::Key;

const MAGIC: &[u8; 8] = b"NEPHCA01";
const HEADER: usize = MAGIC.len() + blake3::OUT_LEN;

/// The bytes of the file for this content.
pub fn seal(kind: &str, key: &Key, content: &[u8]) -> Vec<u8> {
    [&MAGIC[..], checksum(kind, key, content).as_bytes(), content].concat()
}

/// The content, if the file is whole and is the entry of this kind and key.
pub fn open(kind: &str, key: &Key, mut file: Vec<u8>) -> Option<Vec<u8>> {
    let stored = file.get(..HEADER)?.strip_prefix(MAGIC)?;
    let stored = blake3::Hash::from_slice(stored).ok()?;
    (stored == checksum(kind, key, &file[HEADER..])).then(|| file.split_off(HEADER))
}

fn checksum(kind: &str, key: &Key, content: &[u8]) -> blake3::Hash {
    Key::of([kind.as_bytes(), key.0.as_bytes(), content]).0
}

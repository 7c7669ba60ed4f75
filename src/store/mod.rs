//! A cache on disk: content key → bytes.
//!
//! Entries are found again by what they were made from, so they are never stale: [`Key`] is a BLAKE3 hash over every
//! input. Each entry is one file, `FOLDER/KIND/KEY`, replaced whole, with a checksum over kind, key and content: one
//! that is cut short, damaged or misplaced is as good as none. Any number of processes may use one folder.
//!
//! The cache is never needed: where no folder can be written, everything is made anew, and that is said once.

mod entry;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Once;

use crate::places::Folder;

/// What an entry was made from, as a hash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key(blake3::Hash);

impl Key {
    /// The key of several inputs in their order; where one ends and the next begins counts too.
    pub fn of<I: AsRef<[u8]>>(inputs: impl IntoIterator<Item = I>) -> Self {
        let mut hasher = blake3::Hasher::new();
        for input in inputs {
            hasher.update(&(input.as_ref().len() as u64).to_le_bytes());
            hasher.update(input.as_ref());
        }
        Self(hasher.finalize())
    }

    fn parse(hex: &str) -> Option<Self> {
        blake3::Hash::from_hex(hex).ok().map(Self)
    }
}

impl std::fmt::Display for Key {
    /// 64 lower-case hexadecimal digits.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.to_hex().fmt(f)
    }
}

/// One entry of a listing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What it was made from.
    pub key: Key,
    /// Size on disk.
    pub bytes: u64,
}

/// The cache, or its absence.
///
/// A kind (`"spirv"`) is a word of lower-case letters, digits and hyphens; of any other, nothing is kept.
///
/// # Examples
/// ```
/// use nephroid::store::{Key, Store};
/// let folder = tempfile::tempdir().unwrap();
/// let store = Store::at(folder.path());
/// let key = Key::of(["shader source", "compiler version"]);
/// assert_eq!(store.get("spirv", &key), None);
/// store.put("spirv", &key, b"code");
/// assert_eq!(store.get("spirv", &key).as_deref(), Some(&b"code"[..]));
/// ```
#[derive(Clone, Debug)]
pub struct Store {
    folder: Option<PathBuf>,
}

impl Store {
    /// The user's cache: `NEPHROID_CACHE`, else `XDG_CACHE_HOME/nephroid`, else `~/.cache/nephroid`, the first that can
    /// be written to. If none can, a store that keeps nothing; standard error says so, once a process.
    pub fn open() -> Self {
        let folder = Folder::Cache.candidates().into_iter().find(|f| is_writable(f));
        if folder.is_none() {
            warn_once("no cache folder can be written to");
        }
        Self { folder }
    }

    /// A store in a folder of its own, made when the first entry is put.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: Some(folder.into()) }
    }

    /// A store that keeps nothing.
    pub fn none() -> Self {
        Self { folder: None }
    }

    /// Where entries lie, if anywhere.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The content put under this key; `None` if there is none, or not whole.
    pub fn get(&self, kind: &str, key: &Key) -> Option<Vec<u8>> {
        let file = fs::read(self.kind_folder(kind)?.join(key.to_string())).ok()?;
        entry::open(kind, key, file)
    }

    /// Keeps content under a key, in place of any other. If it cannot be kept, that is said once, and is no error.
    pub fn put(&self, kind: &str, key: &Key, content: &[u8]) {
        let Some(folder) = &self.folder else { return };
        if let Err(error) = self.keep(kind, key, content) {
            warn_once(&format!("cannot write to the cache {}: {error}", folder.join(kind).display()));
        }
    }

    /// As [`Store::put`], where what is not kept is lost work.
    ///
    /// # Errors
    /// The system's; the entry is then as it was before.
    pub fn keep(&self, kind: &str, key: &Key, content: &[u8]) -> io::Result<()> {
        let Some(folder) = self.kind_folder(kind) else { return Err(io::ErrorKind::NotFound.into()) };
        replace(&folder, &key.to_string(), &entry::seal(kind, key, content))
    }

    /// Removes an entry, and says whether there was one.
    ///
    /// # Errors
    /// The system's.
    pub fn remove(&self, kind: &str, key: &Key) -> io::Result<bool> {
        let Some(path) = self.file(kind, key) else { return Ok(false) };
        match fs::remove_file(path) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Where an entry lies, if there is one or not.
    pub fn file(&self, kind: &str, key: &Key) -> Option<PathBuf> {
        Some(self.kind_folder(kind)?.join(key.to_string()))
    }

    /// Every kind of which there are entries, or were.
    pub fn kinds(&self) -> Vec<String> {
        let folders = self.folder.as_ref().and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
        let kind = |entry: fs::DirEntry| entry.file_name().into_string().ok().filter(|_| entry.path().is_dir());
        let mut kinds: Vec<_> = folders.filter_map(kind).filter(|kind| self.kind_folder(kind).is_some()).collect();
        kinds.sort();
        kinds
    }

    /// All entries of a kind, by key; whether each is whole, [`Store::get`] finds out.
    pub fn list(&self, kind: &str) -> Vec<Entry> {
        let mut entries: Vec<Entry> = self.files(kind).filter_map(|path| listed(&path)).collect();
        entries.sort_by_key(|entry| *entry.key.0.as_bytes());
        entries
    }

    /// Removes all entries of a kind, with what writers that were killed left behind, and says how many entries.
    ///
    /// # Errors
    /// The system's, at the first file that cannot be removed; one that another process removed first is no error.
    pub fn clear(&self, kind: &str) -> io::Result<usize> {
        let mut removed = 0;
        for path in self.files(kind) {
            let is_entry = listed(&path).is_some();
            match fs::remove_file(&path) {
                Ok(()) => removed += usize::from(is_entry),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(error),
            }
        }
        Ok(removed)
    }

    fn kind_folder(&self, kind: &str) -> Option<PathBuf> {
        let word = |b: u8| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'-';
        let folder = self.folder.as_ref()?;
        (!kind.is_empty() && kind.bytes().all(word)).then(|| folder.join(kind))
    }

    /// Entries and temporaries of ours; files of others are left alone.
    fn files(&self, kind: &str) -> impl Iterator<Item = PathBuf> {
        let entries = self.kind_folder(kind).and_then(|folder| fs::read_dir(folder).ok());
        let ours = |name: &str| name.starts_with(TEMPORARY) || Key::parse(name).is_some();
        entries
            .into_iter()
            .flatten()
            .filter_map(Result::ok)
            .map(|e| e.path())
            .filter(move |p| file_name(p).is_some_and(ours))
    }
}

/// What the name of a file that is still being written begins with.
const TEMPORARY: &str = ".writing-";

fn file_name(path: &Path) -> Option<&str> {
    path.file_name()?.to_str()
}

fn listed(path: &Path) -> Option<Entry> {
    let key = Key::parse(file_name(path)?)?;
    Some(Entry { key, bytes: path.metadata().ok()?.len() })
}

/// Writes a file beside its place and renames it, so that a reader sees the old one or the new one. It is not flushed
/// to the disk: what a power cut damages, the checksum finds.
fn replace(folder: &Path, name: &str, bytes: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut file = tempfile::Builder::new().prefix(TEMPORARY).tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.persist(folder.join(name)).map(|_| ()).map_err(|e| e.error)
}

fn is_writable(folder: &Path) -> bool {
    fs::create_dir_all(folder).is_ok() && tempfile::Builder::new().prefix(TEMPORARY).tempfile_in(folder).is_ok()
}

fn warn_once(problem: &str) {
    static SAID: Once = Once::new();
    SAID.call_once(|| {
        let _ = writeln!(
            std::io::stderr(),
            "nephroid: {problem}; nothing is kept for the next run. NEPHROID_CACHE names another folder."
        );
    });
}

#[cfg(test)]
mod tests;

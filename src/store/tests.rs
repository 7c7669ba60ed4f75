use super::*;
use std::thread;

fn store() -> (tempfile::TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::at(folder.path().join("not/yet/there"));
    (folder, store)
}

fn path(store: &Store, kind: &str, key: &Key) -> PathBuf {
    store.folder().unwrap().join(kind).join(key.to_string())
}

#[test]
fn what_was_put_comes_back_until_replaced_or_cleared() {
    let (_folder, store) = store();
    let (a, b) = (Key::of(["a"]), Key::of(["b"]));
    store.put("spirv", &a, b"one");
    store.put("spirv", &b, b"");
    store.put("truth", &a, b"other kind");
    assert_eq!(store.get("spirv", &a).unwrap(), b"one");
    assert_eq!(store.get("spirv", &b).unwrap(), b"");
    store.put("spirv", &a, b"two, longer");
    assert_eq!(store.get("spirv", &a).unwrap(), b"two, longer");

    assert_eq!((store.kinds(), Store::none().kinds()), (vec!["spirv".to_owned(), "truth".to_owned()], vec![]));
    let listed: Vec<Key> = store.list("spirv").iter().map(|entry| entry.key).collect();
    assert_eq!(listed.len(), 2);
    assert!(listed.contains(&a) && listed.contains(&b));
    assert_eq!(store.clear("spirv").unwrap(), 2);
    assert_eq!((store.get("spirv", &a), store.list("spirv")), (None, vec![]));
    assert_eq!(store.get("truth", &a).unwrap(), b"other kind");
}

#[test]
fn keys_tell_inputs_apart() {
    assert_eq!(Key::of(["ab", "c"]), Key::of([b"ab".to_vec(), b"c".to_vec()]));
    let different = [Key::of(["ab", "c"]), Key::of(["a", "bc"]), Key::of(["abc"]), Key::of(["abc", ""]), Key::of([""])];
    for (i, a) in different.iter().enumerate() {
        assert!(different[..i].iter().all(|b| a != b), "{i}");
    }
    assert_eq!(Key::parse(&different[0].to_string()), Some(different[0]));
}

#[test]
fn damaged_cut_and_misplaced_entries_are_none() {
    let (_folder, store) = store();
    let (key, other) = (Key::of(["k"]), Key::of(["o"]));
    store.put("spirv", &key, b"some content");
    let file = path(&store, "spirv", &key);
    let whole = fs::read(&file).unwrap();
    for length in 0..whole.len() {
        fs::write(&file, &whole[..length]).unwrap();
        assert_eq!(store.get("spirv", &key), None, "cut to {length} bytes");
    }
    for at in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[at] ^= 1;
        fs::write(&file, damaged).unwrap();
        assert_eq!(store.get("spirv", &key), None, "damaged at {at}");
    }
    fs::write(path(&store, "spirv", &other), &whole).unwrap();
    assert_eq!(store.get("spirv", &other), None, "misplaced");
    store.put("spirv", &key, b"mended");
    assert_eq!(store.get("spirv", &key).unwrap(), b"mended");
}

#[test]
fn a_kind_cannot_leave_the_folder() {
    let (folder, store) = store();
    let key = Key::of(["k"]);
    for bad in ["", "..", "../spirv", "a/b", "/tmp", "Spirv", "a b"] {
        store.put(bad, &key, b"x");
        assert_eq!(store.get(bad, &key), None);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn clear_takes_left_over_temporaries_and_nothing_of_others() {
    let (_folder, store) = store();
    store.put("spirv", &Key::of(["k"]), b"x");
    let folder = store.folder().unwrap().join("spirv");
    fs::write(folder.join(".writing-abc"), "half").unwrap();
    fs::write(folder.join("README"), "a user's own").unwrap();
    assert_eq!(store.list("spirv").len(), 1);
    assert_eq!(store.clear("spirv").unwrap(), 1);
    let left: Vec<_> = fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["README"]);
}

#[test]
fn without_a_folder_it_keeps_nothing_and_fails_nowhere() {
    let file = tempfile::NamedTempFile::new().unwrap();
    for store in [Store::none(), Store::at(file.path()), Store::at(file.path().join("below"))] {
        let key = Key::of(["k"]);
        store.put("spirv", &key, b"x");
        assert_eq!(store.get("spirv", &key), None);
        assert!(store.list("spirv").is_empty());
        assert_eq!(store.clear("spirv").unwrap(), 0);
    }
    assert!(!is_writable(&file.path().join("below")));
}

#[test]
fn concurrent_writers_and_readers_see_whole_entries() {
    let (_folder, store) = store();
    let key = Key::of(["shared"]);
    let contents: Vec<Vec<u8>> = (0..4u8).map(|i| vec![i; 50_000 + 1000 * usize::from(i)]).collect();
    store.put("spirv", &key, &contents[0]);
    thread::scope(|scope| {
        for content in &contents {
            scope.spawn(|| (0..50).for_each(|_| store.put("spirv", &key, content)));
        }
        for _ in 0..200 {
            let seen = store.get("spirv", &key).expect("an entry is always there");
            assert!(contents.contains(&seen), "{} bytes of no writer", seen.len());
        }
    });
    assert_eq!(store.list("spirv").len(), 1);
    let files = fs::read_dir(store.folder().unwrap().join("spirv")).unwrap().count();
    assert_eq!(files, 1, "a temporary was left");
}

//! What every file must keep: its size, its silence about the machine it was written on, reasons where they are owed.
use crate::tokens::{Token, tokens};

/// Longest source file, in lines; about 120 is usual.
pub const LONGEST: usize = 450;

/// How many lines above an `unsafe` its reason may stand.
pub const REASON_WITHIN: usize = 4;

/// The only room with unsafe code.
pub const UNSAFE_ROOM: &str = "src/gpu/";

/// Folders of somebody's machine. In two parts, so that this file does not name one.
const MACHINE_FOLDERS: [(&str, &str); 5] =
    [("/ho", "me/"), ("/ro", "ot/"), ("/wo", "rk/"), ("/Us", "ers/"), ("/mn", "t/")];

/// Is this a file whose length is limited?
pub fn is_source(file: &str) -> bool {
    let ending = file.rsplit('/').next().unwrap_or(file).rsplit_once('.').map_or("", |(_, e)| e);
    let shader = ["glsl", "vert", "geom", "frag", "comp", "tesc", "tese"].contains(&ending);
    ending == "rs" || shader || file.starts_with("scripts/")
}

pub fn too_long(file: &str, text: &str) -> Option<String> {
    let lines = text.lines().count();
    (is_source(file) && lines > LONGEST).then(|| format!("{file}: {lines} lines, at most {LONGEST}: split it"))
}

/// Absolute paths below somebody's folders, as `file:line: path`.
pub fn machine_paths(file: &str, text: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    for (number, line) in text.lines().enumerate() {
        for (a, b) in MACHINE_FOLDERS {
            let folder = format!("{a}{b}");
            // A path that goes on from something (`$HOME/…`, `example.org/…`) is not absolute.
            let starts = |at: usize| !line[..at].ends_with(|c: char| c.is_alphanumeric() || "_-.~})]*".contains(c));
            if line.match_indices(&folder).any(|(at, _)| starts(at)) {
                wrong.push(format!("{file}:{}: names a folder of one machine, {folder}", number + 1));
            }
        }
    }
    wrong
}

/// Unsafe code outside its room, or in it without a reason, as `file:line: why`. Rust files only.
pub fn unsafe_complaints(file: &str, source: &str) -> Vec<String> {
    let tokens = tokens(source);
    let lines: Vec<_> = source.lines().collect();
    let text = |at: usize| tokens.get(at).map_or("", |t: &Token| t.text.as_str());
    let mut wrong = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        let why = match token.text.as_str() {
            "unsafe" if !file.starts_with(UNSAFE_ROOM) => "unsafe code belongs in src/gpu",
            "unsafe" if is_owed_a_reason(&tokens, at) && !has_reason(&lines, token.line) => {
                "unsafe without a comment that gives its reason"
            }
            "unsafe_code" if !file.starts_with(UNSAFE_ROOM) => {
                let strict = at >= 2 && ["deny", "forbid"].contains(&text(at - 2));
                if strict { continue } else { "unsafe code is allowed in src/gpu alone" }
            }
            _ => continue,
        };
        wrong.push(format!("{file}:{}: {why}", token.line));
    }
    wrong
}

/// Blocks, implementations and functions are; the type of a function pointer and an attribute are not.
fn is_owed_a_reason(tokens: &[Token], at: usize) -> bool {
    let text = |at: usize| tokens.get(at).map_or("", |t| t.text.as_str());
    let function = if text(at + 1) == "extern" { at + 2 } else { at + 1 };
    let pointer = text(function) == "fn" && text(function + 1) == "(";
    let attribute = at > 0 && text(at - 1) == "(" && text(at + 1) == "(";
    !pointer && !attribute
}

/// A comment with words on the line itself or close above it, no blank line between.
fn has_reason(lines: &[&str], line: usize) -> bool {
    let comment = |l: &str| l.split_once("//").is_some_and(|(_, words)| words.contains(char::is_alphabetic));
    let above = lines[..line].iter().rev().take(REASON_WITHIN + 1);
    above.take_while(|l| !l.trim().is_empty()).any(|l| comment(l))
}

/// Dependencies of a `Cargo.toml` that state no reason, by name.
pub fn unreasoned_dependencies(manifest: &str) -> Vec<String> {
    let (mut wrong, mut inside, mut above) = (Vec::new(), false, "");
    for line in manifest.lines() {
        let reasoned = comment_of(line).is_some() || (above.starts_with('#') && comment_of(above).is_some());
        above = line;
        if let Some(table) = line.strip_prefix('[') {
            let names: Vec<_> = table.split(']').next().unwrap_or("").split('.').collect();
            let kind = names.iter().position(|n| n.ends_with("dependencies"));
            inside = kind.is_some_and(|k| k + 1 == names.len());
            if let Some(name) = kind.and_then(|k| names.get(k + 1)).filter(|_| !reasoned) {
                wrong.push((*name).to_owned());
            }
        } else if inside
            && !reasoned
            && let Some((name, _)) = line.split_once('=')
            && name.starts_with(|c: char| c.is_alphanumeric() || c == '"')
        {
            wrong.push(name.trim().to_owned());
        }
    }
    wrong
}

/// The words of a TOML line's comment, if there are any.
fn comment_of(line: &str) -> Option<&str> {
    let mut quoted = false;
    let at = line.find(|c| {
        quoted ^= c == '"';
        c == '#' && !quoted
    })?;
    Some(line[at + 1..].trim()).filter(|words| words.contains(char::is_alphabetic))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_sources_are_found() {
        let long = "\n".repeat(LONGEST + 1);
        assert!(too_long("src/a.rs", &long).is_some_and(|w| w.contains("451")));
        assert!(too_long("glsl/passes/eye.frag", &long).is_some());
        assert!(too_long("scripts/setup", &long).is_some());
        assert_eq!(too_long("src/a.rs", &"\n".repeat(LONGEST)), None);
        assert_eq!(too_long("scenes/bunny.obj", &long), None);
    }

    #[test]
    fn folders_of_a_machine_are_found() {
        for (a, b) in MACHINE_FOLDERS {
            let bad = format!("fine\nsee {a}{b}x for more");
            assert_eq!(machine_paths("f", &bad).len(), 1, "{bad}");
            assert!(machine_paths("f", &bad)[0].starts_with("f:2:"));
            assert!(machine_paths("f", &format!("$X{a}{b}x https://example.org{a}{b}x ..{a}{b}")).is_empty());
        }
    }

    #[test]
    fn unsafe_code_stays_in_its_room() {
        assert_eq!(
            unsafe_complaints("src/image.rs", "\nfn f() { unsafe { g() } }"),
            ["src/image.rs:2: unsafe code belongs in src/gpu"]
        );
        assert_eq!(unsafe_complaints("tests/a.rs", "#![allow(dead_code, unsafe_code)]").len(), 1);
        assert!(
            unsafe_complaints("src/lib.rs", "#![forbid(unsafe_code)] // unsafe\nconst A: &str = \"unsafe\";")
                .is_empty()
        );
    }

    #[test]
    fn unsafe_code_gives_its_reason() {
        let bare = |source: &str| unsafe_complaints("src/gpu/a.rs", source).len();
        assert_eq!(bare("fn f() {\n    unsafe { g() }\n}"), 1);
        assert_eq!(bare("// Far above.\n\nunsafe impl Send for A {}"), 1);
        assert_eq!(bare("//\nunsafe { g() }"), 1);
        assert_eq!(
            bare("/// Alive.\nunsafe extern \"system\" fn f() {}\nfn a() {}\nfn b() {}\nfn c() {}\nunsafe fn d() {}"),
            1
        );
        assert_eq!(bare("// The device outlives it.\nlet a = unsafe { g() };"), 0);
        assert_eq!(bare("unsafe { g() } // The device outlives it."), 0);
        assert_eq!(bare("type F = unsafe extern \"system\" fn(u32);\ntype G = unsafe fn();"), 0);
    }

    #[test]
    fn dependencies_owe_a_reason() {
        let manifest = "[package]\nname = \"x\"\n[dependencies]\na = \"1\" # why\n# above\nb = \"1\"\nc = \"1\"\nd = \"#\"\n\
                        e = \"1\" #\n[dev-dependencies.f]\nversion = \"1\"\n[target.'cfg(unix)'.dependencies]\ng = \"1\"\n\
                        [features]\nh = []\n";
        assert_eq!(unreasoned_dependencies(manifest), ["c", "d", "e", "f", "g"]);
    }
}

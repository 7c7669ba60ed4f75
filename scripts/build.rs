//! Links what Debian's static `libshaderc.a` leaves out, and records what was built, from what.
use std::{
    env, fs,
    hash::{DefaultHasher, Hash, Hasher},
    io,
    path::{Path, PathBuf},
    process::Command,
};

/// glslang's and SPIRV-Tools' archives, in link order; later glslang versions dropped some, so those that exist are linked.
const COMPANIONS: [&str; 9] = [
    "glslang",
    "MachineIndependent",
    "GenericCodeGen",
    "OSDependent",
    "OGLCompiler",
    "HLSL",
    "SPIRV",
    "SPVRemapper",
    "SPIRV-Tools-opt",
];

/// What no point of a sweep is made by: commands, the window, and the lab's reports and other experiments.
const ONLY_SHOWS: [&str; 13] = [
    "src/cli",
    "src/window",
    "src/main.rs",
    "src/lab/against.rs",
    "src/lab/budget",
    "src/lab/catalogue.rs",
    "src/lab/compare_maps.rs",
    "src/lab/doctor",
    "src/lab/papers",
    "src/lab/plot",
    "src/lab/reproduce",
    "src/lab/sequence.rs",
    "src/lab/tracers",
];

fn main() {
    println!("cargo:rerun-if-changed=scripts/build.rs");
    println!("cargo:rerun-if-env-changed=SHADERC_LIB_DIR");
    if env::var_os("CARGO_FEATURE_SHADERC_FROM_SOURCE").is_none()
        && let Ok(dir) = env::var("SHADERC_LIB_DIR")
        && Path::new(&dir).join("libglslang.a").exists()
    {
        println!("cargo:rustc-link-arg=-Wl,--start-group");
        for name in COMPANIONS.iter().chain(&["SPIRV-Tools"]) {
            if Path::new(&dir).join(format!("lib{name}.a")).exists() {
                println!("cargo:rustc-link-arg=-l{name}");
            }
        }
        println!("cargo:rustc-link-arg=-Wl,--end-group");
        println!("cargo:rustc-link-arg=-lstdc++");
    }
    // In a worktree `.git` is a file. What does not exist would count as changed at every build.
    for name in ["HEAD", "index"] {
        let path = first_line("git", &["rev-parse", "--git-path", name]);
        if Path::new(&path).exists() {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    println!("cargo:rerun-if-changed=src");
    println!("cargo:rerun-if-changed=Cargo.lock");
    println!("cargo:rustc-env=NEPHROID_CODE={:016x}", code().expect("the sources can be read"));
    println!(
        "cargo:rustc-env=NEPHROID_COMMIT={}",
        first_line("git", &["describe", "--always", "--dirty", "--abbrev=12"])
    );
    println!(
        "cargo:rustc-env=NEPHROID_RUSTC={}",
        first_line(&env::var("RUSTC").unwrap_or("rustc".into()), &["--version"])
    );
}

/// A hash of what may change a measured point: every source but those that only show, and the dependencies.
fn code() -> io::Result<u64> {
    let gone = ONLY_SHOWS.iter().find(|shows| !Path::new(shows).exists());
    assert_eq!(gone, None, "ONLY_SHOWS of scripts/build.rs names what is not there");
    let mut files = vec![PathBuf::from("Cargo.lock")];
    gather(Path::new("src"), &mut files)?;
    files.sort();
    let mut hash = DefaultHasher::new();
    for file in files {
        (file.to_string_lossy(), fs::read(&file)?).hash(&mut hash);
    }
    Ok(hash.finish())
}

/// The sources below a folder.
fn gather(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        match path.is_dir() {
            _ if ONLY_SHOWS.iter().any(|shows| path == Path::new(shows)) => {}
            true => gather(&path, files)?,
            false => files.push(path),
        }
    }
    Ok(())
}

/// First line a command prints, or "unknown": a source archive without git still builds.
fn first_line(program: &str, args: &[&str]) -> String {
    let output = Command::new(program).args(args).output().ok().filter(|o| o.status.success());
    let text = output.map(|o| String::from_utf8_lossy(&o.stdout).into_owned()).unwrap_or_default();
    text.lines().next().filter(|l| !l.is_empty()).unwrap_or("unknown").to_owned()
}

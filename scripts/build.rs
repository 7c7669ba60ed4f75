//! Links what Debian's static `libshaderc.a` leaves out, and records what was built, from what.
use std::{env, path::Path, process::Command};

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
    println!("cargo:rerun-if-changed=.git/HEAD");
    println!("cargo:rerun-if-changed=.git/index");
    println!(
        "cargo:rustc-env=NEPHROID_COMMIT={}",
        first_line("git", &["describe", "--always", "--dirty", "--abbrev=12"])
    );
    println!(
        "cargo:rustc-env=NEPHROID_RUSTC={}",
        first_line(&env::var("RUSTC").unwrap_or("rustc".into()), &["--version"])
    );
}

/// First line a command prints, or "unknown": a source archive without git still builds.
fn first_line(program: &str, args: &[&str]) -> String {
    let output = Command::new(program).args(args).output().ok().filter(|o| o.status.success());
    let text = output.map(|o| String::from_utf8_lossy(&o.stdout).into_owned()).unwrap_or_default();
    text.lines().next().filter(|l| !l.is_empty()).unwrap_or("unknown").to_owned()
}

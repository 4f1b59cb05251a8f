//! Linker scripts of a board: its memory.x beside its Cargo.toml, where it has one, and those of its runtime.

use std::path::PathBuf;
use std::{env, fs};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let memory = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?).join("memory.x");
    println!("cargo:rerun-if-changed={}", memory.display());
    if memory.exists() {
        let out = PathBuf::from(env::var("OUT_DIR")?);
        fs::copy(&memory, out.join("memory.x"))?;
        println!("cargo:rustc-link-search={}", out.display());
    }
    let script = if env::var("TARGET")?.starts_with("thumb") { "link.x" } else { "linkall.x" };
    for script in [script, "defmt.x"] {
        println!("cargo:rustc-link-arg-bins=-T{script}");
    }
    Ok(())
}

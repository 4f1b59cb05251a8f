//! Compiles the programs in `peers/` that run other libraries' methods, each where its library is installed. Where a library is not installed, the tool says so when it compares; in continuous integration (`CI=true`) that
//! is an error. A program that cannot be compiled is an error everywhere.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, io};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=peers");
    let directory = env::var_os("OUT_DIR").map(PathBuf::from);
    let Some(directory) = directory else { return };
    println!("cargo:rerun-if-env-changed=CI");
    println!("cargo:rerun-if-env-changed=PKG_CONFIG_PATH");
    let in_ci = env::var("CI").is_ok_and(|ci| ci == "true");
    let mut failed = false;
    for (name, packages) in [("fcl", ["fcl", "eigen3"].as_slice()), ("box2d", &["box2d"])] {
        let program = directory.join(name);
        if let Err(problem) = run(Command::new("pkg-config").arg("--exists").arg("--print-errors").args(packages)) {
            println!("cargo:warning=not installed, left out of comparisons: {name}: {problem}");
            failed |= in_ci;
            watch_folders();
            continue;
        }
        watch_files(packages);
        match compile(name, packages, &program) {
            Ok(version) => {
                let variable = format!("PCR_PEER_{}", name.to_uppercase());
                println!("cargo:rustc-env={variable}={}", program.display());
                println!("cargo:rustc-env={variable}_VERSION={version}");
            }
            Err(problem) => {
                eprintln!("peers/{name}.cc: {problem}");
                failed = true;
            }
        }
    }
    if failed {
        eprintln!("a program that other libraries are compared with cannot be built");
        std::process::exit(1);
    }
}

/// What pkg-config says about libraries that are installed: it changes when they do. Not the folders, or this and all that uses it would be
/// built again after each package that has nothing to do with it.
fn watch_files(packages: &[&str]) {
    for package in packages {
        if let Ok(folder) = run(Command::new("pkg-config").args(["--variable=pcfiledir", package])) {
            println!("cargo:rerun-if-changed={}/{package}.pc", folder.trim());
        }
    }
}

/// Where pkg-config looks for libraries that are not installed: they may come. Without pkg-config it is built again each time.
fn watch_folders() {
    let folders = run(Command::new("pkg-config").args(["--variable", "pc_path", "pkg-config"]));
    let Ok(folders) = folders else { return println!("cargo:rerun-if-changed=no pkg-config") };
    let more = env::var("PKG_CONFIG_PATH").unwrap_or_default();
    // What is not there would count as changed each time.
    let folders = folders.trim().split(':').chain(more.split(':')).filter(|folder| Path::new(folder).exists());
    for folder in folders {
        println!("cargo:rerun-if-changed={folder}");
    }
}

/// Makes the program, and returns the version of the library.
fn compile(name: &str, packages: &[&str], program: &Path) -> io::Result<String> {
    let flags = |which: &str| run(Command::new("pkg-config").arg(which).args(packages));
    let include = flags("--cflags")?;
    // Warnings of the libraries' headers are not ours.
    let include = include.split_whitespace().flat_map(|flag| match flag.strip_prefix("-I") {
        Some(directory) => vec!["-isystem", directory],
        None => vec![flag],
    });
    let libraries = flags("--libs")?;
    let source = Path::new("peers").join(name).with_extension("cc");
    let mut compiler = Command::new(env::var_os("CXX").unwrap_or_else(|| "c++".into()));
    compiler.args(["-std=c++17", "-O3", "-DNDEBUG", "-Wall", "-Wextra"]).args(include).arg(source);
    run(compiler.arg("-o").arg(program).args(libraries.split_whitespace()))?;
    Ok(run(Command::new("pkg-config").args(["--modversion", name]))?.trim().to_owned())
}

/// What a command prints, or what it complains about: the first line with an error in it, else the last one.
fn run(command: &mut Command) -> io::Result<String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| io::Error::new(error.kind(), format!("{name}: {error}")))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let complaint = String::from_utf8_lossy(&output.stderr);
    let complaint =
        complaint.lines().find(|line| line.contains("error")).or(complaint.lines().last()).unwrap_or("failed");
    Err(io::Error::other(format!("{name}: {complaint}")))
}

//! Checks that the headers in the repository are those that the code generates.
//!
//! `PCR_UPDATE=1 cargo test -p pcr-ffi --test header` writes them.

use std::path::{Path, PathBuf};

/// A number format: its header, the prefixes of its names, and its number types.
struct Format {
    /// File in `src` with the lengths of storage.
    source: &'static str,
    header: &'static str,
    types: &'static str,
    functions: &'static str,
    real: &'static str,
    heading: &'static str,
    title: &'static str,
    after: &'static str,
}

const FORMATS: [Format; 3] = [
    Format {
        source: "single",
        header: "pcr.h",
        types: "Pcr",
        functions: "pcr_",
        real: "f32",
        heading: "f32",
        title: "in single precision: numbers up to a million in magnitude. Units: m, s, m/s, m/s^2, rad",
        after: "",
    },
    Format {
        source: "double",
        header: "pcr_f64.h",
        types: "PcrF64",
        functions: "pcr_f64_",
        real: "f64",
        heading: "f64",
        title: "in double precision: numbers up to a trillion in magnitude. Units: m, s, m/s, m/s^2, rad",
        after: "",
    },
    Format {
        source: "fixed",
        header: "pcr_q16.h",
        types: "PcrQ16",
        functions: "pcr_q16_",
        real: "i32",
        heading: "i32",
        title: "in fixed point: numbers are 1/65536 m, s, m/s and m/s^2, up to 4096 in magnitude. Headings are 1/2^32 of a turn",
        after: "/* Constants that a compiler evaluates: a number, and a heading in radians from -pi to pi. */\n\
            #define PCR_Q16(x) ((int32_t)((x) * 65536.0 + ((x) < 0 ? -0.5 : 0.5)))\n\
            #define PCR_Q16_RADIANS(x) ((int32_t)(uint32_t)(int64_t)((x) * 683565275.5764316 + ((x) < 0 ? -0.5 : 0.5)))",
    },
];

/// The header of everything that all formats share.
const COMMON: &str = "pcr_common.h";

const PROMISES: &str = "   Every function but pcr_fleet_agents returns a PcrStatus; a call that fails leaves the fleet unchanged, except that a table
   which became full when it was built is empty.
   A pointer is null, which is reported, or points to as many values as the function says. The memory given to
   fleet_init belongs to the fleet as long as the fleet is used; all other pointers are used during the call only. The library does
   not allocate. A fleet is used by one thread at a time, and is not moved or copied.";

fn config(title: &str, guard: &str) -> cbindgen::Config {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml");
    config.header =
        Some(format!("/* {title}\n   Made by cbindgen from bindings/c/src: see bindings/c/tests/header.rs. */"));
    config.include_guard = Some(guard.into());
    config
}

/// The source for cbindgen, with the names and number types of a format.
fn rust_of(format: &Format, shared: &[String]) -> String {
    let mut text = String::new();
    for file in ["types", "table", "plans", "orders"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/format").join(file).with_extension("rs");
        let mut importing = false;
        for line in std::fs::read_to_string(path).expect("a source").lines() {
            // A list of imports may go on for several lines.
            importing |= line.starts_with("use ");
            if importing {
                importing = !line.ends_with(';');
                continue;
            }
            let line = if line.starts_with("#[unsafe(export_name") { "#[unsafe(no_mangle)]" } else { line };
            if !line.starts_with("//!") {
                words(line, |word| text.push_str(&name(word, format, shared)));
                text.push('\n');
            }
        }
    }
    text
}

fn name(word: &str, format: &Format, shared: &[String]) -> String {
    match word {
        "Real" => format.real.into(),
        "Heading" => format.heading.into(),
        "SEGMENT" | "MOTION" | "PIECE" => length_in_source(word, format),
        _ if shared.iter().any(|shared| shared == word) => word.into(),
        _ => match (word.strip_prefix("Pcr"), word.strip_prefix("pcr_")) {
            (Some(rest), _) => format!("{}{rest}", format.types),
            (_, Some(rest)) => format!("{}{rest}", format.functions),
            _ => word.into(),
        },
    }
}

/// Returns a length of storage as the source of a format declares it: `const NAME: usize = LENGTH;`.
fn length_in_source(name: &str, format: &Format) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(format.source).with_extension("rs");
    let text = std::fs::read_to_string(path).expect("a source");
    let declared = format!("const {name}: usize = ");
    let lengths: Vec<_> = text.lines().filter_map(|line| line.split_once(&declared)).collect();
    let [(_, length)] = lengths[..] else { panic!("{} declarations of {name}", lengths.len()) };
    length.trim_end_matches(';').to_owned()
}

/// Splits a line into words and the text between them.
fn words(line: &str, mut each: impl FnMut(&str)) {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let end = rest.find(|c| is_word(c) != is_word(first)).unwrap_or(rest.len());
        each(&rest[..end]);
        rest = &rest[end..];
    }
}

fn made(config: cbindgen::Config, source: &Path) -> String {
    let mut made = Vec::new();
    let builder = cbindgen::Builder::new().with_config(config).with_src(source);
    builder.generate().expect("bindings").write(&mut made);
    String::from_utf8(made).expect("UTF-8")
}

/// All headers with their contents.
fn headers() -> Vec<(&'static str, String)> {
    let status = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src/status.rs");
    let text = std::fs::read_to_string(&status).expect("a source");
    let declared = |line: &str| {
        let name = line.strip_prefix("pub enum ").or_else(|| line.strip_prefix("pub struct "))?;
        Some(name.trim_end_matches([' ', '{']).to_owned())
    };
    let shared: Vec<String> = text.lines().filter_map(declared).collect();
    let mut common = config("The parts of the C interface of pcr that all number formats share.", "PCR_COMMON_H");
    // No function in that source uses these types.
    common.export.include = shared.clone();
    let mut headers = vec![(COMMON, made(common, &status))];
    for format in &FORMATS {
        let source = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format.header).with_extension("rs");
        std::fs::write(&source, rust_of(format, &shared)).expect("a temporary file");
        let title = format!("Collision regions of discs on line/arc paths, {}.\n{PROMISES}", format.title);
        let guard = format.header.replace('.', "_").to_uppercase();
        let mut config = config(&title, &guard);
        config.includes = vec![COMMON.into()];
        config.after_includes = Some(format.after.into()).filter(|after: &String| !after.is_empty());
        headers.push((format.header, made(config, &source)));
    }
    headers
}

#[test]
fn the_headers_are_up_to_date() {
    for (name, made) in headers() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include").join(name);
        if std::env::var_os("PCR_UPDATE").is_some() {
            std::fs::write(&path, &made).expect("the header can be written");
        }
        let there = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(made == there, "{name} is not what the code makes: PCR_UPDATE=1 cargo test -p pcr-ffi --test header");
    }
}

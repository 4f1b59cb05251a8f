//! The header in the repository is the one that the code makes.
//!
//! `PCR_UPDATE=1 cargo test -p pcr-ffi --test header` writes it anew.

use std::path::Path;

#[test]
fn the_header_is_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml");
    let sources = ["api", "types"].map(|name| root.join("src").join(name).with_extension("rs"));
    let builder =
        sources.iter().fold(cbindgen::Builder::new().with_config(config), |builder, source| builder.with_src(source));
    let mut made = Vec::new();
    builder.generate().expect("bindings").write(&mut made);
    let made = String::from_utf8(made).expect("UTF-8");
    let path = root.join("include/pcr.h");
    if std::env::var_os("PCR_UPDATE").is_some() {
        std::fs::write(&path, &made).expect("the header can be written");
    }
    let there = std::fs::read_to_string(&path).expect("the header");
    assert!(
        made == there,
        "include/pcr.h is not what the code makes: PCR_UPDATE=1 cargo test -p pcr-ffi --test header"
    );
}

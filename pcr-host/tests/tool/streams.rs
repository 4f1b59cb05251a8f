//! Output that cannot be written, or that nobody reads to its end.

use crate::fixture::{PAPER, pcr};
use std::io::Read;
use std::process::Stdio;

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let mut child = pcr()
        .args(["regions", PAPER, "--format", "json", "--slices", "300"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The output is far longer than a pipe holds, so the tool is still writing when its reader goes.
    let mut first = [0; 35];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(&first, b"{\"format\":\"pcr-regions\",\"version\":1");
    assert_eq!((output.status.code(), String::from_utf8(output.stderr).unwrap().as_str()), (Some(0), ""));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_of_its_own() {
    for arguments in [
        &["regions", PAPER][..],
        &["regions", PAPER, "--format", "json"],
        &["regions", PAPER, "--format", "csv"],
        &["demo", "--scenario"],
        &["help"],
        &["--help"],
        &["plan", "-h"],
        &["--version"],
        &["completions", "zsh"],
        &["man"],
        &["plan", PAPER, "-o", "-", "-q"],
        &[],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = pcr().args(arguments).stdout(full).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(3), "{arguments:?}: {message}");
        assert!(message.starts_with("pcr: standard output: cannot be written: "), "{message}");
    }
}

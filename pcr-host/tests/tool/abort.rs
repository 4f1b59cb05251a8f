//! Aborts, which are a fault of the tool and no wrong input.

use crate::fixture::{crossing, pcr};
use std::io::{Read, Write};
use std::process::{Command, Stdio};

/// What a run that reads standard input leaves behind after SIGABRT, within an address space of so many kilobytes.
fn aborted(kilobytes: Option<u32>) -> (Option<i32>, String) {
    let limit = kilobytes.map_or(String::new(), |limit| format!("ulimit -v {limit}; "));
    let script = format!("{limit}exec \"$0\" regions -");
    let mut child = Command::new("bash")
        .args(["-c", &script])
        .arg(pcr().get_program())
        .env("RAYON_NUM_THREADS", "2")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It answers each scenario before it reads the next one, for which it waits now.
    let mut input = child.stdin.take().unwrap();
    writeln!(input, "{}", crossing()).unwrap();
    let mut answer = [0];
    child.stdout.as_mut().unwrap().read_exact(&mut answer).unwrap();
    let killed = Command::new("kill").args(["-ABRT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
#[cfg(target_os = "linux")]
fn an_abort_has_a_status_of_its_own_and_asks_for_a_report() {
    let (status, message) = aborted(None);
    assert_eq!(status, Some(134), "{message}");
    assert!(message.starts_with("pcr: this is a fault of pcr") && message.contains("please report"), "{message}");
    assert_eq!(message.lines().count(), 1);
}

#[test]
#[cfg(target_os = "linux")]
fn where_little_memory_is_left_an_abort_is_a_lack_of_memory() {
    let (status, message) = aborted(Some(400_000));
    assert_eq!((status, message.as_str()), (Some(2), ""));
}

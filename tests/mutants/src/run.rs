//! Each mutant against the tests that reach it, the shortest first.

use crate::tests::{Binary, Test, tests};
use std::collections::HashSet;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::Output;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// The first test that fails, and whether it has no end.
fn failed(output: &Output) -> (String, bool) {
    let text = String::from_utf8_lossy(&output.stdout);
    let mut tests = text.lines().filter(|line| line.starts_with("test ") && !line.starts_with("test result"));
    let test = tests.clone().find(|line| line.ends_with("FAILED")).or_else(|| tests.next_back());
    let name = test.and_then(|line| line.split_whitespace().nth(1)).unwrap_or("?");
    // Killed: by its own limit on time, or by the one of its children.
    (name.to_owned(), matches!(output.status.code(), None | Some(124 | 137 | 152)))
}

/// Tests that run together: few that are short, then more, up to a time in all.
fn batches<'a>(tests: impl Iterator<Item = &'a Test>, seconds: f64) -> Vec<Vec<&'a Test>> {
    let (mut batches, mut total, mut bound) = (Vec::<Vec<&Test>>::new(), 0.0, 0.1);
    for test in tests {
        total += test.seconds;
        if total > seconds {
            break;
        }
        if batches.is_empty() || total > bound {
            batches.push(Vec::new());
            bound = 3.0 * total.max(bound);
        }
        batches.last_mut().expect("a batch").push(test);
    }
    batches
}

/// The result of a mutant: noticed, endless, unreached or passed; the test, or how many, and their time.
fn result(number: &str, binaries: &[Binary], tests: &[Test], seconds: f64) -> String {
    let mutant = number.parse().expect("a number");
    let batches = batches(tests.iter().filter(|test| test.reached.contains(&mutant)), seconds);
    for batch in &batches {
        for (at, binary) in binaries.iter().enumerate() {
            let own: Vec<&Test> = batch.iter().copied().filter(|test| test.binary == at).collect();
            if own.is_empty() {
                continue;
            }
            let limit = 3 + (2.0 * own.iter().map(|test| test.seconds).sum::<f64>()) as u64;
            let names: Vec<&str> = own.iter().map(|test| test.name.as_str()).collect();
            let output = binary.run(&names, limit, ("MUTANT", number));
            if !output.status.success() {
                let (test, endless) = failed(&output);
                return format!("{}\t{test}", if endless { "endless" } else { "noticed" });
            }
        }
    }
    let run = || batches.iter().flatten();
    let time: f64 = run().map(|test| test.seconds).sum();
    let word = if batches.is_empty() { "unreached" } else { "passed" };
    format!("{word}\t{} tests, {time:.1} s", run().count())
}

/// Runs all mutants of `folder/list` that `folder/results` does not have, or has as passed within fewer seconds than these.
pub fn run(folder: &Path, seconds: f64, jobs: usize, binaries: &[&str]) {
    let binaries: Vec<Binary> = binaries.iter().map(|text| Binary::new(text)).collect();
    let tests = tests(folder, &binaries, seconds, jobs);
    let list = fs::read_to_string(folder.join("list")).expect("a list");
    let results = folder.join("results");
    let done = fs::read_to_string(&results).unwrap_or_default();
    let done: HashSet<&str> = done.lines().filter_map(|line| line.split('\t').next()).collect();
    let left: Vec<&str> =
        list.lines().filter(|line| line.split('\t').next().is_some_and(|number| !done.contains(number))).collect();
    let file = Mutex::new(File::options().append(true).create(true).open(&results).expect("a file"));
    println!("{} tests, {} mutants", tests.len(), left.len());
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(line) = left.get(next.fetch_add(1, Ordering::Relaxed)) {
            let number = line.split('\t').next().expect("a number");
            let result = result(number, &binaries, &tests, seconds);
            writeln!(file.lock().expect("a file"), "{line}\t{result}").expect("written");
        }
    };
    thread::scope(|scope| (0..jobs).for_each(|_| drop(scope.spawn(work))));
}

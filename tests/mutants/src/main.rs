//! Mutants of Rust files, all in one build, and a run of the tests against each. `../run.sh` does it all.
//!
//! ```text
//! mutants put AFTER ROOT FILE...              switches in the files of the crate with this root file, in place, numbered from
//!                                             AFTER + 1; a line a mutant. SKIP="N ..." leaves out what does not compile
//! mutants broken < MESSAGES                   numbers of those, by `cargo check --message-format=short` in the same folder
//! mutants run FOLDER SECONDS JOBS DIR:BINARY...   the tests of these binaries, each run in its folder, against FOLDER/list
//! mutants table FOLDER                        results: a line a file, and the mutants that no test noticed
//! ```
//!
//! A mutant is on if the variable `MUTANT` holds its number when the tests run.

mod broken;
mod expand;
mod put;
mod run;
mod table;
mod tests;

use std::env;

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["put", after, root, ..] => put::put(after.parse().expect("a number"), root, &arguments[3..]),
        ["broken"] => broken::print(),
        ["run", folder, seconds, jobs, binaries @ ..] => {
            let (seconds, jobs) = (seconds.parse().expect("seconds"), jobs.parse().expect("a number"));
            run::run(folder.as_ref(), seconds, jobs, binaries);
        }
        ["table", folder] => table::print(folder.as_ref()),
        _ => panic!("put, broken, run or table"),
    }
}

//! The tests: how long each takes, and which mutants it reaches.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

pub struct Binary {
    folder: PathBuf,
    path: PathBuf,
    /// Without the checksum at its end.
    name: String,
}

pub struct Test {
    pub binary: usize,
    pub name: String,
    pub seconds: f64,
    pub reached: HashSet<u32>,
}

impl Binary {
    /// Of `folder:path`.
    pub fn new(text: &str) -> Self {
        let (folder, path) = text.split_once(':').expect("folder:binary");
        let path = PathBuf::from(path);
        let file = path.file_name().and_then(|name| name.to_str()).expect("a name");
        let name = file.rsplit_once('-').map_or(file, |(name, _)| name).to_owned();
        Self { folder: folder.into(), name, path }
    }

    /// Runs tests one after the other, up to the first that fails, with a limit on the time of a core.
    pub fn run(&self, names: &[&str], limit: u64, variable: (&str, &str)) -> Output {
        // Memory is limited too, as an endless loop may fill it; and time, as a process may wait for ever.
        let script = "ulimit -v 8000000; ulimit -t $0; exec timeout -s KILL $((${WAIT:-60} * $0)) \"$@\"";
        Command::new("sh")
            .args(["-c", script, &limit.to_string()])
            .arg(&self.path)
            .args(["--exact", "--test-threads=1", "-Zunstable-options", "--fail-fast"])
            .args(names)
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUST_BACKTRACE", "0")
            .env(variable.0, variable.1)
            .current_dir(&self.folder)
            .output()
            .expect("a process")
    }

    /// How long a test takes \[s\], with the start of the process; no end if it fails, or takes longer than this.
    fn time(&self, name: &str, longest: u64) -> f64 {
        let start = Instant::now();
        let passed = self.run(&[name], longest, ("MUTANT", "0")).status.success();
        if passed { start.elapsed().as_secs_f64() } else { f64::INFINITY }
    }

    fn names(&self) -> Vec<String> {
        let listed = Command::new(&self.path).args(["--list", "--format", "terse"]).output().expect("a process");
        let text = String::from_utf8(listed.stdout).expect("text");
        text.lines().filter_map(|line| line.strip_suffix(": test")).map(str::to_owned).collect()
    }
}

/// What a former run wrote: seconds and mutants, by name.
fn known(file: &Path) -> HashMap<String, (f64, HashSet<u32>)> {
    let text = fs::read_to_string(file).unwrap_or_default();
    let parse = |line: &str| {
        let mut words = line.split_whitespace();
        let (name, seconds) = (words.next()?.to_owned(), words.next()?.parse().ok()?);
        Some((name, (seconds, words.filter_map(|word| word.parse().ok()).collect())))
    };
    text.lines().filter_map(parse).collect()
}

/// All tests that pass in time without a mutant, with what they reach; those of a former run are read from its file.
pub fn tests(folder: &Path, binaries: &[Binary], seconds: f64, jobs: usize) -> Vec<Test> {
    // One that takes longer than a mutant has is no part of the run.
    let longest = seconds.ceil() as u64;
    let path = folder.join("reached");
    let known = known(&path);
    let file = Mutex::new(File::options().append(true).create(true).open(&path).expect("a file"));
    let names: Vec<(usize, String)> = binaries
        .iter()
        .enumerate()
        .flat_map(|(at, binary)| binary.names().into_iter().map(move |name| (at, name)))
        .collect();
    let starts: Vec<f64> = binaries.iter().map(|binary| binary.time("no test has this name", longest)).collect();
    let (next, tests) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = |job: usize| {
        let reached = std::path::absolute(folder.join(format!("reached.{job}"))).expect("a path");
        while let Some((binary, name)) = names.get(next.fetch_add(1, Ordering::Relaxed)) {
            let full = format!("{}/{name}", binaries[*binary].name);
            let (seconds, numbers) = known.get(&full).cloned().unwrap_or_else(|| {
                let _ = fs::remove_file(&reached);
                let seconds = binaries[*binary].time(name, longest) - starts[*binary];
                let variable = ("REACHED", reached.to_str().expect("text"));
                if seconds.is_infinite() {
                    return (seconds, HashSet::new());
                }
                if !binaries[*binary].run(&[name], 10 * longest, variable).status.success() {
                    panic!("{full} fails where what it reaches is written");
                }
                let text = fs::read_to_string(&reached).unwrap_or_default();
                writeln!(file.lock().expect("a file"), "{full} {seconds:.4} {}", text.replace('\n', " "))
                    .expect("written");
                (seconds, text.lines().filter_map(|number| number.parse().ok()).collect())
            });
            if seconds.is_finite() {
                let test = Test { binary: *binary, name: name.clone(), seconds, reached: numbers };
                tests.lock().expect("tests").push(test);
            } else {
                eprintln!("{full} fails, or takes too long: it is no part of the run");
            }
        }
    };
    thread::scope(|scope| {
        for job in 0..jobs {
            let work = &work;
            scope.spawn(move || work(job));
        }
    });
    let mut tests = tests.into_inner().expect("tests");
    tests.sort_by(|one, other| one.seconds.total_cmp(&other.seconds));
    tests
}

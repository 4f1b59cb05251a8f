//! Methods of C++ libraries, run as separate programs: the build script compiles them from `peers/` if the libraries
//! are installed. They read numbers, and write the time of the computation and the contacts. The time to start them and
//! to transfer the numbers does not count.

use pcr_comparing::compare::stopwatch::{Stopwatch, steady};
use pcr_comparing::compare::{
    CollisionMethod, ComparisonFleet, MethodAnswer, MethodContact, MethodError, MethodQuestion, MethodResult,
};
use std::io::{self, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};

/// A program, or why there is none.
#[derive(Clone, Copy, Debug)]
pub(super) struct PeerProgram {
    name: &'static str,
    version: Option<&'static str>,
    path: Option<&'static str>,
    /// What has to be installed when the tool is built.
    missing: &'static str,
}

impl PeerProgram {
    /// The Flexible Collision Library.
    pub(super) const FCL: Self = Self {
        name: "FCL",
        version: option_env!("PCR_PEER_FCL_VERSION"),
        path: option_env!("PCR_PEER_FCL"),
        missing: "libfcl-dev was not installed when pcr-lab was built",
    };

    /// Box2D.
    pub(super) const BOX2D: Self = Self {
        name: "Box2D",
        version: option_env!("PCR_PEER_BOX2D_VERSION"),
        path: option_env!("PCR_PEER_BOX2D"),
        missing: "libbox2d-dev was not installed when pcr-lab was built",
    };

    /// The library with its version, or that it is left out.
    pub(super) fn library(self) -> String {
        match self.version.filter(|_| self.is_there()) {
            Some(version) => format!("{} {version}", self.name),
            None => format!("{} is left out: {}", self.name, self.missing().unwrap_or_default()),
        }
    }

    /// Why it cannot be run, if it cannot.
    fn missing(self) -> Option<&'static str> {
        match self.path {
            None => Some(self.missing),
            Some(_) if !self.is_there() => Some("its program is no longer where pcr-lab was built"),
            Some(_) => None,
        }
    }

    /// Whether it can be run.
    fn is_there(self) -> bool {
        self.path.is_some_and(|path| Path::new(path).is_file())
    }

    /// The time that the work took \[s\], and the contacts, with times as `in_time` has them from the program's.
    fn contacts<'f>(self, input: &[f64], in_time: impl Fn(f64) -> f64) -> io::Result<(f64, MethodAnswer<'f>)> {
        let output = self.run(input)?;
        parse(&output, in_time).ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "not what a peer writes"))
    }

    fn run(self, input: &[f64]) -> io::Result<String> {
        let path = self.path.ok_or(io::ErrorKind::NotFound)?;
        let mut child = Command::new(path).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let bytes: Vec<u8> = input.iter().flat_map(|number| number.to_ne_bytes()).collect();
        // It reads everything before it writes anything. Dropped, the pipe is closed.
        let sent = child.stdin.take().map_or(Ok(()), |mut pipe| pipe.write_all(&bytes));
        let output = child.wait_with_output()?;
        sent?;
        if !output.status.success() {
            return Err(io::Error::other(format!("{path}: {}", output.status)));
        }
        String::from_utf8(output.stdout).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
    }
}

/// A program as a method that finds contacts.
pub(super) struct PeerMethod {
    pub(super) program: PeerProgram,
    pub(super) name: String,
    pub(super) tells: &'static str,
    /// What the program reads; making it counts.
    pub(super) input: fn(&ComparisonFleet<'_>) -> Vec<f64>,
    /// Times from the program's \[s\].
    pub(super) in_time: fn(&ComparisonFleet<'_>, f64) -> f64,
}

impl CollisionMethod for PeerMethod {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn question(&self) -> MethodQuestion {
        MethodQuestion::Conflicts
    }

    fn output_description(&self) -> &'static str {
        self.tells
    }

    fn missing(&self) -> Option<&'static str> {
        self.program.missing()
    }

    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f> {
        self.timed(field).1
    }

    fn timed<'f>(&self, field: &'f ComparisonFleet<'_>) -> (f64, MethodResult<'f>) {
        let (made, input) = steady(Stopwatch::elapsed, || (self.input)(field));
        match self.program.contacts(&input, |time| (self.in_time)(field, time)) {
            Ok((work, answer)) => (made + work, Ok(answer)),
            Err(error) => (made, Err(MethodError::Program(error))),
        }
    }
}

fn parse<'f>(output: &str, in_time: impl Fn(f64) -> f64) -> Option<(f64, MethodAnswer<'f>)> {
    let mut lines = output.lines();
    let time = lines.next()?.parse().ok()?;
    let contact = |line: &str| {
        let mut words = line.split(' ');
        let agents = [words.next()?.parse().ok()?, words.next()?.parse().ok()?];
        let [begin, end] = [words.next()?.parse::<f64>().ok()?, words.next()?.parse().ok()?];
        let end = (!end.is_nan()).then(|| in_time(end));
        Some(MethodContact { agents, begin: in_time(begin), end })
    };
    Some((time, MethodAnswer::Conflicts(lines.map(contact).collect::<Option<_>>()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_are_read_with_and_without_an_end() {
        let (time, answer) = parse("0.25\n0 3 5 7\n1 2 4 nan\n", |sample| 0.5 * sample).unwrap();
        let MethodAnswer::Conflicts(found) = answer else { panic!("contacts are conflicts") };
        let expected = [
            MethodContact { agents: [0, 3], begin: 2.5, end: Some(3.5) },
            MethodContact { agents: [1, 2], begin: 2.0, end: None },
        ];
        assert_eq!((time, &found[..]), (0.25, &expected[..]));
    }

    #[test]
    fn what_no_peer_writes_is_no_answer() {
        for output in ["", "time\n", "0.1\n0 1\n", "0.1\n0 1 2 x\n"] {
            assert!(parse(output, |time| time).is_none(), "{output:?}");
        }
    }
}

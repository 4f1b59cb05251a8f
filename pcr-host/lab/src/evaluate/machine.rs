//! Describes the machine on which the evaluation runs.

use super::Thoroughness;
use crate::methods::libraries;
use std::fs;
use std::thread::available_parallelism;

/// What a document of small fleets says of itself.
pub(super) const QUICK: &str = " Written with `--quick`: small fleets, without the slowest methods.";

/// What only such a document says.
pub(super) const OWN: &str = "evaluate` writes this document with all numbers and pictures";

/// Where the summary begins and ends, which people write: it stays when the numbers are measured anew.
const SUMMARY: [&str; 2] = ["<!-- summary, written by hand -->\n", "<!-- end of summary -->\n\n"];

/// Returns the summary of a document, with its marks; nothing of a document without one.
pub(super) fn summary(document: &str) -> &str {
    let [begins, ends] = SUMMARY;
    let Some(begin) = document.find(begins) else { return "" };
    document[begin..].find(ends).map_or("", |end| &document[begin..begin + end + ends.len()])
}

/// Returns title, summary, command, machine and how to read the numbers.
pub(super) fn preamble(extent: Thoroughness, summary: &str) -> String {
    let cores = available_parallelism().map_or(1, usize::from);
    let cpu = line("/proc/cpuinfo", "model name").unwrap_or_else(|| "an unnamed processor".into());
    let kilobytes = line("/proc/meminfo", "MemTotal").and_then(|total| total.split(' ').next()?.parse::<f64>().ok());
    let memory =
        kilobytes.map_or("an unknown amount".into(), |kilobytes| format!("{:.0} GiB", kilobytes / f64::from(1 << 20)));
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().filter(|load| !load.is_empty()).unwrap_or("unknown");
    let libraries = libraries().join("; ");
    let quick = match extent {
        Thoroughness::Full => "",
        Thoroughness::Quick => QUICK,
    };
    let (os, architecture) = (std::env::consts::OS, std::env::consts::ARCH);
    format!(
        "# Evaluation\n\n{summary}\
        `cargo run --release -p pcr-lab -- {OWN}, and with \
        `--only PART` one part of it anew; only the summary is written by hand.{quick}\n\n\
        **Machine**: {cpu}, {cores} cores, {memory} of memory, {os} on {architecture}; load at the beginning {load} ({cores} would keep all cores \
        busy). **Libraries in C++**: {libraries}. Times are medians. The results are the *ratios*: in each round all methods run one after the \
        other, and a ratio is the median of the ratios of the rounds. Every method starts from the same placed paths and motions; the time for \
        sampling, flattening and making meshes counts. Work of less than 5 ms is repeated for 5 ms in each round, after a first run that does not \
        count, so that the caches that other methods have filled do not matter. Methods run on one core unless stated otherwise. For work of more \
        than 40 ms the processor time counts, so that other work on the machine does not matter.\n"
    )
}

/// The value of a line `key : value` of a file.
pub(super) fn line(file: &str, key: &str) -> Option<String> {
    let text = fs::read_to_string(file).ok()?;
    let (_, value) = text.lines().find(|line| line.starts_with(key))?.split_once(':')?;
    Some(value.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_stays_when_a_document_is_written_anew() {
        let [begins, ends] = SUMMARY;
        let words = format!("{begins}What it comes to.\n{ends}");
        let first = preamble(Thoroughness::Full, &words);
        assert!(first.starts_with(&format!("# Evaluation\n\n{words}`cargo run")), "{first}");
        assert_eq!(summary(&first), words);
        assert_eq!(summary(&preamble(Thoroughness::Full, "")), "");
        assert_eq!(summary(begins), "");
    }
}

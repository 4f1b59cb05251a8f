//! The available memory: data that do not fit are refused before an allocation fails, which would abort the program.

use std::fmt;
use std::fs;

/// Memory that stays free, so that small allocations need no check \[bytes\]; of the address space more stays free, because
/// each thread takes 64 MB of it at a time.
const RESERVE: u64 = 48 << 20;
const ADDRESSES: u64 = 160 << 20;

/// Memory that may be allocated between two checks \[bytes\].
pub const STEP: u64 = 16 << 20;

/// An answer, or a part of it, that does not fit into memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemoryError {
    what: String,
    /// \[bytes\], where it is known.
    needed: Option<u64>,
    /// \[bytes\], where the system tells.
    left: Option<u64>,
}

impl fmt::Display for MemoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let megabytes = |bytes: u64| bytes.div_ceil(1_000_000);
        let what = &self.what;
        match (self.needed.map(megabytes), self.left.map(megabytes)) {
            (Some(needed), Some(0)) => {
                write!(f, "{what} would take {needed} MB of memory; nothing is left beside a small reserve")
            }
            (Some(needed), Some(left)) => write!(f, "{what} would take {needed} MB of memory; {left} MB are left"),
            (Some(needed), None) => write!(f, "{what} would take {needed} MB of memory, which are not left"),
            (None, Some(left @ 1..)) => write!(f, "{what} takes more memory than the {left} MB that are left"),
            (None, _) => write!(f, "{what} takes more memory than is left"),
        }
    }
}

impl std::error::Error for MemoryError {}

impl MemoryError {
    /// The error for a refused allocation.
    pub(crate) fn of(what: String) -> Self {
        Self { what, needed: None, left: available_bytes() }
    }
}

/// A job, with the numbers that decide how much memory it takes. It displays as what the memory is for.
#[derive(Clone, Copy, Debug)]
pub enum MemoryDemand<'a> {
    /// Reading the numbers in a text of so many bytes.
    Text(u64),
    /// Reading a text of so many bytes to a tree, as all but scenarios are read.
    Tree(u64),
    /// Answering about a scenario, beside the answer.
    Answer {
        /// Number of agents.
        agents: usize,
        /// Segments of all their paths.
        segments: usize,
    },
    /// A table for reading: all its rows, until the widths of its columns are known.
    Rows {
        /// Number of rows.
        count: usize,
        /// What is in a row, in the plural.
        what: &'a str,
    },
    /// A plan and its proof, for as many agents that are alone; those that come near one another ask for more.
    Plan(usize),
    /// The forms of all methods of a comparison, for as many agents.
    Comparison(usize),
    /// The start delays that as many regions forbid.
    ForbiddenDelays(usize),
    /// The proof of as many conflicts: in the checker, while its list grows, and in the answer.
    ConflictProof(usize),
    /// The proof for as many segments: in a table and in the checker.
    SegmentProof(usize),
    /// The proof for as many pairs of discs: in a certificate and in the checker.
    PairProof(u64),
    /// The proof of delays of as many motions along edges.
    TraversalProof(usize),
    /// The rules made of a table of as many locks: names, and members of groups.
    Exclusions(usize),
    /// Edges cut into as many parts.
    EdgeParts {
        /// Length of the longest part \[m\].
        longest: f64,
        /// Number of parts.
        parts: u64,
    },
}

impl MemoryDemand<'_> {
    /// Returns how many bytes the job takes. These are estimates, which the tests of limits check
    /// (`pcr-host/tests/tool/large.rs`).
    pub fn bytes(self) -> u64 {
        let (count, each) = match self {
            Self::Text(bytes) => (bytes, 8),
            Self::Tree(bytes) => (bytes, OF_TREE),
            Self::Answer { agents, segments } => return 1600 * agents as u64 + 400 * segments as u64,
            Self::Rows { count, .. } => (count as u64, 800),
            Self::Plan(agents) => (agents as u64, 3800),
            Self::Comparison(agents) => (agents as u64, 2000),
            Self::ForbiddenDelays(regions) => (regions as u64, 256),
            Self::ConflictProof(conflicts) => (conflicts as u64, 128),
            Self::SegmentProof(segments) => (segments as u64, 800),
            Self::PairProof(pairs) => (pairs, 128),
            Self::TraversalProof(motions) => (motions as u64, 4096),
            Self::Exclusions(locks) => (locks as u64, 256),
            Self::EdgeParts { parts, .. } => (parts, 4096),
        };
        count.saturating_mul(each)
    }

    /// Checks that the memory is there, before the job begins; what is small is not checked.
    ///
    /// # Errors
    /// [`MemoryError`], with the number of bytes, if the system reports less free memory.
    pub fn ask(self) -> Result<(), MemoryError> {
        let what = || self.to_string();
        match self {
            Self::Text(_) | Self::Tree(_) | Self::Answer { .. } => ask_for_all_left(self.bytes(), what),
            _ => ask(self.bytes(), what),
        }
    }
}

impl fmt::Display for MemoryDemand<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(_) => f.write_str("what is read"),
            Self::Tree(_) => f.write_str("what is made of the file"),
            Self::Answer { agents, .. } => write!(f, "an answer about {agents} agents"),
            Self::Rows { count, what } => write!(f, "a table of {count} {what}"),
            Self::Plan(agents) => write!(f, "the plan of {agents} agents"),
            Self::Comparison(agents) => write!(f, "the comparison of {agents} agents"),
            Self::ForbiddenDelays(regions) => write!(f, "start delays that {regions} regions forbid"),
            Self::ConflictProof(conflicts) => write!(f, "the proof of {conflicts} conflicts"),
            Self::SegmentProof(segments) => write!(f, "the proof for {segments} segments"),
            Self::PairProof(pairs) => {
                write!(f, "the certificate of {pairs} pairs of discs that come near one another")
            }
            Self::TraversalProof(_) => f.write_str("the motions to be proved"),
            Self::Exclusions(locks) => write!(f, "what is made of a table of {locks} locks"),
            Self::EdgeParts { longest, parts } => write!(f, "--split {longest}: {parts} parts"),
        }
    }
}

/// Checks that some bytes can be allocated, where a list grows or its items have a known size; what is small is not checked.
///
/// # Errors
/// [`MemoryError`], with the number of bytes, if the system reports less free memory.
pub fn ask(bytes: u64, what: impl FnOnce() -> String) -> Result<(), MemoryError> {
    if bytes < STEP { Ok(()) } else { ask_at_all(bytes, what) }
}

/// Bytes of a tree for each byte of its text.
const OF_TREE: u64 = 80;

/// Asks for some bytes and keeps no reserve: for estimates that are high, or while no other thread takes addresses.
fn ask_for_all_left(bytes: u64, what: impl FnOnce() -> String) -> Result<(), MemoryError> {
    let limits = [address_space(), group(), machine()];
    match limits.into_iter().flatten().min() {
        Some(left) if bytes > STEP && bytes > left => {
            Err(MemoryError { what: what(), needed: Some(bytes), left: Some(left) })
        }
        _ => Ok(()),
    }
}

fn ask_at_all(bytes: u64, what: impl FnOnce() -> String) -> Result<(), MemoryError> {
    match available_bytes() {
        Some(left) if bytes > left => Err(MemoryError { what: what(), needed: Some(bytes), left: Some(left) }),
        _ => Ok(()),
    }
}

/// Checks that a list of `count` items of a size \[bytes\] can be allocated. Only for long lists, because the check takes time.
pub(crate) fn for_list(count: usize, size: u64) -> Result<(), MemoryError> {
    ask(count as u64 * size, || format!("a list of {count}"))
}

/// Counts the memory of a growing list, and checks from time to time.
#[derive(Debug, Default)]
pub(crate) struct MemoryBudget {
    unchecked_bytes: u64,
    all: u64,
}

impl MemoryBudget {
    /// Appends items to a list; together they have `beside` bytes of memory outside of the list.
    ///
    /// # Errors
    /// [`MemoryError`] if the list does not fit; it may have to be copied to twice its size.
    pub(crate) fn extend<T>(
        &mut self,
        list: &mut Vec<T>,
        items: Vec<T>,
        beside: u64,
        what: &str,
    ) -> Result<(), MemoryError> {
        let own = size_of::<T>() as u64;
        let count = list.len() + items.len();
        let grows = count > list.capacity();
        let added = items.len() as u64 * own + beside;
        (self.unchecked_bytes, self.all) = (self.unchecked_bytes + added, self.all + added);
        let more = if grows { 2 * count as u64 * own } else { STEP };
        let what = || format!("a list of {count} {what} and those that are to come");
        let so_far = self.all + more;
        if self.unchecked_bytes >= STEP {
            self.unchecked_bytes = 0;
            ask_at_all(more, what).map_err(|large| MemoryError { needed: Some(so_far), ..large })?;
        }
        list.try_reserve(items.len()).map_err(|_| MemoryError { needed: Some(so_far), ..MemoryError::of(what()) })?;
        list.extend(items);
        Ok(())
    }
}

/// Bytes that may be allocated yet, by the limit of the address space (`ulimit -v`), that of the group of processes and what the
/// machine has, less a reserve; nothing where no system tells.
pub fn available_bytes() -> Option<u64> {
    let limits = [(address_space(), ADDRESSES), (group(), RESERVE), (machine(), RESERVE)];
    limits.into_iter().filter_map(|(bytes, reserve)| Some(bytes?.saturating_sub(reserve))).min()
}

/// A number of kilobytes in a file of lines `name: number kB` \[bytes\].
fn kilobytes(file: &str, name: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim_start_matches(':').split_whitespace().next()?.parse::<u64>().ok().map(|number| number << 10)
}

fn address_space() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(kilobytes("/proc/self/status", "VmSize")?))
}

fn group() -> Option<u64> {
    in_groups(|file| fs::read_to_string(file).ok())
}

/// What the group of this process and the groups around it leave, by the files that the system shows.
fn in_groups(read: impl Fn(&str) -> Option<String>) -> Option<u64> {
    let groups = read("/proc/self/cgroup").unwrap_or_default();
    let mut path = groups.lines().find_map(|line| line.strip_prefix("0::")).unwrap_or("").trim_end_matches('/');
    let mut least: Option<u64> = None;
    loop {
        let file = |name: &str| read(&format!("/sys/fs/cgroup{path}/{name}"));
        let number = |name: &str| file(name)?.trim().parse::<u64>().ok();
        if let (Some(most), Some(used)) = (number("memory.max"), number("memory.current")) {
            let used = used.saturating_sub(cached(&file("memory.stat").unwrap_or_default()));
            let left = most.saturating_sub(used);
            least = Some(least.map_or(left, |least| least.min(left)));
        }
        let Some((around, _)) = path.rsplit_once('/') else { return least };
        path = around;
    }
}

/// Pages of files in memory, which the system frees before it refuses an allocation \[bytes\].
fn cached(stat: &str) -> u64 {
    let of = |name: &str| stat.lines().find_map(|line| line.strip_prefix(name)?.trim().parse::<u64>().ok());
    ["inactive_file ", "active_file "].into_iter().filter_map(of).fold(0, u64::saturating_add)
}

fn machine() -> Option<u64> {
    kilobytes("/proc/meminfo", "MemAvailable")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_any_machine_has_is_refused_with_its_number() {
        if available_bytes().is_some() {
            let refused = ask(1 << 60, || "a table".into()).unwrap_err().to_string();
            assert!(refused.starts_with("a table would take 1152921504607 MB of memory; "), "{refused}");
        }
        assert_eq!(ask(STEP - 1, String::new), Ok(()));
    }

    #[test]
    fn jobs_are_refused_with_what_they_need() {
        assert_eq!(MemoryDemand::Rows { count: 1000, what: "regions" }.bytes(), 800_000);
        assert_eq!(MemoryDemand::Answer { agents: 2, segments: 3 }.bytes(), 4400);
        assert_eq!(MemoryDemand::EdgeParts { longest: 0.5, parts: u64::MAX }.bytes(), u64::MAX);
        assert_eq!(MemoryDemand::Plan(4).ask(), Ok(()));
        if available_bytes().is_some() {
            let refused = MemoryDemand::PairProof(1 << 53).ask().unwrap_err().to_string();
            let what = "the certificate of 9007199254740992 pairs of discs that come near one another would take ";
            assert!(refused.starts_with(&format!("{what}1152921504607 MB of memory; ")), "{refused}");
            assert!(MemoryDemand::Tree(1 << 50).ask().is_err() && MemoryDemand::Text(1 << 50).ask().is_err());
        }
    }

    /// Files that had been read counted as memory in use, and groups within others as if there were none.
    #[test]
    fn a_group_leaves_what_is_not_in_use() {
        let left = |files: &[(&str, &str)]| {
            in_groups(|file| files.iter().find(|(name, _)| *name == file).map(|(_, text)| (*text).to_owned()))
        };
        let stat = "anon 100\nfile 850\nkernel 50\ninactive_file 600\nactive_file 250\nworkingset_refault_file 7\n";
        let container = [
            ("/proc/self/cgroup", "0::/\n"),
            ("/sys/fs/cgroup/memory.max", "1000\n"),
            ("/sys/fs/cgroup/memory.current", "990\n"),
            ("/sys/fs/cgroup/memory.stat", stat),
        ];
        assert_eq!(left(&container), Some(1000 - (990 - 850)));
        assert_eq!(left(&container[..3]), Some(10), "no more is known");
        let within = |inner: &'static str, outer: &'static str| {
            left(&[
                ("/proc/self/cgroup", "12:cpu:/x\n0::/a.slice/b.service\n"),
                ("/sys/fs/cgroup/a.slice/b.service/memory.max", inner),
                ("/sys/fs/cgroup/a.slice/b.service/memory.current", "300"),
                ("/sys/fs/cgroup/a.slice/memory.max", outer),
                ("/sys/fs/cgroup/a.slice/memory.current", "400"),
                ("/sys/fs/cgroup/a.slice/memory.stat", "inactive_file 900\n"),
            ])
        };
        assert_eq!(within("1000", "max"), Some(700));
        assert_eq!(within("max", "500"), Some(500), "more files than memory");
        assert_eq!(within("1000", "500"), Some(500));
        assert_eq!(within("max", "max"), None);
        assert_eq!(left(&[]), None);
    }

    #[test]
    fn what_is_left_is_told_only_where_it_is_known() {
        let told = |needed, left| MemoryError { what: "a table".into(), needed, left }.to_string();
        assert_eq!(told(None, None), "a table takes more memory than is left");
        assert_eq!(told(Some(2_000_000), None), "a table would take 2 MB of memory, which are not left");
        assert_eq!(told(None, Some(0)), "a table takes more memory than is left");
        let reserve = "a table would take 2 MB of memory; nothing is left beside a small reserve";
        assert_eq!(told(Some(2_000_000), Some(0)), reserve);
        assert_eq!(told(None, Some(3_000_000)), "a table takes more memory than the 3 MB that are left");
    }
}

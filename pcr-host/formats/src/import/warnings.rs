//! What there is to say about a file that is read: warnings about parts that were not read exactly as written, parts that could not be
//! read, and the options that had an effect on it.

use super::ImportError;
use crate::warning::WarningCode;
use std::collections::{HashMap, HashSet};
use std::fmt;

/// The length of an edge that is written differs from that of its geometry by more than [`DIFFERENCE`].
pub(super) const LENGTH: &str = "its length is not that of its geometry, which counts";

/// Difference of a written length that goes without a warning, relative.
pub(super) const DIFFERENCE: f64 = 0.01;

/// Names of one warning that are listed; the others are counted.
const LISTED: usize = 8;

/// A problem, and the names of what has it.
#[derive(Clone, Debug, PartialEq)]
struct WarningGroup {
    code: WarningCode,
    words: String,
    names: Vec<String>,
}

impl WarningGroup {
    fn key(&self) -> (WarningCode, String) {
        (self.code, self.words.clone())
    }
}

/// Something in a file that is not in what is read. (With `From`, the compiler could no longer infer errors of many closures.)
pub(crate) trait LostPart {
    /// Returns the error with which the file is refused for it.
    fn into_error(self) -> ImportError;
}

impl LostPart for ImportError {
    fn into_error(self) -> ImportError {
        self
    }
}

impl LostPart for fmt::Arguments<'_> {
    fn into_error(self) -> ImportError {
        ImportError::new(self.to_string())
    }
}

/// Warnings, each with the names of what it is about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Warnings {
    list: Vec<WarningGroup>,
    /// Places in the list by the code and the words.
    places: HashMap<(WarningCode, String), usize>,
    unread_parts: Vec<ImportError>,
    /// Fields of options that had an effect.
    used: HashSet<&'static str>,
}

impl Warnings {
    /// Adds a warning about the thing of this name. Warnings of the same words are told once, with all their names.
    pub(crate) fn add(&mut self, code: WarningCode, name: impl fmt::Display, problem: impl Into<String>) {
        let (name, key) = (name.to_string(), (code, problem.into()));
        match self.places.get(&key).and_then(|place| self.list.get_mut(*place)) {
            Some(problem) => problem.names.push(name),
            None => {
                self.places.insert(key.clone(), self.list.len());
                self.list.push(WarningGroup { code, words: key.1, names: vec![name] });
            }
        }
    }

    /// Adds a warning about something in the file that is not in what is read: the file is refused for it, unless the rest is
    /// asked for.
    pub(crate) fn lose(&mut self, part: impl LostPart) {
        let problem = part.into_error();
        self.add(WarningCode::LeftOut, problem.problem(), "left out");
        self.unread_parts.push(problem);
    }

    /// Notes that the option of this field had an effect.
    pub(crate) fn use_option(&mut self, field: &'static str) {
        self.used.insert(field);
    }

    /// Whether the option of this field had an effect.
    pub(super) fn has_used(&self, field: &str) -> bool {
        self.used.contains(field)
    }

    /// Settles the warnings of files that were read each by itself, and then together, with the warnings `all`: what an update releases
    /// is released, an update with its order is not alone, and what is said of all together, and of none by itself, is added to the last one.
    pub(crate) fn merge(files: &mut [&mut Self], all: &Self) {
        let names = |of: &Self, problem: &WarningGroup| -> HashSet<String> {
            let place = of.places.get(&problem.key()).and_then(|place| of.list.get(*place));
            place.map_or_else(HashSet::new, |problem| problem.names.iter().cloned().collect())
        };
        for file in files.iter_mut() {
            let by_others = |problem: &&mut WarningGroup| {
                [WarningCode::NotReleased, WarningCode::UpdateAlone].contains(&problem.code)
            };
            for problem in file.list.iter_mut().filter(by_others) {
                let still = names(all, problem);
                problem.names.retain(|name| still.contains(name));
            }
            file.list.retain(|problem| !problem.names.is_empty());
            file.places = file.list.iter().enumerate().map(|(place, problem)| (problem.key(), place)).collect();
        }
        let mut new = Vec::new();
        for problem in &all.list {
            let said: HashSet<String> = files.iter().flat_map(|file| names(file, problem)).collect();
            // Of other warnings the names may be others: messages are numbered in each file.
            let is_named = matches!(problem.code, WarningCode::NotReleased | WarningCode::SeveralLevels);
            let is_new = |name: &&String| said.is_empty() || is_named && !said.contains(*name);
            new.extend(problem.names.iter().filter(is_new).map(|name| (name, problem)));
        }
        if let Some(last) = files.last_mut() {
            new.into_iter().for_each(|(name, problem)| last.add(problem.code, name, problem.words.clone()));
        }
    }

    /// Parts of the file that were not read.
    pub(super) fn lost(&self) -> &[ImportError] {
        &self.unread_parts
    }

    /// Whether there is nothing to warn about.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The warnings: codes, problems, and the names of what has them, in the order in which they were found.
    pub fn iter(&self) -> impl Iterator<Item = (WarningCode, &str, &[String])> {
        self.list.iter().map(|problem| (problem.code, problem.words.as_str(), problem.names.as_slice()))
    }

    /// The lines in which they are told to people, who do not read hundreds of names, without their codes.
    pub fn lines(&self) -> Vec<String> {
        self.list.iter().map(|WarningGroup { words, names, .. }| format!("{}: {words}", listed(names, ", "))).collect()
    }

    /// The same lines with their codes.
    pub fn coded_lines(&self) -> Vec<String> {
        self.list.iter().zip(self.lines()).map(|(problem, line)| problem.code.text(line)).collect()
    }

    /// The lines in which programs get them, with all names and their codes.
    pub fn all(&self) -> Vec<String> {
        let text = |WarningGroup { code, words, names }: &WarningGroup| {
            code.text(format_args!("{}: {words}", names.join(", ")))
        };
        self.list.iter().map(text).collect()
    }

    /// Removes the warnings that the options acknowledge.
    pub fn acknowledge(&mut self, codes: &[WarningCode]) {
        self.list.retain(|problem| !codes.contains(&problem.code));
        self.places = self.list.iter().enumerate().map(|(place, problem)| (problem.key(), place)).collect();
    }
}

/// A warning of a scenario file as it is told to people, who do not read hundreds of names.
pub fn shortened(line: &str) -> String {
    /// Characters that are left at each end: names are at the begin, what is wrong with them at the end.
    const ENDS: usize = 150;
    let count = line.chars().count();
    if count <= 2 * ENDS {
        return line.to_owned();
    }
    let begin: String = line.chars().take(ENDS).collect();
    let end: String = line.chars().skip(count - ENDS).collect();
    format!("{begin} ... {end}")
}

/// The first names of a list, and how many more there are.
pub(super) fn listed(names: &[String], separator: &str) -> String {
    let listed = names.iter().take(LISTED).cloned().collect::<Vec<_>>().join(separator);
    match names.len().saturating_sub(LISTED) {
        0 => listed,
        more => format!("{listed} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_words_are_told_once() {
        let mut warnings = Warnings::default();
        for k in 0..10 {
            warnings.add(WarningCode::ZeroLength, format_args!("edge {k}"), "too short");
        }
        warnings.add(WarningCode::GivenTwice, "node 3", "given twice");
        let edges = (0..8).map(|k| format!("edge {k}")).collect::<Vec<_>>().join(", ");
        assert_eq!(warnings.lines(), [format!("{edges} and 2 more: too short"), "node 3: given twice".to_owned()]);
        let long = format!("{}: too short", vec!["edge"; 1000].join(", "));
        assert!(shortened(&long).len() < 320 && shortened(&long).ends_with(": too short"));
        assert_eq!(shortened("edge 1: too short"), "edge 1: too short");
        assert_eq!(warnings.all()[0], format!("{edges}, edge 8, edge 9: too short [zero-length]"));
        assert_eq!(warnings.coded_lines()[1], "node 3: given twice [given-twice]");
    }
}

//! Labels of agents: texts that people use in addition to numbers.

use super::{Agent, Scenario};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Longest label, in characters.
pub const LONGEST_LABEL: usize = 200;

/// The labels of the agents that have one, by their numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Labels(BTreeMap<u64, String>);

impl Labels {
    /// The labels of a scenario.
    pub fn from_scenario(scenario: &Scenario) -> Self {
        let labelled = scenario.agents.iter().filter(|agent| !agent.label.is_empty());
        Self(labelled.map(|agent| (agent.id, agent.label.clone())).collect())
    }

    /// Whether no agent has one.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The label of an agent; empty if it has none.
    pub fn get(&self, id: u64) -> &str {
        self.0.get(&id).map_or("", String::as_str)
    }

    /// The number of an agent and its label, as in `7 AGV-3`.
    pub fn display_name(&self, id: u64) -> String {
        display_name(id, self.get(id))
    }
}

impl Agent {
    /// Its number and its label, as in `7 AGV-3`.
    pub fn display_name(&self) -> String {
        display_name(self.id, &self.label)
    }
}

impl FromIterator<(u64, String)> for Labels {
    fn from_iter<I: IntoIterator<Item = (u64, String)>>(labels: I) -> Self {
        Self(labels.into_iter().filter(|(_, label)| !label.is_empty()).collect())
    }
}

/// A number with a label, if there is one.
pub(super) fn display_name(id: u64, label: &str) -> String {
    if label.is_empty() { id.to_string() } else { format!("{id} {label}") }
}

/// Whether a character would end a line, change the direction of text beside it, or not be seen: two labels would look the same.
/// (Joiners are letters of some scripts.)
pub fn controls(c: char) -> bool {
    let ranges = [
        '\u{200b}'..='\u{200b}',
        '\u{200e}'..='\u{200f}',
        '\u{2028}'..='\u{202e}',
        '\u{2060}'..='\u{2069}',
        '\u{feff}'..='\u{feff}',
        '\u{e0000}'..='\u{e007f}',
    ];
    c.is_control() || ranges.iter().any(|range| range.contains(&c))
}

/// Text from elsewhere, such as the name of a file, as it may be printed: what ends a line or moves the cursor is escaped.
pub fn printable(text: &str) -> String {
    let escaped = |c: char| if controls(c) { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(escaped).collect()
}

/// The reason why a text cannot be a label.
pub(super) fn fault(label: &str) -> Option<String> {
    if let Some(c) = label.chars().find(|&c| controls(c)) {
        return Some(format!("has the control character {}; allowed is printable text", c.escape_default()));
    }
    let length = label.chars().count();
    (length > LONGEST_LABEL).then(|| format!("has {length} characters; allowed are up to {LONGEST_LABEL}"))
}

/// Text from elsewhere as a label: without control characters, and not too long.
pub fn label(text: &str) -> String {
    text.chars().filter(|&c| !controls(c)).take(LONGEST_LABEL).collect()
}

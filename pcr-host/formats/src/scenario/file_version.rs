//! Versions of scenario files, and what there is from which of them on.

use super::json_fields::{DecodeLocation, ScenarioError};
use crate::json::JsonNode;

/// The first version.
pub(super) const VERSION: u64 = 1;
/// The version of files in which segments have gears.
pub(super) const GEARS: u64 = 2;
/// The version of files in which turns in place have no length.
pub(super) const TURNS: u64 = 3;
/// The version of files in which segments have other angles between heading and way than those of gears.
pub(super) const FACINGS: u64 = 4;

/// The version of files in which vehicles keep their heading on arcs.
pub(super) const STEADY: u64 = 5;

/// The versions that are read, for messages.
pub(super) const KNOWN_VERSIONS: &str = "1 to 5, all that this pcr knows,";

/// For each key that not all versions of files have, the error of its first use. A file may name its version after its agents, so that the
/// errors are kept until the version is known.
#[derive(Default)]
pub(super) struct VersionFaults {
    /// Of gears.
    pub(super) gear: Option<ScenarioError>,
    /// Of turns without a length.
    pub(super) turn: Option<ScenarioError>,
    /// Of other angles than those of gears.
    pub(super) facing: Option<ScenarioError>,
    /// Of arcs on which the heading is kept.
    pub(super) steady: Option<ScenarioError>,
    /// Of turns with a length.
    pub(super) long_turn: Option<ScenarioError>,
}

impl VersionFaults {
    /// Refuses what the version does not have. An agent before it may be refused for another reason.
    pub(super) fn check(&self, version: u64) -> Result<(), ScenarioError> {
        let gear = self.gear.as_ref().filter(|_| version < GEARS);
        let turn = self.turn.as_ref().filter(|_| version < TURNS);
        let facing = self.facing.as_ref().filter(|_| version < FACINGS);
        let steady = self.steady.as_ref().filter(|_| version < STEADY);
        let long_turn = self.long_turn.as_ref().filter(|_| version >= TURNS);
        gear.or(turn).or(facing).or(steady).or(long_turn).map_or(Ok(()), |fault| Err(fault.clone()))
    }

    /// Notes that something is there from version 3 on.
    pub(super) fn needs_turns(&mut self, place: DecodeLocation<'_>, json: &JsonNode<'_>, field: &str) {
        let problem = format!("it is there from version {TURNS} on; give \"version\": {TURNS}");
        self.turn.get_or_insert_with(|| place.error(json.position, field, problem));
    }
}

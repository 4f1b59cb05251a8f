//! Regions, pieces and conflicts in answers.

use super::{Refusal, short};
use crate::number::Number;
use pcr_core::{Encounter, Interval, Motion, PieceRef, RegionRef};
use serde::{Deserialize, Serialize};

/// A region in an answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct RegionRecord<S: Number> {
    /// Index of the agent whose region it is.
    pub ego: u16,
    /// Index of the agent it must keep clear of.
    pub other: u16,
    /// Time range \[s\].
    pub time: Interval<S>,
    /// Range of lengths along the ego's path \[m\].
    pub length: Interval<S>,
    /// Range of lengths along the other's path \[m\].
    pub other_length: Interval<S>,
    /// Whether the region begins while the other agent stands at its start.
    pub open_at_start: bool,
    /// Whether the region ends while the other agent stands at its end.
    pub open_at_end: bool,
    /// Number of its pieces; they follow.
    pub pieces: u16,
}

impl<S: Number> RegionRecord<S> {
    /// Makes a record of a region.
    pub fn of(region: &RegionRef<'_, S>) -> Self {
        Self {
            ego: short(region.ego()),
            other: short(region.other()),
            time: region.time(),
            length: region.length(),
            other_length: region.other_length(),
            open_at_start: region.is_open_at_start(),
            open_at_end: region.is_open_at_end(),
            pieces: region.pieces().fold(0, |count: u16, _| count.saturating_add(1)),
        }
    }
}

/// A piece of a region in an answer: a rectangle of lengths that contains all of its contacts. It does not say which of
/// two laps of an arc the piece belongs to, so slices, which may be less than the rectangle, cannot be computed from
/// it; `dump::table` prints everything.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct PieceRecord<S: Number> {
    /// Indices of the segments in the paths of the ego and of the other agent.
    pub segments: [u16; 2],
    /// Range of lengths along the ego's path \[m\].
    pub length: Interval<S>,
    /// Range of lengths along the other's path \[m\].
    pub other_length: Interval<S>,
}

impl<S: Number> PieceRecord<S> {
    /// Makes a record of a piece of a region.
    pub fn of(piece: &PieceRef<'_, S>) -> Self {
        Self { segments: piece.segments.map(short), length: piece.length, other_length: piece.other_length }
    }
}

/// The first conflict of two agents in an answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct ConflictRecord<S: Number> {
    /// The two agents, the lower index first.
    pub agents: [u16; 2],
    /// Interval of time in which their discs overlap \[s\].
    pub time: Interval<S>,
    /// Lengths along the path of each agent during the conflict \[m\].
    pub lengths: [Interval<S>; 2],
    /// Largest overlap \[m\].
    pub depth: S,
    /// Whether the two only touch.
    pub touching: bool,
}

impl<S: Number> ConflictRecord<S> {
    /// The first overlap of two agents of a fleet; the first touch if they do not overlap; `None` if they do not touch
    /// either.
    ///
    /// # Errors
    /// [`Refusal::NoSuchAgent`].
    pub fn first(fleet: &[Motion<'_, S>], agents: [usize; 2]) -> Result<Option<Self>, Refusal> {
        let motion = |agent| fleet.get(agent).ok_or(Refusal::NoSuchAgent { agent: short(agent) });
        let encounter = Encounter::new(motion(agents[0])?, motion(agents[1])?);
        let mut conflicts = encounter.conflicts(encounter.time());
        let Some(first) = conflicts.next() else { return Ok(None) };
        let overlap = if first.touching { conflicts.find(|conflict| !conflict.touching) } else { None };
        let conflict = overlap.unwrap_or(first);
        Ok(Some(Self {
            agents: agents.map(short),
            time: conflict.time,
            lengths: [conflict.length, conflict.other_length],
            depth: conflict.depth,
            touching: conflict.touching,
        }))
    }
}

//! What is certified, as plain numbers: `f64` holds those of every number format exactly.
//!
//! The numbers are those that the library holds, not those of a file that it has read: a checker that rounded them
//! itself would check another table.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// An angle as a format holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RawAngle {
    /// Radians.
    Radians(f64),
    /// Turns.
    Turns(f64),
}

/// A line or an arc of a path.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawSegment {
    /// Length \[m\].
    pub length: f64,
    /// Radius of an arc \[m\], positive where it turns left, negative where it turns right; none of a line, which a file has to say.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "Option::deserialize"))]
    pub radius: Option<f64>,
    /// By how much the agent turns in place before it, turn by turn.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub turns: Vec<RawAngle>,
    /// Length of the path before it, as the library has summed it up \[m\].
    pub from: f64,
    /// Length of the path up to its end, likewise \[m\].
    pub to: f64,
}

/// A path: where it starts, and its segments, each from the end of the one before in its direction.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawPath {
    /// Abscissa and ordinate of the start \[m\].
    pub start: [f64; 2],
    /// Direction at the start.
    pub heading: RawAngle,
    /// At least one.
    pub segments: Vec<RawSegment>,
    /// What a length along the path may be off by the rounding of sums \[m\].
    pub rounding: f64,
    /// What all lengths of a fixed-point format are multiples of \[m\]; 0 in floating point.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_zero"))]
    pub step: f64,
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "what serde asks for")]
fn is_zero(step: &f64) -> bool {
    *step == 0.0
}

/// Motion at constant acceleration through the times and lengths at both of its ends, with the speed at the slower one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawPhase {
    /// Times since the start of the motion \[s\].
    pub time: [f64; 2],
    /// Travelled lengths \[m\].
    pub length: [f64; 2],
    /// Speeds \[m/s\].
    pub speed: [f64; 2],
}

/// When an agent is where on its path.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawMotion {
    /// When it sets off \[s\].
    pub start: f64,
    /// Each begins where the one before ends; none if it never moves.
    pub phases: Vec<RawPhase>,
    /// What the travelled length at a time may be off by the rounding of times \[m\].
    pub lag: f64,
    /// By how much the end of a time range that is told may be too far out \[s\].
    pub time_excess: f64,
}

/// A disc on a path.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawAgent {
    /// Number, for messages. Agents with the same number are discs of one body.
    pub id: u64,
    /// Radius \[m\].
    pub radius: f64,
    /// Path.
    pub path: RawPath,
    /// Its motion; none where only the path counts.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub travel: Option<RawMotion>,
}

/// Which of the intervals that are covered of an arc at once a piece stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RawBranch {
    /// The only one; of two each that meets its lengths.
    Only,
    /// Of two the one at the start of the segment.
    Start,
    /// Of two the one at the end.
    End,
}

/// A part of a collision region: a rectangle of lengths along both paths, on one segment of each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawPiece {
    /// Places of the segments in their paths.
    pub segments: [usize; 2],
    /// From and to, along the path of the first and of the second agent \[m\].
    pub lengths: [[f64; 2]; 2],
    /// Share of what is covered of the segment of the first agent.
    pub share: RawBranch,
    /// Place of its region among those of the pair.
    pub region: usize,
}

/// What is told of a region: all that its pieces hold.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawRegion {
    /// From and to, along the path of the first and of the second agent \[m\].
    pub lengths: [[f64; 2]; 2],
    /// From when to when the first agent is at its lengths, and the second one at its own \[s\]; none where the agents have no motion.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "Option::deserialize"))]
    pub times: Option<[[f64; 2]; 2]>,
}

/// Two agents and the pieces of their regions.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawPair {
    /// Places of the agents, the first one first.
    pub agents: [usize; 2],
    /// By how much the radius of the regions may be too large: ε \[m\].
    pub excess: f64,
    /// Regions.
    pub regions: Vec<RawRegion>,
    /// Pieces of all regions, in no order.
    pub pieces: Vec<RawPiece>,
}

/// A table of collision regions: every two agents that are not discs of one body are a pair of it, or far apart.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawTable {
    /// The discs.
    pub agents: Vec<RawAgent>,
    /// The pairs.
    pub pairs: Vec<RawPair>,
    /// ε of those that are left out because their paths are far apart: they have no region \[m\]; none where nobody is left out.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub apart: Option<f64>,
}

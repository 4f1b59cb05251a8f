//! Scenario files: agents with their paths and motions, as JSON.
//!
//! ```
//! # use pcr_formats::scenario::Scenario;
//! let scenario = Scenario::from_json(r#"
//!     { "name": "crossing",
//!       "agents": [
//!         { "id": 1, "radius": 0.11, "v_max": 0.58, "a_max": 0.30, "t_start": 0.0,
//!           "start": { "x": 0.0, "y": 0.0, "heading": 0.0 },
//!           "path": [ { "kind": "line", "length": 2.0 },
//!                     { "kind": "arc", "radius": 1.1, "sweep": -1.2 } ] } ] }"#)?;
//! assert_eq!(scenario.agents[0].structure(), "SA");
//! # Ok::<(), pcr_formats::scenario::ScenarioError>(())
//! ```
//!
//! - Metres, seconds, radians. `sweep` is positive to the left and may be more than a turn. A segment starts in the
//!   pose in which the one before it ends; one of length 0 is skipped.
//! - `heading_deg`, `sweep_deg`, `turn_v_max_deg` and `turn_a_max_deg` are degrees instead of radians. A `heading` or `sweep` above one
//!   turn causes a warning, unless the file has `"angles": "radians"` beside `agents`.
//! - An empty path, or one of length 0, is an agent that stands at its start for the whole time.
//! - The motion is from rest to rest in the least time under `v_max` and `a_max`. Instead an agent may have
//!   `"profile": { "v0": 0.5, "pieces": [ { "duration": 2.0, "accel": 0.0 } ] }`: the speed at the start, then constant
//!   accelerations, never below speed 0. It has to travel the length of the path within [`LENGTH_TOLERANCE`] and is
//!   scaled onto it.
//! - `name` and `t_start` may be left out, and with a profile `v_max` and `a_max`. An unknown key is refused.
//! - `"footprint": { "polygon": [ { "ahead": 0.8, "left": 0.4 }, ... ] }` instead of `radius` is the outline of
//!   the vehicle around the point that travels the path; see [`Footprint`].
//! - `"loads": [ { "segments": [2, 3], "radius": 0.6 } ]`: another radius, or a `footprint`, from segment 2 to segment 3 (counted
//!   from 1): what the vehicle carries there.
//! - `{ "kind": "turn", "sweep": 1.57 }` in a path is a turn in place, before and after which the vehicle is at rest. With `v_max` and
//!   `a_max` it needs `turn_v_max` \[rad/s\] and `turn_a_max` \[rad/s²\]; a profile has pieces with `turn_accel` \[rad/s²\] instead of
//!   `accel` for it. `{ "kind": "kink", "sweep": 0.005 }` is passed without a stop. Files with them have `"version": 3`. Before, turns had a
//!   length of 1 nm for each radian in profiles; such files are read as they were meant.
//! - `"warnings": [ "..." ]` beside `agents` is what `pcr import` had to say about the file that the scenario is from.
//! - `"margin": 0.05` is a distance to be kept around the disc; 0 if left out.
//! - `"label": "AGV-7"` is what people call the agent. Ids may be texts, too, if all are: then the agents are numbered from 1 in the
//!   order of the file, and the texts are their labels.
//! - `"gear": "reverse"` in a line or arc: the vehicle drives backward. It comes to rest where the gear changes, and does not turn there. An
//!   arc turns it by `sweep`, whatever the gear. Files with it have `"version": 2`.
//! - `"facing": 1.57` instead of it is the angle from the direction of travel to the heading \[rad\], of vehicles that travel sideways. Files
//!   with it have `"version": 4`.
//! - `"format": "pcr-scenario"` and `"version": 1` are what files of the tool begin with; they may be left out.
//!
//! Whatever is out of range, missing, unknown, repeated or not finite is refused by a [`ScenarioError`] that names the
//! agent, the segment, the field, the value and what is allowed there. Hence the scenario is decoded by hand.

mod agent_name;
mod agent_parts;
mod angles;
mod decode;
mod encode;
mod facing;
mod file_version;
mod json_fields;
mod labels;
mod load_outline;
mod motion_spec;
mod old_turns;
mod outline;
mod path_decode;
mod placed_segment;
mod round_trip;
mod turns;

use crate::footprint::Footprint;
pub use agent_parts::{AgentPart, SegmentPhase};
pub use decode::LENGTH_TOLERANCE;
pub use json_fields::figure;
pub use json_fields::{LIMIT, ScenarioError};
pub use labels::{LONGEST_LABEL, Labels};
pub use labels::{controls, label, printable};
pub use load_outline::LoadOutline;
pub use motion_spec::{MotionPiece, MotionSpec};
pub(crate) use path_decode::MOST_SEGMENTS;
pub use placed_segment::{KINK, PlacedSegment};
pub use round_trip::speed_after;
use std::f64::consts::{PI, TAU};

#[cfg(test)]
mod tests;

/// A fleet as a file describes it. SI units, angles in radians.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scenario {
    /// Name, empty if the file gives none.
    pub name: String,
    /// The agents, in the order of the file.
    pub agents: Vec<Agent>,
    /// What was read otherwise than it was written, if it comes from a file of another format.
    pub warnings: Vec<String>,
}

/// One agent.
#[derive(Clone, Debug, PartialEq)]
pub struct Agent {
    /// Number, unique in its scenario.
    pub id: u64,
    /// What people call it: printable text, empty if the file gives none.
    pub label: String,
    /// Radius of the disc \[m\]; with a footprint that of the disc around all of it.
    pub radius: f64,
    /// Its outline, if it is no disc.
    pub footprint: Option<Footprint>,
    /// Other outlines on some of its segments, in their order.
    pub loads: Vec<LoadOutline>,
    /// Margin to be kept around the disc \[m\].
    pub margin: f64,
    /// When it sets off \[s\].
    pub t_start: f64,
    /// Abscissa \[m\], ordinate \[m\] and heading \[rad\] of the vehicle at the start of the path, which leads ahead unless it begins with
    /// [`PathSegment::Facing`].
    pub start: [f64; 3],
    /// The path.
    pub path: Vec<PathSegment>,
    /// How it moves along it.
    pub motion: MotionSpec,
}

/// A line, an arc, or what may be between them: a turn in place, a kink, or a change of the angle from the way to the heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathSegment {
    /// Straight, with its length \[m\].
    Line {
        /// \[m\]
        length: f64,
    },
    /// Circular.
    Arc {
        /// \[m\]
        radius: f64,
        /// \[rad\], left positive.
        sweep: f64,
        /// Whether the vehicle keeps its heading, the one at its start, although the direction of travel turns.
        steady: bool,
    },
    /// A turn in place, before and after which the vehicle is at rest. It has no length.
    Turn {
        /// \[rad\], left positive.
        sweep: f64,
    },
    /// A change of direction that the vehicle passes without a stop. It has no length and takes no time.
    Kink {
        /// \[rad\], left positive.
        sweep: f64,
    },
    /// A change of the angle from the direction of travel to the heading of the vehicle, which stands and keeps its heading: the way goes on
    /// in another direction. Where the gear changes, it is the opposite one. It has no length.
    Facing {
        /// \[rad\], left positive.
        before: f64,
        /// \[rad\], left positive; [`REVERSE`] in reverse gear.
        after: f64,
    },
}

/// The angle from the direction of travel to the heading in reverse gear \[rad\].
pub const REVERSE: f64 = -PI;

impl Scenario {
    /// A scenario without warnings.
    pub fn new(name: impl Into<String>, agents: Vec<Agent>) -> Self {
        Self { name: name.into(), agents, warnings: Vec::new() }
    }

    /// Gives this margin, from 0 \[m\], to every agent that has none.
    pub fn give_margin(&mut self, margin: f64) {
        for agent in self.agents.iter_mut().filter(|agent| agent.margin == 0.0) {
            agent.margin = margin;
        }
    }
}

impl PathSegment {
    /// An arc of this radius \[m\] and sweep \[rad\], left positive, on which the vehicle turns with the direction of travel.
    pub const fn arc(radius: f64, sweep: f64) -> Self {
        Self::Arc { radius, sweep, steady: false }
    }

    /// The angle from the direction of travel to the heading behind this segment, if it is `before` at its start \[rad\].
    pub fn facing_after(&self, before: f64) -> f64 {
        match *self {
            Self::Facing { after, .. } => after,
            Self::Arc { sweep, steady: true, .. } => {
                let after = before - sweep;
                if after.abs() <= PI { after } else { after - TAU * (after / TAU).round() }
            }
            _ => before,
        }
    }

    /// Length \[m\].
    pub fn length(&self) -> f64 {
        match *self {
            Self::Line { length } => length,
            Self::Arc { radius, sweep, .. } => radius * sweep.abs(),
            Self::Turn { .. } | Self::Kink { .. } | Self::Facing { .. } => 0.0,
        }
    }

    /// Parts of at most one turn each, equally long, that it is made of.
    pub fn turns(&self) -> f64 {
        /// A full turn may come in with the rounding of 2π to a dozen digits.
        const SHORTENED: f64 = 1.0 - 1e-12;
        match *self {
            Self::Line { .. } | Self::Facing { .. } => 1.0,
            Self::Arc { sweep, .. } | Self::Turn { sweep } | Self::Kink { sweep } => {
                (sweep.abs() / TAU * SHORTENED).ceil().max(1.0)
            }
        }
    }

    /// The angle by which it turns the direction of travel, left positive \[rad\].
    pub fn sweep(&self) -> f64 {
        match *self {
            Self::Arc { sweep, .. } | Self::Turn { sweep } | Self::Kink { sweep } => sweep,
            Self::Line { .. } | Self::Facing { .. } => 0.0,
        }
    }

    /// Whether the vehicle has to turn in place for it.
    pub fn takes_turning(&self) -> bool {
        matches!(self, Self::Turn { sweep } if *sweep != 0.0)
    }

    /// Letter of the paper's path structure; it has none for turns and what keeps the heading.
    pub fn letter(&self) -> char {
        match self {
            Self::Line { .. } => 'S',
            Self::Arc { .. } => 'A',
            Self::Turn { .. } | Self::Kink { .. } => 'T',
            Self::Facing { .. } => 'C',
        }
    }
}

impl Agent {
    /// A disc of this radius \[m\] without a margin that sets off at the time 0; `start` is abscissa \[m\], ordinate \[m\], heading
    /// \[rad\].
    pub fn disc(id: u64, radius: f64, start: [f64; 3], path: Vec<PathSegment>, motion: MotionSpec) -> Self {
        let (label, footprint, loads) = (String::new(), None, Vec::new());
        Self { id, label, radius, footprint, loads, margin: 0.0, t_start: 0.0, start, path, motion }
    }

    /// Length of the path \[m\].
    pub fn length(&self) -> f64 {
        // A sum of nothing is -0.
        self.path.iter().map(PathSegment::length).sum::<f64>() + 0.0
    }

    /// From setting off to arrival \[s\].
    pub fn duration(&self) -> f64 {
        match &self.motion {
            MotionSpec::RestToRest { v_max, a_max } => {
                let length = self.length();
                let peak = v_max.min((length * a_max).sqrt());
                if length > 0.0 { length / peak + peak / a_max } else { 0.0 }
            }
            MotionSpec::Profile { pieces, .. } => pieces.iter().map(|piece| piece.duration).sum(),
        }
    }

    /// The paper's path structure: a letter a segment.
    pub fn structure(&self) -> String {
        self.path.iter().map(PathSegment::letter).collect()
    }
}

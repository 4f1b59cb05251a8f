//! Outlines and bodies as plain numbers, exactly as a format holds them. Nothing here is checked; [`super::body`] does that.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::raw::{RawAngle, RawMotion, RawRegion};

/// The largest number of corners of an outline.
pub const CORNERS: usize = 16;

/// A convex polygon that is rounded by a radius.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawOutline {
    /// Corners, counter-clockwise, from the reference point \[m\]: ahead and to the left of a body with the heading 0. A single one
    /// makes a disc, two make a capsule.
    pub corners: Vec<[f64; 2]>,
    /// Radius by which the polygon is enlarged \[m\].
    pub radius: f64,
}

/// Where the reference point goes on a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RawCourse {
    /// Straight on.
    Line,
    /// Along an arc.
    Arc {
        /// Radius \[m\], positive where the arc turns left, negative where it turns right.
        radius: f64,
    },
    /// Nowhere: the body turns in place.
    Pivot {
        /// Length for each radian \[m\], positive where the body turns left, negative where it turns right.
        lever: f64,
    },
}

/// Where a body looks while it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum RawHeading {
    /// At a constant angle to the direction of the path: 0 ahead, half a turn in reverse gear.
    Along(RawAngle),
    /// In a constant direction of the plane.
    Steady(RawAngle),
}

/// A segment of the path of a body.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawBodySegment {
    /// Where the reference point goes.
    pub course: RawCourse,
    /// Length \[m\].
    pub length: f64,
    /// By how much the direction of the path turns before it, turn by turn. The body does not turn: its heading has to go on.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub turns: Vec<RawAngle>,
    /// Where the body looks.
    pub heading: RawHeading,
    /// Length of the path before the segment, as the library has summed it up \[m\].
    pub from: f64,
    /// Length of the path up to its end, likewise \[m\].
    pub to: f64,
}

/// A body with its path, and its motion if it has one.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawBody {
    /// Number, for messages.
    pub id: u64,
    /// Outline.
    pub outline: RawOutline,
    /// Abscissa and ordinate of the reference point at the start \[m\].
    pub start: [f64; 2],
    /// Direction of the path at the start.
    pub direction: RawAngle,
    /// At least one.
    pub segments: Vec<RawBodySegment>,
    /// What a length along the path may be off by the rounding of sums \[m\].
    pub rounding: f64,
    /// What the heading may jump by where two segments meet, by the rounding of angles \[rad\].
    pub jump: f64,
    /// What all lengths of a fixed-point format are multiples of \[m\]; 0 in floating point.
    pub step: f64,
    /// Motion; none where only the path counts.
    pub travel: Option<RawMotion>,
}

/// A part of a collision region of two bodies: a rectangle of lengths along both paths, on one segment of each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawOutlinePiece {
    /// Places of the segments in their paths.
    pub segments: [usize; 2],
    /// From and to, along the path of the first and of the second body \[m\].
    pub lengths: [[f64; 2]; 2],
    /// k and n: of the n intervals that are covered of the segment of the first body at once, in order, the k-th one, from 0.
    pub rank: [u8; 2],
    /// Place of its region among those of the pair.
    pub region: usize,
}

/// Two bodies and the pieces of their regions.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawOutlinePair {
    /// Places of the bodies, the first one first.
    pub bodies: [usize; 2],
    /// By how much the radius of the regions may be too large: ε \[m\].
    pub excess: f64,
    /// Regions.
    pub regions: Vec<RawRegion>,
    /// Pieces of all regions, in no order.
    pub pieces: Vec<RawOutlinePiece>,
}

/// A table of collision regions of bodies: every two with different numbers are a pair of it, or far apart.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct RawOutlineTable {
    /// The bodies. Discs among them have a single corner, at their reference point.
    pub bodies: Vec<RawBody>,
    /// The pairs.
    pub pairs: Vec<RawOutlinePair>,
    /// ε of those that are left out because their paths are far apart \[m\]; none where nobody is left out.
    pub apart: Option<f64>,
}

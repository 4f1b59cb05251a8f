//! Convex outlines, rounded by a radius, on lines, arcs and turns in place: proofs of their regions and of their motions.
//!
//! ```text
//! data         what is read: outlines, bodies                    plain numbers
//! body         corners, speeds and levers on each segment
//! separation   bounds on the distance of two polygons            Taylor, levers, witnesses
//! cover        all contacts are in rectangles, and nothing else
//! motion       no contact in an interval of time, a contact at a time
//! delays       no contact with any start delay of an interval
//! ranks        a piece stands for the interval that holds its contacts
//! table        all pairs, segments and regions
//! ```
//!
//! Two bodies are in contact where the distance of their polygons is at most R, the sum of both radii. Everything is derived from the
//! corners; nothing is shared with what has computed a table.
//!
//! ```
//! use pcr_certify::raw::RawAngle;
//! use pcr_certify::outline::table::Checker;
//! use pcr_certify::outline::{RawBody, RawCourse, RawHeading, RawOutline, RawOutlinePair, RawBodySegment, RawOutlineTable};
//! use pcr_certify::table::CoverageMargin;
//!
//! // Two trucks of 1.2 by 0.8 m on parallel lanes, and a table that says that they never touch.
//! let truck = |id, y, turns| RawBody {
//!     id,
//!     outline: RawOutline { corners: vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]], radius: 0.0 },
//!     start: [6.0 * turns * 2.0, y],
//!     direction: RawAngle::Turns(turns),
//!     segments: vec![RawBodySegment {
//!         course: RawCourse::Line,
//!         length: 6.0,
//!         turns: vec![],
//!         heading: RawHeading::Along(RawAngle::Turns(0.0)),
//!         from: 0.0,
//!         to: 6.0,
//!     }],
//!     rounding: 0.0,
//!     jump: 0.0,
//!     step: 0.0,
//!     travel: None,
//! };
//! let verdict = |lane: f64| {
//!     let bodies = vec![truck(1, 0.0, 0.0), truck(2, lane, 0.5)];
//!     let pairs = vec![RawOutlinePair { bodies: [0, 1], excess: 1e-9, regions: vec![], pieces: vec![] }];
//!     let table = RawOutlineTable { bodies, pairs, apart: None };
//!     Checker::new(&table)?.check(CoverageMargin::Needed)
//! };
//! let passing = verdict(0.801)?;
//! assert!(passing.findings.refuted.is_empty() && passing.findings.undecided.is_empty());
//! assert_eq!(verdict(0.799)?.findings.refuted.len(), 1); // they touch
//! # Ok::<(), pcr_certify::error::CertifyError>(())
//! ```

pub mod body;
pub mod cover;
pub mod data;
pub mod delays;
pub mod motion;
pub mod ranks;
pub mod separation;
pub mod table;

pub use body::Body;
pub use data::{
    RawBody, RawBodySegment, RawCourse, RawHeading, RawOutline, RawOutlinePair, RawOutlinePiece, RawOutlineTable,
};

#[cfg(test)]
mod tests;

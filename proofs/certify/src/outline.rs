//! Convex outlines, rounded by a radius, on lines, arcs and turns in place: proofs of their regions and of their motions.
//!
//! ```text
//! data         what is read: outlines, bodies                    plain numbers
//! body         corners, speeds and levers on each segment
//! separation   bounds on the distance of two polygons            Taylor, levers, witnesses
//! cover        all contacts are in rectangles, and nothing else
//! motion       no contact in an interval of time, a contact at a time
//! ranks        a piece stands for the interval that holds its contacts
//! table        all pairs, segments and regions
//! ```
//!
//! Two bodies are in contact where the distance of their polygons is at most R, the sum of both radii. Everything is derived from the
//! corners; nothing is shared with what has computed a table.

pub mod body;
pub mod cover;
pub mod data;
pub mod motion;
pub mod ranks;
pub mod separation;
pub mod table;

pub use body::Body;
pub use data::{RawBody, RawCourse, RawHeading, RawOutline, RawPair, RawPiece, RawSegment, RawTable};

#[cfg(test)]
mod tests;

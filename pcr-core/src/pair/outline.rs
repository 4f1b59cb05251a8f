//! Outlines in coordination space: the kernels for a pair of agents of which at least one is not a disc.
//!
//! ```text
//! distance  signed distance of two placed polygons
//! contacts  where one moving outline touches one that stands: vertex-edge, edge-vertex and vertex-vertex
//! slice     which lengths of a segment a standing outline covers Parts
//! events    where slices can change their structure, and where they are extreme
//! walk      from events to pieces
//! lines     the piece of two outlines on lines
//! part      what a piece covers
//! shadow    where on the second segment some of the first is covered
//! ```
//!
//! `docs/theory/outlines.md` has the definitions and proofs; comments name its lemmas and theorems.

pub(crate) mod contacts;
pub(crate) mod distance;
pub(crate) mod events;
mod lines;
pub(crate) mod part;
pub(crate) mod shadow;
pub(crate) mod slice;
pub(crate) mod walk;

#[cfg(all(test, feature = "libm", feature = "outlines"))]
mod tests;

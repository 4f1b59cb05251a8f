//! What the tests of pcr share: cases, generators of cases that aim at degeneracies, and an oracle that knows nothing
//! but the definition of a collision region.

pub mod adversary;
pub mod arguments;
pub mod audit;
pub mod case_ranges;
pub mod certified;
pub mod certified_outlines;
pub mod clearance;
pub mod closed_loop;
pub mod constants;
pub mod delays;
pub mod disc;
pub mod ends;
pub mod exact;
pub mod execution;
pub mod generators;
pub mod limits;
pub mod neighbour;
pub mod oracle;
pub mod outward;
pub mod paper;
pub mod plans;
pub mod polygons;
pub mod reference;
pub mod rules;
pub mod search;
pub mod settings;
pub mod shadow;
pub mod velocity;
pub mod written;

/// The programs of the guide for Rust run.
#[cfg(doctest)]
#[doc = include_str!("../../docs/guide/rust.md")]
pub struct RustGuide;

/// The example of the core's package runs.
#[cfg(doctest)]
#[doc = include_str!("../../pcr-core/README.md")]
pub struct Core;

//! An independent checker of collision regions: proves of one table that no contact is missing, or shows one; proves of motions that
//! discs never touch, or shows when they do.
//!
//! It depends on nothing, and shares no geometry with what has computed a table. It looks at distances between parts of lines and arcs
//! only, each bounded in closed form, and cuts parts in half where the bounds do not tell: nothing is sampled. Every number carries
//! the bound on its error, so that no count of roundings has to be believed.
//!
//! ```text
//! double_double      106 bits
//! ball               numbers with a bound on their error, of 53 or 106 bits; answers that may be a doubt
//! plane              lines and arcs, parts of them, distances from a point      bounds of lemma 3
//! distance_claim     all of a part farther than, or within, so much of another  lemmas 3 and 5
//! error              why what is read is refused
//! raw                what is read: paths, motions, pieces
//! device_dump        the same from the text that a microcontroller prints
//! path               segments in the plane
//! pair               the pieces of two segments, and what is found
//! branches           one of two intervals: C-share                              lemma 4
//! segments           all contacts held, and nothing else: C-rect and C4         lemma 2
//! arc_length_motion  the travelled length over time, as the phases say
//! regions            what is told of all pieces together: lengths and times     lemma 7
//! table              all pairs; the margin
//! moving_disc        an agent in the plane over time                            lemma 8
//! motion             discs that never touch
//! delays             start delays with which two discs never touch
//! outline            the same questions about convex, rounded outlines
//! ```
//!
//! Why that proves what it says is in `docs/theory/certificates.md` of the repository, with the lemmas by these numbers.
//!
//! ```
//! use pcr_certify::raw::{RawAgent, RawAngle, RawPair, RawPath, RawPiece, RawRegion, RawSegment, RawBranch, RawTable};
//! use pcr_certify::table::{Checker, CoverageMargin};
//!
//! // Two lines that cross at right angles, discs of 0.25 m: contact wherever l² + s² <= 0.5², from the crossing.
//! let line = |id, start, heading| RawAgent {
//!     id,
//!     radius: 0.25,
//!     path: RawPath {
//!         start,
//!         heading: RawAngle::Turns(heading),
//!         segments: vec![RawSegment { length: 2.0, radius: None, turns: vec![], from: 0.0, to: 2.0 }],
//!         rounding: 0.0,
//!         step: 0.0,
//!     },
//!     travel: None,
//! };
//! let agents = vec![line(1, [-1.0, 0.0], 0.0), line(2, [0.0, -1.0], 0.25)];
//! let verdict = |reach: f64| {
//!     let lengths = [[1.0 - reach, 1.0 + reach]; 2];
//!     let pieces = vec![RawPiece { segments: [0, 0], lengths, share: RawBranch::Only, region: 0 }];
//!     let regions = vec![RawRegion { lengths, times: None }];
//!     let pairs = vec![RawPair { agents: [0, 1], excess: 1e-3, regions, pieces }];
//!     let table = RawTable { agents: agents.clone(), pairs, apart: None };
//!     Checker::new(&table)?.check(CoverageMargin::Needed)
//! };
//! let proved = verdict(0.5005)?;
//! assert!(proved.refuted.is_empty() && proved.undecided.is_empty());
//! let short = verdict(0.499)?;
//! assert!(short.refuted[0].clearance < 0.0); // a contact outside of the piece
//! let long = verdict(0.502)?;
//! assert!(long.refuted[0].clearance > 1e-3); // told, but farther than ε from any contact
//! # Ok::<(), pcr_certify::error::CertifyError>(())
//! ```
#![forbid(unsafe_code)]

pub mod arc_length_motion;
pub mod ball;
mod box_index;
pub mod branches;
pub mod delays;
pub mod device_dump;
#[cfg(test)]
mod dice;
pub mod distance_claim;
pub mod double_double;
pub mod error;
pub mod motion;
pub mod moving_disc;
pub mod outline;
pub mod pair;
pub mod path;
pub mod plane;
pub mod raw;
mod regions;
pub mod segments;
pub mod table;

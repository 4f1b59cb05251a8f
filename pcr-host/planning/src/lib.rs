//! Everything that the tool computes for a scenario: regions, conflicts, plans, locks, and their output as text.
//!
//! ```text
//! fleet        paths and motions in a number format                Fleet, build_ecm
//! bodies       agents with footprints as discs                     Bodies
//! failure      why there is no answer                              Failure
//! certificate  tables as plain numbers for the checker
//! certify      proofs by the checker                               Certified, Proof
//! regions      regions as plain numbers, and their JSON            Answer, Request
//! rows         regions of fleets of any size, an agent at a time   Row, Grid
//! check        the conflicts of the given motions                  Verdict
//! locks        which edges of a layout exclude one another         Locks
//! memory       refuses what does not fit into memory               TooLarge
//! checksum     checksums of files that are read in parts
//! cores        work on all cores
//! nodes        nodes and edges of a layout                         Listing
//! plan         delays without conflicts                            Plan
//! queue        the conflicts of a fleet while its motions change   Queue
//! safe         when a part of a path is free, in large fleets     safe_intervals
//! report       JSON, CSV and tables
//! figures      numbers as text
//! ```

pub mod agent_regions;
pub mod certify;
pub mod check;
pub mod checker_input;
pub mod checksum;
pub mod conflict_queue;
pub mod disc_fleet;
pub mod exclusion_table;
pub mod failure;
pub mod figures;
pub mod fleet;
pub mod memory_budget;
pub mod nodes;
#[cfg(test)]
mod outline_judge;
mod parallel;
pub mod plan;
pub mod regions;
pub mod report;
pub mod safe_windows;

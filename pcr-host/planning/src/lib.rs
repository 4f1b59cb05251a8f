//! Everything that the tool computes for a scenario: regions, conflicts, plans, locks, and their output as text.
//!
//! ```text
//! fleet             paths and motions in a number format                Fleet, build_ecm
//! bodies            agents as convex bodies that move together            BodyFleet, Body
//! failure           why there is no answer                              ComputationError
//! checker_input     tables as plain numbers for the checker
//! certify           proofs by the checker                               CertifyReport, CertificateTable
//! regions           regions as plain numbers, and their JSON            RegionsReport, RegionOptions
//! agent_regions     regions of fleets of any size, an agent at a time   AgentRegions, BoxGrid
//! check             the conflicts of the given motions                  CheckReport
//! approaches        who came how near to whom, by poses at times       ApproachReport
//! exclusion_table   which edges of a layout exclude one another         ExclusionTable
//! memory_budget     refuses what does not fit into memory               MemoryDemand, MemoryBudget
//! checksum          checksums of files that are read in parts
//! parallel          work on all cores
//! nodes             nodes and edges of a layout
//! plan              delays and speeds without conflicts                 PlanReport
//! safe_windows      when a part of a path is free, in large fleets      safe_intervals
//! report            JSON, CSV and tables
//! figures           numbers as text
//! ```

pub mod agent_regions;
pub mod approaches;
pub mod bodies;
pub mod certify;
pub mod check;
pub mod checker_input;
pub mod checksum;

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

//! What a desktop computes for a scenario: regions, conflicts, plans, locks, traffic, simulations, and their text.
//!
//! ```text
//! fleet        its paths and motions in a number format              Fleet, build_ecm
//! bodies       agents with footprints as discs                       Bodies
//! certificate  tables as plain numbers for the checker
//! certify      what the checker proves of them                       Certified, Proof
//! regions      the answer as plain numbers, and its JSON             Answer, Request
//! rows         regions of fleets of any size, an agent at a time     Row, Grid
//! check        the conflicts of the motions as given                 Verdict
//! locks        which edges of a layout exclude one another           Locks
//! memory       what cannot be held is refused                        TooLarge
//! checksum     of files that are read in parts
//! nodes        what a layout holds                                   Listing
//! plan         delays without conflicts                              Plan
//! queue        the conflicts of a fleet whose motions change         Queue
//! traffic      random missions on a layout, and their plan           Traffic
//! execution    plans of others carried out while robots are late   Execution
//! lifelong     robots that get a new mission whenever one is done    run, Outcome
//! simulate     plans in closed loop, with noise and delays           run, Task
//! report       JSON, CSV and tables
//! random       the same numbers on every machine
//! ```

pub mod bodies;
pub mod certificate;
pub mod certify;
pub mod check;
pub mod checksum;
pub mod execution;
pub mod fleet;
pub mod lifelong;
pub mod locks;
pub mod memory;
pub mod nodes;
pub mod plan;
pub mod queue;
pub mod random;
pub mod regions;
pub mod report;
pub mod rows;
pub mod simulate;
pub mod traffic;

//! Fleets that run: plans that robots carry out, and missions that never end.
//!
//! ```text
//! traffic     random missions on a layout, and their plan          Traffic
//! missions    missions of a file, and what became of them        MissionsReport
//! lifelong    robots that get a new mission after each one         run, Outcome
//! simulate    plans in closed loop, with noise and delays          run, Task
//! report      their results as JSON, CSV and tables
//! ```

mod error;
pub mod lifelong;
pub mod missions;
pub mod report;
pub mod simulate;
pub mod traffic;

pub use error::{DrivenError, ExecutionError};

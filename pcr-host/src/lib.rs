//! The tool `pcr` on a desktop: scenario files in, collision regions, tables and pictures out.
//!
//! ```text
//! scenario   what a file says, and everything that is refused     Scenario, Agent
//! fleet      its paths and motions in a number format             Fleet, build_ecm
//! regions    the answer as plain numbers, and its JSON            Answer, Request
//! report     JSON, CSV and tables
//! input      files and JSON Lines, errors with their places
//! picture    SVG, PNG and a page for the browser                  write
//! paper      the embedded scenario and the paper's numbers
//! progress   a line on the terminal about long work
//! ```

pub mod fleet;
pub mod input;
mod json;
pub mod paper;
pub mod picture;
pub mod progress;
pub mod regions;
pub mod report;
pub mod scenario;

//! The tool `pcr` on a desktop: scenario files in, collision regions, tables and pictures out.
//!
//! ```text
//! scenario   what a file says, and everything that is refused     Scenario, Agent
//! fleet      its paths and motions in a number format             Fleet, build_ecm
//! footprint  outlines that are no discs, covered by discs             Footprint
//! regions    the answer as plain numbers, and its JSON            Answer, Request
//! rows       regions of fleets of any size, an agent at a time       Row, Grid
//! check      the conflicts of the motions as given              Verdict
//! locks      which edges of a layout exclude one another        Locks
//! nodes      what a layout holds                                Listing
//! plan       delays without conflicts                           Plan
//! traffic    random missions on a layout, and their plan             Traffic
//! simulate   plans in closed loop, with noise and delays        run, Task
//! compare    other methods beside this one                        Comparison
//! evaluate   the paper's evaluation and more, as a document
//! report     JSON, CSV and tables
//! input      files and JSON Lines, errors with their places
//! output     files that are written whole or not at all
//! import     layouts, orders and plans in the formats of others Format, Layout
//! picture    SVG, PNG and a page for the browser                  write
//! paper      the embedded scenario and the paper's numbers
//! random     the same numbers on every machine
//! progress   a line on the terminal about long work
//! ```

pub mod certificate;
pub mod certify;
pub mod check;
pub mod compare;
pub mod evaluate;
pub mod exclusion;
pub mod fleet;
pub mod footprint;
pub mod import;
pub mod input;
mod json;
pub mod lifelong;
pub mod locks;
pub mod nodes;
pub mod output;
pub mod paper;
pub mod picture;
pub mod plan;
pub mod progress;
mod random;
pub mod regions;
pub mod report;
pub mod rows;
pub mod scenario;
pub mod simulate;
pub mod traffic;

//! What the tool `pcr` reads and writes: scenarios, layouts, orders and plans in the formats of others.
//!
//! ```text
//! scenario   what a file says, and everything that is refused     Scenario, Agent
//! footprint  outlines that are no discs, covered by discs         Footprint
//! import     layouts, orders and plans in the formats of others   Format, Layout
//! input      files and JSON Lines, errors with their places
//! output     files that are written whole or not at all
//! paper      the embedded scenario and the paper's numbers
//! ```

pub mod footprint;
pub mod import;
pub mod input;
mod json;
pub mod output;
pub mod paper;
pub mod scenario;

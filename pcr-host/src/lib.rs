//! The tool `pcr` on a desktop: scenario files in, collision regions, tables and pictures out.

pub mod fleet;
pub mod scenario;

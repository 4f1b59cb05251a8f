//! x
pub mod fleet;
pub mod scenario;

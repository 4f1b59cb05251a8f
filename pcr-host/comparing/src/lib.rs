//! Compares the library with other methods.
//!
//! ```text
//! compare   this library and other methods                Comparison
//! report    comparisons as JSON, CSV and tables
//! ```

pub mod compare;
pub mod report;

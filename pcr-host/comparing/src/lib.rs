//! The library beside other methods, and the paper's evaluation.
//!
//! ```text
//! compare   other methods beside this one                  Comparison
//! report    comparisons as JSON, CSV and tables
//! evaluate  the paper's evaluation and more, as a document
//! ```

pub mod compare;
pub mod evaluate;
pub mod report;

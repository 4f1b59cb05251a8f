//! Compares the library with other methods, and runs the paper's evaluation.
//!
//! ```text
//! compare   this library and other methods                Comparison
//! report    comparisons as JSON, CSV and tables
//! roadmap   roadmaps with tasks of others
//! evaluate  the paper's evaluation and more, as a document (feature `peers`)
//! ```

pub mod compare;
#[cfg(feature = "peers")]
pub mod evaluate;
pub mod report;
pub mod roadmap;

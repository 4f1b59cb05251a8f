//! The evaluation of pcr: methods of other libraries beside this one, plans and roadmaps of others, and the paper's evaluation as a
//! document. Nothing of the product depends on it.
//!
//! ```text
//! error       why something of others is not read or not carried out
//! methods     methods of other libraries for `compare`
//! roadmap     roadmaps with tasks of others
//! grid_plans  plans on grids, carried out by robots that are late  Outcome
//! evaluate    the paper's evaluation and more, as a document
//! ```

pub mod error;
pub mod evaluate;
pub mod grid_plans;
pub mod methods;
pub mod roadmap;

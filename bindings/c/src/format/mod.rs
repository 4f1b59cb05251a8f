//! The interface in one number format: this folder is compiled once for each, and the formats are in the files that name it.

mod fleet;
mod orders;
mod plans;
mod points;
mod table;
mod types;

use super::number;

pub use orders::*;
pub use plans::*;
pub use table::*;
pub use types::*;

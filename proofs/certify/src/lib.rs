//! An independent checker of collision regions.
#![forbid(unsafe_code)]

pub mod ball;
pub mod cell;
pub mod data;
pub mod motion;
pub mod pair;
pub mod path;
pub mod plane;
pub mod shares;
pub mod table;
pub mod twofold;

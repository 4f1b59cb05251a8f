#![doc = include_str!("../README.md")]

mod dependencies;
mod error;
mod motion;
mod trajectory;

pub use dependencies::{Dependencies, Dependency};
pub use error::Error;
pub use trajectory::{Footprint, TimedPose, Trajectory};

#![doc = include_str!("../README.md")]

mod dependencies;
mod error;
mod motion;
#[cfg(feature = "mapf")]
mod planned;
mod trajectory;

pub use dependencies::{Dependencies, Dependency};
pub use error::Error;
pub use motion::OwnedMotion;
pub use trajectory::{Footprint, TimedPose, Trajectory};

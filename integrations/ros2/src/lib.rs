#![doc = include_str!("../README.md")]

mod answer;
mod config;
mod markers;
pub mod messages;
pub mod node;
mod order;
mod planned_path;
mod refusal;
pub mod report;
mod robot_motion;
mod watch;

pub use answer::Answer;
pub use config::{Config, ConfigError, Pace, RobotConfig};
pub use planned_path::{PlannedPath, PlannedPose};
pub use refusal::Refusal;
pub use watch::Watch;

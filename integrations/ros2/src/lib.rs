#![doc = include_str!("../README.md")]

mod answer;
mod closures;
mod config;
mod connections;
mod edge_requests;
mod markers;
pub mod messages;
pub mod node;
mod order;
mod planned_path;
mod refusal;
pub mod report;
mod robot_motion;
mod route_graph;
mod route_servers;
mod watch;

pub use answer::Answer;
pub use closures::Closures;
pub use config::{Config, ConfigError, Pace, RobotConfig, RouteGraphConfig};
pub use edge_requests::EdgeRequests;
pub use planned_path::{PlannedPath, PlannedPose};
pub use refusal::Refusal;
pub use route_graph::{GraphError, RouteGraph};
pub use watch::Watch;

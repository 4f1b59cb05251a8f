//! `pcr-ros2 CONFIGURATION.json`: conflicts and authorities of robots whose paths are published in ROS 2.

use pcr_ros2::{Config, RouteGraph, node::PcrNode};
use ros2_client::ServiceMapping;
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "pcr-ros2 CONFIGURATION.json
Watches the paths of robots, and publishes /pcr/conflicts, /pcr/authorities and /pcr/markers.
With a route graph, closes edges through the route servers of robots.
The domain is that of the variable ROS_DOMAIN_ID, 0 without it; RMW_IMPLEMENTATION says
how the route servers talk: rmw_fastrtps_cpp, also without it, or rmw_cyclonedds_cpp.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [path] = &arguments[..] else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    if path == "--help" || path == "-h" {
        println!("{USAGE}");
        return ExitCode::SUCCESS;
    }
    match run(path) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("pcr-ros2: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(path: &str) -> Result<(), Box<dyn Error>> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let config = Config::from_json(&text).map_err(|error| format!("{path}: {error}"))?;
    let domain = match std::env::var("ROS_DOMAIN_ID") {
        Ok(text) => text.parse().map_err(|_| format!("ROS_DOMAIN_ID: \"{text}\" is not a domain"))?,
        Err(_) => 0,
    };
    let graph = match &config.route_graph {
        Some(graph) => {
            let file = Path::new(path).with_file_name("").join(&graph.file);
            let problem = |error: &dyn Error| format!("{}: {error}", file.display());
            let text = std::fs::read_to_string(&file).map_err(|error| problem(&error))?;
            Some(RouteGraph::read(&text, &config.frame).map_err(|error| problem(&error))?)
        }
        None => None,
    };
    // Without route servers there are no requests.
    let mapping = if graph.is_some() { mapping()? } else { ServiceMapping::Enhanced };
    PcrNode::new(config, graph, domain, mapping)?.run()
}

/// How the middleware tells to which request an answer belongs.
fn mapping() -> Result<ServiceMapping, String> {
    match std::env::var("RMW_IMPLEMENTATION").as_deref() {
        Err(_) | Ok("" | "rmw_fastrtps_cpp" | "rmw_fastrtps_dynamic_cpp") => Ok(ServiceMapping::Enhanced),
        Ok("rmw_cyclonedds_cpp") => Ok(ServiceMapping::Cyclone),
        Ok(other) => Err(format!("RMW_IMPLEMENTATION: how \"{other}\" answers requests is not known here")),
    }
}

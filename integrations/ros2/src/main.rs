//! `pcr-ros2 CONFIGURATION.json`: conflicts and authorities of robots whose paths are published in ROS 2.

use pcr_ros2::{Config, node::PcrNode};
use std::error::Error;
use std::process::ExitCode;

const USAGE: &str = "pcr-ros2 CONFIGURATION.json
Watches the paths of robots, and publishes /pcr/conflicts, /pcr/authorities and /pcr/markers.
The domain is that of the variable ROS_DOMAIN_ID, 0 without it.";

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
    PcrNode::new(config, domain)?.run()
}

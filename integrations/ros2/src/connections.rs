//! How topics and services are named, and how reliable they are.

use ros2_client::qos::{History, WhenFull};
use ros2_client::{Name, QosProfile};
use std::error::Error;

pub(crate) fn name(of: &str) -> Result<Name, Box<dyn Error>> {
    // Those of a configuration are absolute, with or without the slash.
    Name::parse(&format!("/{}", of.trim_start_matches('/'))).map_err(|error| format!("name \"{of}\": {error:?}").into())
}

/// Paths, what is published, and services are reliable.
pub(crate) fn reliable(depth: usize) -> QosProfile {
    QosProfile::publisher_default().reliability_reliable(WhenFull::DEFAULT).history(History::KeepLast { depth })
}

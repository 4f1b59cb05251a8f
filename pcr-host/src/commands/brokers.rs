//! Brokers of VDA 5050 on the command line, and what `pcr serve` and `pcr fleet` have in common there.

use super::CliError;
use pcr_formats::vda5050::topics::TopicInterface;
use pcr_serve::vda5050::mqtt::BrokerAddress;
use std::fmt::Display;

/// Least width and lookahead for vehicles of VDA 5050: they are told to stop, and say where they are, so much before where they may be \[m\]; and
/// they say so less often \[s\].
pub(super) const AT_BROKERS: (f64, f64) = (0.3, 8.0);

/// Topics of the manager and of the vehicles, which have to be different ones.
pub(super) fn interfaces(topics: &[String]) -> Result<[TopicInterface; 2], CliError> {
    let wrong = |why: &dyn Display| CliError::arguments(format!("--topics: {why}"));
    let [manager, vehicles] = topics else { return Err(wrong(&"two are expected")) };
    if manager == vehicles {
        return Err(wrong(&"the manager's and the vehicles' have to be different"));
    }
    let interface = |prefix: &str| TopicInterface::new(prefix).map_err(|error| wrong(&error));
    Ok([interface(manager)?, interface(vehicles)?])
}

/// A broker at HOST:PORT.
pub(super) fn broker(place: &str) -> Result<BrokerAddress, CliError> {
    let (host, port) = place.rsplit_once(':').unwrap_or((place, "1883"));
    let port = port.parse().map_err(|_| CliError::arguments(format!("--broker {place}: HOST:PORT is expected")))?;
    let host = host.trim_start_matches('[').trim_end_matches(']');
    let login = std::env::var("PCR_BROKER_USER").ok();
    let login = login.map(|user| (user, std::env::var("PCR_BROKER_PASSWORD").unwrap_or_default()));
    Ok(BrokerAddress { login, ..BrokerAddress::new(host, port) })
}

/// What a file of vehicles says that it is, and its version.
pub(super) const VEHICLES: (&str, u64) = ("pcr-vehicles", 1);

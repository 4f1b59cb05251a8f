//! Brokers of VDA 5050 on the command line, and what `pcr serve` and `pcr fleet` have in common there.

use super::Stop;
use pcr_formats::vda5050::topics::Interface;
use pcr_serve::vda5050::mqtt::Broker;

/// Least width and lookahead for vehicles of VDA 5050: they are told to stop, and say where they are, so much before where they may be \[m\]; and
/// they say so less often \[s\].
pub(super) const AT_BROKERS: (f64, f64) = (0.3, 8.0);

/// Topics of the manager and of the vehicles, which have to be different ones.
pub(super) fn interfaces(topics: &[String]) -> Result<[Interface; 2], Stop> {
    let wrong = |why: String| Stop::arguments(format!("--topics: {why}"));
    let [manager, vehicles] = topics else { return Err(wrong("two are expected".into())) };
    if manager == vehicles {
        return Err(wrong("the manager's and the vehicles' have to be different".into()));
    }
    Ok([Interface::new(manager).map_err(wrong)?, Interface::new(vehicles).map_err(wrong)?])
}

/// A broker at HOST:PORT.
pub(super) fn broker(place: &str) -> Result<Broker, Stop> {
    let (host, port) = place.rsplit_once(':').unwrap_or((place, "1883"));
    let port = port.parse().map_err(|_| Stop::arguments(format!("--broker {place}: HOST:PORT is expected")))?;
    let host = host.trim_start_matches('[').trim_end_matches(']');
    let login = std::env::var("PCR_BROKER_USER").ok();
    let login = login.map(|user| (user, std::env::var("PCR_BROKER_PASSWORD").unwrap_or_default()));
    Ok(Broker { login, ..Broker::new(host, port) })
}

/// What a file of vehicles says that it is, and its version.
pub(super) const VEHICLES: (&str, u64) = ("pcr-vehicles", 1);

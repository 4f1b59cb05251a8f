//! Refused connections in the log: of each kind, one line in a while, with the number of those since the last one.

use crate::hello::ConnectionRefusal;
use crate::log::{LogLevel, LogWriter};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Least time between two lines of a kind.
const PAUSE: Duration = Duration::from_secs(10);

/// Writes the refused connections of a listener.
#[derive(Clone, Debug)]
pub(crate) struct Refusals {
    log: LogWriter,
    /// Time of the last line of each kind, and number of connections since.
    last: Arc<Mutex<BTreeMap<&'static str, (Instant, u64)>>>,
}

impl Refusals {
    pub(crate) fn new(log: LogWriter) -> Self {
        Self { log, last: Arc::default() }
    }

    /// Writes a refused connection, or counts it.
    pub(crate) fn note(&self, who: &str, refusal: &ConnectionRefusal) {
        let Some(others) = self.counted(refusal.kind(), Instant::now()) else { return };
        let reason = refusal.reason();
        let mut values: Vec<(&str, &dyn Display)> = vec![("from", &who), ("why", &reason)];
        if let ConnectionRefusal::Http { origin: Some(origin) } = refusal {
            values.push(("page", origin));
        }
        if others > 0 {
            values.push(("others", &others));
        }
        self.log.write(LogLevel::Warn, "a connection to the lines is refused", &values);
    }

    /// Number of connections of a kind since the last line, if another line is due.
    fn counted(&self, kind: &'static str, now: Instant) -> Option<u64> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        match last.get_mut(kind) {
            Some((at, count)) if now.saturating_duration_since(*at) < PAUSE => {
                *count += 1;
                None
            }
            _ => Some(last.insert(kind, (now, 0)).map_or(0, |(_, count)| count)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_each_kind_one_line_in_a_while() {
        let refusals = Refusals::new(LogWriter::new(LogLevel::Error));
        let begin = Instant::now();
        let at = |seconds: u64, kind| refusals.counted(kind, begin + Duration::from_secs(seconds));
        assert_eq!([at(0, "http"), at(1, "http"), at(1, "token"), at(9, "http")], [Some(0), None, Some(0), None]);
        assert_eq!(
            [at(10, "http"), at(11, "token"), at(19, "http"), at(40, "http")],
            [Some(2), Some(0), None, Some(1)]
        );
    }
}

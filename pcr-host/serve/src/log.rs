//! Log messages, one line each, as `key=value`, from a level on.

use crate::event::SupervisorEvent;
use crate::supervisor::PAUSE;
use std::fmt::Display;
use std::io::Write;
use std::time::{SystemTime, UNIX_EPOCH};

/// The importance of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LogLevel {
    /// Holds.
    Debug,
    /// Missions, and robots that are added or removed.
    Info,
    /// Something that a person should look at.
    Warn,
    /// An error that ends the program or stops robots.
    Error,
}

impl LogLevel {
    fn name(self) -> &'static str {
        match self {
            Self::Debug => "debug",
            Self::Info => "info",
            Self::Warn => "warn",
            Self::Error => "error",
        }
    }
}

impl std::str::FromStr for LogLevel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let all = [Self::Debug, Self::Info, Self::Warn, Self::Error];
        let found = all.into_iter().find(|level| level.name() == text);
        found.ok_or_else(|| "allowed are debug, info, warn and error".to_owned())
    }
}

/// Writes the messages of a level or above to standard error.
#[derive(Clone, Copy, Debug)]
pub struct LogWriter {
    least: LogLevel,
}

impl LogWriter {
    /// Writes messages of this level or above.
    pub fn new(least: LogLevel) -> Self {
        Self { least }
    }

    /// Writes a message; values are quoted as JSON.
    pub fn write(self, level: LogLevel, message: &str, values: &[(&str, &dyn Display)]) {
        if level < self.least {
            return;
        }
        let time = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |time| time.as_secs_f64());
        let mut line = format!("time={time:.3} level={} msg={:?}", level.name(), message);
        for (key, value) in values {
            line.push_str(&format!(" {key}={:?}", value.to_string()));
        }
        line.push('\n');
        // If standard error is closed, there is no place to report it.
        let _ = std::io::stderr().lock().write_all(line.as_bytes());
    }

    /// Writes an event of the supervisor.
    pub fn event(self, event: &SupervisorEvent) {
        let level = match event {
            // That of the pause itself is told with more weight.
            SupervisorEvent::Stop { by, .. } if by == PAUSE => LogLevel::Info,
            SupervisorEvent::Hold { .. } => LogLevel::Debug,
            SupervisorEvent::Admitted { .. }
            | SupervisorEvent::Limits { .. }
            | SupervisorEvent::Waiting { .. }
            | SupervisorEvent::Heard { .. }
            | SupervisorEvent::Away { .. }
            | SupervisorEvent::Back { .. }
            | SupervisorEvent::Placed { .. }
            | SupervisorEvent::Clear { .. }
            | SupervisorEvent::Resumed {}
            | SupervisorEvent::Go { .. } => LogLevel::Info,
            SupervisorEvent::Dropped { .. } | SupervisorEvent::Silent { .. } | SupervisorEvent::Paused { .. } => {
                LogLevel::Warn
            }
            SupervisorEvent::Standstill { .. }
            | SupervisorEvent::Alarm { .. }
            | SupervisorEvent::Unplaced { .. }
            | SupervisorEvent::Stop { .. } => LogLevel::Error,
        };
        if level >= self.least {
            let text = serde_json::to_string(event).unwrap_or_default();
            self.write(level, "event", &[("event", &text)]);
        }
    }
}

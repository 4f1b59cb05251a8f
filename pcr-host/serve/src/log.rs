//! Log messages, one line each, as `key=value`, from a level on.

use crate::event::Event;
use std::fmt::Display;
use std::io::Write;
use std::time::{SystemTime, UNIX_EPOCH};

/// How important it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Every hold.
    Debug,
    /// Missions, and who comes and goes.
    Info,
    /// What somebody should look at.
    Warn,
    /// What ends the program, or stops robots.
    Error,
}

impl Level {
    fn name(self) -> &'static str {
        match self {
            Self::Debug => "debug",
            Self::Info => "info",
            Self::Warn => "warn",
            Self::Error => "error",
        }
    }
}

impl std::str::FromStr for Level {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let all = [Self::Debug, Self::Info, Self::Warn, Self::Error];
        let found = all.into_iter().find(|level| level.name() == text);
        found.ok_or_else(|| "allowed are debug, info, warn and error".to_owned())
    }
}

/// Writes to standard error what is important enough.
#[derive(Clone, Copy, Debug)]
pub struct Log {
    least: Level,
}

impl Log {
    /// From this level on.
    pub fn new(least: Level) -> Self {
        Self { least }
    }

    /// A message; values are quoted as JSON.
    pub fn write(self, level: Level, message: &str, values: &[(&str, &dyn Display)]) {
        if level < self.least {
            return;
        }
        let time = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |time| time.as_secs_f64());
        let mut line = format!("time={time:.3} level={} msg={:?}", level.name(), message);
        for (key, value) in values {
            line.push_str(&format!(" {key}={:?}", value.to_string()));
        }
        line.push('\n');
        // Nobody can be told where standard error is closed.
        let _ = std::io::stderr().lock().write_all(line.as_bytes());
    }

    /// What the supervisor says.
    pub fn event(self, event: &Event) {
        let level = match event {
            Event::Hold { .. } => Level::Debug,
            Event::Admitted { .. }
            | Event::Waiting { .. }
            | Event::Heard { .. }
            | Event::Clear { .. }
            | Event::Go { .. } => Level::Info,
            Event::Dropped { .. } | Event::Silent { .. } => Level::Warn,
            Event::Standstill { .. } | Event::Alarm { .. } | Event::Stop { .. } => Level::Error,
        };
        if level >= self.least {
            let text = serde_json::to_string(event).unwrap_or_default();
            self.write(level, "event", &[("event", &text)]);
        }
    }
}

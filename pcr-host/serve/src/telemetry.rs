//! Data that the supervisor's thread publishes for others: its speed, and recent events.

use crate::event::SupervisorEvent;
use crate::metrics::LatencyHistogram;
use crate::supervisor::PAUSE;
use serde_json::{Value, json};
use std::collections::{BTreeSet, VecDeque};
use std::time::Instant;

/// Number of events that are kept.
const EVENTS: usize = 100;

/// The published data.
#[derive(Clone, Debug)]
pub struct Telemetry {
    begin: Instant,
    /// Latency of requests.
    pub(crate) latency: LatencyHistogram,
    events: VecDeque<(f64, String)>,
    /// Robots that were told to stop because the fleet is paused.
    paused: BTreeSet<String>,
}

impl Telemetry {
    /// An empty board of a supervisor whose time began then.
    pub fn new(begin: Instant) -> Self {
        Self { begin, latency: LatencyHistogram::default(), events: VecDeque::new(), paused: BTreeSet::new() }
    }

    /// The supervisor's time at a moment \[s\]; 0 for one before it began.
    pub fn time(&self, moment: Instant) -> f64 {
        moment.saturating_duration_since(self.begin).as_secs_f64()
    }

    /// Stores an event, unless it is a hold.
    pub fn note(&mut self, now: f64, event: &SupervisorEvent) {
        let robot = event.robot().unwrap_or_default();
        let text = match event {
            SupervisorEvent::Hold { .. } => return,
            SupervisorEvent::Admitted { mission, length, .. } => format!("{robot} has {mission}, {length:.1} m"),
            SupervisorEvent::Limits { limits, .. } => match limits.iter().map(|limit| limit.speed).reduce(f64::min) {
                Some(speed) => format!("{robot} has to slow down to {speed} m/s on its path"),
                None => format!("no limit of the speed any more for {robot}"),
            },
            SupervisorEvent::Waiting { mission, why, .. } => format!("{mission} of {robot} waits: {why}"),
            SupervisorEvent::Dropped { mission, why, .. } => format!("{mission} of {robot} is given up: {why}"),
            SupervisorEvent::Silent { since, .. } => format!("{robot} is not heard for {since:.0} s"),
            SupervisorEvent::Heard { .. } => format!("{robot} is heard again"),
            SupervisorEvent::Away { keeps_place: true, .. } => {
                format!("{robot} is away; its place is kept until it is removed")
            }
            SupervisorEvent::Away { .. } => format!("{robot} is away"),
            SupervisorEvent::Back { .. } => format!("{robot} is not away any more"),
            SupervisorEvent::Unplaced { why, .. } => format!("{robot} {why}"),
            SupervisorEvent::Placed { .. } => format!("nobody waits any more for {robot} to say where it stands"),
            SupervisorEvent::Standstill { since, why, .. } => format!("no progress for {since:.0} s: {why}"),
            SupervisorEvent::Alarm { .. } => format!("{robot} is not where it may be"),
            SupervisorEvent::Clear { .. } => format!("{robot} is where it may be again"),
            SupervisorEvent::Paused { why } => why.clone(),
            SupervisorEvent::Resumed {} => "the fleet goes on".to_owned(),
            // All of them would take the place of everything else.
            SupervisorEvent::Stop { by, .. } if by == PAUSE => {
                self.paused.insert(robot.to_owned());
                return;
            }
            SupervisorEvent::Go { .. } if self.paused.remove(robot) => return,
            SupervisorEvent::Stop { by, .. } => {
                // It may have been removed while the fleet was paused.
                self.paused.remove(robot);
                format!("{robot} has to stop for {by}")
            }
            SupervisorEvent::Go { .. } => format!("{robot} may go on"),
        };
        if self.events.len() == EVENTS {
            self.events.pop_front();
        }
        self.events.push_back((now, text));
    }

    /// The latest events, oldest first.
    pub fn events(&self) -> Vec<Value> {
        self.events.iter().map(|(time, text)| json!({ "time": time, "text": text })).collect()
    }
}

//! Metrics in the text format of Prometheus.

use crate::bridge_status::BridgeStatus;
use crate::robot::SupervisedRobot;
use crate::supervisor::{PauseAbility, Supervisor};
use serde::Serialize;
use std::fmt::Write;
use std::time::Duration;

/// Upper bounds of the buckets of a latency \[s\].
const CLASSES: [f64; 10] = [0.000_1, 0.000_25, 0.000_5, 0.001, 0.002_5, 0.005, 0.01, 0.025, 0.1, 1.0];

/// Times from the arrival of a request until its answer and all resulting messages were sent.
#[derive(Clone, Debug, Default)]
pub(crate) struct LatencyHistogram {
    classes: [u64; CLASSES.len()],
    count: u64,
    sum: f64,
}

impl LatencyHistogram {
    /// Adds a time.
    pub(crate) fn add(&mut self, time: Duration) {
        let seconds = time.as_secs_f64();
        if let Some(class) = CLASSES.iter().position(|end| seconds <= *end) {
            self.classes[class] += 1;
        }
        (self.count, self.sum) = (self.count + 1, self.sum + seconds);
    }
}

/// Numbers of robots by what they do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Census {
    robots: u64,
    /// Whose mission is not admitted yet.
    waiting: u64,
    /// That are not where they may be.
    alarmed: u64,
    /// That have to stop for one of these.
    stopped: u64,
    /// That are not heard.
    silent: u64,
}

impl Census {
    /// Counts the robots of a supervisor.
    pub(crate) fn of(supervisor: &Supervisor) -> Self {
        let robots = supervisor.robots();
        let count = |which: fn(&SupervisedRobot) -> bool| robots.iter().filter(|robot| which(robot)).count() as u64;
        Self {
            robots: robots.len() as u64,
            waiting: count(|robot| robot.waiting.is_some()),
            alarmed: count(|robot| robot.alarm.is_some()),
            stopped: count(|robot| robot.stopped.is_some()),
            silent: count(|robot| robot.silent),
        }
    }
}

/// The page `/metrics`; that of the bridge where there is one.
pub(crate) fn text(supervisor: &Supervisor, latency: &LatencyHistogram, bridge: Option<&BridgeStatus>) -> String {
    let mut text = String::new();
    let counts = supervisor.counts();
    let census = Census::of(supervisor);
    for (name, kind, help, value) in [
        ("positions_total", "counter", "Messages with a position.", counts.positions),
        (
            "positions_outdated_total",
            "counter",
            "Messages about a path that the robot does not have any more.",
            counts.outdated,
        ),
        ("missions_total", "counter", "Missions asked for.", counts.missions),
        ("missions_admitted_total", "counter", "Missions admitted.", counts.admitted),
        ("missions_refused_total", "counter", "Attempts to admit a mission that were refused.", counts.refused),
        ("missions_dropped_total", "counter", "Missions given up.", counts.dropped),
        ("holds_total", "counter", "Holds told.", counts.holds),
        ("evaluations_total", "counter", "Holds computed.", counts.evaluations),
        ("alarms_total", "counter", "Robots that were not where they may be.", counts.alarms),
        ("journal_writes_total", "counter", "Writes of the journal.", counts.writes),
        ("robots", "gauge", "Robots.", census.robots),
        ("robots_waiting", "gauge", "Robots whose mission is not admitted yet.", census.waiting),
        ("robots_alarmed", "gauge", "Robots that are not where they may be.", census.alarmed),
        (
            "robots_stopped",
            "gauge",
            "Robots that had to stop for one of these, for a closed area, or for a pause.",
            census.stopped,
        ),
        ("robots_silent", "gauge", "Robots that are not heard.", census.silent),
        ("regions", "gauge", "Collision regions of all paths.", supervisor.orders().ecm().len() as u64),
    ] {
        // Writing to a text does not fail.
        let _ = writeln!(text, "# HELP pcr_{name} {help}\n# TYPE pcr_{name} {kind}\npcr_{name} {value}");
    }
    let name = "pcr_latency_seconds";
    let help =
        "Time from a request, or from a message of a vehicle or the manager, until all that follows from it was sent.";
    let _ = writeln!(text, "# HELP {name} {help}\n# TYPE {name} histogram");
    let mut sum = 0;
    for (end, class) in CLASSES.iter().zip(latency.classes) {
        sum += class;
        let _ = writeln!(text, "{name}_bucket{{le=\"{end}\"}} {sum}");
    }
    let LatencyHistogram { count, sum, .. } = latency;
    let _ = writeln!(text, "{name}_bucket{{le=\"+Inf\"}} {count}\n{name}_sum {sum}\n{name}_count {count}");
    of_robots(&mut text, supervisor);
    of_absent(&mut text, supervisor);
    of_closures(&mut text, supervisor);
    of_pause(&mut text, supervisor);
    text.push_str(&standby(false));
    if let Some(bridge) = bridge {
        of_bridge(&mut text, bridge);
    }
    text
}

/// Whether it waits for the end of another supervisor.
pub(crate) fn standby(waits: bool) -> String {
    let name = "pcr_standby";
    let help = "Whether it waits for the end of the supervisor at work.";
    format!("# HELP {name} {help}\n# TYPE {name} gauge\n{name} {}\n", u8::from(waits))
}

/// Name and help of a gauge, and whether it is 1 for a robot.
type GaugeOfRobots = (&'static str, &'static str, fn(&SupervisedRobot) -> bool);

fn of_robots(text: &mut String, supervisor: &Supervisor) {
    let gauges: [GaugeOfRobots; 4] = [
        ("waiting", "Whether its mission is not admitted yet.", |robot| robot.waiting.is_some()),
        ("alarmed", "Whether it is not where it may be.", |robot| robot.alarm.is_some()),
        (
            "stopped",
            "Whether it has to stop for one that is not where it may be, for a closed area, or for a pause.",
            |robot| robot.stopped.is_some(),
        ),
        ("silent", "Whether it is not heard.", |robot| robot.silent),
    ];
    for (name, help, is) in gauges {
        let _ = writeln!(text, "# HELP pcr_robot_{name} {help}\n# TYPE pcr_robot_{name} gauge");
        for robot in supervisor.robots() {
            let _ = writeln!(text, "pcr_robot_{name}{{robot=\"{}\"}} {}", escaped(&robot.name), u8::from(is(robot)));
        }
    }
}

/// A line for each vehicle that is away, or that others wait for because it has not said where it stands.
fn of_absent(text: &mut String, supervisor: &Supervisor) {
    let name = "pcr_vehicle_away";
    let _ = writeln!(text, "# HELP {name} 1: a person has said that it is away.\n# TYPE {name} gauge");
    for vehicle in supervisor.away() {
        let _ = writeln!(text, "{name}{{robot=\"{}\"}} 1", escaped(vehicle));
    }
    let (name, all) = ("pcr_vehicles_unplaced", supervisor.unplaced().count());
    let _ = writeln!(text, "# HELP {name} Vehicles that others wait for.\n# TYPE {name} gauge\n{name} {all}");
    let name = "pcr_vehicle_unplaced";
    let _ = writeln!(text, "# HELP {name} 1: it has not said where it stands.\n# TYPE {name} gauge");
    for (vehicle, why) in supervisor.unplaced() {
        let _ = writeln!(text, "{name}{{robot=\"{}\",why=\"{}\"}} 1", escaped(vehicle), escaped(why));
    }
}

/// A line for each closed area.
fn of_closures(text: &mut String, supervisor: &Supervisor) {
    let (name, all) = ("pcr_closures", supervisor.closures().count());
    let _ = writeln!(
        text,
        "# HELP {name} Areas that are closed, or where the speed is limited.\n# TYPE {name} gauge\n{name} {all}"
    );
    let name = "pcr_closure";
    let _ = writeln!(text, "# HELP {name} Number of robots that wait before a closed area.\n# TYPE {name} gauge");
    for area in supervisor.closures() {
        let waits = supervisor.robots().iter().filter(|robot| robot.closure.as_ref() == Some(&area.name)).count();
        let _ = writeln!(text, "{name}{{closure=\"{}\"}} {waits}", escaped(&area.name));
    }
}

/// Whether the fleet is paused, and who does not know how to.
fn of_pause(text: &mut String, supervisor: &Supervisor) {
    let (name, is_paused) = ("pcr_fleet_paused", u8::from(supervisor.is_paused()));
    let _ = writeln!(text, "# HELP {name} Whether the whole fleet is paused.\n# TYPE {name} gauge\n{name} {is_paused}");
    let name = "pcr_vehicle_unpausable";
    let help = "1: its factsheet does not name startPause and stopPause as instant actions.";
    let _ = writeln!(text, "# HELP {name} {help}\n# TYPE {name} gauge");
    for vehicle in supervisor.unpausable(PauseAbility::Unable) {
        let _ = writeln!(text, "{name}{{robot=\"{}\"}} 1", escaped(vehicle));
    }
}

fn of_bridge(text: &mut String, bridge: &BridgeStatus) {
    let BridgeStatus { connected, active, counts } = bridge;
    for (name, kind, help, value) in [
        ("broker_connected", "gauge", "Whether the broker is connected.", u64::from(*connected)),
        ("broker_active", "gauge", "Whether this is the supervisor at work at the broker.", u64::from(*active)),
        ("messages_read_total", "counter", "Messages of vehicles and of the manager.", counts.read),
        ("messages_refused_total", "counter", "Messages that were refused; the log says why.", counts.refused),
        ("messages_foreign_total", "counter", "Messages of vehicles that are not in the file.", counts.foreign),
        ("messages_sent_total", "counter", "Messages to vehicles and to the manager.", counts.sent),
    ] {
        let _ = writeln!(text, "# HELP pcr_{name} {help}\n# TYPE pcr_{name} {kind}\npcr_{name} {value}");
    }
}

/// A value of a label, as the format has it.
fn escaped(value: &str) -> String {
    value.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n")
}

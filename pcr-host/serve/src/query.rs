//! Queries about a fleet.

use crate::closed_area::SpeedLimit;
use crate::journal_entry::StoredPassingState;
use crate::owned_path::{JOINT, OwnedPath, PathElement, StartPose};
use crate::request_error::RequestError;
use crate::robot::{Alarm, ROOM, SupervisedRobot};
use crate::supervisor::Supervisor;
use pcr_core::{Encounter, Interval, Limits, Motion, Profile};
use pcr_formats::footprint::Footprint;
use pcr_planning::fleet::ConvexBody;
use pcr_planning::safe_windows::safe_intervals;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// A question. Variants without fields have braces, because serde would otherwise accept unknown fields with them.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "what", rename_all = "snake_case", deny_unknown_fields)]
pub enum Query {
    /// The state of all robots, or of one.
    Robots {
        /// Name of the robot; `None`: all robots.
        #[serde(default)]
        robot: Option<String>,
    },
    /// The holds of all robots, and which of them must not go on for the time being.
    Holds {},
    /// The regions of a robot with others, and their passing orders.
    Regions {
        /// Name of the robot.
        robot: String,
    },
    /// The robots that a robot would touch if all set off now and none waited: what the orders prevent.
    Conflicts {
        /// Name of the robot.
        robot: String,
    },
    /// Times at which a part of a robot's path is free, if the others set off now and did not wait.
    Safe {
        /// Name of the robot.
        robot: String,
        /// Lengths of the part \[m\].
        length: [f64; 2],
        /// End of the time to look at, from now \[s\].
        until: f64,
    },
    /// The areas that are closed, or where the speed is limited.
    Closures {},
    /// Numbers of events since the start.
    Counts {},
}

/// The state of a robot, as it is sent in answers.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct RobotView<'a> {
    robot: &'a str,
    path: u64,
    origin: f64,
    length: f64,
    radius: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    footprint: Option<&'a Footprint>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    any_heading: bool,
    at: [f64; 2],
    hold: f64,
    /// Hold that it needs so that it does not have to brake \[m\].
    wanted: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    waits_for: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mission: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    waiting: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    alarm: Option<&'a Alarm>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stopped_for: Option<&'a str>,
    /// Closed area before which it waits.
    #[serde(skip_serializing_if = "Option::is_none")]
    closure: Option<&'a str>,
    /// Where its speed is limited on its path.
    #[serde(skip_serializing_if = "<[SpeedLimit]>::is_empty")]
    limits: &'a [SpeedLimit],
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    away: bool,
    silent: bool,
    start: StartPose,
    shapes: &'a [PathElement],
}

impl<'a> RobotView<'a> {
    /// The state of one robot of a fleet at a time \[s\].
    pub(crate) fn new(supervisor: &'a Supervisor, robot: &'a SupervisedRobot, now: f64) -> Self {
        let extent = robot.possible_positions(now);
        Self {
            robot: &robot.name,
            path: robot.path,
            origin: robot.origin,
            length: robot.course.length(),
            radius: robot.abilities.radius,
            footprint: robot.abilities.footprint.as_ref(),
            any_heading: robot.any_heading,
            at: [extent.lo, extent.hi],
            hold: robot.granted,
            wanted: robot.wanted(supervisor.settings().lookahead, supervisor.settings().position_uncertainty),
            waits_for: supervisor.waits_for(robot),
            mission: robot.mission.as_deref(),
            waiting: robot.waiting.as_ref().map(|waiting| waiting.mission.as_str()),
            alarm: robot.alarm.as_ref(),
            stopped_for: robot.stopped.as_deref(),
            closure: robot.closure.as_deref(),
            limits: &robot.speed_limits,
            away: robot.away,
            silent: robot.silent,
            start: robot.course.start(),
            shapes: robot.course.shapes(),
        }
    }
}

/// The answer to a question.
///
/// # Errors
/// [`RequestError::NoSuchRobot`], [`RequestError::Invalid`].
pub fn answer(supervisor: &Supervisor, question: &Query, now: f64) -> Result<Value, RequestError> {
    let robots = supervisor.robots();
    let place = |name: &str| robots.iter().position(|robot| robot.name == *name).ok_or(RequestError::NoSuchRobot);
    match question {
        Query::Robots { robot: Some(name) } => {
            Ok(json!({ "robots": [RobotView::new(supervisor, supervisor.robot(name)?, now)] }))
        }
        Query::Robots { robot: None } => {
            let views: Vec<RobotView<'_>> = robots.iter().map(|robot| RobotView::new(supervisor, robot, now)).collect();
            Ok(json!({ "robots": views, "away": supervisor.away(), "paused": supervisor.pause_reason() }))
        }
        Query::Holds {} => {
            let hold = |robot: &SupervisedRobot| {
                let waits_for = supervisor.waits_for(robot);
                let mut told =
                    json!({ "robot": robot.name, "path": robot.path, "hold": robot.granted, "waits_for": waits_for });
                // A client that only asks for holds would otherwise let a stopped robot go on.
                if let Some(by) = &robot.stopped {
                    told["stopped_for"] = json!(by);
                }
                told
            };
            Ok(json!({ "holds": robots.iter().map(hold).collect::<Vec<_>>() }))
        }
        Query::Regions { robot } => {
            let fleet = supervisor.fleet()?;
            let row = supervisor.orders().row(&fleet, place(robot)?).map_err(RequestError::invalid)?;
            let regions = row.map(|(_, region, pass)| {
                let [length, other_length] =
                    [region.length(), region.other_length()].map(|length| [length.lo, length.hi]);
                let with = &robots[region.other()].name;
                json!({ "with": with, "length": length, "other_length": other_length, "pass": StoredPassingState::from(pass) })
            });
            Ok(json!({ "regions": regions.collect::<Vec<_>>() }))
        }
        Query::Conflicts { robot } => {
            let (ego, ways) = (place(robot)?, ways(robots)?);
            let fleet = motions(&ways)?;
            let mut conflicts = Vec::new();
            for other in (0..fleet.len()).filter(|&other| other != ego) {
                let pair = Encounter::new(&fleet[ego], &fleet[other]);
                for conflict in pair.conflicts(pair.time()) {
                    let at = robots[ego].arc_length;
                    conflicts.push(json!({
                        "with": robots[other].name,
                        "time": [conflict.time.lo, conflict.time.hi],
                        "length": [conflict.length.lo + at, conflict.length.hi + at],
                    }));
                }
            }
            Ok(json!({ "conflicts": conflicts }))
        }
        &Query::Safe { ref robot, length: [lo, hi], until } => {
            let (ego, ways) = (place(robot)?, ways(robots)?);
            let (at, end) = (robots[ego].arc_length, robots[ego].course.length());
            if !(at - JOINT..=end + JOINT).contains(&lo)
                || !(lo..=end + JOINT).contains(&hi)
                || !(0.0..=1e6).contains(&until)
            {
                return Err(RequestError::invalid(format!(
                    "length: allowed is {at} to {end} m, the part still ahead; until: allowed is 0 to 1000000 s"
                )));
            }
            let fleet = motions(&ways)?;
            let safe = safe_intervals(
                &fleet,
                ego,
                Interval::new((lo - at).max(0.0), (hi - at).max(0.0)),
                Interval::new(0.0, until),
            );
            let safe = safe.map_err(RequestError::invalid)?.into_iter().map(|safe| [safe.lo, safe.hi]);
            Ok(json!({ "safe": safe.collect::<Vec<_>>() }))
        }
        Query::Closures {} => Ok(json!({ "closures": supervisor.closures().collect::<Vec<_>>() })),
        Query::Counts {} => Ok(json!(supervisor.counts())),
    }
}

/// The rest of a path, at full speed from rest.
struct RemainingPath {
    course: OwnedPath,
    profile: Profile<f64, 3>,
    body: ConvexBody,
}

fn ways(robots: &[SupervisedRobot]) -> Result<Vec<RemainingPath>, RequestError> {
    let way = |robot: &SupervisedRobot| {
        let course = robot.course.part(robot.arc_length, robot.course.length())?;
        let limits = Limits { speed: robot.abilities.speed, acceleration: robot.abilities.acceleration };
        let length = course.length();
        let profile = if length > 0.0 { Profile::rest_to_rest(length, limits)? } else { Profile::standing() };
        Ok(RemainingPath { course, profile, body: robot.body.inflated(-ROOM)? })
    };
    robots.iter().map(way).collect::<Result<_, pcr_core::InvalidInput>>().map_err(RequestError::invalid)
}

fn motions(ways: &[RemainingPath]) -> Result<Vec<Motion<'_, f64>>, RequestError> {
    ways.iter()
        .map(|way| way.course.motion_by(way.profile.as_profile(), &way.body).map_err(RequestError::invalid))
        .collect()
}

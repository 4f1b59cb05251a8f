//! Admission of missions: another path for a robot, with orders with which all robots can finish, or the reason why
//! there are none.

use super::{Supervisor, fleet, retry_with_growth};
use crate::event::{CancelCause, SupervisorEvent};
use crate::journal_entry::{JournalEntry, StoredPrecedence, StoredRobot};
use crate::owned_path::{JOINT, OwnedPath, PathElement, PathRounding, StartPose, WORN, extent};
use crate::request_error::RequestError;
use crate::robot::{MissionEnd, MissionFingerprint, PendingMission, ROOM, SupervisedRobot};
use pcr_core::{AdmissionError, Interval, InvalidInput, PassingState, PathProposal, Progress, RegionRef};
use pcr_planning::fleet::ConvexBody;
use serde::{Deserialize, Serialize};

/// Length of the longest id of a mission \[bytes\].
const LONGEST: usize = 1000;

/// A request for a path of a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MissionRequest {
    /// Name of the robot.
    pub robot: String,
    /// Id of the mission. A repeated request gets the same answer; a request for another path under this id is refused.
    pub mission: String,
    /// Length of the present path at which the new one leaves it \[m\]; `None`: at its end.
    #[serde(default)]
    pub after: Option<f64>,
    /// Expected number of the present path; `None`: not compared.
    #[serde(default)]
    #[serde(rename = "of")]
    pub expected_path: Option<u64>,
    /// Expected start of the new path; `None`: not compared.
    #[serde(default)]
    pub start: Option<StartPose>,
    /// Shapes of the new path.
    pub path: Vec<PathElement>,
    /// Whether the robot may have any heading on it: then it is the disc around its outline.
    #[serde(default)]
    pub any_heading: bool,
}

/// The result of a request for a mission.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "verdict", rename_all = "snake_case")]
pub enum AdmissionResult {
    /// The mission was admitted.
    Admitted {
        /// Number of the new path.
        path: u64,
        /// Length of the new path \[m\].
        length: f64,
        /// Length of the new path up to which the robot had already been allowed to go \[m\]. Further holds follow as events.
        hold: f64,
    },
    /// The mission has been replaced by another one since; nothing is done.
    Past,
    /// The mission is tried again later.
    Waiting {
        /// Robot that is in the way, if one is.
        #[serde(skip_serializing_if = "Option::is_none")]
        by: Option<String>,
        /// Reason, in words.
        why: String,
    },
}

/// A path with which a mission was admitted, and what moves along it.
pub(super) struct AdmittedPath {
    course: OwnedPath,
    rest: PathRounding,
    body: ConvexBody,
    any_heading: bool,
}

/// A path begins where the one before it ends if it is nowhere on its way farther off than this \[m\], and not turned by more \[rad\].
const JOIN: f64 = 1e-3;

impl MissionRequest {
    /// Whether it is a request for a path that begins at this length of the path before, along these shapes.
    fn asks_for(&self, after: f64, shapes: &[PathElement], any_heading: bool) -> bool {
        self.path == shapes
            && self.any_heading == any_heading
            && self.after.is_none_or(|own| (own - after).abs() <= JOINT)
    }
}

impl Supervisor {
    /// Gives a robot a path, now or as soon as that is possible. A robot has at most one waiting mission: a new one replaces
    /// it.
    ///
    /// # Errors
    /// [`RequestError`] for a mission that can never be admitted; it does not wait then.
    pub fn mission(&mut self, proposal: &MissionRequest, now: f64) -> Result<AdmissionResult, RequestError> {
        self.mission_in_parts(proposal, Vec::new(), now)
    }

    /// Takes a mission, as [`Supervisor::mission`] does, that may be admitted in parts: while the whole of it has to wait, it is admitted up to the last
    /// of these ends that is possible, and the rest waits.
    ///
    /// # Errors
    /// As [`Supervisor::mission`].
    pub fn mission_in_parts(
        &mut self,
        proposal: &MissionRequest,
        ends: Vec<MissionEnd>,
        now: f64,
    ) -> Result<AdmissionResult, RequestError> {
        self.works()?;
        let place = self.robot_index(&proposal.robot)?;
        // The last ones of each robot are kept, and the journal has them all in one frame.
        if proposal.mission.len() > LONGEST {
            return Err(RequestError::invalid(format!("mission: longer than {LONGEST} bytes")));
        }
        let robot = &self.robots[place];
        let waiting = robot.waiting.as_ref().filter(|waiting| waiting.mission == proposal.mission);
        if let Some(waiting) = waiting {
            if !proposal.asks_for(waiting.after, &waiting.shapes, waiting.any_heading) {
                return Err(RequestError::MissionExists);
            }
            let why = "it is tried again".into();
            let last = self.tries.get(&proposal.robot).and_then(|attempt| attempt.last.clone());
            return Ok(last.unwrap_or(AdmissionResult::Waiting { by: None, why }));
        }
        if robot.mission.as_ref() == Some(&proposal.mission) {
            let is_same = |(after, shapes, any): (f64, &[PathElement], bool)| proposal.asks_for(after, shapes, any);
            if !robot.mission_request().is_none_or(is_same) {
                return Err(RequestError::MissionExists);
            }
            return Ok(admitted(robot));
        }
        if robot.past.contains(&proposal.mission) {
            return Ok(AdmissionResult::Past);
        }
        if robot.away {
            return Err(RequestError::Away);
        }
        let after = proposal.after.unwrap_or(robot.course.length());
        let waiting = PendingMission {
            mission: proposal.mission.clone(),
            after,
            path: robot.path,
            shapes: proposal.path.clone(),
            any_heading: proposal.any_heading,
            turn: self.turn,
            ends,
        };
        // A length of another path means another place.
        if proposal.expected_path.is_some_and(|path| path != robot.path) {
            return Err(RequestError::NoSuchPath { path: robot.path });
        }
        let joint = joint(robot, after)?;
        if let Some(start) = proposal.start {
            is_there(robot, joint, start, extent(&proposal.path) + robot.spread())?;
        }
        self.counts.missions += 1;
        // Removed now, because a robot with a newly admitted path has no waiting mission.
        let robot = &mut self.robots[place];
        let (before, past) = (robot.waiting.take(), robot.past.clone());
        if let Some(before) = &before {
            SupervisedRobot::outlives(&mut robot.past, before.mission.clone());
        }
        let left = match self.attempt_in_parts(place, waiting, joint, now) {
            Ok(left) => left,
            Err(fault) => {
                let robot = &mut self.robots[place];
                (robot.waiting, robot.past) = (before, past);
                return Err(fault);
            }
        };
        if let Some(before) = before {
            self.drops(&proposal.robot, before.mission, CancelCause::Replaced);
            self.entries.push(JournalEntry::Waiting { robot: proposal.robot.clone(), waiting: None });
        }
        let Some((verdict, rest)) = left else { return Ok(admitted(&self.robots[place])) };
        self.turn += 1;
        self.waits(place, rest, verdict.clone(), now);
        Ok(verdict)
    }

    /// Renames the mission of a robot, if another one has the same path: nothing else changes.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`], [`RequestError::Broken`].
    pub fn adopt(&mut self, name: &str, mission: String) -> Result<(), RequestError> {
        self.works()?;
        let place = self.robot_index(name)?;
        let robot = &mut self.robots[place];
        let waiting = robot.waiting.take().map(|waiting| waiting.mission);
        for before in robot.mission.replace(mission).into_iter().chain(waiting.clone()) {
            SupervisedRobot::outlives(&mut robot.past, before);
        }
        // The request of the new mission is not known.
        robot.asked = None;
        self.tries.remove(name);
        if let Some(waiting) = waiting {
            self.drops(name, waiting, CancelCause::Replaced);
        }
        self.keep_robot(place)
    }

    /// Tries to admit a mission that begins at a length of the path before \[m\]. Returns `None` if it was admitted, otherwise
    /// why not.
    ///
    /// # Errors
    /// [`RequestError`] for a mission that can never be admitted.
    pub(super) fn attempt(
        &mut self,
        place: usize,
        mission: &PendingMission,
        joint: f64,
        now: f64,
    ) -> Result<Option<AdmissionResult>, RequestError> {
        match self.order_mission(place, mission, joint, now)? {
            Ok((path, dropped)) => self.commit(place, mission, path, dropped).map(|()| None),
            Err(refused) => {
                self.counts.refused += 1;
                Ok(Some(refused))
            }
        }
    }

    /// Orders a mission behind and before all others, as [`Supervisor::attempt`]. The table of orders is then that of the returned path, which the
    /// robot does not have yet, and the length that is dropped from the start of its present path \[m\].
    ///
    /// # Errors
    /// As [`Supervisor::attempt`]; the table is unchanged then, and where the mission has to wait.
    pub(super) fn order_mission(
        &mut self,
        place: usize,
        mission: &PendingMission,
        joint: f64,
        now: f64,
    ) -> Result<Result<(AdmittedPath, f64), AdmissionResult>, RequestError> {
        let robot = &self.robots[place];
        if robot.alarm.is_some() {
            let why = "it is not where it may be".into();
            return Ok(Err(AdmissionResult::Waiting { by: Some(robot.name.clone()), why }));
        }
        let rejoined = robot.course.rejoined(robot.arc_length, joint, &mission.shapes, robot.rest);
        let (course, dropped, rest) = rejoined.map_err(RequestError::invalid)?;
        // Where it has come to the end of its path, it faces as the mission says.
        let stands = robot.arc_length >= joint - 2.0 * ROOM;
        let any_heading = mission.any_heading || robot.any_heading && !stands;
        let body = match any_heading == robot.any_heading {
            true => robot.body.clone(),
            false => robot.abilities.body(any_heading).map_err(RequestError::invalid)?,
        };
        if rest.worn(course.length() + robot.spread()) > WORN {
            let why = "the rounding of all its missions is more than the outlines have room for: remove the robot, and add it anew";
            return Err(RequestError::invalid(why));
        }
        let shifted = |length: f64| (length - dropped).max(0.0).min(course.length());
        let (at, told) = (shifted(robot.arc_length), shifted(robot.notified_limit));
        if let Some(why) = self.pause_reason() {
            return Ok(Err(AdmissionResult::Waiting { by: None, why }));
        }
        if let Some(closure) = self.closed_on(&robot.name, &course, &body, [at, told]) {
            let why = format!("{closure} is closed");
            return Ok(Err(AdmissionResult::Waiting { by: None, why }));
        }
        let own = Progress { at: Interval::new(at, told), stop: told };
        let motion = course.motion(&body).map_err(turning)?;
        let (mut progress, tolerances) = (self.progress(), self.tolerances());
        self.orders.passed(&progress);
        let mut fleet = fleet(&self.robots)?;
        let speeds: Vec<f64> = self.robots.iter().map(|robot| robot.abilities.speed).collect();
        let (known, overtaken) = (progress.clone(), self.overtaken(now));
        let prefer = |region: &RegionRef<'_, f64>| match overtaken.get(region.other()) {
            Some(true) => PassingState::Second,
            _ => preferred(region, own.at.lo, &known, &speeds),
        };
        let asked = PathProposal { agent: place, motion, progress: own };
        let admission = retry_with_growth(&mut self.orders, |orders| {
            orders.admit(&mut fleet, &mut progress, asked, tolerances, &mut self.reaches, prefer)
        });
        drop(fleet);
        let Err(refused) = admission else {
            let path = AdmittedPath { course: course.clone(), rest, body: body.clone(), any_heading };
            return Ok(Ok((path, dropped)));
        };
        let name = |agent: usize| self.robots.get(agent).map_or_else(String::new, |robot| robot.name.clone());
        let (by, why) = match refused {
            AdmissionError::Blocked { by, .. } => (name(by), format!("{} is in the way, whoever goes first", name(by))),
            AdmissionError::Stuck { agent, by, .. } => {
                (name(by), format!("{} would wait for {} for ever", name(agent), name(by)))
            }
            AdmissionError::Late { agent, by, .. } => {
                (name(by), format!("{} is where {} was to go first", name(agent), name(by)))
            }
            refused => return Err(RequestError::invalid(refused)),
        };
        Ok(Err(AdmissionResult::Waiting { by: Some(by), why }))
    }

    /// Makes the admitted path that of the robot.
    fn commit(
        &mut self,
        place: usize,
        mission: &PendingMission,
        AdmittedPath { course, rest, body, any_heading }: AdmittedPath,
        dropped: f64,
    ) -> Result<(), RequestError> {
        let robot = &mut self.robots[place];
        let length = course.length();
        let shifted = |value: f64| (value - dropped).max(0.0).min(length);
        robot.arc_length = shifted(robot.arc_length);
        robot.up_to = shifted(robot.up_to).max(robot.arc_length);
        (robot.granted, robot.notified_limit) = (shifted(robot.granted), shifted(robot.notified_limit));
        robot.next = 0.0;
        // No hold beyond `told` has been told.
        robot.ceiling = robot.notified_limit;
        (robot.moved, robot.stands) = (None, false);
        robot.path += 1;
        robot.origin += dropped;
        (robot.course, robot.rest) = (course, rest);
        (robot.body, robot.any_heading) = (body, any_heading);
        if let Some(before) = robot.mission.replace(mission.mission.clone()) {
            SupervisedRobot::outlives(&mut robot.past, before);
        }
        let PendingMission { after, any_heading, .. } = *mission;
        robot.asked = Some(MissionFingerprint { after, shapes: mission.shapes.len(), any_heading });
        robot.waiting = None;
        let event = SupervisorEvent::Admitted {
            robot: robot.name.clone(),
            mission: mission.mission.clone(),
            path: robot.path,
            origin: robot.origin,
            length,
            hold: robot.granted,
        };
        self.tries.remove(&self.robots[place].name);
        self.counts.admitted += 1;
        self.events.push(event);
        self.forget_holds_with(place);
        // A robot that was in the way of a stopped one may no longer be.
        self.hazards |= self.robots.iter().any(|robot| robot.stopped.is_some());
        self.keep_robot(place)
    }

    /// Marks as unknown the holds of a robot, and of those that have a region with it or waited for it.
    fn forget_holds_with(&mut self, place: usize) {
        let pairs = self.orders.decisions().map(|decision| decision.agents).filter(|agents| agents.contains(&place));
        for agents in pairs {
            agents.into_iter().for_each(|agent| self.robots[agent].authority = None);
        }
        for (other, robot) in self.robots.iter_mut().enumerate() {
            if other == place || robot.authority.is_some_and(|wait| wait.waits_for.is_some_and(|(by, _)| by == place)) {
                robot.authority = None;
            }
        }
    }

    /// A robot with its orders, as the journal has it.
    pub(super) fn known(&self, place: usize) -> Result<StoredRobot, RequestError> {
        let fleet = fleet(&self.robots)?;
        let robot = &self.robots[place];
        let decisions = self.orders.decisions().filter(|decision| decision.agents.contains(&place));
        let row = self.orders.row(&fleet, place).map_err(RequestError::invalid)?;
        let orders = row.zip(decisions).map(|((_, region, pass), decision)| StoredPrecedence {
            with: self.robots[region.other()].name.clone(),
            pass: pass.into(),
            active_from: decision.since,
            lengths: [region.length(), region.other_length()].map(|length| [length.lo, length.hi]),
        });
        Ok(StoredRobot {
            name: robot.name.clone(),
            abilities: robot.abilities.clone(),
            any_heading: robot.any_heading,
            course: robot.course.clone(),
            rest: robot.rest,
            path: robot.path,
            origin: robot.origin,
            mission: robot.mission.clone(),
            asked: robot.asked,
            past: robot.past.clone(),
            arc_length: robot.arc_length,
            ceiling: robot.ceiling,
            alarm: robot.alarm.clone(),
            waiting: robot.waiting.clone(),
            orders: orders.collect(),
            notes: robot.notes.clone(),
        })
    }
}

/// Length of a robot's path at which a new path begins, corrected for rounding.
///
/// # Errors
/// [`RequestError`] if no path can begin there.
pub(super) fn joint(robot: &SupervisedRobot, after: f64) -> Result<f64, RequestError> {
    let length = robot.course.length();
    if !(-JOINT..=length + JOINT).contains(&after) {
        return Err(RequestError::invalid(format!("after: {after} is out of range; the path is {length} m long")));
    }
    if after < robot.notified_limit - JOINT {
        return Err(RequestError::Released { hold: robot.notified_limit });
    }
    Ok(after.max(robot.notified_limit).min(length))
}

/// Checks that a path that leaves that of a robot at a length begins at the stated pose. `extent` bounds the distance of the points
/// of the path from its start: a wrong heading there becomes a wrong place further on.
fn is_there(robot: &SupervisedRobot, after: f64, start: StartPose, extent: f64) -> Result<(), RequestError> {
    let end = robot.course.arrival(after).map_err(RequestError::invalid)?;
    let distance = (start.x - end.x).hypot(start.y - end.y);
    let angle = (start.heading - end.heading).sin().atan2((start.heading - end.heading).cos()).abs();
    // Written so that NaN is not near.
    let is_near = angle <= JOIN && distance + angle * extent <= JOIN;
    if is_near { Ok(()) } else { Err(RequestError::Apart { distance, angle }) }
}

/// Why there is no motion along a path: says what to do where an outline would turn in no time.
fn turning(reason: InvalidInput) -> RequestError {
    match reason {
        InvalidInput::TurnInPlace => RequestError::invalid(
            "path: a robot with a footprint sweeps an area as it turns in place: give each turn its `lever`, the length of the path for each \
             radian [m], or the mission `any_heading`",
        ),
        reason => RequestError::invalid(reason),
    }
}

fn admitted(robot: &SupervisedRobot) -> AdmissionResult {
    AdmissionResult::Admitted { path: robot.path, length: robot.course.length(), hold: robot.granted }
}

/// Preferred passing order: first goes the robot that makes the other one wait less, if there were no other robots.
fn preferred(region: &RegionRef<'_, f64>, at: f64, known: &[Progress<f64>], speeds: &[f64]) -> PassingState {
    let speed = |agent: usize| speeds.get(agent).copied().unwrap_or(1.0);
    let there = known.get(region.other()).map_or(0.0, |progress| progress.at.lo);
    let times = |length: Interval<f64>, at: f64, speed: f64| {
        [length.lo, length.hi].map(|length| (length - at).max(0.0) / speed)
    };
    let own = times(region.length(), at, speed(region.ego()));
    let their = times(region.other_length(), there, speed(region.other()));
    if own[1] - their[0] <= their[1] - own[0] { PassingState::First } else { PassingState::Second }
}

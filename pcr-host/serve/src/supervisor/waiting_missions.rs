//! Missions that wait to be admitted: they are tried again, and a mission that may be admitted in parts gets as far as it can.

use super::Supervisor;
use super::admission::{AdmissionResult, joint};
use crate::event::{CancelCause, SupervisorEvent};
use crate::journal_entry::JournalEntry;
use crate::owned_path::PathElement;
use crate::request_error::RequestError;
use crate::robot::{MissionEnd, PendingMission, SupervisedRobot};

/// The attempts to admit a waiting mission.
#[derive(Clone, Debug, Default)]
pub(super) struct AdmissionRetry {
    next: f64,
    pause: f64,
    pub(super) last: Option<AdmissionResult>,
}

impl AdmissionRetry {
    /// Lets it be tried at once.
    pub(super) fn hurry(&mut self) {
        (self.next, self.pause) = (f64::NEG_INFINITY, PAUSE[0]);
    }
}

/// Pause between two attempts \[s\]: the first one, and the largest.
const PAUSE: [f64; 2] = [0.25, 2.0];

/// A mission that has to wait, or what is left of it, and why.
type Left = Option<(AdmissionResult, PendingMission)>;

impl Supervisor {
    /// Gives up the waiting mission of a robot, if there is one: its way ends where its present path ends.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`], [`RequestError::Broken`].
    pub(crate) fn give_up(&mut self, name: &str) -> Result<(), RequestError> {
        self.works()?;
        let place = self.robot_index(name)?;
        let robot = &mut self.robots[place];
        let Some(PendingMission { mission, .. }) = robot.waiting.take() else { return Ok(()) };
        SupervisedRobot::outlives(&mut robot.past, mission.clone());
        self.tries.remove(name);
        self.entries.push(JournalEntry::Waiting { robot: name.into(), waiting: None });
        self.drops(name, mission, CancelCause::Cancelled);
        Ok(())
    }

    /// Tells that a waiting mission was given up.
    pub(super) fn drops(&mut self, robot: &str, mission: String, why: CancelCause) {
        self.counts.dropped += 1;
        self.events.push(SupervisorEvent::Dropped { robot: robot.into(), mission, why });
    }

    /// Tries to admit a mission, and if it has to wait, its parts up to each of its ends, the longest first. Returns what has to wait.
    ///
    /// # Errors
    /// As [`Supervisor::attempt`] of the whole mission.
    pub(super) fn attempt_in_parts(
        &mut self,
        place: usize,
        mission: PendingMission,
        joint: f64,
        now: f64,
    ) -> Result<Left, RequestError> {
        let Some(verdict) = self.attempt(place, &mission, joint, now)? else { return Ok(None) };
        for (k, end) in mission.ends.iter().enumerate().rev() {
            let Some((shapes, rest)) = mission.shapes.split_at_checked(end.shapes) else { continue };
            let part = PendingMission { mission: end.mission.clone(), shapes: shapes.to_vec(), ..mission.clone() };
            // What is wrong with a part is wrong with the whole, which waits.
            if !matches!(self.attempt(place, &part, joint, now), Ok(None)) {
                continue;
            }
            let robot = &self.robots[place];
            let later = mission.ends.iter().skip(k + 1);
            let ends = later
                .map(|later| MissionEnd { shapes: later.shapes.saturating_sub(end.shapes), ..later.clone() })
                .collect();
            let (after, path) = (robot.course.length(), robot.path);
            return Ok(Some((verdict, PendingMission { after, path, shapes: rest.to_vec(), ends, ..mission })));
        }
        Ok(Some((verdict, mission)))
    }

    /// A mission has to wait, for this reason.
    pub(super) fn waits(&mut self, place: usize, mission: PendingMission, verdict: AdmissionResult, now: f64) {
        let name = self.robots[place].name.clone();
        let next = AdmissionRetry { next: now + PAUSE[0], pause: PAUSE[0], last: Some(verdict) };
        self.tries.insert(name.clone(), next);
        self.entries.push(JournalEntry::Waiting { robot: name, waiting: Some(mission.clone()) });
        self.robots[place].waiting = Some(mission);
    }

    /// The robot for which the mission of a robot waits, if it does for one, and why, in words; `None` if none waits, or if it was not tried
    /// since the start.
    pub(crate) fn why_waiting(&self, robot: &SupervisedRobot) -> Option<(Option<&str>, &str)> {
        match self.tries.get(&robot.name).filter(|_| robot.waiting.is_some())?.last.as_ref()? {
            AdmissionResult::Waiting { by, why } => Some((by.as_deref(), why)),
            _ => None,
        }
    }

    /// The first of several paths from the end of a robot's present one that would be admitted now. Nothing changes.
    pub(crate) fn first_admissible<'p>(
        &mut self,
        name: &str,
        paths: impl IntoIterator<Item = &'p [PathElement]>,
        any_heading: bool,
        now: f64,
    ) -> Option<usize> {
        let place = self.robot_index(name).ok()?;
        let before = self.orders.clone();
        let robot = &self.robots[place];
        let (after, path) = (robot.course.length(), robot.path);
        let found = paths.into_iter().position(|shapes| {
            let (mission, shapes, ends) = (String::new(), shapes.to_vec(), Vec::new());
            let mission = PendingMission { mission, after, path, shapes, any_heading, turn: 0, ends };
            matches!(self.order_mission(place, &mission, after, now), Ok(Ok(_)))
        });
        self.orders = before;
        found
    }

    /// Tries the mission that has been due for the longest time; of several, the oldest. (Trying the oldest of all due missions
    /// would starve a young one while many wait, even if it was the only one that could be admitted.)
    pub(super) fn retry(&mut self, now: f64) {
        let time = |robot: &SupervisedRobot| self.tries.get(&robot.name).map_or(f64::NEG_INFINITY, |last| last.next);
        let waiting = self.robots.iter().enumerate().filter_map(|(place, robot)| {
            let turn = robot.waiting.as_ref()?.turn;
            Some((time(robot), turn, place)).filter(|(time, ..)| *time <= now)
        });
        let first = waiting.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(.., place)| place);
        let waiting = first.and_then(|place| Some((place, self.robots[place].waiting.clone()?)));
        let Some((place, waiting)) = waiting else { return };
        let robot = &self.robots[place];
        let name = robot.name.clone();
        let possible = match waiting.path == robot.path {
            true => {
                joint(robot, waiting.after).and_then(|joint| self.attempt_in_parts(place, waiting.clone(), joint, now))
            }
            false => Err(RequestError::NoSuchPath { path: robot.path }),
        };
        match possible {
            Ok(None) => {}
            Ok(Some((verdict, rest))) => {
                if rest.path != waiting.path {
                    // A part of it was admitted.
                    self.waits(place, rest, verdict, now);
                    return;
                }
                let last = self.tries.entry(name.clone()).or_default();
                last.pause = (2.0 * last.pause).clamp(PAUSE[0], PAUSE[1]);
                last.next = now + last.pause;
                if last.last.as_ref() != Some(&verdict)
                    && let AdmissionResult::Waiting { by, why } = verdict.clone()
                {
                    self.events.push(SupervisorEvent::Waiting { robot: name, mission: waiting.mission, by, why });
                }
                last.last = Some(verdict);
            }
            Err(fault) => {
                self.robots[place].waiting = None;
                SupervisedRobot::outlives(&mut self.robots[place].past, waiting.mission.clone());
                self.tries.remove(&name);
                self.entries.push(JournalEntry::Waiting { robot: name.clone(), waiting: None });
                self.drops(&name, waiting.mission, CancelCause::Impossible(fault.to_string()));
            }
        }
    }
}

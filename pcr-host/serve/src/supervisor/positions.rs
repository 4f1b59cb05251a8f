//! Reports of robots about their positions.

use super::Supervisor;
use crate::event::SupervisorEvent;
use crate::journal_entry::JournalEntry;
use crate::request_error::RequestError;
use crate::robot::{Alarm, BACK, ROOM, SupervisedRobot};
use serde::{Deserialize, Serialize};

/// A robot that has advanced by at most this counts as not having moved \[m\].
const STIR: f64 = 1e-3;

/// A position message of a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PositionReport {
    /// Name of the robot.
    pub robot: String,
    /// Number of the path to which `at` refers. A message about an older path only shows that the robot is alive.
    pub path: u64,
    /// Lengths of the path between which the robot certainly was \[m\].
    pub at: [f64; 2],
    /// Age of the position \[s\].
    #[serde(default)]
    pub age: f64,
}

impl Supervisor {
    /// Takes a position message. Messages may be lost, late and repeated: the largest of the lower ends counts.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`], [`RequestError::NoSuchPath`] for a path that the robot does not have yet, [`RequestError::Invalid`].
    pub fn position(&mut self, report: &PositionReport, now: f64) -> Result<(), RequestError> {
        self.works()?;
        let place = self.robot_index(&report.robot)?;
        let (PositionReport { at: [lo, hi], age, .. }, robot) = (report, &self.robots[place]);
        if !(lo.is_finite() && hi.is_finite() && lo <= hi) {
            return Err(RequestError::invalid(format!("at: {lo} to {hi} is no interval")));
        }
        let time = time(*age, now)?;
        if report.path > robot.path {
            return Err(RequestError::NoSuchPath { path: robot.path });
        }
        self.counts.positions += 1;
        self.is_alive(place, now);
        if report.path < self.robots[place].path {
            self.counts.outdated += 1;
            return Ok(());
        }
        let begun = self.begun(now);
        let robot = &self.robots[place];
        let (is_new, told, passed) = (is_new(robot, time, begun), robot.notified_limit, robot.arc_length);
        // What bends makes a path's corners go further: only those that are beyond what was told pay for the search.
        if *hi > told && *hi > told + robot.allowance() {
            if is_new {
                self.alarm(place, Some(Alarm::Beyond { notified_limit: told, at: *hi }), time);
            }
            return Ok(());
        }
        // The robot rolled or was pushed back into a part of its path that may already be free for others. Positions from before a
        // restart do not count.
        let since = robot.heard.map_or(begun, |heard| heard.max(begun));
        let is_back = *hi < passed - 2.0 * robot.abilities.margin - BACK && time >= since;
        if is_new && is_back {
            self.alarm(place, Some(Alarm::Back { passed, between: [*lo, *hi] }), time);
            return Ok(());
        }
        if is_new {
            self.alarm(place, None, time);
        }
        let robot = &mut self.robots[place];
        // An older message with a lower end above the upper end of a newer one: the robot has gone back since. (After a restart the
        // newest upper end is not known.)
        let lo = if is_new || *lo <= robot.up_to { *lo } else { robot.arc_length };
        // A robot at the end of its path has not left the regions there, whatever rounding makes of their ends.
        let lo = lo.min(robot.notified_limit).min(robot.course.length() - ROOM);
        if lo > robot.arc_length {
            if lo > robot.arc_length + STIR {
                (robot.moved, robot.stands) = (Some(now), false);
            }
            robot.arc_length = lo;
            self.unsaved[place] = true;
        }
        if is_new {
            robot.heard = Some(time);
            robot.up_to = hi.min(robot.notified_limit);
        }
        robot.up_to = robot.up_to.max(robot.arc_length);
        Ok(())
    }

    /// Takes a message that a robot is not on its path but at `at` \[m\]. The other robots keep away from all places that it can reach, and
    /// stop if they have been allowed to go near these. `age` is the age of the message \[s\]; it is ignored if a newer one is known.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`], [`RequestError::Invalid`].
    pub fn report_off_path(&mut self, name: &str, at: [f64; 2], age: f64, now: f64) -> Result<(), RequestError> {
        self.works()?;
        let place = self.robot_index(name)?;
        // One further away than any path can be is taken: nobody knows where the robot is, and everybody stops.
        if at.iter().any(|value| !value.is_finite()) {
            return Err(RequestError::invalid(format!("{at:?} is no place")));
        }
        let time = time(age, now)?;
        self.counts.positions += 1;
        self.is_alive(place, now);
        let begun = self.begun(now);
        if is_new(&self.robots[place], time, begun) {
            self.alarm(place, Some(Alarm::Off { x: at[0], y: at[1] }), time);
        }
        Ok(())
    }

    /// Takes what a robot does where it stands, in words; `None`: nothing that would keep it. If it does not advance, this is the reason.
    pub(crate) fn set_doing(&mut self, name: &str, doing: Option<String>) {
        if let Ok(place) = self.robot_index(name) {
            self.robots[place].doing = doing;
        }
    }

    /// The first time that it was told: what is in the journal that it was restored from is older.
    pub(super) fn begun(&mut self, now: f64) -> f64 {
        *self.begun.get_or_insert(now)
    }

    fn is_alive(&mut self, place: usize, now: f64) {
        if self.robots[place].away {
            let name = self.robots[place].name.clone();
            self.comes_back(&name);
        }
        let robot = &mut self.robots[place];
        robot.alive = Some(now);
        if std::mem::take(&mut robot.silent) {
            self.events.push(SupervisorEvent::Heard { robot: robot.name.clone() });
        }
    }

    /// Something is wrong with a robot, or no longer, as it said at a time that is not before what is known of it.
    pub(super) fn alarm(&mut self, place: usize, alarm: Option<Alarm>, heard: f64) {
        let robot = &mut self.robots[place];
        let same = |(a, b): (&Alarm, &Alarm)| std::mem::discriminant(a) == std::mem::discriminant(b);
        if robot.alarm.is_none() && alarm.is_none() {
            return;
        }
        if robot.alarm.as_ref().zip(alarm.as_ref()).is_some_and(same) {
            // Still wrong, perhaps elsewhere: no news, and after a restart it may be anywhere until it is heard.
            (robot.heard, robot.alarm) = (Some(heard), alarm);
            return;
        }
        let name = robot.name.clone();
        match &alarm {
            Some(alarm) => {
                self.counts.alarms += u64::from(robot.alarm.is_none());
                robot.heard = Some(heard);
                self.events.push(SupervisorEvent::Alarm { robot: name.clone(), alarm: alarm.clone() });
            }
            None => self.events.push(SupervisorEvent::Clear { robot: name.clone() }),
        }
        robot.alarm.clone_from(&alarm);
        self.entries.push(JournalEntry::Alarm { robot: name, alarm });
        self.hazards = true;
    }

    /// Tells of robots that have not been heard for long.
    pub(super) fn note_silence(&mut self, now: f64) {
        for robot in self.robots.iter_mut().filter(|robot| !robot.away) {
            let since = now - *robot.alive.get_or_insert(now);
            if since > self.settings.report_timeout && !robot.silent {
                robot.silent = true;
                self.events.push(SupervisorEvent::Silent { robot: robot.name.clone(), since });
            }
        }
    }
}

/// When a message was true \[s\].
fn time(age: f64, now: f64) -> Result<f64, RequestError> {
    match (0.0..=1e6).contains(&age) {
        true => Ok(now - age),
        false => Err(RequestError::invalid(format!("age: {age} is out of range; allowed is 0 to 1000000"))),
    }
}

/// Whether a message of this time is about what is so now: it is not older than what is known of the robot. An alarm that it had when the
/// supervisor was started is as old as that, because nobody knows when it was seen last.
fn is_new(robot: &SupervisedRobot, time: f64, begun: f64) -> bool {
    robot.heard.or(robot.alarm.as_ref().map(|_| begun)).is_none_or(|known| time >= known)
}

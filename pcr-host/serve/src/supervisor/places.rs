//! Reports of robots about their places.

use super::Supervisor;
use crate::course::FAR;
use crate::entry::Entry;
use crate::event::Event;
use crate::fault::Fault;
use crate::robot::{Alarm, ROOM};
use serde::{Deserialize, Serialize};

/// Who has not gone further than this has not moved \[m\].
const STIR: f64 = 1e-3;

/// A message of a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Whose.
    pub robot: String,
    /// Number of the path along which it counts. That of an older path says no more than that the robot is alive.
    pub path: u64,
    /// It was between these lengths of the path \[m\], surely.
    pub at: [f64; 2],
    /// How long ago \[s\].
    #[serde(default)]
    pub age: f64,
}

impl Supervisor {
    /// Takes a message about a position. Messages may be lost, late and repeated: of the lower ends the largest counts.
    ///
    /// # Errors
    /// [`Fault::NoSuchRobot`], [`Fault::NoSuchPath`] for a path that it does not have yet, [`Fault::Invalid`].
    pub fn position(&mut self, report: &Report, now: f64) -> Result<(), Fault> {
        self.works()?;
        let place = self.place(&report.robot)?;
        let (Report { at: [lo, hi], age, .. }, robot) = (report, &self.robots[place]);
        if !(lo.is_finite() && hi.is_finite() && lo <= hi) {
            return Err(Fault::invalid(format!("at: {lo} to {hi} is no interval")));
        }
        if !(0.0..=1e6).contains(age) {
            return Err(Fault::invalid(format!("age: {age} is out of range; allowed is 0 to 1000000")));
        }
        if report.path > robot.path {
            return Err(Fault::NoSuchPath { path: robot.path });
        }
        self.counts.positions += 1;
        self.is_alive(place, now);
        if report.path < self.robots[place].path {
            self.counts.outdated += 1;
            return Ok(());
        }
        let told = self.robots[place].told;
        if *hi > told + self.robots[place].abilities.margin + ROOM {
            self.alarm(place, Some(Alarm::Beyond { told, at: *hi }), now - age);
            return Ok(());
        }
        // One from before it was seen that something is wrong says nothing of what is so now.
        if self.robots[place].heard.is_none_or(|heard| now - age >= heard) {
            self.alarm(place, None, now);
        }
        let robot = &mut self.robots[place];
        // Whoever stands at its end has not left what is there, whatever rounding says of where that ends.
        let lo = lo.min(robot.told).min(robot.course.length() - ROOM);
        if lo > robot.at {
            if lo > robot.at + STIR {
                (robot.moved, robot.stands) = (Some(now), false);
            }
            robot.at = lo;
            self.unsaved[place] = true;
        }
        if robot.heard.is_none_or(|heard| now - age >= heard) {
            robot.heard = Some(now - age);
            robot.up_to = hi.min(robot.told);
        }
        robot.up_to = robot.up_to.max(robot.at);
        Ok(())
    }

    /// Takes a message that a robot is not on its path, but here: the others keep away from wherever it can go, and stop where they
    /// have been allowed to come near.
    ///
    /// # Errors
    /// [`Fault::NoSuchRobot`], [`Fault::Invalid`].
    pub fn off(&mut self, name: &str, at: [f64; 2], now: f64) -> Result<(), Fault> {
        self.works()?;
        let place = self.place(name)?;
        if at.iter().any(|value| !value.is_finite() || value.abs() > FAR) {
            return Err(Fault::invalid(format!("{at:?} is no place")));
        }
        self.counts.positions += 1;
        self.is_alive(place, now);
        self.alarm(place, Some(Alarm::Off { x: at[0], y: at[1] }), now);
        Ok(())
    }

    fn is_alive(&mut self, place: usize, now: f64) {
        let robot = &mut self.robots[place];
        robot.alive = Some(now);
        if std::mem::take(&mut robot.silent) {
            self.events.push(Event::Heard { robot: robot.name.clone() });
        }
    }

    /// Something is wrong with a robot, or no longer.
    fn alarm(&mut self, place: usize, alarm: Option<Alarm>, heard: f64) {
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
                self.events.push(Event::Alarm { robot: name.clone(), alarm: alarm.clone() });
            }
            None => self.events.push(Event::Clear { robot: name.clone() }),
        }
        robot.alarm.clone_from(&alarm);
        self.entries.push(Entry::Alarm { robot: name, alarm });
        self.hazards = true;
    }

    /// Tells of robots that have not been heard for long.
    pub(super) fn note_silence(&mut self, now: f64) {
        for robot in &mut self.robots {
            let since = now - *robot.alive.get_or_insert(now);
            if since > self.settings.silence && !robot.silent {
                robot.silent = true;
                self.events.push(Event::Silent { robot: robot.name.clone(), since });
            }
        }
    }
}

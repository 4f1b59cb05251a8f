//! How far robots may go on. A hold is computed again only if the robot that is waited for has moved, and only for
//! robots that would go further; other robots are not affected.

use super::alarms::Limit;
use super::{Supervisor, fleet};
use crate::entry::Entry;
use crate::event::Event;
use crate::fault::Fault;
use crate::robot::Wait;
use pcr_core::Hold;

impl Supervisor {
    /// Tells the supervisor that a robot cannot stop before this length of its path \[m\]. If it may go there, it is told so at once.
    ///
    /// # Errors
    /// [`Fault::NoSuchRobot`].
    pub fn stops_at(&mut self, name: &str, length: f64) -> Result<(), Fault> {
        let place = self.place(name)?;
        self.robots[place].next = length;
        Ok(())
    }

    /// Sends holds to all robots that need to go on and may.
    pub(super) fn release(&mut self, limits: &[Limit]) {
        let wanting: Vec<usize> = (0..self.robots.len()).filter(|&place| self.wants(place)).collect();
        let stale: Vec<usize> = wanting.iter().copied().filter(|&place| self.is_stale(place)).collect();
        if !stale.is_empty() {
            self.evaluate(&stale);
        }
        for place in wanting {
            self.tell(place, limits.get(place));
        }
    }

    fn wants(&self, place: usize) -> bool {
        let robot = &self.robots[place];
        robot.alarm.is_none() && robot.stopped.is_none() && robot.wanted(self.settings.lookahead) > robot.granted
    }

    /// Whether the hold of a robot is before the length that it needs next, and may have changed.
    fn is_stale(&self, place: usize) -> bool {
        let robot = &self.robots[place];
        let Some(Wait { hold, by }) = robot.hold else { return true };
        let bound = hold.length(robot.course.length()).unwrap_or(robot.granted);
        bound < robot.wanted(self.settings.lookahead) && by.is_some_and(|(by, at)| self.robots[by].at > at)
    }

    fn evaluate(&mut self, places: &[usize]) {
        let progress = self.progress();
        let fleet = fleet(&self.robots);
        let wait = |place| self.orders.wait(fleet.as_ref().ok()?, place, &progress).ok();
        let holds: Vec<_> = places.iter().map(|&place| wait(place)).collect();
        self.counts.evaluations += places.len() as u64;
        for (&place, hold) in places.iter().zip(holds) {
            // The table belongs to these robots, so this never fails; if it did, the robots would stop.
            let (hold, by) = hold.unwrap_or((Hold::Inside, None));
            self.robots[place].hold = Some(Wait { hold, by: by.map(|by| (by, progress[by].at.lo)) });
        }
    }

    /// When the journal is written anyway, raises ceilings that will be needed soon, which saves writes.
    pub(super) fn raise_ceilings(&mut self) {
        let spare = self.settings.spare;
        for robot in &mut self.robots {
            let ceiling = (robot.granted + spare).min(robot.course.length());
            // Not after a restart, as long as `told` is the old ceiling, beyond what was granted since.
            if robot.told == robot.granted && robot.granted > robot.at && robot.ceiling + 0.5 * spare < ceiling {
                robot.ceiling = ceiling;
                let (name, path) = (robot.name.clone(), robot.path);
                self.entries.push(Entry::Ceiling { robot: name, path, ceiling });
            }
        }
    }

    fn tell(&mut self, place: usize, limit: Option<&Limit>) {
        let Self { robots, settings, .. } = self;
        let robot = &robots[place];
        let Some(Wait { hold, by }) = robot.hold else { return };
        let end = robot.course.length();
        let mut bound = hold.length(end).unwrap_or(robot.granted);
        if let Some(Limit { at: Some(at), .. }) = limit {
            bound = bound.min(*at);
        }
        let wanted = robot.wanted(settings.lookahead);
        let granted = bound.min(wanted);
        let before = robot.granted;
        let is_worth = granted >= before + settings.step || (granted > before && granted >= bound.min(end));
        if !is_worth {
            return;
        }
        let waits_for = by.filter(|_| granted >= bound && bound < end).map(|(by, _)| robots[by].name.clone());
        let robot = &mut robots[place];
        robot.granted = granted;
        robot.told = robot.told.max(granted);
        if granted > robot.ceiling {
            robot.ceiling = (granted + settings.spare).min(end);
            let (name, path, ceiling) = (robot.name.clone(), robot.path, robot.ceiling);
            self.entries.push(Entry::Ceiling { robot: name, path, ceiling });
        }
        self.counts.holds += 1;
        self.events.push(Event::Hold { robot: robot.name.clone(), path: robot.path, hold: granted, waits_for });
    }
}

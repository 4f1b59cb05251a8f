//! How far robots may go on. A hold is computed again only if the robot that is waited for has moved, or the robot itself, which may have
//! passed what kept it, and only for robots that would go further; other robots are not affected.

use super::alarms::AlarmLimit;
use super::{Supervisor, fleet};
use crate::event::SupervisorEvent;
use crate::journal_entry::JournalEntry;
use crate::request_error::RequestError;
use crate::robot::{PrecedenceLimit, SupervisedRobot};
use pcr_core::MovementAuthority;

impl Supervisor {
    /// Tells the supervisor that a robot cannot stop before this length of its path \[m\]. If it may go there, it is told so at once.
    ///
    /// # Errors
    /// [`RequestError::NoSuchRobot`].
    pub fn stops_at(&mut self, name: &str, length: f64) -> Result<(), RequestError> {
        let place = self.robot_index(name)?;
        self.robots[place].next = length;
        Ok(())
    }

    /// Sends holds to all robots that need to go on and may.
    pub(super) fn release(&mut self, limits: &[AlarmLimit]) {
        let wanting: Vec<usize> = (0..self.robots.len()).filter(|&place| self.wants(place)).collect();
        let stale: Vec<usize> = wanting.iter().copied().filter(|&place| self.is_stale(place)).collect();
        if !stale.is_empty() {
            self.evaluate(&stale);
        }
        for place in wanting {
            self.notify_authority(place, limits.get(place));
        }
    }

    fn wants(&self, place: usize) -> bool {
        let robot = &self.robots[place];
        robot.alarm.is_none()
            && !robot.away
            && robot.stopped.is_none()
            && robot.wanted(self.settings.lookahead, self.settings.position_uncertainty) > robot.granted
    }

    /// Whether the hold of a robot is before the length that it needs next, and may have changed.
    fn is_stale(&self, place: usize) -> bool {
        let robot = &self.robots[place];
        let Some(PrecedenceLimit { hold, waits_for: by, at }) = robot.authority else { return true };
        let bound = hold.length(robot.course.length()).unwrap_or(robot.granted);
        let have_moved = robot.arc_length > at || by.is_some_and(|(by, at)| self.robots[by].arc_length > at);
        have_moved && bound < robot.wanted(self.settings.lookahead, self.settings.position_uncertainty)
    }

    fn evaluate(&mut self, places: &[usize]) {
        let progress = self.progress();
        let fleet = fleet(&self.robots);
        let wait = |place| self.orders.wait(fleet.as_ref().ok()?, place, &progress).ok();
        let holds: Vec<_> = places.iter().map(|&place| wait(place)).collect();
        self.counts.evaluations += places.len() as u64;
        for (&place, hold) in places.iter().zip(holds) {
            // The table belongs to these robots, so this never fails; if it did, the robots would stop.
            let (hold, by) = hold.unwrap_or((MovementAuthority::Inside, None));
            let by = by.map(|by| (by, progress[by].at.lo));
            self.robots[place].authority = Some(PrecedenceLimit { hold, waits_for: by, at: progress[place].at.lo });
        }
    }

    /// When the journal is written anyway, raises ceilings that will be needed soon, which saves writes, and lowers those that
    /// lie where a robot may no longer come.
    ///
    /// After a restart the ceiling counts as told. So it has to be at or above every hold that was told, and this has to be
    /// on the disk before the hold is told: `tell` raises the ceiling with the hold, in the frame after which the hold is told.
    /// And it must not be further than the robot could be told by the present orders: a robot that was added beyond the hold, or
    /// a mission that goes first there, would find the way taken after a restart, by a robot that stands before it, and wait for
    /// ever. `highest` bounds both: it is at least `told`, in which every hold is that was decided, also those that are still on
    /// their way to the disk. So a ceiling may be lowered to it. Frames are read in the order in which they were decided, each of
    /// them as a whole, and the last ceiling counts. So whatever frame is the last one on the disk, its ceilings are at or above
    /// the holds that were told by then, and match its orders, because they are lowered in the frame with the new orders.
    pub(super) fn set_ceilings(&mut self) {
        let is_ahead = |robot: &SupervisedRobot| robot.ceiling > robot.notified_limit && robot.authority.is_none();
        let stale: Vec<usize> = (0..self.robots.len()).filter(|&place| is_ahead(&self.robots[place])).collect();
        if !stale.is_empty() {
            self.evaluate(&stale);
        }
        for place in 0..self.robots.len() {
            let (robot, highest) = (&self.robots[place], self.highest(place));
            // Not raised after a restart, as long as `told` is the old ceiling, beyond what was granted since.
            let goes = robot.notified_limit == robot.granted && robot.granted > robot.arc_length;
            if robot.ceiling > highest || (goes && robot.ceiling + 0.5 * self.settings.persisted_reserve < highest) {
                self.set_ceiling(place, highest);
            }
        }
    }

    /// Lowers all ceilings to what was told, because nothing more will be told.
    pub(super) fn lower_ceilings(&mut self) {
        for place in 0..self.robots.len() {
            if self.robots[place].ceiling > self.robots[place].notified_limit {
                self.set_ceiling(place, self.robots[place].notified_limit);
            }
        }
    }

    /// The furthest ceiling of a robot: `spare` beyond its hold, but not further than it may be told now, and at least what it
    /// was told. As long as a robot is not where it may be, there is nothing to spare.
    fn highest(&self, place: usize) -> f64 {
        let robot = &self.robots[place];
        let bound = robot
            .authority
            .filter(|_| !self.hazards && !robot.away)
            .and_then(|wait| wait.hold.length(robot.course.length()));
        bound.map_or(robot.notified_limit, |bound| {
            let spare = robot.granted + self.settings.persisted_reserve;
            bound.min(spare).min(self.area_limit(robot)).max(robot.notified_limit)
        })
    }

    fn set_ceiling(&mut self, place: usize, ceiling: f64) {
        let robot = &mut self.robots[place];
        robot.ceiling = ceiling;
        self.entries.push(JournalEntry::Ceiling {
            robot: robot.name.clone(),
            path: robot.path,
            persisted_limit: ceiling,
        });
    }

    fn notify_authority(&mut self, place: usize, limit: Option<&AlarmLimit>) {
        let Self { robots, settings, .. } = self;
        let robot = &robots[place];
        let Some(PrecedenceLimit { hold, waits_for: by, .. }) = robot.authority else { return };
        let end = robot.course.length();
        let mut bound = hold.length(end).unwrap_or(robot.granted);
        if let Some(AlarmLimit { arc_length: Some(at), .. }) = limit {
            bound = bound.min(*at);
        }
        let wanted = robot.wanted(settings.lookahead, settings.position_uncertainty);
        let granted = bound.min(wanted);
        let before = robot.granted;
        // A slow robot never needs much more than it has.
        let step = settings.step.min(0.25 * (wanted - robot.up_to));
        let is_worth = granted > before && (granted >= before + step || granted >= bound.min(end));
        if !is_worth {
            return;
        }
        let waits_for = by.filter(|_| granted >= bound && bound < end).map(|(by, _)| robots[by].name.clone());
        let robot = &mut robots[place];
        robot.granted = granted;
        robot.notified_limit = robot.notified_limit.max(granted);
        let event = SupervisorEvent::Hold { robot: robot.name.clone(), path: robot.path, hold: granted, waits_for };
        if granted > robot.ceiling {
            self.set_ceiling(place, self.highest(place));
        }
        self.counts.holds += 1;
        self.events.push(event);
    }
}

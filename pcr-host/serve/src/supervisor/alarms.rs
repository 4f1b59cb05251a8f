//! Robots that are not where they may be: all others keep away from everywhere that such a robot can have reached.

use super::{PAUSE, StandingPlace, Supervisor, fleet};
use crate::event::SupervisorEvent;
use crate::owned_path::{OwnedPath, StartPose};
use crate::robot::{Alarm, ROOM, SupervisedRobot};
use pcr_core::{Ecm, MovementAuthority, PassingState, RegionRef};
use pcr_planning::fleet::ConvexBody;

/// A limit to how far a robot may go, whatever its orders say, because another one is not where it may be.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AlarmLimit {
    /// Length of the path \[m\]; `None`: no limit.
    pub(super) arc_length: Option<f64>,
    by: LimitCause,
}

/// Because of whom a robot may go no further.
#[derive(Clone, Copy, Debug)]
pub(super) enum LimitCause {
    /// The robot with this index, which is not where it may be.
    Robot(usize),
    /// A vehicle that has not said where it stands, by its index among those.
    Unplaced(usize),
    /// A closed area, by its index among those on the path of the robot.
    Area(usize),
}

impl Default for LimitCause {
    fn default() -> Self {
        Self::Robot(0)
    }
}

impl AlarmLimit {
    pub(super) fn lower(&mut self, at: f64, by: LimitCause) {
        if self.arc_length.is_none_or(|before| at < before) {
            *self = Self { arc_length: Some(at), by };
        }
    }
}

impl Supervisor {
    /// The limits of all robots; robots that have been allowed to go beyond are stopped. Empty if there is no alarm.
    pub(super) fn limits(&mut self, now: f64) -> Vec<AlarmLimit> {
        if !self.hazards && !self.is_any_shut {
            return Vec::new();
        }
        // A robot whose limit is no further than this beyond its hold waits for it \[m\].
        let near = self.settings.step;
        let by_it = |robot: &SupervisedRobot, at: f64| robot.granted >= at - near;
        let mut limits = vec![AlarmLimit::default(); self.robots.len()];
        self.lost(now, &mut limits);
        self.unordered(&mut limits);
        self.note_returned(now);
        self.unsaid(&mut limits);
        self.closed_areas(&mut limits);
        self.hazards = self.robots.iter().any(|robot| robot.alarm.is_some())
            || self.paused
            || self.unplaced.values().any(|vehicle| !vehicle.places.is_empty());
        for (place, limit) in limits.iter().enumerate() {
            let robot = &self.robots[place];
            // A robot that stands needs no `stop`. At the end of its path its length stays a little before that.
            let by = limit
                .arc_length
                .filter(|at| *at < robot.notified_limit && robot.notified_limit > robot.arc_length + 2.0 * ROOM);
            let by = by.and_then(|_| match limit.by {
                LimitCause::Robot(by) => Some(self.robots[by].name.clone()),
                LimitCause::Unplaced(by) => self.unplaced.keys().nth(by).cloned(),
                LimitCause::Area(index) => robot.areas.as_ref()?.name(index).map(str::to_owned),
            });
            // Closed areas are looked at as long as there are any.
            let is_hazard = by.is_some() && !matches!(limit.by, LimitCause::Area(_));
            // That one is to be known first: it has to go on being kept away from when the pause ends.
            let by = by.or_else(|| (self.paused && !robot.away).then(|| PAUSE.to_owned()));
            // It waits there once it has come up to it.
            let closure = match (limit.arc_length, limit.by) {
                (Some(at), LimitCause::Area(index)) if by_it(robot, at) => {
                    robot.areas.as_ref().and_then(|areas| areas.name(index)).map(str::to_owned)
                }
                _ => None,
            };
            self.hazards |= is_hazard;
            let robot = &mut self.robots[place];
            let name = robot.name.clone();
            match (&robot.stopped, &by) {
                (None, Some(by)) => self.events.push(SupervisorEvent::Stop { robot: name, by: by.clone() }),
                (Some(_), None) => self.events.push(SupervisorEvent::Go { robot: name }),
                _ => {}
            }
            robot.stopped = by;
            robot.closure = closure;
        }
        limits
    }

    /// Limits because of robots with alarms: such a robot may be anywhere that its speed takes it from its last position.
    fn lost(&self, now: f64, limits: &mut [AlarmLimit]) {
        for (place, robot) in self.robots.iter().enumerate() {
            let (at, spread) = match &robot.alarm {
                None => continue,
                Some(Alarm::Off { x, y }) => ([*x, *y], 0.0),
                Some(Alarm::Beyond { at, .. }) => {
                    let pose = robot.course.pose(*at);
                    ([pose.x, pose.y], (at - robot.arc_length).max(0.0))
                }
                Some(Alarm::Back { between: [lo, hi], .. }) => {
                    let pose = robot.course.pose(*hi);
                    ([pose.x, pose.y], hi - lo)
                }
            };
            // After a restart it may be anywhere until it sends a message: no disc is that large, so all robots stop.
            let gone = robot.heard.map_or(f64::INFINITY, |heard| robot.abilities.speed * (now - heard).max(0.0));
            let radius = robot.abilities.radius_with_margin() + spread + gone;
            for (other, limit) in limits.iter_mut().enumerate().filter(|(other, _)| *other != place) {
                if let Some(at) = self.meets(other, at, radius) {
                    limit.lower(at, LimitCause::Robot(place));
                }
            }
        }
    }

    /// Limits because of vehicles that have not said where they stand: each of the places where such a vehicle may stand counts as taken.
    fn unsaid(&self, limits: &mut [AlarmLimit]) {
        for (index, vehicle) in self.unplaced.values().enumerate() {
            for place in &vehicle.places {
                for (other, limit) in limits.iter_mut().enumerate() {
                    if self.is_near(other, place)
                        && let Some(at) = self.meets(other, [place.x, place.y], place.radius)
                    {
                        limit.lower(at, LimitCause::Unplaced(index));
                    }
                }
            }
        }
    }

    /// Whether a robot can come to a place on the rest of its path, by the length of that alone.
    fn is_near(&self, place: usize, there: &StandingPlace) -> bool {
        let robot = &self.robots[place];
        let pose = robot.course.pose(robot.arc_length);
        let rest = robot.course.length() - robot.arc_length + robot.abilities.radius_with_margin();
        (pose.x - there.x).hypot(pose.y - there.y) <= rest + there.radius + ROOM
    }

    /// The first length from where a robot is at which it would touch a disc.
    fn meets(&self, place: usize, [x, y]: [f64; 2], radius: f64) -> Option<f64> {
        let robot = &self.robots[place];
        let found = || -> Option<Option<f64>> {
            let disc = OwnedPath::new(StartPose { x, y, heading: 0.0 }, Vec::new()).ok()?;
            let body = ConvexBody::Disc(radius);
            let fleet = [robot.motion().ok()?, disc.motion(&body).ok()?];
            let ecm = Ecm::grown(&fleet).ok()?;
            let regions = ecm.pair(&fleet, 0, 1).ok()?;
            let ahead = regions.map(|region| region.length()).filter(|length| length.hi >= robot.arc_length);
            Some(ahead.map(|length| length.lo.max(robot.arc_length) - ROOM).reduce(f64::min))
        };
        // If it cannot be computed, the robot counts as near.
        found().unwrap_or(Some(robot.arc_length - ROOM))
    }

    /// A robot that was added where others may come: nothing is decided with it. Where one of them has been already,
    /// nothing is left to decide.
    fn unordered(&self, limits: &mut [AlarmLimit]) {
        if !self.orders.decisions().any(|decision| decision.pass == PassingState::Undecided) {
            return;
        }
        let fleet = fleet(&self.robots);
        for (place, limit) in limits.iter_mut().enumerate() {
            let row = fleet.as_ref().ok().and_then(|fleet| self.orders.row(fleet, place).ok());
            let Some(row) = row else {
                // If it cannot be told with whom nothing is decided, it may be with anybody near.
                limit.lower(self.robots[place].arc_length - ROOM, LimitCause::Robot(place));
                continue;
            };
            let undecided = row.filter(|(_, _, pass)| *pass == PassingState::Undecided).map(|(_, region, _)| region);
            let left = |region: &RegionRef<'_, f64>| {
                let [own, their] = [place, region.other()].map(|robot| self.robots[robot].arc_length);
                own > region.length().hi || their > region.other_length().hi
            };
            for region in undecided.filter(|region| !left(region)) {
                match region.hold(0.0, 0.0) {
                    MovementAuthority::Free => {}
                    MovementAuthority::At(hold) => limit.lower(hold, LimitCause::Robot(region.other())),
                    MovementAuthority::Inside => {
                        limit.lower(self.robots[place].arc_length - ROOM, LimitCause::Robot(region.other()))
                    }
                }
            }
        }
    }
}

impl Supervisor {
    /// A robot that was away and stands where others may go already is not where it may be: that is an alarm, beside the stop of those others,
    /// until it says that it stands there.
    fn note_returned(&mut self, now: f64) {
        let returned = |robot: &&SupervisedRobot| robot.returned;
        if !self.robots.iter().any(|robot| returned(&robot)) {
            return;
        }
        let fleet = fleet(&self.robots);
        let is_in_the_way = |place: &usize| {
            let row = fleet.as_ref().ok().and_then(|fleet| self.orders.row(fleet, *place).ok());
            let Some(mut row) = row else { return true };
            row.any(|(_, region, pass)| {
                let other = &self.robots[region.other()];
                let length = region.other_length();
                pass == PassingState::Undecided && other.arc_length <= length.hi && other.notified_limit >= length.lo
            })
        };
        let places = (0..self.robots.len()).filter(|&place| self.robots[place].returned);
        let found: Vec<usize> = places.filter(is_in_the_way).collect();
        drop(fleet);
        self.robots.iter_mut().for_each(|robot| robot.returned = false);
        for place in found {
            let StartPose { x, y, .. } = self.robots[place].course.start();
            self.alarm(place, Some(Alarm::Off { x, y }), now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::journal_entry::NullStore;
    use crate::owned_path::PathElement;
    use crate::robot::RobotTraits;
    use crate::supervisor::{MissionRequest, SupervisorConfig};

    #[test]
    fn where_the_table_is_not_that_of_the_robots_nobody_goes_on() {
        let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(NullStore));
        let can = RobotTraits { radius: 0.25, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };
        own.add("east", can.clone(), StartPose { x: -3.0, y: 0.0, heading: 0.0 }).unwrap();
        let path = vec![PathElement::Line { length: 6.0 }];
        let (robot, mission) = ("east".into(), "1".into());
        own.mission(
            &MissionRequest { robot, mission, after: None, expected_path: None, any_heading: false, start: None, path },
            0.0,
        )
        .unwrap();
        own.settle(0.0).unwrap();
        assert!(own.robots[0].granted > 0.0);
        own.add("new", can, StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
        own.robots[1].body = ConvexBody::Disc(0.3);
        let limits = own.limits(1.0);
        assert!(
            limits
                .iter()
                .zip(&own.robots)
                .all(|(limit, robot)| limit.arc_length.is_some_and(|at| at < robot.arc_length)),
            "{limits:?}"
        );
        assert!(own.robots[0].stopped.is_some());
    }
}

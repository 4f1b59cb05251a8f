//! Areas on the paths of robots: closed ones, into which nobody gets authority, and those where the speed is limited. Some are for all robots,
//! others for one. On which lengths of a path an area is does not change while the robot is on it, so it is computed once for each path.

use super::Supervisor;
use super::alarms::{AlarmLimit, LimitCause};
use crate::closed_area::{AreaLengths, AreasOnPath, SpeedLimit};
use crate::event::SupervisorEvent;
use crate::owned_path::{OwnedPath, StartPose, extent};
use crate::request_error::RequestError;
use crate::robot::{ROOM, SupervisedRobot};
use pcr_core::{Ecm, Interval};
use pcr_formats::footprint::Footprint;
use pcr_planning::fleet::ConvexBody;

/// An area.
#[derive(Clone, Debug)]
pub(super) struct Area {
    name: String,
    /// Largest speed in it \[m/s\]; `None`: nobody may enter.
    speed: Option<f64>,
    /// What moves along what: all that these touch is in it.
    bodies: Vec<(OwnedPath, ConvexBody)>,
    /// The disc about a point that contains it \[m\], if that is known.
    within: Option<([f64; 2], f64)>,
}

impl Area {
    /// All that is nearer to one of these paths than a radius \[m\].
    ///
    /// # Errors
    /// [`RequestError::Invalid`] for a path or a radius out of range.
    pub(super) fn along(
        name: String,
        speed: Option<f64>,
        courses: Vec<OwnedPath>,
        radius: f64,
    ) -> Result<Self, RequestError> {
        let bodies = courses.into_iter().map(|course| (course, ConvexBody::Disc(radius))).collect();
        Self { name, speed, bodies, within: None }.checked()
    }

    /// The inside of a polygon with these corners \[m\].
    ///
    /// # Errors
    /// [`RequestError::Invalid`] for corners that are no polygon, or out of range.
    pub(super) fn within(name: String, speed: Option<f64>, corners: &[[f64; 2]]) -> Result<Self, RequestError> {
        let &[x, y] = corners.first().ok_or_else(|| RequestError::invalid("a polygon without corners"))?;
        let polygon = Footprint::new(corners.iter().map(|corner| [corner[0] - x, corner[1] - y]).collect());
        let polygon = polygon.map_err(RequestError::invalid)?;
        let place = |part: Footprint| {
            let stands = OwnedPath::new(StartPose { x, y, heading: 0.0 }, Vec::new())?;
            Ok((stands, ConvexBody::of_vehicle(Some(&part), 0.0)?))
        };
        let bodies = polygon.parts().map(place).collect::<Result<_, pcr_core::InvalidInput>>();
        let bodies = bodies.map_err(RequestError::invalid)?;
        Self { name, speed, bodies, within: Some(([x, y], polygon.circumscribed_radius())) }.checked()
    }

    /// Checks that all of it can be compared with paths.
    fn checked(self) -> Result<Self, RequestError> {
        for (course, body) in &self.bodies {
            course.motion(body).map_err(RequestError::invalid)?;
        }
        Ok(self)
    }

    /// The lengths of a path on which a body touches it; `None` if they cannot be computed.
    pub(super) fn lengths(&self, course: &OwnedPath, body: &ConvexBody) -> Option<Vec<Interval<f64>>> {
        let mut lengths = Vec::new();
        if let Some(([x, y], radius)) = self.within {
            let start = course.start();
            let near = (extent(course.shapes()) + body.reach() + radius) * (1.0 + 1e-9) + ROOM;
            if (start.x - x).hypot(start.y - y) > near {
                return Some(lengths);
            }
        }
        for (own, own_body) in &self.bodies {
            let fleet = [course.motion(body).ok()?, own.motion(own_body).ok()?];
            let ecm = Ecm::grown(&fleet).ok()?;
            lengths.extend(ecm.pair(&fleet, 0, 1).ok()?.map(|region| region.length()));
        }
        Some(lengths)
    }

    /// Whether nobody may enter.
    pub(super) fn is_shut(&self) -> bool {
        self.speed.is_none()
    }
}

/// The length of a robot's path at which it would come into an area, from where it is; `None` if it never does, or if it is in it.
pub(super) fn entry(lengths: &AreaLengths, robot: &SupervisedRobot) -> Option<f64> {
    let Some(lengths) = lengths else { return Some(robot.arc_length) };
    let ahead = lengths.iter().filter(|length| length.lo > robot.arc_length);
    ahead.map(|length| length.lo).reduce(f64::min)
}

impl Supervisor {
    /// The areas of a robot: those for all, and its own.
    fn areas_of(&self, robot: &str) -> impl Iterator<Item = &Area> {
        let own = self.zones.get(robot).into_iter().flatten();
        self.closures.values().map(|closed| &closed.is).chain(own)
    }

    /// The areas are others than before.
    pub(super) fn areas_changed(&mut self) {
        let mut all = self.closures.values().map(|closed| &closed.is).chain(self.zones.values().flatten());
        let [mut is_any_shut, mut is_any_slow] = [false; 2];
        all.by_ref().for_each(|area| *(if area.is_shut() { &mut is_any_shut } else { &mut is_any_slow }) = true);
        (self.is_any_shut, self.is_any_slow) = (is_any_shut, is_any_slow);
        self.closure_revision += 1;
        self.hazards = true;
    }

    /// The first closed area into which a path of a robot leads beyond what it has been allowed already, except where the robot is in it.
    pub(super) fn closed_on(
        &self,
        robot: &str,
        course: &OwnedPath,
        body: &ConvexBody,
        [at, told]: [f64; 2],
    ) -> Option<&str> {
        let leads_into = |area: &&Area| match area.lengths(course, body) {
            Some(lengths) => lengths.iter().any(|length| length.lo > at && length.lo >= told - ROOM),
            None => true,
        };
        self.areas_of(robot).filter(|area| area.is_shut()).find(leads_into).map(|area| area.name.as_str())
    }

    /// Limits because of closed areas.
    pub(super) fn closed_areas(&mut self, limits: &mut [AlarmLimit]) {
        for (place, limit) in limits.iter_mut().enumerate() {
            let of = (self.robots[place].path, self.closure_revision);
            let known = self.robots[place].areas.take().filter(|areas| areas.of == of);
            let robot = &self.robots[place];
            let shut = known.map(|areas| areas.shut).unwrap_or_else(|| {
                let shut = self.areas_of(&robot.name).filter(|area| area.is_shut());
                let lengths = shut.map(|area| (area.name.clone(), area.lengths(&robot.course, &robot.body)));
                lengths.filter(|(_, lengths)| lengths.as_ref().is_none_or(|it| !it.is_empty())).collect()
            });
            let mut first: Option<f64> = None;
            for (index, (_, lengths)) in shut.iter().enumerate() {
                if let Some(entry) = entry(lengths, robot).map(|entry| entry - ROOM) {
                    limit.lower(entry, LimitCause::Area(index));
                    first = Some(first.map_or(entry, |first| first.min(entry)));
                }
            }
            self.robots[place].areas = Some(AreasOnPath { of, shut, limit: first });
        }
    }

    /// How far a robot may be told to go at most because of closed areas, as far as that is known without computing it \[m\].
    pub(super) fn area_limit(&self, robot: &SupervisedRobot) -> f64 {
        if !self.is_any_shut {
            return f64::INFINITY;
        }
        let known = robot.areas.as_ref().filter(|areas| areas.of == (robot.path, self.closure_revision));
        known.map_or(robot.notified_limit, |areas| areas.limit.unwrap_or(f64::INFINITY))
    }

    /// The limits of the speed on a path of a robot, by name and length. Where it cannot be computed, all of the path is limited.
    pub(crate) fn speed_limits(&self, robot: &str, course: &OwnedPath, body: &ConvexBody) -> Vec<SpeedLimit> {
        let limits = self.areas_of(robot).filter_map(|area| Some((area, area.speed?)));
        let limits = limits.flat_map(|(area, speed)| {
            let all = || vec![Interval::new(0.0, course.length())];
            let lengths = area.lengths(course, body).unwrap_or_else(all);
            let limit = move |length: Interval<f64>| SpeedLimit {
                closure: area.name.clone(),
                length: [length.lo.max(0.0), length.hi.min(course.length())],
                speed,
            };
            lengths.into_iter().map(limit)
        });
        limits.collect()
    }

    /// A number that changes whenever an area begins or ends.
    pub(crate) fn closure_revision(&self) -> u64 {
        self.closure_revision
    }

    /// Whether the speed is limited anywhere.
    pub(crate) fn limits_speed(&self) -> bool {
        self.is_any_slow
    }

    /// Tells robots where their speed is limited, before they get any authority there: on a new path, and when a limit begins or ends.
    pub(super) fn tell_speed_limits(&mut self) {
        for place in 0..self.robots.len() {
            let robot = &self.robots[place];
            let known = (robot.path, self.closure_revision);
            if robot.limits_at == Some(known) || !self.is_any_slow && robot.speed_limits.is_empty() {
                continue;
            }
            let limits = self.speed_limits(&robot.name, &robot.course, &robot.body);
            let is_new_path = robot.limits_at.is_none_or(|(path, _)| path != robot.path);
            let is_news = if is_new_path { !limits.is_empty() } else { limits != robot.speed_limits };
            if is_news {
                let (robot, path, limits) = (robot.name.clone(), robot.path, limits.clone());
                self.events.push(SupervisorEvent::Limits { robot, path, limits });
            }
            let robot = &mut self.robots[place];
            (robot.speed_limits, robot.limits_at) = (limits, Some(known));
        }
    }
}

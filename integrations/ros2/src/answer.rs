//! What follows from the paths: pairs with their conflicts, and authorities.

use crate::config::RobotConfig;
use crate::messages::{Header, MarkerArray, Position, Quaternion, SpatialPose, Time};
use crate::order::{Order, Place};
use crate::planned_path::PlannedPath;
use crate::refusal::Refusal;
use crate::report::{AuthoritiesReport, AuthorityReport, ConflictReport, ConflictsReport, PairReport};
use crate::robot_motion::RobotMotion;
use crate::{markers, order};
use pcr_core::{Encounter, Interval, Motion};
use pcr_rmf_mapf::TimedPose;

/// A robot, and its motion if its path was not refused.
pub(crate) struct Known<'a> {
    pub(crate) robot: &'a RobotConfig,
    pub(crate) motion: Result<RobotMotion, Refusal>,
}

impl<'a> Known<'a> {
    pub(crate) fn new(robot: &'a RobotConfig, path: Result<&PlannedPath, Refusal>, now: Time) -> Self {
        let motion = path.and_then(|path| RobotMotion::new(path, now, robot.footprint(), robot.margin));
        Self { robot, motion }
    }

    /// Why nothing is known.
    fn unknown(&self) -> Option<String> {
        self.motion.as_ref().err().map(|refusal| format!("{}: {refusal}", self.robot.name))
    }
}

/// The conflicts, authorities and markers that are published.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// Pairs and conflicts.
    pub conflicts: ConflictsReport,
    /// How far the robots may drive.
    pub authorities: AuthoritiesReport,
    /// Pictures of the conflicts.
    pub markers: MarkerArray,
}

/// A pose as it is published.
fn spatial(pose: TimedPose) -> SpatialPose {
    let [x, y] = pose.position;
    SpatialPose { position: Position { x, y, z: 0.0 }, orientation: Quaternion::heading(pose.yaw) }
}

impl Answer {
    /// `others` are refusals of robots that are not configured: whoever they are, they may be anywhere.
    /// `order` is that of these paths, if there is one already, and is left here otherwise: it does not change with time.
    pub(crate) fn new(
        known: &[Known<'_>],
        others: &[Refusal],
        order: &mut Option<Result<Order, String>>,
        header: Header,
    ) -> Self {
        let mut answer = Self::default();
        for (b, second) in known.iter().enumerate() {
            for first in &known[..b] {
                answer.pair([first, second], header.stamp);
            }
        }
        answer.authorities = authorities(known, others, order, &header);
        let robots: Vec<&RobotConfig> = known.iter().map(|known| known.robot).collect();
        answer.markers = markers::of(&robots, &answer.conflicts.conflicts, &header);
        answer.authorities.header = header.clone();
        answer.conflicts.header = header;
        answer
    }

    fn pair(&mut self, pair: [&Known<'_>; 2], now: Time) {
        let [robot_a, robot_b] = pair.map(|known| known.robot.name.clone());
        let found = conflicts(pair, now);
        let (state, reason) = match &found {
            Ok(found) if found.is_empty() => (PairReport::CLEAR, String::new()),
            Ok(_) => (PairReport::CONFLICT, String::new()),
            Err(reason) => (PairReport::UNKNOWN, reason.clone()),
        };
        self.conflicts.pairs.push(PairReport { robot_a, robot_b, state, reason });
        self.conflicts.conflicts.extend(found.into_iter().flatten());
    }
}

/// The motions of some robots, or why not.
fn motions<'a>(known: &[&'a Known<'_>]) -> Result<Vec<(&'a RobotMotion, Motion<'a, f64>)>, String> {
    let reasons: Vec<String> = known.iter().filter_map(|known| known.unknown()).collect();
    if !reasons.is_empty() {
        return Err(reasons.join("; "));
    }
    let each = known.iter().map(|known| {
        let robot = known.motion.as_ref().map_err(Clone::clone)?;
        Ok((robot, robot.motion()?))
    });
    each.collect::<Result<_, Refusal>>().map_err(|refusal| refusal.to_string())
}

fn conflicts(pair: [&Known<'_>; 2], now: Time) -> Result<Vec<ConflictReport>, String> {
    let found = motions(&pair)?;
    let [(first, a), (second, b)] = &found[..] else { return Err("there are not two robots".to_owned()) };
    // After that both stand at their ends: what touches then, touches for ever.
    let end = a.time().hi.max(b.time().hi).max(0.0);
    let encounter = Encounter::new(a, b);
    let out_of_range = || "a time is after January 2038".to_owned();
    (encounter.conflicts(Interval::new(0.0, end + 1.0)))
        .map(|conflict| {
            let lasting = conflict.time.hi > end;
            let until = if lasting { end.max(conflict.time.lo) } else { conflict.time.hi };
            let at = |time: f64| now.later(time).ok_or_else(out_of_range);
            let deepest = conflict.deepest.time;
            Ok(ConflictReport {
                robot_a: pair[0].robot.name.clone(),
                robot_b: pair[1].robot.name.clone(),
                begin: at(conflict.time.lo)?,
                end: at(until)?,
                lasting,
                begin_length_a: first.travelled(conflict.length.lo),
                end_length_a: first.travelled(conflict.length.hi),
                begin_length_b: second.travelled(conflict.other_length.lo),
                end_length_b: second.travelled(conflict.other_length.hi),
                deepest: at(deepest)?,
                pose_a: spatial(first.pose_at(deepest)),
                pose_b: spatial(second.pose_at(deepest)),
                depth: conflict.depth,
                touching: conflict.touching,
            })
        })
        .collect()
}

fn authorities(
    known: &[Known<'_>],
    others: &[Refusal],
    order: &mut Option<Result<Order, String>>,
    header: &Header,
) -> AuthoritiesReport {
    let all: Vec<&Known<'_>> = known.iter().collect();
    let named = |agent: usize| known.get(agent).map(|known| known.robot.name.clone()).unwrap_or_default();
    let strangers = others.iter().map(Refusal::to_string).collect::<Vec<_>>().join("; ");
    let found = if strangers.is_empty() { motions(&all) } else { Err(strangers) };
    let found = found.and_then(|found| {
        let fleet: Vec<Motion<'_, f64>> = found.iter().map(|(_, motion)| *motion).collect();
        let Order { places, stuck } = order.get_or_insert_with(|| order::of(&fleet)).clone()?;
        let each = (found.iter().zip(&places).enumerate()).map(|(agent, ((robot, motion), place))| {
            authority(robot, motion, place, header.stamp, named).map(|of| AuthorityReport { robot: named(agent), ..of })
        });
        Ok((each.collect::<Result<Vec<_>, String>>()?, stuck))
    });
    match found {
        Ok((robots, stuck)) => {
            let stuck: Vec<String> = stuck.into_iter().map(named).collect();
            AuthoritiesReport { robots, stuck: stuck.join(", "), ..Default::default() }
        }
        Err(reason) => {
            // Whoever is not known may be anywhere.
            let unknown = |known: &Known<'_>| AuthorityReport {
                robot: known.robot.name.clone(),
                reason: reason.clone(),
                ..Default::default()
            };
            AuthoritiesReport { robots: known.iter().map(unknown).collect(), ..Default::default() }
        }
    }
}

/// The authority of a robot, without its name.
fn authority(
    robot: &RobotMotion,
    motion: &Motion<'_, f64>,
    place: &Place,
    now: Time,
    named: impl Fn(usize) -> String,
) -> Result<AuthorityReport, String> {
    let until = |state: u8, length: f64| {
        let time = robot.time_at(motion, length);
        let stamp = now.later(time).ok_or("a time is after January 2038")?;
        Ok(AuthorityReport {
            state,
            length: robot.travelled(length),
            time: stamp,
            pose: spatial(robot.pose_at(time)),
            ..Default::default()
        })
    };
    match *place {
        Place::End => until(AuthorityReport::FREE, motion.path().length()),
        Place::Before { length, other } => until(AuthorityReport::LIMITED, length)
            .map(|limited| AuthorityReport { waits_for: named(other), ..limited }),
        Place::Nowhere { other } => {
            Ok(AuthorityReport { state: AuthorityReport::NONE, waits_for: named(other), ..Default::default() })
        }
    }
}

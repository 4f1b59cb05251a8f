//! The tasks of the robots, and the obstacles.

use super::frame_contact::ROUNDING;
use super::outline_contact::{BodyTrack, meetings};
use super::speed_limited_path::SpeedLimitedPath;
use super::vector::{PlaneVector, norm, sub};
use pcr_core::Limits;
use pcr_formats::scenario::{Agent, Labels, MotionSpec, PathSegment, Scenario, SegmentPhase};
use pcr_formats::warning::WarningCode;
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::{ConvexBody, Fleet};

/// When the last robot may set off \[s\]: every frame until then is simulated and kept.
const LATEST: f64 = 1e4;

/// How long a robot may take alone \[s\], for the same reason.
const LONGEST: f64 = 1e5;

/// A motion that takes longer than necessary by more than this share, or the other way round, is reported as a warning.
const SLOWER: f64 = 1e-3;

/// The task of a run: robots with their missions, and obstacles.
#[derive(Clone, Debug)]
pub struct SimulationTask {
    /// Name of the scenario.
    pub name: String,
    /// Labels of its agents.
    pub labels: Labels,
    /// The robots.
    pub robots: Vec<RobotTask>,
    /// Agents that never move.
    pub obstacles: Vec<StandingObstacle>,
    /// What the simulation changes or leaves out of the scenario.
    pub warnings: Vec<String>,
}

/// A robot and its missions.
#[derive(Clone, Debug)]
pub struct RobotTask {
    /// Number.
    pub id: u64,
    /// Radius of the disc about its reference point that contains it \[m\], which is all that controllers of discs know.
    pub radius: f64,
    /// Its body.
    pub body: ConvexBody,
    /// Distance that others keep from it \[m\].
    pub margin: f64,
    /// Largest speed \[m/s\] and acceleration \[m/s²\].
    pub limits: Limits<f64>,
    /// One after the other; each begins where the one before it ends.
    pub missions: Vec<ReleasedMission>,
}

/// A path to be travelled.
#[derive(Clone, Debug)]
pub struct ReleasedMission {
    /// Not before this time \[s\].
    pub release: f64,
    /// The way.
    pub course: SpeedLimitedPath,
}

/// A body that stands.
#[derive(Clone, Debug)]
pub struct StandingObstacle {
    /// Number, where the scenario gives one.
    pub id: Option<u64>,
    /// Its reference point \[m\].
    pub centre: PlaneVector,
    /// \[rad\]
    pub heading: f64,
    /// Radius of the disc about its reference point that contains it \[m\].
    pub radius: f64,
    /// Its body.
    pub body: ConvexBody,
    /// Distance that others keep from it \[m\].
    pub margin: f64,
}

impl RobotTask {
    /// Position at the start.
    pub fn home(&self) -> PlaneVector {
        self.missions.first().map_or([0.0; 2], |first| first.course.point_at(0.0))
    }
}

impl SimulationTask {
    /// The agents of a scenario: those with a path have one mission, the others are in the way. One that is concave, or that has loads, is the
    /// convex hull of all that it ever is, which is among the warnings. Of a profile, the largest speed on each segment, the durations of turns in place and the largest acceleration
    /// count; if it takes longer than these allow from rest to rest, or less, that is among the warnings. So are agents in the way that
    /// overlap one another: no run counts them as a collision.
    ///
    /// # Errors
    /// [`ComputationError::Refused`] if a value is out of range, [`ComputationError::Late`] if a robot sets off too late, [`ComputationError::Long`] if it takes too
    /// long.
    pub fn from_scenario(scenario: &Scenario) -> Result<Self, ComputationError> {
        let fleet = Fleet::<f64>::new(scenario)?;
        let (mut robots, mut obstacles): (Vec<RobotTask>, Vec<StandingObstacle>) = (Vec::new(), Vec::new());
        let mut warnings = scenario.warnings.clone();
        // A run begins at 0 s, or with the first one before that; with the first one, too, if they set off long after 0 s, as at times
        // since 1970.
        let starts = || scenario.agents.iter().filter(|agent| !agent.path.is_empty()).map(|agent| agent.t_start);
        let first = starts().fold(f64::INFINITY, f64::min);
        let begin = if starts().any(|start| start > LATEST) { first } else { first.min(0.0) };
        if begin != 0.0 {
            let text = format_args!("the first agent sets off at {begin} s; times of the simulation count from there");
            warnings.push(WarningCode::ShiftedTimes.text(text));
        }
        for (place, (agent, motion)) in scenario.agents.iter().zip(fleet.motions()).enumerate() {
            let tops = tops(agent);
            let top = |segment| fleet.source(place, segment).and_then(|source| tops.get(source).copied());
            let body = ConvexBody::of_agent(agent).map_err(|_| ComputationError::Robot(agent.id))?;
            let stands = body.is_disc() && !agent.changes_facing();
            let course = if stands && !agent.turns_in_place() {
                SpeedLimitedPath::of(&motion).with_speed_limits(|segment| top(segment).unwrap_or(f64::INFINITY))
            } else {
                SpeedLimitedPath::of_agent(agent, &tops, stands).map_err(|_| ComputationError::Robot(agent.id))?
            };
            if body.excess() > 0.0 {
                warnings.push(WarningCode::ConvexHull.text(format_args!(
                    "agent {}: its outline is concave, or changes on the way; it is simulated as the convex hull of all of it, which reaches \
                     up to {:.3} m farther",
                    agent.id,
                    body.excess()
                )));
            }
            if course.length() > 0.0 {
                if agent.t_start - begin > LATEST {
                    return Err(ComputationError::Late(agent.id, LATEST));
                }
                let limits = limits(agent);
                let (own, least) = (agent.duration(), course.unimpeded(limits));
                if least > LONGEST {
                    return Err(ComputationError::Long(agent.id, LONGEST));
                }
                if own > least * (1.0 + SLOWER) || least > own * (1.0 + SLOWER) {
                    let by = "from rest to rest by its largest speed on each segment and its largest acceleration";
                    warnings.push(WarningCode::ReplacedMotion.text(format_args!(
                        "agent {}: its own motion takes {own:.3} s; it is simulated {by}, by which it takes {least:.3} s",
                        agent.id
                    )));
                }
                let missions = vec![ReleasedMission { release: agent.t_start - begin, course }];
                let radius = agent.circumscribed_radius().max(body.reach());
                robots.push(RobotTask { id: agent.id, radius, body, margin: agent.margin, limits, missions });
            } else {
                let centre = course.point_at(0.0);
                obstacles.push(StandingObstacle {
                    id: Some(agent.id),
                    centre,
                    heading: agent.start[2],
                    radius: agent.circumscribed_radius().max(body.reach()),
                    body,
                    margin: agent.margin,
                });
            }
        }
        warnings.extend(overlapping(&obstacles));
        Ok(Self { name: scenario.name.clone(), labels: Labels::from_scenario(scenario), robots, obstacles, warnings })
    }
}

/// Warnings about standing agents that overlap.
fn overlapping(standing: &[StandingObstacle]) -> Vec<String> {
    /// Largest number of pairs that are named.
    const NAMED: usize = 16;
    let left = |it: &StandingObstacle| it.centre[0] - it.radius;
    let mut order: Vec<&StandingObstacle> = standing.iter().collect();
    order.sort_by(|a, b| left(a).total_cmp(&left(b)));
    let (mut named, mut count): (Vec<[u64; 2]>, usize) = (Vec::new(), 0);
    for (place, own) in order.iter().enumerate() {
        let right = own.centre[0] + own.radius;
        let near = order[place + 1..].iter().take_while(|other| left(other) <= right);
        for other in near.filter(|other| overlap(own, other) > ROUNDING) {
            count += 1;
            if let [Some(id), Some(other)] = [own.id, other.id]
                && named.len() < NAMED
            {
                named.push([id.min(other), id.max(other)]);
            }
        }
    }
    named.sort_unstable();
    let more = count - named.len();
    let named = named.into_iter().map(|[i, j]| format!("agents {i} and {j} stand in contact"));
    let all = named.chain((more > 0).then(|| format!("{more} more pairs of agents stand in contact")));
    all.map(|text| WarningCode::StandingContact.text(text)).collect()
}

/// How deep two standing agents overlap \[m\]; below 0 if they do not.
fn overlap(own: &StandingObstacle, other: &StandingObstacle) -> f64 {
    let discs = own.radius + other.radius - norm(sub(own.centre, other.centre));
    if discs <= ROUNDING || (own.body.is_disc() && other.body.is_disc()) {
        return discs;
    }
    let [(a, at), (b, its)] = [own, other].map(|it| ([it.centre; 2], [it.heading; 2]));
    -meetings(&BodyTrack::new(&own.body, &a, &at), &BodyTrack::new(&other.body, &b, &its)).1
}

/// The largest speed of a profile on each segment \[m/s\], and that of a turn in place in the mean \[rad/s\], without the waits; infinite
/// without a profile.
fn tops(agent: &Agent) -> Vec<f64> {
    if matches!(agent.motion, MotionSpec::RestToRest { .. }) {
        return Vec::new();
    }
    let top = |(segment, parts): (&PathSegment, Vec<SegmentPhase>)| {
        let moves = || parts.iter().filter(|part| part.moves());
        let top = match *segment {
            PathSegment::Turn { sweep } => sweep.abs() / moves().map(|part| part.duration).sum::<f64>(),
            _ => moves().map(|part| part.before.max(part.after)).fold(0.0, f64::max),
        };
        if top > 0.0 { top } else { f64::INFINITY }
    };
    agent.path.iter().zip(agent.parts()).map(top).collect()
}

/// The limits of an agent. For a profile: its largest speed and acceleration; without any acceleration, one second to the top
/// speed. A profile that begins or ends under way may have hardly any acceleration; the simulated robot then gets to the top speed within
/// the duration of the profile. (Every profile from rest to rest does so by itself.)
fn limits(agent: &Agent) -> Limits<f64> {
    match &agent.motion {
        MotionSpec::RestToRest { v_max, a_max } => Limits { speed: *v_max, acceleration: *a_max },
        // The duration of a turn contains all ramps, and these add none.
        MotionSpec::Profile { .. } if agent.length() == 0.0 => Limits { speed: 1.0, acceleration: 1.0 },
        MotionSpec::Profile { .. } => {
            let (v0, pieces) = agent.motion.pieces(agent.length());
            let (mut now, mut speed, mut acceleration) = (v0, v0, 0.0_f64);
            for (duration, accel) in pieces {
                now += accel * duration;
                speed = speed.max(now);
                acceleration = acceleration.max(accel.abs());
            }
            let acceleration = match acceleration {
                some if some > 0.0 => some.max(speed / agent.duration()),
                _ => speed,
            };
            Limits { speed, acceleration }
        }
    }
}

//! From scenarios to motions and maps, in any number format of the tool.

use crate::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use pcr_core::{
    Ecm, Full, Invalid, Limits, Motion, PathRef, Phase, Piece, Point, Pose, Profile, ProfileRef, Radians, Region,
    Scalar, Segment, Turn,
};
use std::f64::consts::TAU;
use std::fmt;

/// A number format that scenario files can be read into.
pub trait Format: Scalar {
    /// Name on the command line and in the output.
    const NAME: &'static str;
    /// The nearest number of the format.
    fn from_f64(value: f64) -> Self;
    /// The exact value.
    fn to_f64(self) -> f64;
    /// The nearest angle of the format.
    fn angle(radians: f64) -> Self::Angle;
}

impl Format for f64 {
    const NAME: &'static str = "f64";
    fn from_f64(value: f64) -> Self {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn angle(radians: f64) -> Radians<f64> {
        Radians(radians)
    }
}

impl Format for f32 {
    const NAME: &'static str = "f32";
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    fn angle(radians: f64) -> Radians<f32> {
        Radians(radians as f32)
    }
}

/// Why a motion could not be built from an agent of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    agent: u64,
    segment: Option<usize>,
    format: &'static str,
    reason: Invalid,
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "agent {}", self.agent)?;
        if let Some(segment) = self.segment {
            write!(f, ", segment {}", segment + 1)?;
        }
        write!(f, ": {} in {}", self.reason, self.format)
    }
}

impl std::error::Error for Refused {}

/// The paths and profiles of a scenario in one number format.
#[derive(Clone, Debug)]
pub struct Fleet<S: Scalar> {
    agents: Vec<Parts<S>>,
}

/// What the motion of one agent borrows.
#[derive(Clone, Debug)]
struct Parts<S: Scalar> {
    segments: Vec<Segment<S>>,
    /// Place of each segment in the scenario: zero lengths are left out there, arcs over one turn are split.
    sources: Vec<usize>,
    phases: Vec<Phase<S>>,
    radius: S,
    start: S,
}

impl<S: Format> Fleet<S> {
    /// All agents of a scenario.
    ///
    /// # Errors
    /// [`Refused`] where a value does not fit the number format.
    pub fn new(scenario: &Scenario) -> Result<Self, Refused> {
        let agents: Vec<_> = scenario.agents.iter().map(Parts::new).collect::<Result<_, _>>()?;
        let fleet = Self { agents };
        for (parts, agent) in fleet.agents.iter().zip(&scenario.agents) {
            parts.motion().map_err(|reason| Refused { agent: agent.id, segment: None, format: S::NAME, reason })?;
        }
        Ok(fleet)
    }

    /// The motions, in the order of the scenario.
    pub fn motions(&self) -> Vec<Motion<'_, S>> {
        self.agents.iter().filter_map(|parts| parts.motion().ok()).collect()
    }

    /// Place in the scenario (from 0) of a segment of an agent's motion; `None` for the point of an agent that stands.
    pub fn source(&self, agent: usize, segment: usize) -> Option<usize> {
        self.agents.get(agent)?.sources.get(segment).copied()
    }
}

impl<S: Format> Parts<S> {
    fn new(agent: &Agent) -> Result<Self, Refused> {
        let refused = |segment| move |reason| Refused { agent: agent.id, segment, format: S::NAME, reason };
        let [x, y, heading] = agent.start;
        let pose = Pose { position: Point::new(S::from_f64(x), S::from_f64(y)), heading: S::angle(heading) };
        let origin = Segment::standing(pose).map_err(refused(None))?;
        let (mut segments, mut sources) = (Vec::<Segment<S>>::new(), Vec::new());
        for (source, segment) in agent.path.iter().enumerate().filter(|(_, segment)| segment.length() > 0.0) {
            let turns = match segment {
                PathSegment::Line { .. } => 1.0,
                PathSegment::Arc { sweep, .. } => (sweep.abs() / TAU * (1.0 - 1e-12)).ceil(),
            };
            for _ in 0..turns as usize {
                let last = segments.last().unwrap_or(&origin);
                let length = S::from_f64(segment.length() / turns);
                let next = match *segment {
                    PathSegment::Line { .. } => last.then_line(length),
                    PathSegment::Arc { radius, sweep } => {
                        last.then_arc(S::from_f64(radius), if sweep > 0.0 { Turn::Left } else { Turn::Right }, length)
                    }
                };
                segments.push(next.map_err(refused(Some(source)))?);
                sources.push(source);
            }
        }
        if segments.is_empty() {
            segments.push(origin);
        }
        let length = PathRef::new(&segments).map_err(refused(None))?.length();
        let phases = match &agent.motion {
            MotionSpec::RestToRest { v_max, a_max } => {
                let limits = Limits { speed: S::from_f64(*v_max), acceleration: S::from_f64(*a_max) };
                Profile::rest_to_rest(length, limits).map_err(refused(None))?.as_profile().phases().to_vec()
            }
            MotionSpec::Profile { v0, pieces } => {
                let mut phases = Vec::<Phase<S>>::new();
                for &(duration, accel) in pieces {
                    let (duration, accel) = (S::from_f64(duration), S::from_f64(accel));
                    let next = match phases.last() {
                        None => Phase::starting_at(S::from_f64(*v0), duration, accel),
                        Some(last) => last.then(duration, accel),
                    };
                    phases.push(next.map_err(refused(None))?);
                }
                phases
            }
        };
        Ok(Self { segments, sources, phases, radius: S::from_f64(agent.radius), start: S::from_f64(agent.t_start) })
    }

    fn motion(&self) -> Result<Motion<'_, S>, Invalid> {
        Motion::new(PathRef::new(&self.segments)?, ProfileRef::new(&self.phases)?, self.radius, self.start)
    }
}

/// A table on the heap.
pub type HostEcm<S> = Ecm<S, Vec<Region>, Vec<Piece<S>>>;

/// The extended collision map of a fleet of any size: the storage grows until it is large enough.
///
/// # Errors
/// [`Full::Agents`] for more than 65535 agents.
pub fn build_ecm<S: Scalar>(motions: &[Motion<'_, S>]) -> Result<HostEcm<S>, Full> {
    let (mut regions, mut pieces) = (4 * motions.len() + 16, 8 * motions.len() + 16);
    loop {
        match Ecm::build(vec![Region::EMPTY; regions], vec![Piece::EMPTY; pieces], motions) {
            Err(Full::Regions) => regions *= 2,
            Err(Full::Pieces) => pieces *= 2,
            done => return done,
        }
    }
}

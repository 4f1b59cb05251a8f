//! The agents of a scenario as motions of the core: an agent is one body, or several that move together, the convex parts of a concave
//! outline. With loads there are bodies for each stretch of the path on which the outline does not change.

use crate::fleet::{Fleet, FormatRangeError, HostScalar};
use pcr_core::{Interval, Motion};
use pcr_formats::scenario::{Agent, AgentPart, PathSegment, Scenario};
use std::borrow::Cow;

/// Rounding of lengths along a path, relative.
const ROUNDING: f64 = 1e-12;

/// The bodies of a scenario.
pub struct BodyFleet<S: HostScalar> {
    /// The bodies as agents.
    pub scenario: Scenario,
    /// Their motions.
    pub fleet: Fleet<S>,
    /// For each of them the agent to which it belongs.
    pub bodies: Vec<Body>,
}

/// A body of an agent.
pub struct Body {
    /// Index of the agent in its scenario.
    pub agent: usize,
    /// `None` if it is there all the way.
    stretch: Option<Stretch>,
    /// Lengths on its path during which it turns in place, which that of the agent does not have \[m\].
    turned: Vec<[f64; 2]>,
    /// What lengths on its path are off by their rounding \[m\].
    rounding: f64,
}

/// The part of the path of its agent on which a body is present.
#[derive(Clone, Copy)]
struct Stretch {
    /// Length of the path before the part \[m\].
    from: f64,
    /// Length of the whole path \[m\].
    length: f64,
    /// Index of its first segment in a file.
    first: usize,
    /// Whether it contains the start, and the end, of the path.
    ends: [bool; 2],
}

impl Body {
    /// A body that is there all the way and whose path is that of its agent.
    fn whole(agent: usize) -> Self {
        Self { agent, stretch: None, turned: Vec::new(), rounding: 0.0 }
    }

    /// Whether it is there all the way, and lengths on its path are those of its agent.
    pub(crate) fn is_whole(&self) -> bool {
        self.stretch.is_none() && self.turned.is_empty()
    }

    /// Returns the same body, of the agent whose index is higher by `places`.
    pub(crate) fn moved(self, places: usize) -> Self {
        Self { agent: self.agent + places, ..self }
    }

    /// Returns the lengths on the path of the agent, outward, of lengths on that of the body.
    pub(crate) fn on_agent(&self, lengths: [f64; 2]) -> [f64; 2] {
        if self.is_whole() {
            return lengths;
        }
        let slack = self.rounding;
        let before = |length: f64| {
            let turned = self.turned.iter().map(|[from, to]| (length.min(*to) - from).max(0.0));
            length - turned.sum::<f64>()
        };
        let [lo, hi] = [before(lengths[0]) - slack, before(lengths[1]) + slack];
        match self.stretch {
            None => [lo.max(0.0), hi],
            Some(Stretch { from, length, .. }) => [(lo + from).max(0.0), (hi + from).min(length)],
        }
    }

    /// Returns its first segment in the scenario (from 0).
    pub fn first(&self) -> usize {
        self.stretch.map_or(0, |stretch| stretch.first)
    }

    /// Returns the segment in the scenario (from 0) of a segment of its path.
    pub fn segment(&self, segment: usize) -> Option<usize> {
        segment.checked_add(self.first())
    }

    /// Whether it is there before the agent sets off.
    pub(crate) fn is_at_start(&self) -> bool {
        self.stands()[0]
    }

    /// Whether it is there after the arrival of the agent.
    pub(crate) fn is_at_end(&self) -> bool {
        self.stands()[1]
    }

    /// Whether it is there before the agent sets off, and after its arrival.
    pub(crate) fn stands(&self) -> [bool; 2] {
        self.stretch.map_or([true; 2], |stretch| stretch.ends)
    }

    /// Returns when it is there, in a time that contains all motions \[s\].
    pub fn time<S: HostScalar>(&self, motion: &Motion<'_, S>, all: Interval<S>) -> Interval<S> {
        let own = motion.time();
        let [start, end] = self.stands();
        Interval { lo: if start { all.lo } else { own.lo }, hi: if end { all.hi } else { own.hi } }
    }
}

/// The fleet of the bodies, the bodies, and their scenario.
pub type BodyMotions<'a, S> = (Fleet<S>, Vec<Body>, Cow<'a, Scenario>);

impl<S: HostScalar> BodyFleet<S> {
    /// Returns the bodies of a scenario.
    ///
    /// # Errors
    /// [`FormatRangeError`] where a value does not fit the number format.
    pub fn new(scenario: &Scenario) -> Result<Self, FormatRangeError> {
        let (mut agents, mut bodies) = (Vec::new(), Vec::new());
        let mut fleet = Fleet::new(&Scenario::default())?;
        for (place, agent) in scenario.agents.iter().enumerate() {
            for (agent, stretch) in parts::<S>(agent) {
                let own = Fleet::body(&agent)?;
                let turned = own.turned(0).iter().map(|turn| [turn.lo, turn.hi].map(S::to_f64)).collect();
                let segments = agent.path.len() as f64;
                let length = agent.length() + stretch.map_or(0.0, |stretch| stretch.length);
                let rounding = ROUNDING * (1.0 + length) + segments * (S::EPSILON * length + S::STEP);
                fleet.append(own);
                agents.push(agent);
                bodies.push(Body { agent: place, stretch, turned, rounding });
            }
        }
        Ok(Self { fleet, scenario: Scenario::new(scenario.name.clone(), agents), bodies })
    }

    /// Returns the same with the scenario itself where all agents are discs: of a large fleet, a copy of it would be large.
    ///
    /// # Errors
    /// As [`BodyFleet::new`].
    pub fn moving(scenario: &Scenario) -> Result<BodyMotions<'_, S>, FormatRangeError> {
        if scenario.agents.iter().any(|agent| agent.footprint.is_some() || !agent.loads.is_empty()) {
            let Self { fleet, bodies, scenario } = Self::new(scenario)?;
            return Ok((fleet, bodies, Cow::Owned(scenario)));
        }
        let bodies = (0..scenario.agents.len()).map(Body::whole).collect();
        Ok((Fleet::new(scenario)?, bodies, Cow::Borrowed(scenario)))
    }
}

/// The bodies of an agent, each as an agent with a convex outline or a disc.
fn parts<S: HostScalar>(agent: &Agent) -> Vec<(Agent, Option<Stretch>)> {
    let outlines = agent.outlines();
    let mut bodies = Vec::new();
    for outline in &outlines {
        let [first, last] = outline.segments;
        let (part, stretch) = if outlines.len() > 1 {
            let AgentPart { agent: part, from, .. } = agent.stretch(first, last);
            // An agent that stands where the outline changes has both outlines. At its start or end that is so if it does not move and
            // does not turn on the segments in between.
            let length = agent.length();
            let way = |segments: &[PathSegment]| -> f64 {
                segments.iter().map(|segment| segment.length() + segment.sweep().abs()).sum()
            };
            let [before, after] = [agent.path.get(..first), agent.path.get(last + 1..)];
            let ends = [before, after].map(|segments| way(segments.unwrap_or_default()) <= ROUNDING * (1.0 + length));
            (settled::<S>(part), Some(Stretch { from, length, first: agent.file_segment(first), ends }))
        } else {
            (agent.clone(), None)
        };
        let part = Agent { radius: outline.radius, footprint: None, loads: Vec::new(), ..part };
        match outline.footprint {
            None => bodies.push((part, stretch)),
            Some(footprint) => bodies.extend(footprint.parts().map(|convex| {
                let radius = convex.circumscribed_radius();
                (Agent { radius, footprint: Some(convex), ..part.clone() }, stretch)
            })),
        }
    }
    bodies
}

/// The agent with a start of which no coordinate is less than the last digit of the format, which rounding may leave of 0.
fn settled<S: HostScalar>(mut agent: Agent) -> Agent {
    for coordinate in agent.start.iter_mut().take(2) {
        if S::from_f64(*coordinate) == S::ZERO {
            *coordinate = 0.0;
        }
    }
    agent
}

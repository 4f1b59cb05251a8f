//! The agents of a scenario as discs: the discs of a footprint, or a single one. With loads there is one set of discs
//! for each stretch of the path on which the outline does not change.

mod joints;
mod offset;

use crate::fleet::{Fleet, Format, Refused, Rounding};
use offset::{Offset, Precision};
use pcr_core::{Interval, Motion};
use pcr_formats::scenario::{Agent, PathSegment, Placed, Scenario, Stretch};
use std::borrow::Cow;
use std::convert::Infallible;

/// Rounding of lengths along a path, relative.
const ROUNDING: f64 = 1e-12;

/// A scenario whose agents are the discs of another one's.
pub struct Bodies<S: Format> {
    /// The discs as agents.
    pub scenario: Scenario,
    /// Their motions.
    pub fleet: Fleet<S>,
    /// For each disc the agent to which it belongs.
    pub discs: Vec<Disced>,
}

/// A disc of an agent.
pub struct Disced {
    /// Index of the agent in its scenario.
    pub agent: usize,
    /// `None` if the agent is the disc.
    offset: Option<Box<Offset>>,
    stretch: Range,
    /// Difference of its radius to that in the cover \[m\].
    pub growth: f64,
}

/// The part of the path of its agent on which a disc is present.
#[derive(Clone, Copy)]
struct Range {
    /// Length of the path before the part \[m\].
    from: f64,
    /// Length of the whole path \[m\].
    length: f64,
    /// Index of its first segment.
    first: usize,
    /// Whether it contains the start, and the end, of the path.
    ends: [bool; 2],
}

impl Disced {
    /// An agent that is a disc.
    fn whole(agent: &Agent, place: usize) -> Self {
        let stretch = Range { from: 0.0, length: agent.length(), first: 0, ends: [true, true] };
        Self { agent: place, offset: None, stretch, growth: 0.0 }
    }

    /// The same disc, of the agent whose index is higher by `places`.
    pub(crate) fn moved(self, places: usize) -> Self {
        Self { agent: self.agent + places, ..self }
    }

    /// Lengths on the path of the agent, outward, of lengths on that of the disc.
    pub fn on_agent(&self, lengths: [f64; 2]) -> [f64; 2] {
        let [lo, hi] = self.offset.as_ref().map_or(lengths, |offset| offset.on_reference(lengths));
        let Range { from, length, ends, .. } = self.stretch;
        if from == 0.0 && ends == [true, true] {
            return [lo, hi];
        }
        // The rounding of the sums.
        let slack = ROUNDING * (1.0 + length);
        [(lo + from - slack).max(0.0), (hi + from + slack).min(length)]
    }

    /// Its first segment in the scenario (from 0).
    pub fn first(&self) -> usize {
        self.stretch.first
    }

    /// Segment in the scenario (from 0) of a segment of the disc.
    pub fn segment(&self, segment: usize) -> Option<usize> {
        let segment = self.offset.as_ref().map_or(Some(segment), |offset| offset.source(segment))?;
        segment.checked_add(self.stretch.first)
    }

    /// Whether it is there before the agent sets off.
    pub fn is_at_start(&self) -> bool {
        self.stretch.ends[0]
    }

    /// Whether it is there after the arrival of the agent.
    pub fn is_at_end(&self) -> bool {
        self.stretch.ends[1]
    }

    /// Whether it is there before the agent sets off, and after its arrival.
    pub(crate) fn stands(&self) -> [bool; 2] {
        self.stretch.ends
    }

    /// When it is there, in a time that holds all motions \[s\].
    pub fn time<S: Format>(&self, motion: &Motion<'_, S>, all: Interval<S>) -> Interval<S> {
        let own = motion.time();
        let [start, end] = self.stretch.ends;
        Interval { lo: if start { all.lo } else { own.lo }, hi: if end { all.hi } else { own.hi } }
    }
}

/// The fleet of the discs, the discs, and their scenario.
pub type Moving<'a, S> = (Fleet<S>, Vec<Disced>, Cow<'a, Scenario>);

impl<S: Format> Bodies<S> {
    /// The discs of a scenario.
    ///
    /// # Errors
    /// [`Refused`] where a value does not fit the number format.
    pub fn new(scenario: &Scenario) -> Result<Self, Refused> {
        let mut bodies = (Vec::new(), Vec::new());
        for (place, agent) in scenario.agents.iter().enumerate() {
            discs::<S, _>(agent, place, &mut bodies, rounded::<S>)?;
        }
        let (agents, discs) = bodies;
        let scenario = Scenario::new(scenario.name.clone(), agents);
        Ok(Self { fleet: Fleet::new(&scenario)?, scenario, discs })
    }

    /// The same with the scenario itself where all agents are discs: of a large fleet, a copy of it would be large.
    ///
    /// # Errors
    /// As [`Bodies::new`].
    pub fn moving(scenario: &Scenario) -> Result<Moving<'_, S>, Refused> {
        if scenario.agents.iter().any(|agent| agent.footprint.is_some() || !agent.loads.is_empty()) {
            let Self { fleet, discs, scenario } = Self::new(scenario)?;
            return Ok((fleet, discs, Cow::Owned(scenario)));
        }
        let discs = scenario.agents.iter().enumerate().map(|(place, agent)| Disced::whole(agent, place)).collect();
        Ok((Fleet::new(scenario)?, discs, Cow::Borrowed(scenario)))
    }
}

/// The paths of the discs of an agent, and their radii \[m\].
pub fn tracks(agent: &Agent) -> Vec<(Vec<Placed>, f64)> {
    let mut bodies = (Vec::new(), Vec::new());
    // Discs in `f64` lose no digits, for which one could be refused.
    let Ok(()) = discs::<f64, Infallible>(agent, 0, &mut bodies, Ok);
    let track = |disc: &Agent| {
        let [x, y, heading] = disc.start;
        let mut last = Placed { at: [x, y], heading, shape: PathSegment::Line { length: 0.0 } };
        let pieces = disc.path.iter().map(|&shape| {
            last = Placed { at: last.end(), heading: last.heading_at_end(), shape };
            last
        });
        let pieces: Vec<Placed> = pieces.collect();
        (if pieces.is_empty() { vec![last] } else { pieces }, disc.radius)
    };
    bodies.0.iter().map(track).collect()
}

/// Adds the discs of an agent, each as it is `rounded`.
fn discs<S: Format, E>(
    agent: &Agent,
    place: usize,
    (agents, discs): &mut (Vec<Agent>, Vec<Disced>),
    rounded: impl Fn(Offset) -> Result<Offset, E>,
) -> Result<(), E> {
    let outlines = agent.outlines();
    for outline in &outlines {
        let [first, last] = outline.segments;
        let (part, parts, from) = if outlines.len() > 1 {
            let Stretch { agent, parts, from } = agent.stretch(first, last);
            (agent, parts, from)
        } else {
            (agent.clone(), agent.parts(), 0.0)
        };
        let part = Agent { radius: outline.radius, footprint: None, loads: Vec::new(), ..part };
        // An agent that stands where the outline changes has both outlines. At its start or end that is so if the segments in between
        // have no length.
        let length = agent.length();
        let rest: f64 = agent.path.iter().skip(last + 1).map(PathSegment::length).sum();
        let ends = [from, rest].map(|way| way <= ROUNDING * (1.0 + length));
        let stretch = Range { from, length, first, ends };
        let Some(footprint) = outline.footprint else {
            discs.push(Disced { agent: place, offset: None, stretch, growth: 0.0 });
            agents.push(if outlines.len() > 1 { settled::<S>(part) } else { part });
            continue;
        };
        let precision = Precision::of::<S>(&part);
        for disc in footprint.discs() {
            // Their number is that of the agent, by which errors name them.
            let offset = rounded(Offset::of(&part, &parts, disc, agent.id, precision))?;
            let growth = offset.agent.radius - disc.radius;
            agents.push(offset.agent.clone());
            discs.push(Disced { agent: place, offset: Some(Box::new(offset)), stretch, growth });
        }
    }
    Ok(())
}

/// The agent with a start of which no coordinate is less than the last digit of the format, which rounding may leave of 0.
fn settled<S: Format>(mut agent: Agent) -> Agent {
    for coordinate in agent.start.iter_mut().take(2) {
        if S::from_f64(*coordinate) == S::ZERO {
            *coordinate = 0.0;
        }
    }
    agent
}

/// The disc with a radius that makes up for the digits that the format does not have.
fn rounded<S: Format>(offset: Offset) -> Result<Offset, Refused> {
    if S::NAME == f64::NAME {
        return Ok(offset);
    }
    let offset = offset.map(settled::<S>);
    let fleet = Fleet::<S>::new(&Scenario::new("", vec![offset.agent.clone()]))?;
    let rounding = fleet.motions().first().map(|motion| Rounding::of(&offset.agent, motion));
    Ok(rounding.map_or(offset.clone(), |rounding| offset.rounded(rounding)))
}

//! The agents of a scenario as motions of the core: a disc or a convex outline is one; any other footprint is covered by discs. With
//! loads there is one set of discs for each stretch of the path on which the outline does not change.

mod offset_disc;
mod speed_jumps;

use crate::fleet::{Fleet, FormatRangeError, HostScalar, RoundingBounds};
use offset_disc::{OffsetDisc, ScalarPrecision};
use pcr_core::{Interval, Motion};
use pcr_formats::scenario::{Agent, AgentPart, PathSegment, PlacedSegment, Scenario};
use std::borrow::Cow;
use std::convert::Infallible;

/// Rounding of lengths along a path, relative.
const ROUNDING: f64 = 1e-12;

/// What outlines are computed as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// As they are, where the core computes with them; the others are covered.
    Exact,
    /// Covers of discs, for what only knows discs.
    Covers,
}

/// A scenario whose agents are the bodies of another one's: discs, and outlines that are computed as they are.
pub struct DiscFleet<S: HostScalar> {
    /// The bodies as agents.
    pub scenario: Scenario,
    /// Their motions.
    pub fleet: Fleet<S>,
    /// For each of them the agent to which it belongs.
    pub discs: Vec<BodyDisc>,
}

/// A disc of an agent, or all of it.
pub struct BodyDisc {
    /// Index of the agent in its scenario.
    pub agent: usize,
    /// `None` if it moves with the reference point.
    offset: Option<Box<OffsetDisc>>,
    /// `None` if it is there all the way.
    stretch: Option<DiscPresence>,
    /// Difference of its radius to that in the cover \[m\].
    pub growth: f64,
}

/// The part of the path of its agent on which a disc is present.
#[derive(Clone, Copy)]
struct DiscPresence {
    /// Length of the path before the part \[m\].
    from: f64,
    /// Length of the whole path \[m\].
    length: f64,
    /// Index of its first segment.
    first: usize,
    /// Whether it contains the start, and the end, of the path.
    ends: [bool; 2],
}

impl BodyDisc {
    /// An agent that is a disc, or an outline that is computed as it is.
    fn whole(place: usize) -> Self {
        Self { agent: place, offset: None, stretch: None, growth: 0.0 }
    }

    /// Whether it is all of its agent, and moves with the reference point.
    pub(crate) fn is_whole(&self) -> bool {
        self.offset.is_none() && self.stretch.is_none()
    }

    /// The same disc, of the agent whose index is higher by `places`.
    pub(crate) fn moved(self, places: usize) -> Self {
        Self { agent: self.agent + places, ..self }
    }

    /// Lengths on the path of the agent, outward, of lengths on that of the disc.
    pub fn on_agent(&self, lengths: [f64; 2]) -> [f64; 2] {
        let [lo, hi] = self.offset.as_ref().map_or(lengths, |offset| offset.on_reference(lengths));
        let Some(DiscPresence { from, length, .. }) = self.stretch else { return [lo, hi] };
        // The rounding of the sums.
        let slack = ROUNDING * (1.0 + length);
        [(lo + from - slack).max(0.0), (hi + from + slack).min(length)]
    }

    /// Its first segment in the scenario (from 0).
    pub fn first(&self) -> usize {
        self.stretch.map_or(0, |stretch| stretch.first)
    }

    /// Segment in the scenario (from 0) of a segment of the disc.
    pub fn segment(&self, segment: usize) -> Option<usize> {
        let segment = self.offset.as_ref().map_or(Some(segment), |offset| offset.source(segment))?;
        segment.checked_add(self.first())
    }

    /// Whether it is there before the agent sets off.
    pub fn is_at_start(&self) -> bool {
        self.stands()[0]
    }

    /// Whether it is there after the arrival of the agent.
    pub fn is_at_end(&self) -> bool {
        self.stands()[1]
    }

    /// Whether it is there before the agent sets off, and after its arrival.
    pub(crate) fn stands(&self) -> [bool; 2] {
        self.stretch.map_or([true; 2], |stretch| stretch.ends)
    }

    /// When it is there, in a time that holds all motions \[s\].
    pub fn time<S: HostScalar>(&self, motion: &Motion<'_, S>, all: Interval<S>) -> Interval<S> {
        let own = motion.time();
        let [start, end] = self.stands();
        Interval { lo: if start { all.lo } else { own.lo }, hi: if end { all.hi } else { own.hi } }
    }
}

/// The fleet of the bodies, the bodies, and their scenario.
pub type DiscMotions<'a, S> = (Fleet<S>, Vec<BodyDisc>, Cow<'a, Scenario>);

impl<S: HostScalar> DiscFleet<S> {
    /// The bodies of a scenario.
    ///
    /// # Errors
    /// [`FormatRangeError`] where a value does not fit the number format.
    pub fn new(scenario: &Scenario, form: Form) -> Result<Self, FormatRangeError> {
        let (mut agents, mut discs) = (Vec::new(), Vec::new());
        let mut fleet = Fleet::new(&Scenario::default())?;
        for (place, agent) in scenario.agents.iter().enumerate() {
            if form == Form::Exact
                && let Some(outlined) = Fleet::outlined(agent)
            {
                fleet.append(outlined);
                agents.push(agent.clone());
                discs.push(BodyDisc::whole(place));
                continue;
            }
            let mut covers = (Vec::new(), Vec::new());
            self::discs::<S, _>(agent, place, &mut covers, rounded::<S>)?;
            let own = Scenario::new("", covers.0);
            fleet.append(Fleet::new(&own)?);
            agents.extend(own.agents);
            discs.extend(covers.1);
        }
        Ok(Self { fleet, scenario: Scenario::new(scenario.name.clone(), agents), discs })
    }

    /// Whether an agent is computed as several discs, or as one on a part of its path.
    pub(crate) fn is_covered(agent: &Agent) -> bool {
        !agent.loads.is_empty() || (agent.footprint.is_some() && Fleet::<S>::outlined(agent).is_none())
    }

    /// The same with the scenario itself where all agents are discs: of a large fleet, a copy of it would be large.
    ///
    /// # Errors
    /// As [`DiscFleet::new`].
    pub fn moving(scenario: &Scenario, form: Form) -> Result<DiscMotions<'_, S>, FormatRangeError> {
        if scenario.agents.iter().any(|agent| agent.footprint.is_some() || !agent.loads.is_empty()) {
            let Self { fleet, discs, scenario } = Self::new(scenario, form)?;
            return Ok((fleet, discs, Cow::Owned(scenario)));
        }
        let discs = (0..scenario.agents.len()).map(BodyDisc::whole).collect();
        Ok((Fleet::new(scenario)?, discs, Cow::Borrowed(scenario)))
    }
}

/// The paths of the discs of an agent, and their radii \[m\].
pub fn tracks(agent: &Agent) -> Vec<(Vec<PlacedSegment>, f64)> {
    let mut bodies = (Vec::new(), Vec::new());
    // Discs in `f64` lose no digits, for which one could be refused.
    let Ok(()) = discs::<f64, Infallible>(agent, 0, &mut bodies, Ok);
    let track = |disc: &Agent| {
        let [x, y, heading] = disc.start;
        let mut last = PlacedSegment { start: [x, y], heading, shape: PathSegment::Line { length: 0.0 } };
        let pieces = disc.path.iter().map(|&shape| {
            last = PlacedSegment { start: last.end(), heading: last.heading_at_end(), shape };
            last
        });
        let pieces: Vec<PlacedSegment> = pieces.collect();
        (if pieces.is_empty() { vec![last] } else { pieces }, disc.radius)
    };
    bodies.0.iter().map(track).collect()
}

/// Adds the discs of an agent, each as it is `rounded`.
fn discs<S: HostScalar, E>(
    agent: &Agent,
    place: usize,
    (agents, discs): &mut (Vec<Agent>, Vec<BodyDisc>),
    rounded: impl Fn(OffsetDisc) -> Result<OffsetDisc, E>,
) -> Result<(), E> {
    let outlines = agent.outlines();
    for outline in &outlines {
        let [first, last] = outline.segments;
        let (part, parts, stretch) = if outlines.len() > 1 {
            let AgentPart { agent: part, parts, from } = agent.stretch(first, last);
            // An agent that stands where the outline changes has both outlines. At its start or end that is so if the segments in
            // between have no length.
            let length = agent.length();
            let rest: f64 = agent.path.iter().skip(last + 1).map(PathSegment::length).sum();
            let ends = [from, rest].map(|way| way <= ROUNDING * (1.0 + length));
            (part, parts, Some(DiscPresence { from, length, first, ends }))
        } else {
            (agent.clone(), agent.parts(), None)
        };
        let part = Agent { radius: outline.radius, footprint: None, loads: Vec::new(), ..part };
        let Some(footprint) = outline.footprint else {
            discs.push(BodyDisc { agent: place, offset: None, stretch, growth: 0.0 });
            agents.push(if stretch.is_some() { settled::<S>(part) } else { part });
            continue;
        };
        let precision = ScalarPrecision::of::<S>(&part);
        for disc in footprint.discs() {
            // Their number is that of the agent, by which errors name them.
            let offset = rounded(OffsetDisc::of(&part, &parts, disc, agent.id, precision))?;
            let growth = offset.agent.radius - disc.radius;
            agents.push(offset.agent.clone());
            discs.push(BodyDisc { agent: place, offset: Some(Box::new(offset)), stretch, growth });
        }
    }
    Ok(())
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

/// The disc with a radius that makes up for the digits that the format does not have.
fn rounded<S: HostScalar>(offset: OffsetDisc) -> Result<OffsetDisc, FormatRangeError> {
    if S::NAME == f64::NAME {
        return Ok(offset);
    }
    let offset = offset.map(settled::<S>);
    let fleet = Fleet::<S>::new(&Scenario::new("", vec![offset.agent.clone()]))?;
    let rounding = fleet.motions().first().map(|motion| RoundingBounds::of(&offset.agent, motion));
    Ok(rounding.map_or(offset.clone(), |rounding| offset.rounded(rounding)))
}

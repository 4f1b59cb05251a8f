//! The agents of a scenario as discs: those of their footprints, or the one that they are.

use super::Disc;
use super::offset::Offset;
use crate::fleet::{Fleet, Format, Refused};
use crate::scenario::Scenario;

/// A scenario whose agents are the discs of another one's.
pub(crate) struct Bodies<S: Format> {
    /// The discs as agents.
    pub(crate) scenario: Scenario,
    /// Their motions.
    pub(crate) fleet: Fleet<S>,
    /// Whose they are.
    pub(crate) discs: Vec<Disced>,
}

/// A disc of an agent.
pub(crate) struct Disced {
    /// Place of the agent in its scenario.
    pub(crate) agent: usize,
    /// None where the agent is the disc.
    offset: Option<Offset>,
}

impl Disced {
    /// Lengths on the path of the agent, outward, of lengths on that of the disc.
    pub(crate) fn on_agent(&self, lengths: [f64; 2]) -> [f64; 2] {
        self.offset.as_ref().map_or(lengths, |offset| offset.on_reference(lengths))
    }

    /// Segment in the scenario (from 0) of a segment of the disc.
    pub(crate) fn segment(&self, segment: usize) -> Option<usize> {
        self.offset.as_ref().map_or(Some(segment), |offset| offset.source(segment))
    }
}

impl<S: Format> Bodies<S> {
    /// The discs of a scenario.
    ///
    /// # Errors
    /// [`Refused`] where a value does not fit the number format, and for footprints in another one than `f64`.
    pub(crate) fn new(scenario: &Scenario) -> Result<Self, Refused> {
        let mut discs = Vec::new();
        let mut agents = Vec::new();
        for (place, agent) in scenario.agents.iter().enumerate() {
            let Some(footprint) = &agent.footprint else {
                discs.push(Disced { agent: place, offset: None });
                agents.push(agent.clone());
                continue;
            };
            if S::NAME != f64::NAME {
                return Err(Refused::of::<S>(agent.id, "footprint: computed with in f64 only"));
            }
            // Their number is that of the agent, by which errors name them.
            let offsets = footprint.discs().iter().map(|disc: &Disc| Offset::of(agent, disc, agent.id));
            for offset in offsets {
                agents.push(offset.agent.clone());
                discs.push(Disced { agent: place, offset: Some(offset) });
            }
        }
        let scenario = Scenario { name: scenario.name.clone(), agents };
        Ok(Self { fleet: Fleet::new(&scenario)?, scenario, discs })
    }
}

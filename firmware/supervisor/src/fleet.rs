//! Storage for the motions of a fleet. It is built to be a `static`: nothing large is ever moved over the stack.

use crate::agent::{Agent, Step};
use heapless::Vec;
use pcr_core::{Curve, Invalid, Motion, PathRef, Phase, Profile, ProfileRef, Scalar, Segment};

/// The motions of up to `A` agents.
pub type Motions<'a, S, const A: usize> = Vec<Motion<'a, S>, A>;

/// What the motions of up to `A` agents with `N` segments in all borrow.
#[derive(Debug)]
pub struct Store<S: Scalar, const A: usize, const N: usize> {
    agents: Vec<Parts<S>, A>,
    segments: Vec<Segment<S>, N>,
}

#[derive(Debug)]
struct Parts<S> {
    /// Number of its segments, which follow those of the agent before.
    segments: usize,
    phases: Vec<Phase<S>, 3>,
    radius: S,
    start: S,
}

impl<S: Scalar, const A: usize, const N: usize> Store<S, A, N> {
    /// No agents.
    pub const fn new() -> Self {
        Self { agents: Vec::new(), segments: Vec::new() }
    }

    /// Forgets all agents.
    pub fn clear(&mut self) {
        self.agents.clear();
        self.segments.clear();
    }

    /// Number of agents.
    pub fn len(&self) -> usize {
        self.agents.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.agents.is_empty()
    }

    /// Adds an agent behind the others and returns its index.
    ///
    /// # Errors
    /// What the constructors of its path, its profile and its motion refuse; [`Invalid::Full`] where there is no room.
    pub fn add<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>) -> Result<usize, Invalid> {
        let (index, begin) = (self.agents.len(), self.segments.len());
        let added = self.place(agent, begin);
        if added.is_err() {
            self.segments.truncate(begin);
        }
        added.map(|()| index)
    }

    fn place<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>, begin: usize) -> Result<(), Invalid> {
        let origin = Segment::standing(agent.start)?;
        for step in agent.path.as_ref() {
            let last = self.segments.get(begin..).and_then(<[_]>::last).unwrap_or(&origin);
            let next = match step.curve {
                Curve::Line => last.then_line(step.length),
                Curve::Arc { radius, turn } => last.then_arc(radius, turn, step.length),
            }?;
            self.segments.push(next).map_err(|_| Invalid::Full("segment"))?;
        }
        if self.segments.len() == begin {
            self.segments.push(origin).map_err(|_| Invalid::Full("segment"))?;
        }
        let path = PathRef::new(self.segments.get(begin..).unwrap_or_default())?;
        let profile = Profile::rest_to_rest(path.length(), agent.limits)?;
        Motion::new(path, profile.as_profile(), agent.radius, agent.start_time)?;
        let mut phases = Vec::new();
        for phase in profile.as_profile().phases() {
            phases.push(*phase).map_err(|_| Invalid::Full("phase"))?;
        }
        let segments = self.segments.len().saturating_sub(begin);
        let parts = Parts { segments, phases, radius: agent.radius, start: agent.start_time };
        self.agents.push(parts).map_err(|_| Invalid::Full("agent"))
    }

    /// Lets an agent set off later by `delay`, which its motion must allow ([`Motion::delayed`]).
    pub fn delay(&mut self, agent: usize, delay: S) {
        if let Some(parts) = self.agents.get_mut(agent) {
            parts.start = parts.start + delay;
        }
    }

    /// The motions of all agents.
    // Inlined, its copies of the motions would lie on the stack of all that is done with them.
    #[inline(never)]
    pub fn motions(&self) -> Motions<'_, S, A> {
        let mut motions = Vec::new();
        self.put_motions(&mut motions);
        motions
    }

    /// Puts the motions of all agents behind those that are there.
    pub fn put_motions<'a>(&'a self, motions: &mut Motions<'a, S, A>) {
        let mut rest = &self.segments[..];
        for parts in &self.agents {
            let Some((own, others)) = rest.split_at_checked(parts.segments) else {
                break;
            };
            rest = others;
            // Each was accepted once, when the agent was added.
            let Ok(motion) = parts.motion(own) else {
                break;
            };
            if motions.push(motion).is_err() {
                break;
            }
        }
    }
}

impl<S: Scalar> Parts<S> {
    fn motion<'a>(&'a self, segments: &'a [Segment<S>]) -> Result<Motion<'a, S>, Invalid> {
        Motion::new(PathRef::new(segments)?, ProfileRef::new(&self.phases)?, self.radius, self.start)
    }
}

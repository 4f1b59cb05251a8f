//! Storage for the motions of a fleet, meant to be a `static`, so that nothing large is moved over the stack.

use crate::agent::{Agent, Step};
use heapless::Vec;
use pcr_core::{
    Curve, Interval, InvalidInput, Limits, Motion, PathRef, Phase, Pose, Profile, ProfileRef, Scalar, Segment,
};

/// The motions of up to `A` agents.
pub type Motions<'a, S, const A: usize> = Vec<Motion<'a, S>, A>;

/// The paths and profiles that the motions of up to `A` agents with `N` segments in total borrow. [`Store::replace`]
/// needs room for the segments of the new path in addition to those of the old one.
#[derive(Debug)]
pub struct Store<S: Scalar, const A: usize, const N: usize> {
    agents: Vec<Parts<S>, A>,
    segments: Vec<Segment<S>, N>,
}

/// An agent whose segments are stored.
#[derive(Debug)]
pub(crate) struct Parts<S> {
    /// Index of its first segment, and their number.
    begin: u16,
    segments: u16,
    phases: Vec<Phase<S>, 3>,
    limits: Limits<S>,
    radius: S,
    start: S,
}

/// Why an agent of a fleet was not changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rejected {
    /// There is no agent with this index.
    NoSuchAgent(usize),
    /// The new agent or motion is invalid.
    Invalid(InvalidInput),
}

impl From<InvalidInput> for Rejected {
    fn from(invalid: InvalidInput) -> Self {
        Self::Invalid(invalid)
    }
}

impl<S: Scalar, const A: usize, const N: usize> Default for Store<S, A, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar, const A: usize, const N: usize> Store<S, A, N> {
    /// A store without agents.
    pub const fn new() -> Self {
        const { assert!(A <= u16::MAX as usize && N <= u16::MAX as usize, "places are sent in 16 bits") };
        Self { agents: Vec::new(), segments: Vec::new() }
    }

    /// Removes all agents.
    pub fn clear(&mut self) {
        self.agents.clear();
        self.segments.clear();
    }

    /// Number of agents.
    pub fn len(&self) -> usize {
        self.agents.len()
    }

    /// Whether there are no agents.
    pub fn is_empty(&self) -> bool {
        self.agents.is_empty()
    }

    /// Appends an agent and returns its index.
    ///
    /// # Errors
    /// The errors of the constructors of its path, its profile and its motion; [`Invalid::Full`] if there is no room.
    pub fn add<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>) -> Result<usize, InvalidInput> {
        let (index, begin) = (self.agents.len(), self.segments.len());
        let added =
            self.parts(agent).and_then(|parts| self.agents.push(parts).map_err(|_| InvalidInput::Full("agent")));
        if added.is_err() {
            self.segments.truncate(begin);
        }
        added.map(|()| index)
    }

    /// Replaces an agent. O(segments).
    ///
    /// # Errors
    /// As [`Store::add`], and [`Rejected::NoSuchAgent`]; the fleet is then unchanged.
    pub fn replace<P: AsRef<[Step<S>]>>(&mut self, index: usize, agent: &Agent<S, P>) -> Result<(), Rejected> {
        let staged = self.stage(agent)?;
        self.settle(index, staged)
    }

    /// Stores an agent beside all others. It becomes part of the fleet by [`Store::settle`]; [`Store::unstage`] removes
    /// it.
    pub(crate) fn stage<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>) -> Result<Parts<S>, InvalidInput> {
        let begin = self.segments.len();
        self.parts(agent).inspect_err(|_| self.segments.truncate(begin))
    }

    pub(crate) fn unstage(&mut self, staged: &Parts<S>) {
        self.segments.truncate(usize::from(staged.begin));
    }

    /// The motion of a staged agent.
    pub(crate) fn staged<'a>(&'a self, staged: &'a Parts<S>) -> Result<Motion<'a, S>, InvalidInput> {
        staged.motion(&self.segments)
    }

    /// Replaces an agent by a staged one.
    pub(crate) fn settle(&mut self, index: usize, staged: Parts<S>) -> Result<(), Rejected> {
        let Some(place) = self.agents.get_mut(index) else {
            self.unstage(&staged);
            return Err(Rejected::NoSuchAgent(index));
        };
        let before = core::mem::replace(place, staged);
        self.forget(before.begin, before.segments);
        Ok(())
    }

    /// Removes an agent; the index of every agent behind it decreases by one. O(segments).
    ///
    /// # Errors
    /// [`Rejected::NoSuchAgent`].
    pub fn remove(&mut self, index: usize) -> Result<(), Rejected> {
        let gone = self.agents.get(index).ok_or(Rejected::NoSuchAgent(index))?;
        let (begin, segments) = (gone.begin, gone.segments);
        take_out(&mut self.agents, index);
        self.forget(begin, segments);
        Ok(())
    }

    /// Closes the gap in the segments of a removed agent.
    fn forget(&mut self, begin: u16, segments: u16) {
        for _ in 0..segments {
            take_out(&mut self.segments, usize::from(begin));
        }
        for parts in &mut self.agents {
            if parts.begin > begin {
                parts.begin = parts.begin.wrapping_sub(segments);
            }
        }
    }

    /// Stores an agent's segments behind all others. A caller that does not keep them has to remove them again.
    fn parts<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>) -> Result<Parts<S>, InvalidInput> {
        let begin = self.segments.len();
        let origin = Segment::standing(agent.start)?;
        for step in agent.path.as_ref() {
            let last = self.segments.get(begin..).and_then(<[_]>::last).unwrap_or(&origin);
            let next = match step.curve {
                Curve::Line => last.then_line(step.length),
                Curve::Arc { radius, turn } => last.then_arc(radius, turn, step.length),
                Curve::Pivot { lever, turn } => last.then_pivot(lever, turn, step.length),
            }?;
            self.segments.push(next).map_err(|_| InvalidInput::Full("segment"))?;
        }
        if self.segments.len() == begin {
            self.segments.push(origin).map_err(|_| InvalidInput::Full("segment"))?;
        }
        let path = PathRef::new(self.segments.get(begin..).unwrap_or_default())?;
        let profile = Profile::rest_to_rest(path.length(), agent.limits)?;
        Motion::new(path, profile.as_profile(), agent.radius, agent.start_time)?;
        let mut phases = Vec::new();
        for phase in profile.as_profile().phases() {
            phases.push(*phase).map_err(|_| InvalidInput::Full("phase"))?;
        }
        // There are at most 65535 segments.
        let [begin, end] = [begin, self.segments.len()].map(|place| place as u16);
        let segments = end.saturating_sub(begin);
        let (limits, radius, start) = (agent.limits, agent.radius, agent.start_time);
        Ok(Parts { begin, segments, phases, limits, radius, start })
    }

    /// Delays the start of an agent by `delay` \[s\]; returns the interval of its new motion.
    ///
    /// # Errors
    /// [`Rejected::NoSuchAgent`], and the errors of [`Motion::delayed`].
    pub fn delay(&mut self, index: usize, delay: S) -> Result<Interval<S>, Rejected> {
        let parts = self.agents.get(index).ok_or(Rejected::NoSuchAgent(index))?;
        let time = parts.motion(&self.segments)?.delayed(delay)?.time();
        if let Some(parts) = self.agents.get_mut(index) {
            parts.start = time.lo;
        }
        Ok(time)
    }

    /// An agent as it was received: its path is computed from the same bits.
    ///
    /// # Errors
    /// [`Rejected::NoSuchAgent`], and [`Invalid::Full`] if the path has more lines and arcs than a message can hold.
    pub fn agent(&self, index: usize) -> Result<Agent<S>, Rejected> {
        let parts = self.agents.get(index).ok_or(Rejected::NoSuchAgent(index))?;
        let [begin, count] = [parts.begin, parts.segments].map(usize::from);
        let segments = self.segments.get(begin..begin.saturating_add(count)).unwrap_or_default();
        let first = segments.first().ok_or(InvalidInput::Full("segment"))?;
        let start = Pose { position: first.point_at(S::ZERO), heading: first.heading_at(S::ZERO) };
        let mut path = Vec::new();
        for segment in segments {
            let step = Step { curve: segment.curve(), length: segment.length() };
            path.push(step).map_err(|_| InvalidInput::Full("step"))?;
        }
        Ok(Agent { radius: parts.radius, start_time: parts.start, limits: parts.limits, start, path })
    }

    /// The motions of all agents.
    ///
    /// # Errors
    /// As [`Store::put_motions`].
    // Not inlined: its copies of the motions would stay on the stack while the caller works with them.
    #[inline(never)]
    pub fn motions(&self) -> Result<Motions<'_, S, A>, InvalidInput> {
        let mut motions = Vec::new();
        self.put_motions(&mut motions)?;
        Ok(motions)
    }

    /// Appends the motions of all agents to a list.
    ///
    /// # Errors
    /// [`Invalid::Full`] if there is no room for all of them. A motion itself cannot be refused, because it was
    /// accepted when its agent was added.
    pub fn put_motions<'a>(&'a self, motions: &mut Motions<'a, S, A>) -> Result<(), InvalidInput> {
        for parts in &self.agents {
            motions.push(parts.motion(&self.segments)?).map_err(|_| InvalidInput::Full("agent"))?;
        }
        Ok(())
    }
}

impl<S: Scalar> Parts<S> {
    fn motion<'a>(&'a self, segments: &'a [Segment<S>]) -> Result<Motion<'a, S>, InvalidInput> {
        let [begin, count] = [self.begin, self.segments].map(usize::from);
        let own = segments.get(begin..begin.saturating_add(count)).ok_or(InvalidInput::Full("segment"))?;
        Motion::new(PathRef::new(own)?, ProfileRef::new(&self.phases)?, self.radius, self.start)
    }
}

/// Removes an existing item from a list, without the panic of [`Vec::remove`].
fn take_out<T, const N: usize>(list: &mut Vec<T, N>, index: usize) {
    for place in index..list.len() {
        if let Some([item, next]) = list.get_mut(place..).and_then(<[T]>::first_chunk_mut) {
            core::mem::swap(item, next);
        }
    }
    list.pop();
}

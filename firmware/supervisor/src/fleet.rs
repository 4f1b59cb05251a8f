//! Storage for the motions of a fleet. It is built to be a `static`: nothing large is ever moved over the stack.

use crate::agent::{Agent, Step};
use heapless::Vec;
use pcr_core::{Curve, Interval, Invalid, Limits, Motion, PathRef, Phase, Pose, Profile, ProfileRef, Scalar, Segment};

/// The motions of up to `A` agents.
pub type Motions<'a, S, const A: usize> = Vec<Motion<'a, S>, A>;

/// What the motions of up to `A` agents with `N` segments in all borrow. [`Store::replace`] needs room for the segments
/// of the new path beside those of the old one.
#[derive(Debug)]
pub struct Store<S: Scalar, const A: usize, const N: usize> {
    agents: Vec<Parts<S>, A>,
    segments: Vec<Segment<S>, N>,
}

/// An agent whose segments are placed.
#[derive(Debug)]
pub(crate) struct Parts<S> {
    /// The first of its segments, and how many there are.
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
    /// There is no agent of this index.
    NoSuchAgent(usize),
    /// What it was to become is refused.
    Invalid(Invalid),
}

impl From<Invalid> for Rejected {
    fn from(invalid: Invalid) -> Self {
        Self::Invalid(invalid)
    }
}

impl<S: Scalar, const A: usize, const N: usize> Default for Store<S, A, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Scalar, const A: usize, const N: usize> Store<S, A, N> {
    /// No agents.
    pub const fn new() -> Self {
        const { assert!(A <= u16::MAX as usize && N <= u16::MAX as usize, "places are sent in 16 bits") };
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
        let added = self.parts(agent).and_then(|parts| self.agents.push(parts).map_err(|_| Invalid::Full("agent")));
        if added.is_err() {
            self.segments.truncate(begin);
        }
        added.map(|()| index)
    }

    /// Puts another agent in the place of one. O(segments).
    ///
    /// # Errors
    /// As [`Store::add`], and [`Rejected::NoSuchAgent`]; the fleet is then as it was.
    pub fn replace<P: AsRef<[Step<S>]>>(&mut self, index: usize, agent: &Agent<S, P>) -> Result<(), Rejected> {
        let staged = self.stage(agent)?;
        self.settle(index, staged)
    }

    /// Places an agent beside all others; it is none of them before [`Store::settle`], and [`Store::unstage`] takes it away.
    pub(crate) fn stage<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>) -> Result<Parts<S>, Invalid> {
        let begin = self.segments.len();
        self.parts(agent).inspect_err(|_| self.segments.truncate(begin))
    }

    pub(crate) fn unstage(&mut self, staged: &Parts<S>) {
        self.segments.truncate(usize::from(staged.begin));
    }

    /// The motion of an agent that was staged.
    pub(crate) fn staged<'a>(&'a self, staged: &'a Parts<S>) -> Result<Motion<'a, S>, Invalid> {
        staged.motion(&self.segments)
    }

    /// Puts an agent that was staged in the place of one.
    pub(crate) fn settle(&mut self, index: usize, staged: Parts<S>) -> Result<(), Rejected> {
        let Some(place) = self.agents.get_mut(index) else {
            self.unstage(&staged);
            return Err(Rejected::NoSuchAgent(index));
        };
        let before = core::mem::replace(place, staged);
        self.forget(before.begin, before.segments);
        Ok(())
    }

    /// Removes an agent; those behind it move up by one index. O(segments).
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

    /// Closes the gap that an agent's segments leave.
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

    /// Puts an agent's segments behind all others. Whoever does not keep it takes them away again.
    fn parts<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>) -> Result<Parts<S>, Invalid> {
        let begin = self.segments.len();
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
        // There are at most 65535.
        let [begin, end] = [begin, self.segments.len()].map(|place| place as u16);
        let segments = end.saturating_sub(begin);
        let (limits, radius, start) = (agent.limits, agent.radius, agent.start_time);
        Ok(Parts { begin, segments, phases, limits, radius, start })
    }

    /// Lets an agent set off later by `delay` \[s\]; when it moves then.
    ///
    /// # Errors
    /// [`Rejected::NoSuchAgent`], and what [`Motion::delayed`] refuses.
    pub fn delay(&mut self, index: usize, delay: S) -> Result<Interval<S>, Rejected> {
        let parts = self.agents.get(index).ok_or(Rejected::NoSuchAgent(index))?;
        let time = parts.motion(&self.segments)?.delayed(delay)?.time();
        if let Some(parts) = self.agents.get_mut(index) {
            parts.start = time.lo;
        }
        Ok(time)
    }

    /// An agent as it came: the same path of the same bits comes of it.
    ///
    /// # Errors
    /// [`Rejected::NoSuchAgent`], and [`Invalid::Full`] for more lines and arcs than an agent has that is sent.
    pub fn agent(&self, index: usize) -> Result<Agent<S>, Rejected> {
        let parts = self.agents.get(index).ok_or(Rejected::NoSuchAgent(index))?;
        let [begin, count] = [parts.begin, parts.segments].map(usize::from);
        let segments = self.segments.get(begin..begin.saturating_add(count)).unwrap_or_default();
        let first = segments.first().ok_or(Invalid::Full("segment"))?;
        let start = Pose { position: first.point_at(S::ZERO), heading: first.heading_at(S::ZERO) };
        let mut path = Vec::new();
        for segment in segments {
            let step = Step { curve: segment.curve(), length: segment.length() };
            path.push(step).map_err(|_| Invalid::Full("step"))?;
        }
        Ok(Agent { radius: parts.radius, start_time: parts.start, limits: parts.limits, start, path })
    }

    /// The motions of all agents.
    ///
    /// # Errors
    /// As [`Store::put_motions`].
    // Inlined, its copies of the motions would lie on the stack of all that is done with them.
    #[inline(never)]
    pub fn motions(&self) -> Result<Motions<'_, S, A>, Invalid> {
        let mut motions = Vec::new();
        self.put_motions(&mut motions)?;
        Ok(motions)
    }

    /// Puts the motions of all agents behind those that are there.
    ///
    /// # Errors
    /// [`Invalid::Full`] where there is no room for all of them. A motion itself is not refused: it was accepted when its
    /// agent came.
    pub fn put_motions<'a>(&'a self, motions: &mut Motions<'a, S, A>) -> Result<(), Invalid> {
        for parts in &self.agents {
            motions.push(parts.motion(&self.segments)?).map_err(|_| Invalid::Full("agent"))?;
        }
        Ok(())
    }
}

impl<S: Scalar> Parts<S> {
    fn motion<'a>(&'a self, segments: &'a [Segment<S>]) -> Result<Motion<'a, S>, Invalid> {
        let [begin, count] = [self.begin, self.segments].map(usize::from);
        let own = segments.get(begin..begin.saturating_add(count)).ok_or(Invalid::Full("segment"))?;
        Motion::new(PathRef::new(own)?, ProfileRef::new(&self.phases)?, self.radius, self.start)
    }
}

/// Takes an item that is there out of a list. As [`Vec::remove`], which panics where there is none.
fn take_out<T, const N: usize>(list: &mut Vec<T, N>, index: usize) {
    for place in index..list.len() {
        if let Some([item, next]) = list.get_mut(place..).and_then(<[T]>::first_chunk_mut) {
            core::mem::swap(item, next);
        }
    }
    list.pop();
}

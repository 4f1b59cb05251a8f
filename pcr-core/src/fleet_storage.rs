//! Storage of fixed capacity for the paths and profiles of a fleet, meant to be a `static`, so that nothing large is moved over the stack.

#[cfg(all(test, feature = "libm", feature = "outlines"))]
mod tests;

use crate::error::InvalidInput;
use crate::geometry::{Direction, Interval, Pose};
use crate::motion::Motion;
use crate::outline::OutlineRef;
use crate::path::{PathRef, SegmentChain, swept};
use crate::profile::{Limits, Phase, Profile, ProfileRef};
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment, TurnSide};
use core::fmt;
use core::ops::{Deref, DerefMut};
use heapless::Vec;

/// The paths and profiles of up to `A` agents, with `N` segments in total and at most `F` phases each. Segments are built where they are
/// stored. A [`FleetMotions`] has the motions that borrow from it.
///
/// Outlines are borrowed for `'o`; they may be in a `static`, or built before the storage.
///
/// ```
/// use pcr_core::{Ecm, EcmEntry, FleetMotions, FleetStorage, Limits, Piece, Point, Pose, Radians};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let limits = Limits { speed: 1.0, acceleration: 1.0 };
///
/// let mut storage = FleetStorage::<f64, 2, 8>::new();
/// storage.start_at(east)?.line(4.0)?.rest_to_rest(limits)?.disc(0.25, 0.0)?.add()?;
/// storage.start_at(north)?.line(4.0)?.rest_to_rest(limits)?.disc(0.25, 0.0)?.add()?;
///
/// let mut fleet = FleetMotions::new();
/// fleet.fill(&storage);
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
/// assert_eq!(ecm.len(), 1);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// On a microcontroller, storage, motions and table are statics, here in cells of the crate `static_cell`:
///
/// ```ignore
/// static STORAGE: ConstStaticCell<FleetStorage<f32, 12, 36>> = ConstStaticCell::new(FleetStorage::new());
/// static FLEET: ConstStaticCell<FleetMotions<f32, 12>> = ConstStaticCell::new(FleetMotions::new());
/// static TABLE: ConstStaticCell<Ecm<f32, [EcmEntry; 80], [Piece<f32>; 110]>> =
///     ConstStaticCell::new(Ecm::new([EcmEntry::EMPTY; 80], [Piece::EMPTY; 110]));
/// ```
///
/// The compiler refuses more segments than an agent can number:
/// ```compile_fail,E0080
/// let _ = pcr_core::FleetStorage::<f64, 2, 65536>::new();
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FleetStorage<'o, S: Scalar, const A: usize, const N: usize, const F: usize = 3> {
    agents: Vec<StoredAgent<'o, S, F>, A>,
    /// Those of the agents, one agent after the other, and then those of an agent that is being built.
    segments: Vec<Segment<S>, N>,
    /// The agent that is being built. It is here because a [`NewAgent`] is moved at every call.
    next: Option<StoredAgent<'o, S, F>>,
}

/// An agent whose segments are stored.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct StoredAgent<'o, S: Scalar, const F: usize> {
    /// Index of its first segment, and their number.
    begin: u16,
    segments: u16,
    phases: Vec<Phase<S>, F>,
    outline: OutlineRef<'o, S>,
    start: S,
}

/// Why an agent in the storage of a fleet was not changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FleetStorageError {
    /// The storage has no agent with this index.
    NoSuchAgent(usize),
    /// The motion of the agent would be invalid.
    Invalid(InvalidInput),
}

impl From<InvalidInput> for FleetStorageError {
    fn from(invalid: InvalidInput) -> Self {
        Self::Invalid(invalid)
    }
}

impl fmt::Display for FleetStorageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchAgent(agent) => write!(f, "the fleet has no agent {agent}"),
            Self::Invalid(invalid) => invalid.fmt(f),
        }
    }
}

impl core::error::Error for FleetStorageError {}

impl<S: Scalar, const A: usize, const N: usize, const F: usize> Default for FleetStorage<'_, S, A, N, F> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'o, S: Scalar, const A: usize, const N: usize, const F: usize> FleetStorage<'o, S, A, N, F> {
    /// Returns a storage without agents. It is all zeros, so a `static` takes no flash for it.
    pub const fn new() -> Self {
        const { assert!(N <= u16::MAX as usize, "a fleet has at most 65535 segments") };
        Self { agents: Vec::new(), segments: Vec::new(), next: None }
    }

    /// Removes all agents.
    pub fn clear(&mut self) {
        self.agents.clear();
        self.segments.clear();
        self.next = None;
    }

    /// Number of agents.
    pub fn len(&self) -> usize {
        self.agents.len()
    }

    /// Whether there are no agents.
    pub fn is_empty(&self) -> bool {
        self.agents.is_empty()
    }

    /// Begins an agent whose path starts at `pose`. It belongs to the fleet once [`StagedAgent::add`] or [`StagedAgent::replace`] is called;
    /// until then the fleet does not change, and if neither is, it is forgotten.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`]; [`InvalidInput::Full`] if there is no room for a segment.
    pub fn start_at(&mut self, pose: Pose<S>) -> Result<NewAgent<'_, 'o, S, A, N, F>, InvalidInput> {
        let begin = self.used();
        // Those of an agent that was forgotten.
        self.segments.truncate(usize::from(begin));
        self.segments.push(Segment::standing(pose)?).map_err(|_| InvalidInput::Full("segment"))?;
        let outline = OutlineRef::disc(S::ZERO);
        self.next = Some(StoredAgent { begin, segments: 0, phases: Vec::new(), outline, start: S::ZERO });
        Ok(NewAgent { storage: self, body: None })
    }

    /// Returns the motion of an agent.
    ///
    /// # Errors
    /// [`FleetStorageError::NoSuchAgent`].
    pub fn motion(&self, agent: usize) -> Result<Motion<'_, S>, FleetStorageError> {
        let stored = self.agents.get(agent).ok_or(FleetStorageError::NoSuchAgent(agent))?;
        Ok(stored.motion(&self.segments))
    }

    /// Delays the start of an agent by `delay` \[s\], which may be negative, and returns the interval of its new motion \[s\].
    ///
    /// # Errors
    /// [`FleetStorageError::NoSuchAgent`], and the errors of [`Motion::delayed`]; the agent is then unchanged.
    pub fn delay(&mut self, agent: usize, delay: S) -> Result<Interval<S>, FleetStorageError> {
        let time = self.motion(agent)?.delayed(delay)?.time();
        if let Some(stored) = self.agents.get_mut(agent) {
            stored.start = time.lo;
        }
        Ok(time)
    }

    /// Removes an agent; the index of every agent behind it decreases by one. O(agents + segments).
    ///
    /// # Errors
    /// [`FleetStorageError::NoSuchAgent`].
    pub fn remove(&mut self, agent: usize) -> Result<(), FleetStorageError> {
        let gone = self.agents.get(agent).ok_or(FleetStorageError::NoSuchAgent(agent))?;
        let (begin, segments) = (gone.begin, gone.segments);
        for place in agent..self.agents.len() {
            if let Some([first, second]) = self.agents.get_mut(place..).and_then(<[_]>::first_chunk_mut) {
                core::mem::swap(first, second);
            }
        }
        self.agents.pop();
        self.close(begin, segments);
        Ok(())
    }

    /// The agent that is being built. There is one wherever this is called.
    fn next(&mut self) -> Result<&mut StoredAgent<'o, S, F>, InvalidInput> {
        self.next.as_mut().ok_or(InvalidInput::Disconnected("path"))
    }

    /// Number of segments of the agents.
    fn used(&self) -> u16 {
        self.agents.iter().fold(0, |sum, agent| agent.segments.wrapping_add(sum))
    }

    /// Closes the gap in the segments of an agent that is gone.
    fn close(&mut self, begin: u16, segments: u16) {
        let count = usize::from(segments);
        for place in usize::from(begin)..self.segments.len() {
            let Some(&next) = self.segments.get(place.saturating_add(count)) else { break };
            if let Some(segment) = self.segments.get_mut(place) {
                *segment = next;
            }
        }
        self.segments.truncate(self.segments.len().saturating_sub(count));
        for agent in &mut self.agents {
            if agent.begin > begin {
                agent.begin = agent.begin.wrapping_sub(segments);
            }
        }
    }
}

impl<S: Scalar, const F: usize> StoredAgent<'_, S, F> {
    fn path<'a>(&self, segments: &'a [Segment<S>]) -> PathRef<'a, S> {
        let [begin, count] = [self.begin, self.segments].map(usize::from);
        PathRef::of(segments.get(begin..begin.saturating_add(count)).unwrap_or_default())
    }

    /// The motion, which was accepted when the agent was completed.
    fn motion<'a>(&'a self, segments: &'a [Segment<S>]) -> Motion<'a, S> {
        Motion::accepted(self.path(segments), ProfileRef::of(&self.phases), self.outline, self.start)
    }
}

/// An agent that is being built in a [`FleetStorage`]: first its path, then its profile, then its body.
#[derive(Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "an agent belongs to the fleet once it has a body and is added"]
pub struct NewAgent<'f, 'o, S: Scalar, const A: usize, const N: usize, const F: usize> {
    storage: &'f mut FleetStorage<'o, S, A, N, F>,
    body: Option<Direction<S>>,
}

impl<'f, 'o, S: Scalar, const A: usize, const N: usize, const F: usize> NewAgent<'f, 'o, S, A, N, F> {
    /// Appends a segment of this shape and length \[m\], for paths that are stored as lists of both.
    ///
    /// # Errors
    /// As [`Path::line`](crate::Path::line), [`Path::arc`](crate::Path::arc) and [`Path::pivot`](crate::Path::pivot).
    pub fn segment(mut self, curve: Curve<S>, length: S) -> Result<Self, InvalidInput> {
        match curve {
            Curve::Line => self.append_line(length),
            Curve::Arc { radius, turn } => self.append_arc(radius, turn, length),
            Curve::Pivot { lever, turn } => self.append_pivot(lever, turn, length),
        }?;
        Ok(self)
    }

    /// Appends a line of this length \[m\].
    ///
    /// # Errors
    /// As [`Path::line`](crate::Path::line).
    pub fn line(mut self, length: S) -> Result<Self, InvalidInput> {
        self.append_line(length)?;
        Ok(self)
    }

    /// Appends an arc of this radius \[m\] and length \[m\].
    ///
    /// # Errors
    /// As [`Path::arc`](crate::Path::arc).
    pub fn arc(mut self, radius: S, turn: TurnSide, length: S) -> Result<Self, InvalidInput> {
        self.append_arc(radius, turn, length)?;
        Ok(self)
    }

    /// Appends an arc of this radius \[m\] and length \[m\] on which the body keeps its heading.
    ///
    /// # Errors
    /// As [`Path::steady_arc`](crate::Path::steady_arc).
    pub fn steady_arc(mut self, radius: S, turn: TurnSide, length: S) -> Result<Self, InvalidInput> {
        self.append_steady_arc(radius, turn, length)?;
        Ok(self)
    }

    /// Appends an arc of this radius \[m\] that turns by `sweep` \[rad\], to the left if positive.
    ///
    /// # Errors
    /// As [`Path::arc_by`](crate::Path::arc_by).
    pub fn arc_by(mut self, radius: S, sweep: S) -> Result<Self, InvalidInput> {
        let (turn, length) = swept(radius, sweep)?;
        self.append_arc(radius, turn, length)?;
        Ok(self)
    }

    /// Appends a turn in place by `sweep` \[rad\], to the left if positive, with this lever \[m\].
    ///
    /// # Errors
    /// As [`Path::pivot`](crate::Path::pivot).
    pub fn pivot(mut self, lever: S, sweep: S) -> Result<Self, InvalidInput> {
        let (turn, length) = swept(lever, sweep)?;
        self.append_pivot(lever, turn, length)?;
        Ok(self)
    }

    /// Turns the direction of travel, as [`Path::turn`](crate::Path::turn) does.
    ///
    /// # Errors
    /// As [`Path::turn`](crate::Path::turn).
    pub fn turn(mut self, by: S::Angle) -> Result<Self, InvalidInput> {
        self.turn_by(by)?;
        Ok(self)
    }

    /// Sets the angle from the direction of travel to the heading of the body, as [`Path::facing`](crate::Path::facing) does.
    ///
    /// # Errors
    /// As [`Path::facing`](crate::Path::facing).
    pub fn facing(mut self, angle: S::Angle) -> Result<Self, InvalidInput> {
        self.face(angle)?;
        Ok(self)
    }

    /// Changes gear at a cusp, as [`Path::reverse`](crate::Path::reverse) does.
    ///
    /// # Errors
    /// As [`Path::reverse`](crate::Path::reverse).
    pub fn reverse(mut self) -> Result<Self, InvalidInput> {
        self.change_gear()?;
        Ok(self)
    }

    /// Sets the profile that travels the path from rest to rest in the least time. Call it when the path is complete.
    ///
    /// # Errors
    /// As [`Profile::rest_to_rest`]; [`InvalidInput::Full`] if it has more than `F` phases, of at most three.
    pub fn rest_to_rest(self, limits: Limits<S>) -> Result<Self, InvalidInput> {
        let length = self.storage.segments.last().map_or(S::ZERO, |last| last.to);
        let profile = Profile::rest_to_rest(length, limits)?;
        self.profile(profile.as_profile())
    }

    /// Sets the profile; without one the agent stands.
    ///
    /// # Errors
    /// [`InvalidInput::Full`] if it has more than `F` phases.
    pub fn profile(self, profile: ProfileRef<'_, S>) -> Result<Self, InvalidInput> {
        let phases = &mut self.storage.next()?.phases;
        phases.clear();
        for phase in profile.phases() {
            phases.push(*phase).map_err(|_| InvalidInput::Full("phase"))?;
        }
        Ok(self)
    }

    /// Completes the agent: a disc of this radius \[m\] that sets off at the time `start` \[s\].
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn disc(self, radius: S, start: S) -> Result<StagedAgent<'f, 'o, S, A, N, F>, InvalidInput> {
        crate::error::radius(radius)?;
        self.staged(OutlineRef::disc(radius), start)
    }

    /// Completes the agent: an outline that sets off at the time `start` \[s\].
    ///
    /// # Errors
    /// As [`Motion::with_outline`].
    #[cfg(feature = "outlines")]
    pub fn outline(
        self,
        outline: impl Into<OutlineRef<'o, S>>,
        start: S,
    ) -> Result<StagedAgent<'f, 'o, S, A, N, F>, InvalidInput> {
        self.staged(outline.into(), start)
    }

    fn staged(self, outline: OutlineRef<'o, S>, start: S) -> Result<StagedAgent<'f, 'o, S, A, N, F>, InvalidInput> {
        // There are at most 65535 segments.
        let end = self.storage.segments.len() as u16;
        let mut agent = self.storage.next.take().ok_or(InvalidInput::Disconnected("path"))?;
        (agent.segments, agent.outline, agent.start) = (end.wrapping_sub(agent.begin), outline, start);
        Motion::of(agent.path(&self.storage.segments), ProfileRef::of(&agent.phases), outline, start)?;
        Ok(StagedAgent { storage: self.storage, agent })
    }
}

impl<S: Scalar, const A: usize, const N: usize, const F: usize> SegmentChain<S> for NewAgent<'_, '_, S, A, N, F> {
    fn last(&mut self) -> Result<&mut Segment<S>, InvalidInput> {
        self.storage.segments.last_mut().ok_or(InvalidInput::Disconnected("segment"))
    }

    fn body(&mut self) -> &mut Option<Direction<S>> {
        &mut self.body
    }

    fn push(&mut self, next: Segment<S>) -> Result<(), InvalidInput> {
        let begin = self.storage.next()?.begin;
        match self.storage.segments.get_mut(usize::from(begin)) {
            // The one with which the path begins has no length; the first one that has takes its place.
            Some(first) if first.length <= S::ZERO => *first = next,
            _ => self.storage.segments.push(next).map_err(|_| InvalidInput::Full("segment"))?,
        }
        Ok(())
    }
}

/// An agent that is complete, and does not belong to the fleet yet.
#[derive(Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "an agent belongs to the fleet once it is added"]
pub struct StagedAgent<'f, 'o, S: Scalar, const A: usize, const N: usize, const F: usize> {
    storage: &'f mut FleetStorage<'o, S, A, N, F>,
    agent: StoredAgent<'o, S, F>,
}

impl<'o, S: Scalar, const A: usize, const N: usize, const F: usize> StagedAgent<'_, 'o, S, A, N, F> {
    /// Returns the storage with the fleet to which the agent does not belong yet.
    pub fn storage(&self) -> &FleetStorage<'o, S, A, N, F> {
        self.storage
    }

    /// Returns the motion of the agent, to try it before it is added.
    pub fn motion(&self) -> Motion<'_, S> {
        self.agent.motion(&self.storage.segments)
    }

    /// Adds the agent to the fleet, behind all others, and returns its index.
    ///
    /// # Errors
    /// [`InvalidInput::Full`] if there are `A` agents already.
    pub fn add(self) -> Result<usize, InvalidInput> {
        let index = self.storage.agents.len();
        self.storage.agents.push(self.agent).map_err(|_| InvalidInput::Full("agent"))?;
        Ok(index)
    }

    /// Puts the agent in the place of another one. The storage has to have room for the segments of both. O(agents + segments).
    ///
    /// # Errors
    /// [`FleetStorageError::NoSuchAgent`]; the fleet is then unchanged.
    pub fn replace(self, agent: usize) -> Result<(), FleetStorageError> {
        let stored = self.storage.agents.get_mut(agent).ok_or(FleetStorageError::NoSuchAgent(agent))?;
        let (begin, segments) = (stored.begin, stored.segments);
        *stored = self.agent;
        self.storage.close(begin, segments);
        Ok(())
    }
}

/// The motions of up to `A` agents of a [`FleetStorage`], as the slice that tables and queries take. Motions may be changed in place, for
/// example to give them a margin.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FleetMotions<'a, S: Scalar, const A: usize> {
    motions: Vec<Motion<'a, S>, A>,
}

impl<'a, S: Scalar, const A: usize> FleetMotions<'a, S, A> {
    /// Returns an empty list. It is all zeros, so a `static` takes no flash for it.
    pub const fn new() -> Self {
        Self { motions: Vec::new() }
    }

    /// Puts the motions of all agents of the storage into the list, in the place of those that were in it.
    pub fn fill<const N: usize, const F: usize>(&mut self, storage: &'a FleetStorage<'_, S, A, N, F>) {
        self.motions.clear();
        for agent in &storage.agents {
            // There is room: storage and list have the same capacity, `A`.
            let _ = self.motions.push(agent.motion(&storage.segments));
        }
    }
}

impl<S: Scalar, const A: usize> Default for FleetMotions<'_, S, A> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'a, S: Scalar, const A: usize> Deref for FleetMotions<'a, S, A> {
    type Target = [Motion<'a, S>];

    fn deref(&self) -> &Self::Target {
        &self.motions
    }
}

impl<S: Scalar, const A: usize> DerefMut for FleetMotions<'_, S, A> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.motions
    }
}

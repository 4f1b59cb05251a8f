//! Broad phase in space and time: which agents of a fleet can be in contact at all, and when.
//!
//! An interval of time is cut into equal parts, and each agent has a box for every part. A box holds the positions of
//! the agent at both ends of the part and the joints of its path in between. An arc of length w and radius ϱ is at most
//! w² / 8ϱ from its chord (linear interpolation), so the box contains the arc after it is expanded by that. It is
//! expanded further by the radius and the [`Encounter::tolerance`] of the agent with itself, so that agents whose boxes
//! do not meet are not in contact. The parts in which the boxes of a pair meet are bits of a word;
//! [`Encounter::contacts`] then examines runs of such parts.

use crate::bit_rows::{self, BitRuns};
use crate::error::{CapacityError, MismatchError};
use crate::geometry::{Aabb, Interval, Point};
use crate::motion::Motion;
use crate::query::contact::{Contacts, Encounter};
use crate::scalar::Scalar;
use core::hint::select_unpredictable as select;
use core::iter::{self, Take};
use core::slice::ChunksExact;

/// Number of parts that the bits of a word can represent.
const MOST_PARTS: usize = u32::BITS as usize;

/// A fleet during an interval of time, as boxes in space and time.
///
/// ```
/// use pcr_core::{Aabb, BroadPhase, Interval, Motion, Path, Point, Pose, Profile, Radians};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let far = Pose { position: Point::new(9.0, 0.0), heading: Radians(0.0) };
/// let [east, north, far] = [east, north, far].map(|pose| Path::<f64, 1>::starting_at(pose)?.line(4.0));
/// let (paths, profile) = ([east?, north?, far?], Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?);
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?, motion(paths[2].as_path())?];
///
/// let boxes = [Aabb::default(); 3 * (1 + 16)];
/// let broad_phase = BroadPhase::new(boxes, &fleet, Interval::new(0.0, 4.0))?;
/// let (agents, time) = broad_phase.contacts().next().unwrap();
/// assert_eq!(agents, [0, 1]);
/// assert!((time.middle() - 2.0).abs() < 1e-9 && (time.length() - 0.5_f64.sqrt()).abs() < 1e-9);
/// assert_eq!(broad_phase.candidates().count(), 1);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BroadPhase<'a, S: Scalar, B> {
    fleet: &'a [Motion<'a, S>],
    /// One row for each agent: the box for the whole time, then those for its parts.
    boxes: B,
    during: Interval<S>,
    /// How often the time is halved.
    halvings: u32,
}

#[cfg(feature = "defmt")]
impl<S: Scalar + defmt::Format, B> defmt::Format for BroadPhase<'_, S, B> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} agents in {} parts of {} s", self.fleet.len(), self.parts(), self.during);
    }
}

impl<'a, S: Scalar, B: AsRef<[Aabb<S>]> + AsMut<[Aabb<S>]>> BroadPhase<'a, S, B> {
    /// Computes the boxes of a fleet for an interval of time \[s\], in 32, 16, 8, 4, 2 parts or 1: as many as the
    /// storage has room for. Each agent needs one box more than there are parts. More parts exclude more pairs, but
    /// take more time themselves; about 16 are best for a fleet that crosses its floor once. The interval is limited in
    /// the same way as by [`Encounter::contacts`].
    ///
    /// Cost: one evaluation of the path for each part.
    ///
    /// # Errors
    /// [`CapacityError::Boxes`] if there is room for less than two boxes for each agent.
    pub fn new(mut boxes: B, fleet: &'a [Motion<'a, S>], during: Interval<S>) -> Result<Self, CapacityError> {
        let during = during.limited();
        let room = boxes.as_ref().len().checked_div(fleet.len()).unwrap_or(usize::MAX);
        let (needed, capacity) = (fleet.len().saturating_mul(2), boxes.as_ref().len());
        let halvings = room.saturating_sub(1).checked_ilog2().ok_or(CapacityError::Boxes { needed, capacity })?;
        let halvings = halvings.min(MOST_PARTS.ilog2());
        let parts = 1_u32.wrapping_shl(halvings);
        let mut ends = [during.hi; MOST_PARTS];
        for (part, end) in (1..parts).zip(&mut ends) {
            *end = place_in(during, part, halvings);
        }
        let row = (parts as usize).wrapping_add(1);
        for (motion, row) in fleet.iter().zip(boxes.as_mut().chunks_exact_mut(row)) {
            let [all, row @ ..] = row else { break };
            let margin = motion.radius() + Encounter::new(motion, motion).tolerance();
            let mut way = PathCursor::starting(motion, during.lo);
            *all = Aabb::around(way.point, way.point);
            for (place, &end) in row.iter_mut().zip(&ends) {
                *place = way.until(end, margin);
                *all = all.hull(*place);
            }
        }
        Ok(Self { fleet, boxes, during, halvings })
    }
}

impl<S: Scalar, B> BroadPhase<'_, S, B> {
    /// Number of parts into which the time is cut.
    pub fn parts(&self) -> u32 {
        1_u32.wrapping_shl(self.halvings)
    }
}

impl<S: Scalar, B: AsRef<[Aabb<S>]>> BroadPhase<'_, S, B> {
    /// The pairs of agents that may be in contact, the lower index first, with the interval of time \[s\]: in
    /// increasing order of the agents, then of the time. At all other times they are not in contact.
    ///
    /// Cost: a comparison of boxes for each pair of agents, and one for each part for pairs whose boxes for the whole
    /// time meet.
    pub fn candidates(&self) -> impl Iterator<Item = ([usize; 2], Interval<S>)> {
        let rows = self.boxes.as_ref().chunks_exact((self.parts() as usize).wrapping_add(1));
        let rows = rows.take(self.fleet.len());
        CandidatePairs {
            during: self.during,
            halvings: self.halvings,
            own: &[],
            others: [].chunks_exact(1).take(0),
            agents: [0; 2],
            runs: BitRuns(0),
            rows,
            next: 0,
        }
    }

    /// The contacts of all pairs as intervals of time \[s\], in increasing order of the agents, then of the time: the
    /// same as [`Encounter::contacts`] of each pair, within its tolerance.
    ///
    /// Cost: that of [`BroadPhase::candidates`], and of [`Encounter::contacts`] for each.
    pub fn contacts(&self) -> impl Iterator<Item = ([usize; 2], Interval<S>)> {
        let (mut candidates, mut current) = (self.candidates(), None);
        iter::from_fn(move || {
            loop {
                if let Some((agents, contacts)) = &mut current
                    && let Some(time) = Contacts::next(contacts)
                {
                    return Some((*agents, time));
                }
                let (agents, during) = candidates.next()?;
                // Both agents are in the fleet.
                current = self.encounter(agents).ok().map(|encounter| (agents, encounter.contacts(during)));
            }
        })
    }

    /// The contacts of two agents of the fleet, given by their indices, during an interval of time \[s\]. Use it for
    /// one of the [`BroadPhase::candidates`]; these may be examined in any order, also on several cores.
    ///
    /// Cost: that of [`Encounter::contacts`].
    ///
    /// # Errors
    /// [`MismatchError::NoSuchAgent`].
    pub fn contacts_of(
        &self,
        agents: [usize; 2],
        during: Interval<S>,
    ) -> Result<impl Iterator<Item = ([usize; 2], Interval<S>)> + use<'_, S, B>, MismatchError> {
        let contacts = self.encounter(agents)?.contacts(during);
        Ok(contacts.map(move |time| (agents, time)))
    }
}

impl<'a, S: Scalar, B> BroadPhase<'a, S, B> {
    fn encounter(&self, agents: [usize; 2]) -> Result<Encounter<'a, S>, MismatchError> {
        let [first, second] = agents.map(|agent| self.fleet.get(agent).ok_or(MismatchError::NoSuchAgent(agent)));
        Ok(Encounter::new(first?, second?))
    }
}

/// The pairs of agents whose boxes meet.
struct CandidatePairs<'a, S: Scalar> {
    during: Interval<S>,
    halvings: u32,
    /// Boxes of the agents from index `next` on.
    rows: Take<ChunksExact<'a, Aabb<S>>>,
    next: usize,
    /// Boxes of the first agent of the pair, and of those that come after the second one.
    own: &'a [Aabb<S>],
    others: Take<ChunksExact<'a, Aabb<S>>>,
    agents: [usize; 2],
    /// The parts in which their boxes meet and which have not been returned yet.
    runs: BitRuns,
}

impl<S: Scalar> Iterator for CandidatePairs<'_, S> {
    type Item = ([usize; 2], Interval<S>);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(run) = self.runs.next() {
                let ends = [run.trailing_zeros(), u32::BITS.wrapping_sub(run.leading_zeros())];
                let [lo, hi] = ends.map(|part| place_in(self.during, part, self.halvings));
                return Some((self.agents, Interval::new(lo, hi)));
            }
            if let Some(other) = self.others.next() {
                self.agents[1] = self.agents[1].wrapping_add(1);
                self.runs = BitRuns(meeting(self.own, other));
            } else {
                self.own = self.rows.next()?;
                self.others = self.rows.clone();
                self.agents = [self.next; 2];
                self.next = self.next.wrapping_add(1);
            }
        }
    }
}

/// The begin of a part of an interval that has been halved so often. The index behind the last part gives the end of
/// the interval.
fn place_in<S: Scalar>(interval: Interval<S>, part: u32, halvings: u32) -> S {
    let Interval { mut lo, mut hi } = interval;
    if part.wrapping_shr(halvings) != 0 {
        return hi;
    }
    for bit in (0..halvings).rev() {
        let middle = Interval::new(lo, hi).middle();
        let upper = part.wrapping_shr(bit) & 1 != 0;
        (lo, hi) = (select(upper, middle, lo), select(upper, hi, middle));
    }
    lo
}

/// The parts in which the boxes of two rows meet, one bit each.
fn meeting<S: Scalar>(own: &[Aabb<S>], other: &[Aabb<S>]) -> u32 {
    let ([all, own @ ..], [their, other @ ..]) = (own, other) else { return 0 };
    if !all.meets(*their) {
        return 0;
    }
    bit_rows::row(own.iter().zip(other).map(|(own, other)| own.meets(*other)))
}

/// Follows an agent along its path from one time to the next.
struct PathCursor<'a, S: Scalar> {
    motion: &'a Motion<'a, S>,
    /// The place that was reached: index of the segment, length along the path, and the point there.
    place: usize,
    length: S,
    point: Point<S>,
}

impl<'a, S: Scalar> PathCursor<'a, S> {
    fn starting(motion: &'a Motion<'a, S>, time: S) -> Self {
        let length = motion.length_at(time);
        let place = motion.path().segments().partition_point(|segment| segment.to < length);
        Self { motion, place, length, point: motion.path().point_at(length) }
    }

    /// A box around the path from the last place to that at `time`, expanded by `margin`.
    fn until(&mut self, time: S, margin: S) -> Aabb<S> {
        let (path, from) = (self.motion.path(), self.length);
        let to = self.motion.length_at(time).max(from);
        let (mut bounds, mut bulge) = (Aabb::around(self.point, self.point), S::ZERO);
        for segment in path.segments().get(self.place..).unwrap_or_default() {
            self.point = segment.point_at(to - segment.from);
            bounds = bounds.hull(Aabb::around(self.point, self.point));
            bulge = bulge.max(segment.bulge(to.min(segment.to) - from.max(segment.from)));
            if to <= segment.to {
                break;
            }
            self.place = self.place.wrapping_add(1);
        }
        self.length = to;
        bounds.expanded(bulge + margin)
    }
}

//! Broad phase in space and time: which agents of a fleet can be in contact at all, and when.
//!
//! An interval of time is cut into equal parts, and each agent has a box for every part. A box holds the points where the
//! agent is at both ends of the part and the joints of its path between them. An arc of length w and radius ϱ is w² / 8ϱ
//! from its chord at most (linear interpolation), so that the box, moved outward by as much, holds the arc; and by the radius
//! and [`Encounter::tolerance`] of the agent with itself, so that agents whose boxes do not meet are in no contact. The
//! parts in which the boxes of a pair meet are bits of a word, and runs of them are looked at by [`Encounter::contacts`].

use crate::bits::{self, Runs};
use crate::error::{Full, Mismatch};
use crate::geometry::{Bounds, Interval, Point};
use crate::motion::Motion;
use crate::query::contact::{Contacts, Encounter};
use crate::scalar::Scalar;
use core::hint::select_unpredictable as select;
use core::iter::{self, Take};
use core::slice::ChunksExact;

/// What the bits of a word can tell of.
const MOST_PARTS: usize = u32::BITS as usize;

/// A fleet during an interval of time, as boxes in space and time.
///
/// ```
/// use pcr_core::{Bounds, BroadPhase, Interval, Motion, Path, Point, Pose, Profile, Radians};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let far = Pose { position: Point::new(9.0, 0.0), heading: Radians(0.0) };
/// let [east, north, far] = [east, north, far].map(|pose| Path::<f64, 1>::starting_at(pose)?.line(4.0));
/// let (paths, profile) = ([east?, north?, far?], Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?);
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?, motion(paths[2].as_path())?];
///
/// let boxes = [Bounds::default(); 3 * (1 + 16)];
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
    /// A row an agent: the box of all of the time, then those of its parts.
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

impl<'a, S: Scalar, B: AsRef<[Bounds<S>]> + AsMut<[Bounds<S>]>> BroadPhase<'a, S, B> {
    /// The fleet during an interval of time \[s\], in 32, 16, 8, 4, 2 parts or 1: as many as there is room for. Each agent
    /// needs a box more than there are parts. More parts sort out more pairs and take more time themselves; about 16 are
    /// best where a fleet crosses its floor once. The interval is cut as by [`Encounter::contacts`].
    ///
    /// Cost: a point of the path a part.
    ///
    /// # Errors
    /// [`Full::Boxes`] where there is room for less than two boxes an agent.
    pub fn new(mut boxes: B, fleet: &'a [Motion<'a, S>], during: Interval<S>) -> Result<Self, Full> {
        let during = during.limited();
        let room = boxes.as_ref().len().checked_div(fleet.len()).unwrap_or(usize::MAX);
        let halvings = room.saturating_sub(1).checked_ilog2().ok_or(Full::Boxes)?.min(MOST_PARTS.ilog2());
        let parts = 1_u32.wrapping_shl(halvings);
        let mut ends = [during.hi; MOST_PARTS];
        for (part, end) in (1..parts).zip(&mut ends) {
            *end = place_in(during, part, halvings);
        }
        let row = (parts as usize).wrapping_add(1);
        for (motion, row) in fleet.iter().zip(boxes.as_mut().chunks_exact_mut(row)) {
            let [all, row @ ..] = row else { break };
            let margin = motion.radius() + Encounter::new(motion, motion).tolerance();
            let mut way = Way::starting(motion, during.lo);
            *all = Bounds::around(way.point, way.point);
            for (place, &end) in row.iter_mut().zip(&ends) {
                *place = way.until(end, margin);
                *all = all.hull(*place);
            }
        }
        Ok(Self { fleet, boxes, during, halvings })
    }
}

impl<S: Scalar, B> BroadPhase<'_, S, B> {
    /// Into how many parts the time is cut.
    pub fn parts(&self) -> u32 {
        1_u32.wrapping_shl(self.halvings)
    }
}

impl<S: Scalar, B: AsRef<[Bounds<S>]>> BroadPhase<'_, S, B> {
    /// The pairs of agents that may be in contact, the lower index first, and from when to when \[s\]: in increasing order of
    /// the agents, then of the time. At no other time they are in contact.
    ///
    /// Cost: a comparison of boxes a pair of agents, and one a part for pairs whose ways meet.
    pub fn candidates(&self) -> impl Iterator<Item = ([usize; 2], Interval<S>)> {
        let rows = self.boxes.as_ref().chunks_exact((self.parts() as usize).wrapping_add(1));
        let rows = rows.take(self.fleet.len());
        Meetings {
            during: self.during,
            halvings: self.halvings,
            own: &[],
            others: [].chunks_exact(1).take(0),
            agents: [0; 2],
            runs: Runs(0),
            rows,
            next: 0,
        }
    }

    /// When the agents of each pair are in contact \[s\], in increasing order of the agents, then of the time: what
    /// [`Encounter::contacts`] tells of each pair, within its tolerance.
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
                // Both are of the fleet.
                current = self.encounter(agents).ok().map(|encounter| (agents, encounter.contacts(during)));
            }
        })
    }

    /// When two agents of the fleet, by their places in it, are in contact during an interval of time \[s\]: of one of the
    /// [`BroadPhase::candidates`], which may be looked at in any order, on several cores as well.
    ///
    /// Cost: that of [`Encounter::contacts`].
    ///
    /// # Errors
    /// [`Mismatch::NoSuchAgent`].
    pub fn contacts_of(
        &self,
        agents: [usize; 2],
        during: Interval<S>,
    ) -> Result<impl Iterator<Item = ([usize; 2], Interval<S>)> + use<'_, S, B>, Mismatch> {
        let contacts = self.encounter(agents)?.contacts(during);
        Ok(contacts.map(move |time| (agents, time)))
    }
}

impl<'a, S: Scalar, B> BroadPhase<'a, S, B> {
    fn encounter(&self, agents: [usize; 2]) -> Result<Encounter<'a, S>, Mismatch> {
        let [first, second] = agents.map(|agent| self.fleet.get(agent).ok_or(Mismatch::NoSuchAgent(agent)));
        Ok(Encounter::new(first?, second?))
    }
}

/// The pairs of agents whose boxes meet.
struct Meetings<'a, S: Scalar> {
    during: Interval<S>,
    halvings: u32,
    /// Boxes of the agents from the `next` one on.
    rows: Take<ChunksExact<'a, Bounds<S>>>,
    next: usize,
    /// Boxes of the first agent of the pair, and of those that come after the second one.
    own: &'a [Bounds<S>],
    others: Take<ChunksExact<'a, Bounds<S>>>,
    agents: [usize; 2],
    /// The parts in which their boxes meet, as far as they were not told yet.
    runs: Runs,
}

impl<S: Scalar> Iterator for Meetings<'_, S> {
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
                self.runs = Runs(meeting(self.own, other));
            } else {
                self.own = self.rows.next()?;
                self.others = self.rows.clone();
                self.agents = [self.next; 2];
                self.next = self.next.wrapping_add(1);
            }
        }
    }
}

/// Where a part of so often halved an interval begins; the last one ends where the interval does.
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

/// The parts in which the boxes of two rows meet, a bit each.
fn meeting<S: Scalar>(own: &[Bounds<S>], other: &[Bounds<S>]) -> u32 {
    let ([all, own @ ..], [their, other @ ..]) = (own, other) else { return 0 };
    if !all.meets(*their) {
        return 0;
    }
    bits::row(own.iter().zip(other).map(|(own, other)| own.meets(*other)))
}

/// The way of an agent, followed from one time to the next.
struct Way<'a, S: Scalar> {
    motion: &'a Motion<'a, S>,
    /// What it has reached: a segment, by its place, a length of the path and the point there.
    place: usize,
    length: S,
    point: Point<S>,
}

impl<'a, S: Scalar> Way<'a, S> {
    fn starting(motion: &'a Motion<'a, S>, time: S) -> Self {
        let length = motion.length_at(time);
        let place = motion.path().segments().partition_point(|segment| segment.to < length);
        Self { motion, place, length, point: motion.path().point_at(length) }
    }

    /// A box around the way up to a time, and `margin` more.
    fn until(&mut self, time: S, margin: S) -> Bounds<S> {
        let (path, from) = (self.motion.path(), self.length);
        let to = self.motion.length_at(time).max(from);
        let (mut bounds, mut bulge) = (Bounds::around(self.point, self.point), S::ZERO);
        for segment in path.segments().get(self.place..).unwrap_or_default() {
            self.point = segment.point_at(to - segment.from);
            bounds = bounds.hull(Bounds::around(self.point, self.point));
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

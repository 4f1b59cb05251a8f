//! Safe intervals: when a part of a path is free, and which lengths are free during an interval of time.
//!
//! Both are the same question in coordination space. The part of the ego's path blocks those lengths of the other path
//! that are within R of it. For each pair of segments, these are the slabs between events (see `pair::events`) in the
//! middle of which some of the part is covered; this has a closed form. The motion of the other agent turns lengths
//! into times; an agent that stands before its start or after its arrival blocks all of that time.

use crate::error::Mismatch;
use crate::geometry::{Interval, Pose};
use crate::intervals::{gaps, union};
use crate::motion::Motion;
use crate::pair::Pair;
use crate::pair::events::add_events;
use crate::pair::footprint::Footprint;
use crate::pair::lengths::Lengths;
use crate::query::contact::Encounter;
use crate::region::RegionRef;
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};

/// Largest number of parts of one segment that another one blocks: of the slabs between 16 events ([`Lengths`]), no two
/// parts are neighbours.
const PARTS: usize = 8;

impl<'a, S: Scalar> Encounter<'a, S> {
    /// The windows in an interval of time \[s\] in which the other agent blocks a part of the ego's path \[m\]: its
    /// disc then reaches the ego's disc at some of these lengths. Disjoint windows in increasing order, rounded
    /// outward. The part may also be a single length or a whole segment; it is clamped to the path.
    ///
    /// Cost for each window: a comparison of boxes for each pair of segments, and a few hundred operations for each
    /// pair that comes near.
    pub fn blocked(
        &self,
        length: Interval<S>,
        during: Interval<S>,
    ) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        let (ego, other, during) = (self.ego, self.other, in_order(during));
        union(self.covered(ego, length, other).filter_map(move |covered| kept_from(ego, other, covered, during)))
    }

    /// The lengths of the ego's path \[m\] that the other agent blocks at some time of an interval \[s\]: disjoint
    /// intervals in increasing order, rounded outward. Cost as for [`Encounter::blocked`].
    pub fn blocked_lengths(&self, during: Interval<S>) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        let during = during.limited();
        let times = [during.lo - self.other.lateness(), during.hi + self.ego.lateness()];
        let lengths = times.map(|time| self.other.length_at(time));
        // The length that belongs to a time is right within the rounding error of a distance.
        let all = Interval::new(S::ZERO, self.other.path().length());
        let part = Interval::new(lengths[0], lengths[1]).widen(self.pad(), all);
        union(self.covered(self.other, part, self.ego))
    }

    /// The lengths of the path of `on` that are within reach of this part of the path of `by`, in no order.
    fn covered(
        &self,
        by: &'a Motion<'a, S>,
        part: Interval<S>,
        on: &'a Motion<'a, S>,
    ) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        let slack = Pair::new(by, on).slack;
        let part = on_path(by, part);
        // Cutting a segment adds rounding errors of its own.
        let radius = self.radius() + slack.double();
        let length = Interval::new(S::ZERO, on.path().length());
        let theirs = on.path().segments().iter();
        theirs.flat_map(move |second| {
            let own = by.path().segments().iter().filter_map(move |first| cut(first, part));
            let near = own.filter(move |first| first.bounds().expanded(radius).meets(second.bounds()));
            near.flat_map(move |first| covered(&first, second, radius, slack)).flatten().map(move |covered| {
                Interval::new(covered.lo + second.from, covered.hi + second.from).widen(slack, length)
            })
        })
    }
}

impl<'a, S: Scalar> RegionRef<'a, S> {
    /// The windows in an interval of time \[s\] in which the other agent blocks a part of the ego's path \[m\] in this
    /// region, rounded outward: in no order, and they may overlap. Another region of the same two segments may be
    /// included. The ego's own motion does not matter.
    ///
    /// Cost: a few hundred operations for each piece that meets the part.
    pub fn blocked(
        &self,
        length: Interval<S>,
        during: Interval<S>,
    ) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        let (ego, other, slack) = (self.ego_motion(), self.other_motion(), self.slack());
        let (length, during) = (on_path(ego, length), in_order(during));
        // Cutting a segment adds rounding errors of its own.
        let radius = ego.radius() + other.radius() + slack.double();
        let all = Interval::new(S::ZERO, other.path().length());
        let pieces = self.pieces().filter(move |piece| piece.length.meets(length));
        let parts = pieces.filter_map(move |piece| Some((cut(piece.ego, length)?, piece.other)));
        parts.flat_map(move |(own, their)| {
            let lengths = covered(&own, their, radius, slack).into_iter().flatten();
            let along = lengths.map(move |part| Interval::new(part.lo + their.from, part.hi + their.from));
            along.filter_map(move |part| kept_from(ego, other, part.widen(slack, all), during))
        })
    }
}

/// A window of time whose ends are the wrong way round is meant to be the time between them.
fn in_order<S: Scalar>(during: Interval<S>) -> Interval<S> {
    if during.hi < during.lo { Interval::new(during.hi, during.lo) } else { during }
}

/// The safe intervals of a part of an agent's path: the times in an interval \[s\] at which no other agent of the fleet
/// blocks any of these lengths \[m\], in increasing order. The lengths are clamped to the path. The other agents move as
/// their motions say, and stand before and after them.
///
/// Cost for each interval: that of [`Encounter::blocked`] for every other agent.
///
/// # Errors
/// [`Mismatch::NoSuchAgent`].
///
/// ```
/// use pcr_core::{Interval, Motion, Path, Point, Pose, Profile, Radians, safe_intervals};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 1.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
///
/// // The middle of the path of agent 0 is blocked while agent 1 passes at 1 m/s, within 0.5 m of it at 3 s.
/// let mut safe = safe_intervals(&fleet, 0, Interval::new(2.0, 2.0), Interval::new(0.0, 10.0))?;
/// let (before, after) = (safe.next().unwrap(), safe.next().unwrap());
/// assert!(before.lo == 0.0 && (before.hi - 2.5).abs() < 1e-12 && (after.lo - 3.5).abs() < 1e-12 && after.hi == 10.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn safe_intervals<'a, S: Scalar>(
    fleet: &'a [Motion<'a, S>],
    ego: usize,
    length: Interval<S>,
    during: Interval<S>,
) -> Result<impl Iterator<Item = Interval<S>> + Clone, Mismatch> {
    let pairs = encounters(fleet, ego)?;
    Ok(gaps(union(pairs.flat_map(move |pair| pair.blocked(length, during))), during))
}

/// The lengths of an agent's path \[m\] that no other agent of the fleet blocks at any time of an interval \[s\]: the
/// dual of [`safe_intervals`], with the same cost and the same error.
pub fn safe_lengths<'a, S: Scalar>(
    fleet: &'a [Motion<'a, S>],
    ego: usize,
    during: Interval<S>,
) -> Result<impl Iterator<Item = Interval<S>> + Clone, Mismatch> {
    let pairs = encounters(fleet, ego)?;
    let length = fleet.get(ego).map_or(S::ZERO, |ego| ego.path().length());
    let blocked = union(pairs.flat_map(move |pair| pair.blocked_lengths(during)));
    Ok(gaps(blocked, Interval::new(S::ZERO, length)))
}

/// The encounters of the ego with every other agent.
fn encounters<'a, S: Scalar>(
    fleet: &'a [Motion<'a, S>],
    ego: usize,
) -> Result<impl Iterator<Item = Encounter<'a, S>> + Clone, Mismatch> {
    let own = fleet.get(ego).ok_or(Mismatch::NoSuchAgent(ego))?;
    // `enumerate` would check its counter for overflow.
    let others = (0..fleet.len()).zip(fleet).filter(move |&(other, _)| other != ego);
    Ok(others.map(move |(_, other)| Encounter::new(own, other)))
}

/// Clamps a part to the path, so that an end that is off by a rounding lies on it. An end that is NaN becomes an end of
/// the path; the ends may be in either order.
fn on_path<S: Scalar>(motion: &Motion<'_, S>, part: Interval<S>) -> Interval<S> {
    let (from, to) = (S::ZERO.max(part.lo), motion.path().length().min(part.hi));
    Interval::new(from.min(to), from.max(to))
}

/// The part of a segment between these lengths of its path, if there is any.
pub(crate) fn cut<S: Scalar>(segment: &Segment<S>, part: Interval<S>) -> Option<Segment<S>> {
    // Compared with `from` and `to`, because `from` + `length` may differ from `to` in floating point: joints, and the
    // end of the path, are on the segment.
    let own = Interval::new(segment.from, segment.to);
    if !own.meets(part) {
        return None;
    }
    if part.lo <= own.lo && own.hi <= part.hi {
        return Some(*segment);
    }
    let along = |length: S| (length - own.lo).min(segment.length);
    let from = along(part.lo.max(own.lo));
    let to = if part.hi < own.hi { along(part.hi) } else { segment.length };
    let pose = Pose { position: segment.point_at(from), heading: segment.heading_at(from) };
    let length = to - from;
    let cut = Segment::standing(pose).and_then(|start| match segment.curve {
        Curve::Line => start.then_line(length),
        Curve::Arc { radius, turn } => start.then_arc(radius, turn, length),
    });
    // The cut segment is valid because the whole one is, except for rounding at the limits of the format. The whole
    // segment blocks no less.
    Some(cut.unwrap_or(*segment))
}

/// The lengths of the second segment that are within the radius of the first one. Distances are right within `slack`.
pub(crate) fn covered<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    radius: S,
    slack: S,
) -> [Option<Interval<S>>; PARTS] {
    let mut events = Lengths::new(S::ZERO);
    add_events(first, second, radius, slack, &mut events);
    events.sort();
    let events = events.as_slice();
    let mut parts = [None; PARTS];
    let mut places = parts.iter_mut();
    let mut place: Option<&mut Option<Interval<S>>> = None;
    for (&lo, &hi) in events.iter().zip(events.iter().skip(1)) {
        // Events may coincide. A second segment of length 0 has only this slab.
        if lo >= hi && second.length > S::ZERO {
            continue;
        }
        let slab = Interval::new(lo, hi);
        let reach = Footprint::of(second.point_at(slab.middle()), first).reach(first, radius);
        if reach.intervals(first)[0].is_none() {
            place = None;
            continue;
        }
        match &mut place {
            Some(part) => **part = part.map(|part| part.hull(slab)),
            None => {
                place = places.next();
                if let Some(part) = &mut place {
                    **part = Some(slab);
                }
            }
        }
    }
    parts
}

/// The times of an interval at which the ego must not plan to be within reach of the other agent, which is on these
/// lengths of its path, because either may be late.
fn kept_from<S: Scalar>(
    ego: &Motion<'_, S>,
    other: &Motion<'_, S>,
    lengths: Interval<S>,
    during: Interval<S>,
) -> Option<Interval<S>> {
    let (early, late) = (ego.lateness(), other.lateness());
    let inner = during.limited();
    let window = times(other, lengths, Interval::new(inner.lo - late, inner.hi + early))?;
    let (lo, hi) = (window.lo - early, window.hi + late);
    // No motion has times beyond the limits.
    let lo = if lo <= inner.lo { during.lo } else { lo };
    let hi = if hi >= inner.hi { during.hi } else { hi };
    (lo <= hi).then_some(Interval::new(lo, hi))
}

/// The times of an interval at which an agent is on these lengths of its path, including the times when it stands
/// there.
pub(crate) fn times<S: Scalar>(
    motion: &Motion<'_, S>,
    lengths: Interval<S>,
    during: Interval<S>,
) -> Option<Interval<S>> {
    let time = motion.time_in(lengths);
    let lo = if lengths.lo <= S::ZERO { during.lo } else { time.lo };
    let hi = if lengths.hi >= motion.path().length() { during.hi } else { time.hi };
    let window = Interval::new(lo.max(during.lo), hi.min(during.hi));
    (window.lo <= window.hi).then_some(window)
}

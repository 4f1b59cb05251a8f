//! Safe intervals: when a part of a path is free, and which lengths are free during an interval of time.
//!
//! Both are the same question in coordination space. The part of the ego's path blocks those lengths of the other path
//! that are within R of it. For each pair of segments, these are the slabs between events (see `pair::events`) in the
//! middle of which some of the part is covered; this has a closed form. The motion of the other agent turns lengths
//! into times; an agent that stands before its start or after its arrival blocks all of that time.

use crate::array_vec::ArrayVec;
use crate::error::MismatchError;
use crate::geometry::Interval;
use crate::intervals::{LowestInterval, gaps};
use crate::motion::Motion;
use crate::outline::placed::Carried;
use crate::pair::AgentPair;
use crate::pair::disc_on_segment::CarrierCoordinates;
use crate::pair::events::add_events;
use crate::pair::lengths::LengthList;
use crate::pair::outline::events::Carriers;
use crate::pair::outline::shadow::MOST_SHADOWS;
use crate::query::contact::Encounter;
use crate::region::RegionRef;
use crate::scalar::Scalar;
use crate::segment::Segment;

/// Largest number of parts of one segment that another one blocks: of the slabs between 12 events ([`LengthList`]), no two
/// parts are neighbours.
const PARTS: usize = 6;

impl<'a, S: Scalar> Encounter<'a, S> {
    /// The windows in an interval of time \[s\] in which the other agent blocks a part of the ego's path \[m\]: its
    /// disc then reaches the ego's disc at some of these lengths. Disjoint windows in increasing order, rounded
    /// outward. The part may also be a single length or a whole segment; it is clamped to the path.
    ///
    /// Cost for each window: on those segments of the other path that the other agent passes from the end of the window
    /// before to the end of this one, a comparison of boxes with each segment of the part, and a few hundred operations
    /// for each pair that comes near.
    pub fn blocked(
        &self,
        length: Interval<S>,
        during: Interval<S>,
    ) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        BlockedUnion { reaches: core::iter::once(self.reach(length, during)), after: None }
    }

    /// The lengths of the ego's path \[m\] that the other agent blocks at some time of an interval \[s\]: disjoint
    /// intervals in increasing order, rounded outward. Cost as for [`Encounter::blocked`].
    pub fn blocked_lengths(&self, during: Interval<S>) -> impl Iterator<Item = Interval<S>> + Clone + use<'a, S> {
        BlockedUnion { reaches: core::iter::once(self.reach_during(during)), after: None }
    }

    /// The windows in which the other agent blocks a part of the ego's path.
    fn reach(&self, length: Interval<S>, during: Interval<S>) -> ProximityWindows<'a, S> {
        self.reach_of(self.ego, length, self.other, Some(in_order(during)))
    }

    /// The lengths of the ego's path that the other agent blocks during an interval of time.
    fn reach_during(&self, during: Interval<S>) -> ProximityWindows<'a, S> {
        let during = during.limited();
        let times = [during.lo - self.other.lateness(), during.hi + self.ego.lateness()];
        let lengths = times.map(|time| self.other.length_at(time));
        // The length that belongs to a time is right within the rounding error of a distance.
        let all = Interval::new(S::ZERO, self.other.path().length());
        let part = Interval::new(lengths[0], lengths[1]).widen(self.pad(), all);
        self.reach_of(self.other, part, self.ego, None)
    }

    fn reach_of(
        &self,
        by: &'a Motion<'a, S>,
        part: Interval<S>,
        on: &'a Motion<'a, S>,
        during: Option<Interval<S>>,
    ) -> ProximityWindows<'a, S> {
        let slack = AgentPair::new(by, on).slack;
        // Cutting a segment adds rounding errors of its own.
        let radius = self.radius() + slack.double();
        ProximityWindows { by, part: on_path(by, part), on, during, radius, slack, pad: self.pad() }
    }
}

/// The lengths of one path that are within reach of a part of another one, or the times that belong to them.
#[derive(Clone)]
struct ProximityWindows<'a, S: Scalar> {
    by: &'a Motion<'a, S>,
    part: Interval<S>,
    on: &'a Motion<'a, S>,
    /// The window of time \[s\]; `None` if lengths are asked for.
    during: Option<Interval<S>>,
    radius: S,
    slack: S,
    /// Bound on the rounding error of the length that belongs to a time.
    pad: S,
}

impl<S: Scalar> ProximityWindows<'_, S> {
    /// Distance of the reference points at which the agents may be within the radius \[m\].
    fn near(&self) -> S {
        self.radius + self.by.outline().spread() + self.on.outline().spread()
    }

    /// What is blocked on a segment, in no order.
    fn on_segment(&self, second: &Segment<S>) -> impl Iterator<Item = Interval<S>> {
        let (part, all) = (self.part, Interval::new(S::ZERO, self.on.path().length()));
        let segments = self.by.path().segments();
        let first = segments.partition_point(|segment| segment.to < part.lo);
        let own = segments.get(first..).unwrap_or_default().iter().map_while(move |first| cut(first, part));
        let near = own.filter(|first| first.bounds().expanded(self.near()).meets(second.bounds()));
        let covered = near.flat_map(|first| covered_by(self.by, self.on, &first, second, self.radius, self.slack));
        covered.filter_map(move |covered| {
            let lengths = Interval::new(covered.lo + second.from, covered.hi + second.from).widen(self.slack, all);
            match self.during {
                None => Some(lengths),
                Some(during) => kept_from(self.by, self.on, lengths, during),
            }
        })
    }

    /// An interval that contains all that is blocked on a segment. It is wider by more than rounding errors, so what is
    /// blocked on segments before this one does not end after it, and on those that follow does not begin before it.
    fn bounds(&self, segment: &Segment<S>) -> Option<Interval<S>> {
        let all = Interval::new(S::ZERO, self.on.path().length());
        let lengths = Interval::new(segment.from, segment.to).widen(self.slack + self.pad, all);
        match self.during {
            None => Some(lengths),
            Some(_) => kept_from(self.by, self.on, lengths, Interval::new(-S::LIMIT, S::LIMIT)),
        }
    }

    /// Adds what is blocked, except for what can neither be nor belong to the lowest interval.
    fn add_to(&self, lowest: &mut LowestInterval<S>) {
        let segments = self.on.path().segments();
        let known = |segment: &Segment<S>, after: S| self.bounds(segment).is_some_and(|bounds| bounds.hi < after);
        let first = lowest.after.map_or(0, |after| segments.partition_point(|segment| known(segment, after)));
        let near = self.by.bounds().expanded(self.near() + self.slack);
        let rest = segments.get(first..).unwrap_or_default().iter();
        for segment in rest.filter(|segment| near.meets(segment.bounds())) {
            if self.bounds(segment).is_some_and(|bounds| lowest.is_below(bounds.lo)) {
                break;
            }
            self.on_segment(segment).for_each(|blocked| lowest.add(blocked));
        }
    }
}

/// The union of what is blocked, as disjoint intervals in increasing order. Each one is looked for from the end of the
/// one before it on.
#[derive(Clone)]
struct BlockedUnion<S, R> {
    reaches: R,
    after: Option<S>,
}

impl<'a, S: Scalar, R: Iterator<Item = ProximityWindows<'a, S>> + Clone> Iterator for BlockedUnion<S, R> {
    type Item = Interval<S>;

    fn next(&mut self) -> Option<Interval<S>> {
        LowestInterval::next(&mut self.after, |lowest| self.reaches.clone().for_each(|reach| reach.add_to(lowest)))
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
        let radius = ego.rounding_radius() + other.rounding_radius() + slack.double();
        let all = Interval::new(S::ZERO, other.path().length());
        let pieces = self.pieces().filter(move |piece| piece.length.meets(length));
        let parts = pieces.filter_map(move |piece| Some((cut(piece.ego, length)?, piece.other)));
        parts.flat_map(move |(own, their)| {
            let lengths = covered_by(ego, other, &own, their, radius, slack);
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
/// their motions say, and stand before and after them. An instant, an interval of length 0, is its own safe interval if
/// the lengths are free then.
///
/// Cost for each interval: that of [`Encounter::blocked`] for every other agent, up to the end of the blocked window that
/// follows it.
///
/// # Errors
/// [`MismatchError::NoSuchAgent`].
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
) -> Result<impl Iterator<Item = Interval<S>> + Clone, MismatchError> {
    let pairs = encounters(fleet, ego)?;
    let reaches = pairs.map(move |pair| pair.reach(length, during));
    Ok(gaps(BlockedUnion { reaches, after: None }, in_order(during)))
}

/// The lengths of an agent's path \[m\] that no other agent of the fleet blocks at any time of an interval \[s\]: the
/// dual of [`safe_intervals`], with the same cost. Of an agent without a path, its place is the length 0.
///
/// # Errors
/// [`MismatchError::NoSuchAgent`].
pub fn safe_lengths<'a, S: Scalar>(
    fleet: &'a [Motion<'a, S>],
    ego: usize,
    during: Interval<S>,
) -> Result<impl Iterator<Item = Interval<S>> + Clone, MismatchError> {
    let pairs = encounters(fleet, ego)?;
    let length = fleet.get(ego).map_or(S::ZERO, |ego| ego.path().length());
    let reaches = pairs.map(move |pair| pair.reach_during(during));
    Ok(gaps(BlockedUnion { reaches, after: None }, Interval::new(S::ZERO, length)))
}

/// The encounters of the ego with every other agent.
fn encounters<'a, S: Scalar>(
    fleet: &'a [Motion<'a, S>],
    ego: usize,
) -> Result<impl Iterator<Item = Encounter<'a, S>> + Clone, MismatchError> {
    let own = fleet.get(ego).ok_or(MismatchError::NoSuchAgent(ego))?;
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
    Some(segment.part(from, to))
}

// Not inlined: discs would need the stack of it.
#[inline(never)]
fn shadow<S: Scalar>(
    [by, on]: [&Motion<'_, S>; 2],
    [first, second]: [&Segment<S>; 2],
    [radius, slack]: [S; 2],
) -> ArrayVec<Interval<S>, MOST_SHADOWS> {
    let (first, second) = (Carried::new(first, by.outline()), Carried::new(second, on.outline()));
    Carriers { first, second, radius, slack }.shadow()
}

/// The parts of a segment of the path of `on` at which it comes within the radius of `by`, somewhere on the segment `first`.
pub(crate) fn covered_by<S: Scalar>(
    by: &Motion<'_, S>,
    on: &Motion<'_, S>,
    first: &Segment<S>,
    second: &Segment<S>,
    radius: S,
    slack: S,
) -> impl Iterator<Item = Interval<S>> + Clone + use<S> {
    let outlines = (by.has_outline() | on.has_outline()).then(|| shadow([by, on], [first, second], [radius, slack]));
    let discs = outlines.is_none().then(|| covered(first, second, radius, slack));
    discs.into_iter().flatten().flatten().chain(outlines.into_iter().flat_map(ArrayVec::into_values))
}

/// The lengths of the second segment that are within the radius of the first one. Distances are right within `slack`.
fn covered<S: Scalar>(first: &Segment<S>, second: &Segment<S>, radius: S, slack: S) -> [Option<Interval<S>>; PARTS] {
    let mut events = LengthList::new(S::ZERO);
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
        let reach = CarrierCoordinates::of(second.point_at(slab.middle()), first).reach(first, radius);
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
    // No motion has times beyond the limits. What is no number is no end.
    let before = if during.lo < inner.lo { during.lo } else { inner.lo };
    let after = if during.hi > inner.hi { during.hi } else { inner.hi };
    let lo = if lo <= inner.lo { before } else { lo };
    let hi = if hi >= inner.hi { after } else { hi };
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

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;
    use crate::{Limits, Path, Point, Pose, Profile, Radians, TurnSide, union};
    use heapless::Vec;

    /// Rounds on a track of two lines and two half circles.
    fn rounds<const N: usize>(start: [f64; 3], rounds: usize) -> Path<f64, N> {
        let pose = Pose { position: Point::new(start[0], start[1]), heading: Radians(start[2]) };
        let half = |path: Path<f64, N>| {
            path.line(2.0).and_then(|path| path.arc(0.5, TurnSide::Left, 0.5 * core::f64::consts::PI)).expect("a path")
        };
        (0..2 * rounds).fold(Path::starting_at(pose).expect("a pose"), |path, _| half(path))
    }

    /// From rest to rest at 1 m/s twice, with a wait between.
    fn with_a_wait(length: f64, wait: f64) -> Profile<f64, 8> {
        let ends = |part: f64| [(1.0, 1.0), (part * length - 1.0, 0.0), (1.0, -1.0)];
        let pieces = ends(0.3).into_iter().chain([(wait, 0.0)]).chain(ends(0.7));
        Profile::from_pieces(0.0, pieces).expect("a profile")
    }

    /// The union of all that is blocked on any segment.
    fn all<'a>(reaches: impl Iterator<Item = ProximityWindows<'a, f64>>) -> Vec<Interval<f64>, 64> {
        let mut found: Vec<_, 2048> = Vec::new();
        for reach in reaches {
            let segments = reach.on.path().segments().iter();
            segments.for_each(|segment| found.extend(reach.on_segment(segment)));
        }
        union(found.iter().copied()).collect()
    }

    #[test]
    fn what_is_blocked_is_the_union_over_all_segments() {
        let paths: [Path<f64, 32>; 4] = [
            rounds([0.0, 0.0, 0.0], 3),
            rounds([0.2, 1.3, 1.0], 5),
            rounds([1.0, -0.5, 2.0], 1),
            rounds([0.7, 0.1, 0.5], 0),
        ];
        let profiles = [0, 1, 2, 3].map(|k| match paths[k].as_path().length() {
            0.0 => Profile::standing(),
            length => with_a_wait(length, 2.0 * k as f64),
        });
        let motion = |k: usize| {
            let profile = profiles[k].as_profile();
            let motion = Motion::new(paths[k].as_path(), profile, 0.3, 7.0 * k as f64).expect("a motion");
            motion.with_lateness(0.25 * (k % 2) as f64).expect("a lateness")
        };
        let fleet = [0, 1, 2, 3].map(motion);
        let mut windows = 0;
        for ego in 0..4 {
            let end = fleet[ego].path().length();
            for (lo, hi) in [(0.0, 1.0), (0.0, 0.0), (0.31, 0.31), (0.2, 0.3), (0.5, 1.0)] {
                for during in [Interval::new(-9.0, 90.0), Interval::new(8.0, 15.5), Interval::new(12.0, 12.0)] {
                    let part = Interval::new(lo * end, hi * end);
                    let pairs = encounters(&fleet, ego).expect("an agent of the fleet");
                    for pair in pairs.clone() {
                        assert!(pair.blocked(part, during).eq(all(core::iter::once(pair.reach(part, during)))));
                        assert!(pair.blocked_lengths(during).eq(all(core::iter::once(pair.reach_during(during)))));
                    }
                    let blocked = all(pairs.clone().map(|pair| pair.reach(part, during)));
                    windows += blocked.len();
                    let safe = safe_intervals(&fleet, ego, part, during).expect("an agent of the fleet");
                    assert!(safe.eq(gaps(blocked.into_iter(), during)), "{ego} {part:?} {during:?}");
                    let blocked = all(pairs.map(|pair| pair.reach_during(during)));
                    let safe = safe_lengths(&fleet, ego, during).expect("an agent of the fleet");
                    assert!(safe.eq(gaps(blocked.into_iter(), Interval::new(0.0, end))), "{ego} {during:?}");
                }
            }
        }
        assert!(windows > 90, "{windows}");
    }

    #[test]
    fn instants_and_places_without_a_path_are_free_unless_they_are_blocked() {
        // The second agent is within reach of the first one, which stands, from 0.5 s to 1.5 s.
        let paths: [Path<f64, 1>; 2] =
            [rounds([0.0, 0.0, 0.0], 0), rounds([-1.0, 0.0, 0.0], 0).line(2.0).expect("a path")];
        let profiles = [Profile::standing(), Profile::<f64, 1>::from_pieces(1.0, [(2.0, 0.0)]).expect("a profile")];
        let fleet =
            [0, 1].map(|k| Motion::new(paths[k].as_path(), profiles[k].as_profile(), 0.25, 0.0).expect("a motion"));
        let here = Interval::new(0.0, 0.0);
        for (at, free) in [(-1.0, true), (0.25, true), (0.75, false), (1.0, false), (1.75, true), (9.0, true)] {
            let instant = Interval::new(at, at);
            let safe = safe_intervals(&fleet, 0, here, instant).expect("an agent of the fleet");
            assert!(safe.eq(free.then_some(instant)), "at {at}");
            let safe = safe_lengths(&fleet, 0, instant).expect("an agent of the fleet");
            assert!(safe.eq(free.then_some(here)), "at {at}");
        }
        let safe = |lo, hi| safe_intervals(&fleet, 0, here, Interval::new(lo, hi)).expect("an agent of the fleet");
        assert_eq!(safe(-1.0, 3.0).count(), 2);
        assert!(safe(3.0, -1.0).eq(safe(-1.0, 3.0)), "the ends are the other way round");
        assert!(safe_lengths(&fleet, 0, Interval::new(0.0, 2.0)).expect("an agent of the fleet").eq([]));
    }

    #[test]
    fn windows_of_one_agent_count_where_those_of_another_reach_them() {
        // An agent stands. Another one comes past at 0.5 s to 1.5 s, and again a round later, which is not looked at before
        // the window of the third, slow one joins both.
        let paths: [Path<f64, 8>; 3] = [
            rounds([0.0, 0.0, 0.0], 0),
            rounds([-1.0, 0.0, 0.0], 2),
            rounds([0.0, -1.0, core::f64::consts::FRAC_PI_2], 0).line(2.0).expect("a path"),
        ];
        let speeds = [1.0, 1.0, 0.125];
        let profiles = [0, 1, 2].map(|k| {
            let piece = (paths[k].as_path().length() / speeds[k], 0.0);
            Profile::<f64, 1>::from_pieces(speeds[k], [piece]).expect("a profile")
        });
        let fleet = [(0, 0.0), (1, 0.0), (2, -4.0)].map(|(k, start)| {
            Motion::new(paths[k].as_path(), profiles[k].as_profile(), 0.25, start).expect("a motion")
        });
        let (here, during) = (Interval::new(0.0, 0.0), Interval::new(-1.0, 10.0));
        let mut safe = safe_intervals(&fleet, 0, here, during).expect("an agent of the fleet");
        let (before, after) = (safe.next().expect("before"), safe.next().expect("after"));
        let again = 2.0 * 2.0 + core::f64::consts::PI + 1.5;
        assert!(before.lo == -1.0 && before.hi.abs() < 1e-9, "{before:?}");
        assert!((after.lo - again).abs() < 1e-9 && after.hi == 10.0, "{after:?}");
        assert_eq!(safe.next(), None);
    }

    #[test]
    fn paths_of_many_rounds_are_answered_in_a_moment() {
        // Where each interval was found in several passes over all pairs of segments, this took days.
        // (No more rounds than this: paths are moved as they are built, and in debug builds each move takes room on the stack.)
        let paths: [Path<f64, 256>; 2] = [rounds([0.0, 0.0, 0.0], 64), rounds([0.2, 1.3, 1.0], 64)];
        let length = paths[0].as_path().length();
        let profile = Profile::rest_to_rest(length, Limits { speed: 1.0, acceleration: 1.0 }).expect("a profile");
        let fleet =
            paths.each_ref().map(|path| Motion::new(path.as_path(), profile.as_profile(), 0.3, 0.0).expect("a motion"));
        let during = fleet[0].time();
        let safe = |part| safe_intervals(&fleet, 0, part, during).expect("an agent of the fleet").count();
        // Each round crosses the other track twice.
        assert_eq!(safe(Interval::new(0.0, length)), 64);
        assert_eq!(safe(Interval::new(5.2, 5.2)), 64);
        assert_eq!(safe_lengths(&fleet, 0, during).expect("an agent of the fleet").count(), 65);
    }
}

//! Crossings of two paths, and the paper's descriptor of the region at each (Tables III, IV and VII).
//!
//! Regions do not depend on crossings: paths that come close to each other without crossing have regions, too (paper,
//! Fig. 14a). The descriptor is for programs that print, compare or transmit the quantities of the paper.

use crate::geometry::Direction;
use crate::motion::Motion;
use crate::pair::AgentPair;
use crate::pair::disc_on_segment::CarrierCoordinates;
use crate::pair::lateral_offset::{Carrier, RelativeCarrier};
use crate::pair::lengths::LengthList;
use crate::region::PieceType;
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};

/// An intersection of the paths of an ordered pair of agents, and the parameters of the collision region there:
/// `CR(T, L, r̂, v, θ, ς_ego, ς_other, dir)` of Table VII.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "S: serde::Serialize, S::Angle: serde::Serialize",
        deserialize = "S: serde::Deserialize<'de>, S::Angle: serde::Deserialize<'de>"
    ))
)]
pub struct Crossing<S: Scalar> {
    /// Shapes of the segments that cross.
    pub piece_type: PieceType,
    /// Indices of the segments in the ego's path and in the other's.
    pub segments: [usize; 2],
    /// T: the first time at which the other agent passes the crossing \[s\].
    pub time: S,
    /// L: length along the ego's path \[m\].
    pub length: S,
    /// Length along the other's path \[m\].
    pub other_length: S,
    /// r̂: sum of the radii \[m\]; of an outline, that of the disc about its reference point that contains it.
    pub combined_radius: S,
    /// v: speed of the other agent as it passes \[m/s\].
    pub speed: S,
    /// θ: heading of the other agent minus heading of the ego. Both headings accumulate along their paths; formats
    /// whose angles hold at most one turn give θ modulo one turn.
    pub theta: S::Angle,
    /// Shape of the ego's segment; an arc has ς and dir.
    pub ego_curve: Curve<S>,
    /// Shape of the other's segment; an arc has ς and dir.
    pub other_curve: Curve<S>,
}

/// The crossings of two paths, in the order of the other's segments. Each end of a segment belongs to only one of the
/// two segments that meet there, so that a crossing at a joint counts once. Paths that only touch or overlap do not
/// cross: the angle has to move the paths apart by more than four slacks over the length of a combined radius.
///
/// A crossing at a joint counts once if the sine of the angle between the paths is 1/4 or more; below that, rounding
/// may count it twice or not at all (`docs/theory/errors.md`).
///
/// Cost: a box test for each pair of segments; a square root and a few arctangents if the boxes overlap.
pub fn crossings<'a, S: Scalar>(
    ego: &'a Motion<'a, S>,
    other: &'a Motion<'a, S>,
) -> impl Iterator<Item = Crossing<S>> + 'a {
    let margin = margin(ego, other);
    numbered(other).flat_map(move |(j, their)| {
        let own = numbered(ego);
        let near = own.filter(move |(_, own)| own.bounds.expanded(margin).meets(their.bounds));
        near.flat_map(move |(i, own)| {
            let start = CarrierCoordinates::of(own.start, their);
            let mut roots = LengthList::new(S::ZERO);
            RelativeCarrier::new(their, Carrier::from(own), &start).lengths_at(&[S::ZERO], margin, S::ZERO, &mut roots);
            let [a, b] = [0, 1].map(|place| roots.as_slice().get(place).copied());
            // A double root is one crossing.
            let roots = a.into_iter().chain(b.filter(|_| a != b));
            roots.filter_map(move |s| Crossing::at(ego, other, [i, j], own, their, s))
        })
    })
}

/// The segments of a path with their indices, without turns in place: nothing crosses a point. `enumerate` would check its counter
/// for overflow.
fn numbered<'a, S: Scalar>(motion: &'a Motion<'_, S>) -> impl Iterator<Item = (usize, &'a Segment<S>)> {
    let segments = motion.path().segments();
    (0..segments.len()).zip(segments).filter(|(_, segment)| !matches!(segment.curve, Curve::Pivot { .. }))
}

/// How far rounding may move a crossing along a segment: the error of a distance divided by the sine of the angle,
/// taken as 1/4 at least.
fn margin<S: Scalar>(ego: &Motion<'_, S>, other: &Motion<'_, S>) -> S {
    AgentPair::new(ego, other).slack.double().double()
}

impl<S: Scalar> Crossing<S> {
    fn at(
        ego: &Motion<'_, S>,
        other: &Motion<'_, S>,
        [i, j]: [usize; 2],
        own: &Segment<S>,
        their: &Segment<S>,
        s: S,
    ) -> Option<Self> {
        let margin = margin(ego, other);
        let combined_radius = ego.radius() + other.radius();
        let last = |motion: &Motion<'_, S>, index: usize| motion.path().segments().len().checked_sub(1) == Some(index);
        let on = |segment: &Segment<S>, u: S, last: bool| {
            u >= -margin && u <= segment.length + margin && (last || u < segment.length - margin)
        };
        let l = CarrierCoordinates::of(their.point_at(s), own).foot(own);
        if !on(their, s, last(other, j)) || !on(own, l, last(ego, i)) {
            return None;
        }
        let theta = their.heading_at(s) - own.heading_at(l);
        let apart = combined_radius.scale(Direction::<S>::at(theta).sin).abs();
        (apart > margin).then(|| {
            let time = other.time().lo + other.profile().first_time_at(their.from + s);
            Self {
                piece_type: PieceType::of(own.curve, their.curve),
                segments: [i, j],
                time,
                length: (own.from + l).clamp(S::ZERO, ego.path().length()),
                other_length: (their.from + s).clamp(S::ZERO, other.path().length()),
                combined_radius,
                speed: other.speed_at(time),
                theta,
                ego_curve: own.curve,
                other_curve: their.curve,
            }
        })
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::crossings;
    use crate::{Limits, Motion, Path, Point, Pose, Profile, Radians, TurnSide};

    fn count(ego: &Path<f64, 2>, other: &Path<f64, 2>) -> usize {
        let limits = Limits { speed: 1.0, acceleration: 1.0 };
        let profiles = [ego, other].map(|path| Profile::rest_to_rest(path.as_path().length(), limits).unwrap());
        let ego = Motion::new(ego.as_path(), profiles[0].as_profile(), 0.2, 0.0).unwrap();
        let other = Motion::new(other.as_path(), profiles[1].as_profile(), 0.2, 0.0).unwrap();
        crossings(&ego, &other).count()
    }

    fn from(x: f64, y: f64, heading: f64) -> Path<f64, 2> {
        Path::starting_at(Pose { position: Point::new(x, y), heading: Radians(heading) }).unwrap()
    }

    #[test]
    fn a_crossing_at_joints_of_both_paths_counts_once() {
        for k in 0..1000 {
            let k = f64::from(k);
            let (own, their) = (0.1 + 0.001 * k, 0.4 + 0.003 * k);
            let ego = from(-1.3 * own.cos(), -1.3 * own.sin(), own).line(1.3).unwrap().line(1.0).unwrap();
            let other = from(-1.7 * their.cos(), -1.7 * their.sin(), their).line(1.7).unwrap().line(1.0).unwrap();
            assert_eq!(count(&ego, &other), 1, "headings {own} and {their}");
        }
    }

    /// Two arcs that meet at the origin with this heading, after 1.7 m.
    fn arcs(heading: f64, turn: TurnSide) -> Path<f64, 2> {
        let side = if turn == TurnSide::Left { 1.0 } else { -1.0 };
        let begin = heading - side * 1.7 / 2.0;
        let (x, y) = (2.0 * side * (begin.sin() - heading.sin()), 2.0 * side * (heading.cos() - begin.cos()));
        from(x, y, begin).arc(2.0, turn, 1.7).unwrap().arc(2.0, turn, 1.0).unwrap()
    }

    #[test]
    fn a_crossing_at_joints_of_arcs_counts_once() {
        for k in 0..1000 {
            let k = f64::from(k);
            let (own, their) = (0.1 + 0.001 * k, 0.4 + 0.003 * k);
            for turn in [TurnSide::Left, TurnSide::Right] {
                let line = from(-0.2 * own.cos(), -0.2 * own.sin(), own).line(0.2).unwrap().line(0.1).unwrap();
                let other = arcs(their, turn);
                assert_eq!(count(&line, &other), 1, "headings {own} and {their}, {turn:?}");
                assert_eq!(count(&other, &line), 1, "headings {own} and {their}, {turn:?}");
            }
        }
    }

    #[test]
    fn a_line_crosses_a_circle_twice_and_touches_it_not_at_all() {
        let circle = from(0.0, -1.0, 0.0).arc(1.0, TurnSide::Left, core::f64::consts::TAU).unwrap();
        assert_eq!(count(&from(-2.0, 0.5, 0.0).line(4.0).unwrap(), &circle), 2);
        assert_eq!(count(&from(-2.0, 1.0, 0.0).line(4.0).unwrap(), &circle), 0);
        assert_eq!(count(&from(-2.0, 1.5, 0.0).line(4.0).unwrap(), &circle), 0);
    }

    #[test]
    fn paths_on_one_line_do_not_cross() {
        assert_eq!(count(&from(0.0, 0.0, 0.7).line(3.0).unwrap(), &from(0.0, 0.0, 0.7).line(3.0).unwrap()), 0);
        let head_on = from(3.0 * 0.7_f64.cos(), 3.0 * 0.7_f64.sin(), 0.7 - core::f64::consts::PI);
        assert_eq!(count(&from(0.0, 0.0, 0.7).line(3.0).unwrap(), &head_on.line(3.0).unwrap()), 0);
    }
}

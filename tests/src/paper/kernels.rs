//! The same crossing through the public interface of pcr-core: two agents on long paths that cross once where the
//! paper's frame {B} has its origin, both moving at constant speed.

use super::{Arc, Pcr, Range};
use pcr_core::{
    Crossing, Ecm, EcmEntry, Motion, PathRef, Piece, Point, Pose, Profile, Radians, Segment, TurnSide, crossings,
};
use std::f64::consts::PI;

/// Length of a line on either side of the crossing \[m\].
const LINE: f64 = 40.0;

/// Half circles of an arc on either side of the crossing: a merged region extends by less than a full circle.
const HALF_CIRCLES: usize = 3;

/// Where the joint of two segments is before the crossing \[m\] or \[rad\]: within the region, so that it has to be
/// joined, but not at the crossing itself.
const JOINT: f64 = 0.05;

/// Path of one agent: its segments, and the length at which it passes the origin of {B} \[m\].
struct Track {
    segments: Vec<Segment<f64>>,
    before: f64,
}

impl Track {
    /// The carrier through the origin with this heading there.
    fn through_origin(heading: f64, arc: Option<Arc>) -> Self {
        let before = arc.map_or(LINE + JOINT, |arc| (HALF_CIRCLES as f64 * PI + JOINT) * arc.radius);
        let [x, y] = super::definition::point(heading, arc, -before);
        let turned = arc.map_or(0.0, |arc| arc.dir * before / arc.radius);
        let pose = Pose { position: Point::new(x, y), heading: Radians(heading - turned) };
        let mut last = Segment::standing(pose).expect("a finite pose");
        let segments = (0..arc.map_or(2, |_| 2 * HALF_CIRCLES)).map(|_| {
            last = match arc {
                None => last.then_line(LINE),
                Some(Arc { radius, dir }) => {
                    last.then_arc(radius, if dir > 0.0 { TurnSide::Left } else { TurnSide::Right }, PI * radius)
                }
            }
            .expect("a valid segment");
            last
        });
        Self { segments: segments.collect(), before }
    }
}

/// What the library finds, in {B}.
#[derive(Clone, Debug)]
pub struct Found {
    /// Time range of the region at the crossing \[s\].
    pub time: Range,
    /// Its length range \[m\].
    pub length: Range,
    /// Its slices at the times asked for \[m\].
    pub slices: Vec<Vec<Range>>,
    /// From start to end of the other's travel \[s\].
    pub travel: Range,
    /// From start to end of the ego's path \[m\].
    pub path: Range,
    /// The descriptor of the crossing at the origin, in {A}.
    pub crossing: Crossing<f64>,
    /// T and L: the origin of {B} in {A}.
    pub origin: [f64; 2],
}

/// The region of pcr-core that holds the crossing, and its slices at these times in {B}. `ego_first` tells which of
/// the two agents comes first in the fleet: the other way round the region is the transposed one.
///
/// # Panics
/// If the library refuses the agents, or finds no region or more than one at the crossing.
pub fn find(pcr: &Pcr, ego_first: bool, times: &[f64]) -> Found {
    let own = Track::through_origin(0.0, pcr.own);
    let other = Track::through_origin(pcr.theta, pcr.other);
    let own_path = PathRef::new(&own.segments).expect("a path");
    let other_path = PathRef::new(&other.segments).expect("a path");
    let constant = |speed: f64, length: f64| {
        Profile::<f64, 1>::from_pieces(speed, [(length / speed, 0.0)]).expect("a constant speed")
    };
    let own_profile = constant(1.0, own_path.length());
    let other_profile = constant(pcr.v, other_path.length());
    let radius = 0.5 * pcr.r;
    let ego = Motion::new(own_path, own_profile.as_profile(), radius, 0.0).expect("a motion");
    let grown = Motion::new(other_path, other_profile.as_profile(), radius, 0.0).expect("a motion");
    let (fleet, ego_index) = if ego_first { ([ego, grown], 0) } else { ([grown, ego], 1) };

    let ecm = Ecm::build(vec![EcmEntry::EMPTY; 256], vec![Piece::EMPTY; 1024], &fleet).expect("enough room");
    let origin = [other.before / pcr.v, own.before];
    let [big_t, big_l] = origin;
    let mut holding = ecm
        .pair(&fleet, ego_index, 1 - ego_index)
        .expect("the table of the fleet")
        .filter(|region| region.contains(big_t, big_l));
    let region = holding.next().expect("a region at the crossing");
    assert!(holding.next().is_none(), "one region at the crossing");

    let local = |lo: f64, hi: f64, zero: f64| [lo - zero, hi - zero];
    let slices = times.iter().map(|t| {
        let slice = region.slice_at(big_t + t);
        slice.map(|interval| local(interval.lo, interval.hi, big_l)).collect()
    });
    let away =
        |crossing: &Crossing<f64>| (crossing.length - big_l).abs() + (crossing.other_length - other.before).abs();
    let crossing = crossings(&fleet[ego_index], &fleet[1 - ego_index]).min_by(|a, b| away(a).total_cmp(&away(b)));
    Found {
        time: local(region.time().lo, region.time().hi, big_t),
        length: local(region.length().lo, region.length().hi, big_l),
        slices: slices.collect(),
        travel: local(grown.time().lo, grown.time().hi, big_t),
        path: local(0.0, own_path.length(), big_l),
        crossing: crossing.expect("a crossing at the origin"),
        origin,
    }
}

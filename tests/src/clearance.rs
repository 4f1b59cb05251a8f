//! How far the ends of pieces are from what they must hold, exactly: what a directed search makes small.
//!
//! A piece ends inside a segment where the discs cease to touch. Just there the distance of the point from all of the other
//! segment is to be above R, or what lies beyond is lost, and below R + ε. In the middle of both it is ½ of the excess.

use crate::disc::{Course, Disc};
use crate::exact::{DoubleDouble, Route};
use crate::generators::Pair;
use pcr_core::{Interval, Motion, RegionRef, excess};
use pcr_planning::fleet::{HostScalar, build_ecm};

/// The least and the largest clearance of ends of pieces inside segments, as parts of the excess. None where the format does
/// not hold the pair, or no piece ends inside a segment.
pub fn of_ends<S: HostScalar>(pair: &Pair) -> Option<[f64; 2]> {
    let discs: [Disc; 2] = [pair.0.rounded::<S>(), pair.1.rounded::<S>()];
    let [first, second] = [Course::<S>::new(&discs[0]).ok()?, Course::new(&discs[1]).ok()?];
    let motions = [first.motion(), second.motion()];
    let routes = discs.each_ref().map(Route::new::<S>);
    let radius = DoubleDouble::from(discs[0].radius) + DoubleDouble::from(discs[1].radius);
    let ecm = build_ecm(&motions).ok()?;
    let regions: Vec<_> = ecm.pair(&motions, 0, 1).expect("the table of both").collect();
    let mut found: Option<[f64; 2]> = None;
    for own in [0, 1] {
        let stated = excess(&motions[0], &motions[1]).to_f64();
        for clearance in clearances(&regions, &motions, &routes, own, radius) {
            let part = clearance / stated;
            let [least, most] = found.unwrap_or([part; 2]);
            found = Some([least.min(part), most.max(part)]);
        }
    }
    found
}

/// The segments of a piece, and its ranges, those of the path `own` first.
type Ranges<S> = ([usize; 2], [Interval<S>; 2]);

fn ranges<S: HostScalar>(regions: &[RegionRef<'_, S>], own: usize) -> Vec<Ranges<S>> {
    let pieces = regions.iter().flat_map(|region| region.pieces());
    let turned = |piece: pcr_core::PieceRef<'_, S>| match own {
        0 => (piece.segments, [piece.length, piece.other_length]),
        _ => ([piece.segments[1], piece.segments[0]], [piece.other_length, piece.length]),
    };
    pieces.map(turned).collect()
}

/// Of the ends of the ranges along the path `own`: how far they are from contact \[m\].
fn clearances<S: HostScalar>(
    regions: &[RegionRef<'_, S>],
    motions: &[Motion<'_, S>; 2],
    routes: &[Route; 2],
    own: usize,
    radius: DoubleDouble,
) -> Vec<f64> {
    let pieces = ranges(regions, own);
    let mut found = Vec::new();
    for (segments, [range, _]) in &pieces {
        let path = motions[own].path();
        let from = path.segments()[segments[0]].from();
        let to = path.segments().get(segments[0] + 1).map_or(path.length(), |next| next.from());
        for end in [range.lo, range.hi] {
            // What another piece of these segments holds on both sides is no end of anything.
            let inside = |other: &&Ranges<S>| other.0 == *segments && other.1[0].contains(end);
            if end > from && end < to && pieces.iter().filter(inside).count() == 1 {
                let point = routes[own].at(end.to_f64().into());
                found.push((routes[1 - own].distance(segments[1], point) - radius).to_f64());
            }
        }
    }
    found
}

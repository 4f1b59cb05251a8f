//! Random crossings of each type: all four quadrants of θ, both turns of either agent, combined radii below, between
//! and above the radii of the arcs.

use super::arc_arc::centre_distance;
use super::{Arc, Pcr};
use pcr_core::PieceType;
use pcr_formats::splitmix64::SplitMix64;
use std::f64::consts::FRAC_PI_2;

/// How far, in radii, a case stays away from contacts that touch without crossing \[1\]. There the ends of a range
/// are as the square root of an error, and which ranges merge is not decidable.
const CLEAR: f64 = 1e-3;

/// Least angle between the two directions at the crossing \[rad\].
const LEAST_ANGLE: f64 = 0.1;

/// `each` random cases of every class (quadrant, turns, size of the combined radius) of a type.
pub fn of_type(piece_type: PieceType, each: usize) -> Vec<Pcr> {
    let (own_arc, other_arc) = match piece_type {
        PieceType::SS => (false, false),
        PieceType::SA => (false, true),
        PieceType::AS => (true, false),
        PieceType::AA => (true, true),
    };
    let turns = |arc: bool| if arc { vec![Some(1.0), Some(-1.0)] } else { vec![None] };
    let sizes = if own_arc || other_arc { [0.0, 0.5, 1.0].as_slice() } else { [0.0].as_slice() };
    let mut random = SplitMix64(0x50c5 + piece_type as u64);
    let mut cases = Vec::new();
    for quadrant in 0..4 {
        for own in turns(own_arc) {
            for other in turns(other_arc) {
                for &size in sizes {
                    for _ in 0..each {
                        cases.push(clear_case(&mut random, quadrant, own, other, size));
                    }
                }
            }
        }
    }
    cases
}

/// A case of one class, drawn until it is clear of tangency.
fn clear_case(random: &mut SplitMix64, quadrant: i32, own: Option<f64>, other: Option<f64>, size: f64) -> Pcr {
    loop {
        let mut arc = |dir: Option<f64>| dir.map(|dir| Arc { radius: random.uniform(0.3, 2.5), dir });
        let (own, other) = (arc(own), arc(other));
        let radii: Vec<f64> = [own, other].iter().flatten().map(|arc| arc.radius).collect();
        let smallest = radii.iter().copied().fold(1.0, f64::min);
        let largest = radii.iter().copied().fold(smallest, f64::max);
        let r = match size {
            0.0 => random.uniform(0.1, 0.9) * smallest,
            1.0 => random.uniform(1.1, 2.5) * largest,
            _ => random.uniform(smallest, largest),
        };
        let theta = f64::from(quadrant) * FRAC_PI_2 + random.uniform(LEAST_ANGLE, FRAC_PI_2 - LEAST_ANGLE);
        let pcr = Pcr { r, v: random.uniform(0.2, 1.5), theta, own, other };
        if is_clear(&pcr) {
            return pcr;
        }
    }
}

/// Whether no contact of the carriers is near to touching: the extreme distances of one carrier from the other
/// differ from the combined radius.
fn is_clear(pcr: &Pcr) -> bool {
    let extremes = match (pcr.own, pcr.other) {
        (None, None) => return true,
        (None, Some(arc)) | (Some(arc), None) => {
            let line = arc.radius * pcr.theta.cos().abs();
            vec![arc.radius - line, arc.radius + line, arc.radius]
        }
        (Some(own), Some(other)) => {
            let centres = centre_distance(pcr, own, other);
            let from = |circle: Arc, moving: Arc| {
                let (near, far) = ((centres - moving.radius).abs(), centres + moving.radius);
                [far - circle.radius, near - circle.radius, circle.radius - near, circle.radius + near, circle.radius]
            };
            from(own, other).into_iter().chain(from(other, own)).collect()
        }
    };
    extremes.iter().all(|extreme| (extreme.abs() - pcr.r).abs() > CLEAR * pcr.r.max(1.0))
}

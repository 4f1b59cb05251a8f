//! The time of impact of Box2D, for pairs of lines whose boxes meet. Its bodies move uniformly on lines between two
//! times, so paths are flattened to a tenth of a millimetre. It finds only the first contact of a pair.

use super::peer_program::{PeerMethod, PeerProgram};
use pcr_comparing::compare::polyline::knots;
use pcr_comparing::compare::{CollisionMethod, ComparisonFleet};

/// Largest distance from the path \[m\]: a tenth of what Box2D's own tolerance is.
const TOLERANCE: f64 = 1e-4;

pub(super) fn methods() -> Vec<Box<dyn CollisionMethod>> {
    let name = "Box2D time of impact".to_owned();
    vec![Box::new(PeerMethod {
        program: PeerProgram::BOX2D,
        name,
        tells: "first times",
        input: flattened,
        in_time: |_, time| time,
    })]
}

fn flattened(field: &ComparisonFleet<'_>) -> Vec<f64> {
    let mut input = vec![field.tracks.len() as f64];
    for track in field.tracks {
        let knots = knots(track, TOLERANCE, field.horizon);
        input.extend([track.radius, knots.len() as f64]);
        input.extend(knots.iter().flat_map(|knot| [knot.time, knot.at[0], knot.at[1]]));
    }
    input
}

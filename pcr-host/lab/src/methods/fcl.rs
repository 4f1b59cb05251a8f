//! Proximity of meshes at every sample of time by FCL, from the authors of the library PQP that the paper uses: the same
//! cylinders and samples as with `parry3d`.

use super::peer_program::{PeerMethod, PeerProgram};
use pcr_comparing::compare::mesh_proximity::{HEIGHT, SIDES, STEP, STEP_UP, circumscribed, samples};
use pcr_comparing::compare::{CollisionMethod, ComparisonFleet};

pub(super) fn methods() -> Vec<Box<dyn CollisionMethod>> {
    let name = format!("FCL meshes {STEP} s");
    let in_time = |field: &ComparisonFleet<'_>, sample: f64| field.horizon[0] + STEP * sample;
    vec![Box::new(PeerMethod { program: PeerProgram::FCL, name, tells: "samples", input: sampled, in_time })]
}

fn sampled(field: &ComparisonFleet<'_>) -> Vec<f64> {
    let times = samples(field);
    let mut input = vec![f64::from(SIDES), HEIGHT, STEP_UP, field.tracks.len() as f64, times.len() as f64];
    for track in field.tracks {
        input.push(circumscribed(track.radius));
        input.extend(times.iter().flat_map(|&time| track.position(time)));
    }
    input
}

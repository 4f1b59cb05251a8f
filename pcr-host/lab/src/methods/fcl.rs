//! Proximity of meshes at every sample of time by FCL, from the authors of the library PQP that the paper uses: the same
//! cylinders and samples as with `parry3d`.

use super::program::{Peer, Program};
use pcr_comparing::compare::mesh::{HEIGHT, SIDES, STEP, STEP_UP, circumscribed, samples};
use pcr_comparing::compare::{Field, Method};

pub(super) fn methods() -> Vec<Box<dyn Method>> {
    let name = format!("FCL meshes {STEP} s");
    let in_time = |field: &Field<'_>, sample: f64| field.horizon[0] + STEP * sample;
    vec![Box::new(Peer { program: Program::FCL, name, tells: "samples", input: sampled, in_time })]
}

fn sampled(field: &Field<'_>) -> Vec<f64> {
    let times = samples(field);
    let mut input = vec![f64::from(SIDES), HEIGHT, STEP_UP, field.tracks.len() as f64, times.len() as f64];
    for track in field.tracks {
        input.push(circumscribed(track.radius));
        input.extend(times.iter().flat_map(|&time| track.position(time)));
    }
    input
}

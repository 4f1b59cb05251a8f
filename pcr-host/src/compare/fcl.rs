//! Proximity of meshes at every sample of time by FCL, from the authors of the library PQP that the paper uses: the same
//! cylinders and samples as with `parry3d`.

use super::mesh::{HEIGHT, SIDES, STEP, STEP_UP, circumscribed, samples};
use super::program::Program;
use super::stopwatch::Stopwatch;
use super::{Answer, Field, Method, Question};

struct Fcl;

pub(super) fn methods() -> Vec<Box<dyn Method>> {
    vec![Box::new(Fcl)]
}

impl Method for Fcl {
    fn name(&self) -> String {
        format!("FCL meshes {STEP} s")
    }

    fn question(&self) -> Question {
        Question::Conflicts
    }

    fn tells(&self) -> &'static str {
        "samples"
    }

    fn missing(&self) -> Option<&'static str> {
        (!Program::FCL.is_there()).then_some(Program::FCL.missing)
    }

    fn answer<'f>(&self, field: &'f Field<'_>) -> Option<Answer<'f>> {
        self.timed(field).1
    }

    fn timed<'f>(&self, field: &'f Field<'_>) -> (f64, Option<Answer<'f>>) {
        let clock = Stopwatch::start();
        let times = samples(field);
        let mut input = vec![f64::from(SIDES), HEIGHT, STEP_UP, field.tracks.len() as f64, times.len() as f64];
        for track in field.tracks {
            input.push(circumscribed(track.radius));
            input.extend(times.iter().flat_map(|&time| track.position(time)));
        }
        let sampling = clock.elapsed();
        let time = |sample: f64| field.horizon[0] + STEP * sample;
        match Program::FCL.contacts(&input, time) {
            Ok((work, answer)) => (sampling + work, Some(answer)),
            Err(_) => (sampling, None),
        }
    }
}

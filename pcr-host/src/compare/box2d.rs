//! The time of impact of Box2D, line by line with boxes in front. Its bodies move evenly on lines between two times, so paths are
//! flattened to a tenth of a millimetre. A pair is done with its first contact.

use super::polyline::knots;
use super::program::Program;
use super::stopwatch::Stopwatch;
use super::{Answer, Field, Method, Question};

/// Largest distance from the path \[m\]: a tenth of what Box2D's own tolerance is.
const TOLERANCE: f64 = 1e-4;

struct Box2d;

pub(super) fn methods() -> Vec<Box<dyn Method>> {
    vec![Box::new(Box2d)]
}

impl Method for Box2d {
    fn name(&self) -> String {
        "Box2D time of impact".to_owned()
    }

    fn question(&self) -> Question {
        Question::Conflicts
    }

    fn tells(&self) -> &'static str {
        "first times"
    }

    fn missing(&self) -> Option<&'static str> {
        (!Program::BOX2D.is_there()).then_some(Program::BOX2D.missing)
    }

    fn answer<'f>(&self, field: &'f Field<'_>) -> Option<Answer<'f>> {
        self.timed(field).1
    }

    fn timed<'f>(&self, field: &'f Field<'_>) -> (f64, Option<Answer<'f>>) {
        let clock = Stopwatch::start();
        let mut input = vec![field.tracks.len() as f64];
        for track in field.tracks {
            let knots = knots(track, TOLERANCE, field.horizon);
            input.extend([track.radius, knots.len() as f64]);
            input.extend(knots.iter().flat_map(|knot| [knot.time, knot.at[0], knot.at[1]]));
        }
        let flattening = clock.elapsed();
        match Program::BOX2D.contacts(&input, |time| time) {
            Ok((work, answer)) => (flattening + work, Some(answer)),
            Err(_) => (flattening, None),
        }
    }
}

//! Generic continuous collision detection: nonlinear shape casts of the crate `parry2d`, for each interval of time in
//! which both agents are on one line or arc at constant speed, if their boxes meet. Phases of acceleration are cut into
//! pieces of constant speed, with an error of a tenth of a millimetre. A cast returns the first time of contact, so it
//! finds only the first contact of a pair.
//!
//! Every cast begins at the time 0 and covers [`LONGEST`] at most: version 0.31 does not return for times above some 16
//! s
//! (`cargo run --release -p pcr-lab --example parry_times`).

use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query::{NonlinearRigidMotion, cast_shapes_nonlinear};
use parry2d_f64::shape::Ball;
use pcr_comparing::compare::disc_track::{DiscTrack, EMPTY, Xy, hull, near};
use pcr_comparing::compare::polyline::cuts;
use pcr_comparing::compare::{
    CollisionMethod, ComparisonFleet, MethodAnswer, MethodContact, MethodQuestion, MethodResult,
};

/// Largest error of a position where speeds change \[m\].
const TOLERANCE: f64 = 1e-4;

/// Longest time of a cast \[s\].
const LONGEST: f64 = 8.0;

struct ShapeCastMethod;

pub(super) fn methods() -> Vec<Box<dyn CollisionMethod>> {
    vec![Box::new(ShapeCastMethod)]
}

impl CollisionMethod for ShapeCastMethod {
    fn name(&self) -> String {
        "parry2d casts".to_owned()
    }

    fn question(&self) -> MethodQuestion {
        MethodQuestion::Conflicts
    }

    fn output_description(&self) -> &'static str {
        "first times"
    }

    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f> {
        let pieces: Vec<Vec<UniformMotion>> = field.tracks.iter().map(|track| pieces(track, field.horizon)).collect();
        let corners = |piece: &UniformMotion| [[piece.bounds[0], piece.bounds[1]], [piece.bounds[2], piece.bounds[3]]];
        let bound = |pieces: &Vec<UniformMotion>| {
            pieces.iter().flat_map(corners).fold(EMPTY, |bounds, corner| hull(bounds, corner, 0.0))
        };
        let bounds: Vec<[f64; 4]> = pieces.iter().map(bound).collect();
        let mut found = Vec::new();
        for (first, a) in field.tracks.iter().enumerate() {
            for (second, b) in field.tracks.iter().enumerate().skip(first + 1) {
                if near(bounds[first], bounds[second], a.radius + b.radius) {
                    let begin = first_contact(&pieces[first], &pieces[second], [a.radius, b.radius]);
                    found.extend(begin.map(|begin| MethodContact { agents: [first, second], begin, end: None }));
                }
            }
        }
        Ok(MethodAnswer::Conflicts(found))
    }
}

/// Constant speed on a line or an arc, or standing.
struct UniformMotion {
    time: [f64; 2],
    at: Xy,
    heading: f64,
    curvature: f64,
    speed: f64,
    bounds: [f64; 4],
}

impl UniformMotion {
    fn new(track: &DiscTrack, time: [f64; 2]) -> Self {
        let [from, to] = time.map(|time| track.length_at(time));
        // The way between them: a joint belongs to the next one.
        let way = track.way_at(0.5 * (from + to));
        let length = (to - from).max(0.0);
        let sagitta = 0.125 * way.curvature.abs() * length * length;
        let at = way.at(from - way.from);
        Self {
            time,
            at,
            heading: way.direction[1].atan2(way.direction[0]) + way.curvature * (from - way.from),
            curvature: way.curvature,
            speed: length / (time[1] - time[0]),
            bounds: hull(hull(EMPTY, at, sagitta), way.at(to - way.from), sagitta),
        }
    }

    /// Its motion from a time on, which becomes 0.
    fn motion(&self, from: f64) -> NonlinearRigidMotion {
        let turned = self.curvature * self.speed * (from - self.time[0]);
        let (sin, cos) = self.heading.sin_cos();
        if self.curvature == 0.0 {
            let way = self.speed * (from - self.time[0]);
            let at = Vector::new(self.at[0] + way * cos, self.at[1] + way * sin);
            let velocity = Vector::new(self.speed * cos, self.speed * sin);
            return NonlinearRigidMotion::new(Pose::new(at, self.heading), Vector::ZERO, velocity, 0.0);
        }
        let heading = self.heading + turned;
        let radius = 1.0 / self.curvature;
        let at = Vector::new(self.at[0] + radius * (heading.sin() - sin), self.at[1] - radius * (heading.cos() - cos));
        let centre = Vector::new(0.0, radius);
        NonlinearRigidMotion::new(Pose::new(at, heading), centre, Vector::ZERO, self.curvature * self.speed)
    }
}

fn pieces(track: &DiscTrack, horizon: [f64; 2]) -> Vec<UniformMotion> {
    let mut times = vec![horizon[0]];
    times.extend(cuts(track, TOLERANCE, 0.0));
    times.push(horizon[1]);
    times.dedup();
    times.windows(2).map(|pair| UniformMotion::new(track, [pair[0], pair[1]])).collect()
}

fn first_contact(a: &[UniformMotion], b: &[UniformMotion], radii: [f64; 2]) -> Option<f64> {
    let balls = radii.map(Ball::new);
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    while let (Some(own), Some(their)) = (a.peek(), b.peek()) {
        let (from, to) = (own.time[0].max(their.time[0]), own.time[1].min(their.time[1]));
        if near(own.bounds, their.bounds, radii[0] + radii[1]) {
            let parts = ((to - from) / LONGEST).ceil().max(1.0);
            for part in 0..parts as usize {
                let begin = from + (to - from) * (part as f64 / parts);
                let (own, their) = (own.motion(begin), their.motion(begin));
                let hit = cast_shapes_nonlinear(&own, &balls[0], &their, &balls[1], 0.0, (to - from) / parts, true);
                if let Ok(Some(hit)) = hit {
                    return Some(begin + hit.time_of_impact);
                }
            }
        }
        let ends = [own.time[1], their.time[1]];
        if ends[0] <= to {
            a.next();
        }
        if ends[1] <= to {
            b.next();
        }
    }
    None
}

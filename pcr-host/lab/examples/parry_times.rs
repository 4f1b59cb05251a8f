//! Nonlinear casts of `parry2d` at later and later times: two discs that cross as soon as the cast begins. A cast that does
//! not return within five seconds is given up.
//!
//! ```sh
//! cargo run --release -p pcr-lab --example parry_times
//! ```

use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query::{NonlinearRigidMotion, cast_shapes_nonlinear};
use parry2d_f64::shape::Ball;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// Time that a cast gets.
const PATIENCE: Duration = Duration::from_secs(5);

fn main() {
    for begin in [0.0, 1.0, 4.0, 8.0, 12.0, 16.0, 20.0, 32.0, 64.0] {
        let (sender, receiver) = mpsc::channel();
        let since = Instant::now();
        // The thread ends with the program if the cast does not.
        thread::spawn(move || sender.send(cast(begin)));
        match receiver.recv_timeout(PATIENCE) {
            Ok(hit) => println!("from {begin} s on: contact at {hit:?} after {:?}", since.elapsed()),
            Err(_) => println!("from {begin} s on: no answer within {PATIENCE:?}"),
        }
    }
}

/// The time of the contact, 0.74 s after the begin.
fn cast(begin: f64) -> Option<f64> {
    // Where they would have been at the time 0.
    let motion = |x: f64, y: f64, speed: [f64; 2]| {
        let start = Pose::new(Vector::new(x - begin * speed[0], y - begin * speed[1]), 0.0);
        NonlinearRigidMotion::new(start, Vector::ZERO, Vector::new(speed[0], speed[1]), 0.0)
    };
    let (east, west) = (motion(-1.0, 0.0, [1.0, 0.0]), motion(1.0, 0.3, [-1.0, 0.0]));
    let ball = Ball::new(0.25 + 0.05);
    let hit = cast_shapes_nonlinear(&east, &ball, &west, &ball, begin, begin + 2.0, true);
    hit.ok().flatten().map(|hit| hit.time_of_impact)
}

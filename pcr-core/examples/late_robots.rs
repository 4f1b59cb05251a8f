//! Two robots that are late at random and never touch: each goes only as far as its hold allows.
//!
//! ```text
//! cargo run -p pcr-core --features std --example late_robots
//! ```

use pcr_core::{
    BrakingModel, Interval, Limits, Motion, MovementAuthority, Path, Piece, Point, Pose, PrecedenceTable, Profile,
    Progress, RegionPrecedence,
};
use pcr_core::{CheckState, CheckTolerances, EcmEntry, Radians};

/// Seconds between two control steps, in which robots report where they are.
const STEP: f64 = 0.1;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    let paths = [
        Path::<f64, 1>::starting_at(pose(-2.0, 0.0, 0.0))?.line(4.0)?,
        Path::<f64, 1>::starting_at(pose(0.0, -2.0, std::f64::consts::FRAC_PI_2))?.line(4.0)?,
    ];
    let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    let motion = |path, start| Motion::new(path, profile.as_profile(), 0.25, start);
    // A plan without conflicts, as from `plan_delays`. Its orders are used, its times are not.
    let fleet = [motion(paths[0].as_path(), 0.0)?, motion(paths[1].as_path(), 2.0)?];
    let mut orders =
        PrecedenceTable::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], [RegionPrecedence::EMPTY; 4], &fleet)?;
    orders.as_planned(&fleet)?;
    // Whatever the delays, all robots arrive.
    let start = [Progress::at_rest(0.0); 2];
    orders.check(&fleet, &start, CheckTolerances { width: 0.01, gain: 0.001 }, &mut [CheckState::EMPTY; 2])?;

    let brakes = BrakingModel::new(1.0, 0.0)?;
    let (mut at, mut speed, mut nearest) = ([0.0_f64; 2], [0.0_f64; 2], f64::INFINITY);
    for step in 0..600 {
        let places = [0, 1].map(|robot| Progress {
            at: Interval::new(at[robot], at[robot]),
            stop: at[robot] + brakes.distance(speed[robot]),
        });
        for robot in 0..2 {
            let end = paths[robot].as_path().length();
            let hold = match orders.hold(&fleet, robot, &places)? {
                MovementAuthority::Free => end,
                MovementAuthority::At(length) => length.min(end),
                MovementAuthority::Inside => at[robot],
            };
            // Something holds up robot 0 for 20 seconds.
            let held_up = robot == 0 && (10..210).contains(&step);
            // The speed must allow it to stop before its hold from the place where it will be in the next step.
            let allowed = brakes.speed((hold - at[robot] - 1.0 * STEP * STEP).max(0.0));
            speed[robot] = if held_up { 0.0 } else { (speed[robot] + STEP).min(1.0).min(allowed) };
            at[robot] = (at[robot] + speed[robot] * STEP).min(hold);
        }
        let [a, b] = [0, 1].map(|robot| paths[robot].as_path().point_at(at[robot]));
        nearest = nearest.min((a.x - b.x).hypot(a.y - b.y) - 0.5);
    }
    println!("robots at {:.2} m and {:.2} m of 4 m, never nearer than {nearest:.3} m", at[0], at[1]);
    assert!(nearest >= 0.0 && at.iter().all(|&at| at > 3.9));
    Ok(())
}

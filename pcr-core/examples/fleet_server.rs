//! A server that owns its robots. Each robot gets one mission after the other, and only its own regions are computed
//! again.
//!
//! ```text
//! cargo run -p pcr-core --features std --example fleet_server
//! ```

use pcr_core::{
    CapacityError, Ecm, EcmEntry, EcmError, InvalidInput, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians,
};
use pcr_core::{earliest_start, first_overlap};
use std::error::Error;

/// The data of a robot. A [`Motion`] borrows its path and its profile, so it is made when it is needed; that costs a
/// pass over the segments.
struct Robot {
    path: Path<f64, 16>,
    profile: Profile<f64, 8>,
    start: f64,
}

const LIMITS: Limits<f64> = Limits { speed: 1.0, acceleration: 0.5 };
const RADIUS: f64 = 0.4;

impl Robot {
    /// A robot that drives from rest to rest along a path, starting at a time \[s\].
    fn new(path: Path<f64, 16>, start: f64) -> Result<Self, InvalidInput> {
        let profile = Profile::rest_to_rest(path.as_path().length(), LIMITS)?;
        Ok(Self { path, profile: Profile::copied(profile.as_profile())?, start })
    }

    fn motion(&self) -> Result<Motion<'_, f64>, InvalidInput> {
        // The disc is larger by the tolerance of a check, so that robots that touch in the plan do not touch in fact.
        Motion::new(self.path.as_path(), self.profile.as_profile(), RADIUS, self.start)?.for_plan()
    }
}

/// The robots and the table of their regions; both are always changed together.
struct Server {
    robots: Vec<Robot>,
    table: Ecm<f64, Vec<EcmEntry>, Vec<Piece<f64>>>,
}

fn motions(robots: &[Robot]) -> Result<Vec<Motion<'_, f64>>, InvalidInput> {
    robots.iter().map(Robot::motion).collect()
}

/// Repeats a call, with more room each time, until the result fits.
fn with_room<T>(
    table: &mut Ecm<f64, Vec<EcmEntry>, Vec<Piece<f64>>>,
    mut act: impl FnMut(&mut Ecm<f64, Vec<EcmEntry>, Vec<Piece<f64>>>) -> Result<T, EcmError>,
) -> Result<T, Box<dyn Error>> {
    loop {
        match act(table) {
            Err(EcmError::Full(full @ (CapacityError::Regions { .. } | CapacityError::Pieces { .. }))) => {
                table.grow(full)?
            }
            done => return Ok(done?),
        }
    }
}

impl Server {
    fn new() -> Self {
        Self { robots: Vec::new(), table: Ecm::new(Vec::new(), Vec::new()) }
    }

    fn add(&mut self, robot: Robot) -> Result<usize, Box<dyn Error>> {
        let number = self.robots.len();
        self.robots.push(robot);
        let fleet = motions(&self.robots)?;
        let added = with_room(&mut self.table, |table| table.insert(&fleet, number));
        drop(fleet);
        if added.is_err() {
            self.robots.pop();
        }
        added.map(|()| number)
    }

    /// Gives a robot another path and the least start delay that the other robots allow; `None` if no start is late
    /// enough. Returns the delay \[s\].
    fn send(&mut self, number: usize, mut mission: Robot) -> Result<Option<f64>, Box<dyn Error>> {
        let mut fleet = motions(&self.robots)?;
        let before = fleet[number];
        let motion = mission.motion()?;
        with_room(&mut self.table, |table| table.replace(&mut fleet, number, motion))?;
        let delay = earliest_start(self.table.row(&fleet, number)?, 0.0);
        let Some(delay) = delay else {
            // Restores the old mission.
            with_room(&mut self.table, |table| table.replace(&mut fleet, number, before))?;
            return Ok(None);
        };
        // A delay does not change the table. The plan is checked before it is used.
        let late = motion.delayed(delay)?;
        let whole = pcr_core::Interval::new(0.0, Motion::span(&fleet).hi + delay);
        assert!(first_overlap(&late, self.table.row(&fleet, number)?, whole)?.is_none());
        drop(fleet);
        mission.start += delay;
        self.robots[number] = mission;
        Ok(Some(delay))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut server = Server::new();
    let east = Path::starting_at(pose(-4.0, 0.0, 0.0))?.line(8.0)?;
    let parked = Path::starting_at(pose(0.0, -4.0, quarter))?;
    let first = server.add(Robot::new(east, 0.0)?)?;
    let second = server.add(Robot::new(parked, 0.0)?)?;
    println!("{} robots, {} regions", server.robots.len(), server.table.len());

    let north = Path::starting_at(pose(0.0, -4.0, quarter))?.line(3.0)?.arc_by(2.0, -1.5)?;
    let delay = server.send(second, Robot::new(north, 0.0)?)?;
    println!("robot {second} sets off {:.3} s later than it wished", delay.ok_or("no start helps")?);
    for region in server.table.row(&motions(&server.robots)?, first)? {
        println!("robot {first} shares {:.3}..{:.3} m of its path", region.length().lo, region.length().hi);
    }
    Ok(())
}

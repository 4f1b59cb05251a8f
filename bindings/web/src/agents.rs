//! Reads agents from the numbers of the caller, and builds their paths and motions.

use crate::limits::{AGENTS, CORNERS, LEGS, STRIDE};
use crate::message::Fault;
use heapless::Vec;
use pcr_core::{Limits, Motion, Outline, Path, Point, Pose, Profile, Radians, Vector};

/// All agents, a row of [`STRIDE`] numbers each.
pub type Input = [f64; AGENTS * STRIDE];

/// The parts of an agent.
#[derive(Debug)]
pub struct Agent {
    path: Path<f64, LEGS>,
    profile: Profile<f64, 3>,
    outline: Outline<f64, CORNERS>,
    start: f64,
}

impl Agent {
    /// Reads an agent. A leg whose second number is 0 is a line, and the first number is its length. Otherwise it is an
    /// arc with the first number as radius, which turns by the second number, to the left if positive. Without corners the
    /// agent is a disc of the radius; with corners, it is their polygon, rounded by the radius.
    fn read(agent: usize, row: &[f64]) -> Result<Self, Fault> {
        let &[x, y, heading, radius, start, speed, acceleration, legs, ref rest @ ..] = row else {
            return Err(Fault::Agents(agent));
        };
        let whole = Fault::of_agent(agent);
        let position = Point::new(x, y);
        let mut path = Path::starting_at(Pose { position, heading: Radians(heading) }).map_err(whole)?;
        let (Some(legs_in), Some(&[corners, ref corners_in @ ..])) = (rest.get(..2 * LEGS), rest.get(2 * LEGS..))
        else {
            return Err(Fault::Agents(agent));
        };
        let all = legs_in.chunks_exact(2).zip(0_usize..);
        // The number of legs is an `f64` that must be an integer from 0 to LEGS.
        if !(0..=LEGS).any(|count| count as f64 == legs) {
            return Err(Fault::Legs(agent));
        }
        for (leg, place) in all.take(legs as usize) {
            let &[length, sweep] = leg else { return Err(Fault::Legs(agent)) };
            let next = if sweep == 0.0 { path.line(length) } else { path.arc_by(length, sweep) };
            path = next.map_err(Fault::of_leg(agent, place))?;
        }
        if !(0..=CORNERS).any(|count| count as f64 == corners) {
            return Err(Fault::Corners(agent));
        }
        let polygon = corners_in.chunks_exact(2).take(corners as usize).map(|corner| match *corner {
            [x, y] => Vector { x, y },
            _ => Vector { x: f64::NAN, y: f64::NAN },
        });
        let outline = if corners == 0.0 { Outline::disc(radius) } else { Outline::polygon(polygon, radius) };
        let outline = outline.map_err(whole)?;
        let limits = Limits { speed, acceleration };
        let profile = Profile::rest_to_rest(path.as_path().length(), limits).map_err(whole)?;
        Ok(Self { path, profile, outline, start })
    }

    fn motion(&self) -> Result<Motion<'_, f64>, pcr_core::InvalidInput> {
        Motion::with_outline(self.path.as_path(), self.profile.as_profile(), &self.outline, self.start)
    }
}

/// The agents of a fleet.
#[derive(Debug)]
pub struct Agents {
    all: Vec<Agent, AGENTS>,
    /// Whether agents were read. Before that a query is an error, because an empty answer would be one about an empty
    /// fleet.
    known: bool,
}

/// Motions of the agents.
pub type Motions<'a> = Vec<Motion<'a, f64>, AGENTS>;

impl Agents {
    /// An empty fleet that was not read.
    pub const NONE: Self = Self { all: Vec::new(), known: false };

    /// Reads the first `count` agents of the input. If one of them is refused, queries are errors until another fleet
    /// is read.
    ///
    /// # Errors
    /// [`Fault`], with the agent and the leg.
    pub fn read(&mut self, input: &Input, count: usize) -> Result<(), Fault> {
        self.clear();
        if count > AGENTS {
            return Err(Fault::Agents(count));
        }
        let read = input.chunks_exact(STRIDE).zip(0..count).try_for_each(|(row, number)| {
            let agent = Agent::read(number, row)?;
            agent.motion().map_err(Fault::of_agent(number))?;
            self.all.push(agent).map_err(|_| Fault::Agents(count))
        });
        self.known = read.is_ok();
        read
    }

    /// Removes all agents.
    pub fn clear(&mut self) {
        self.all.clear();
        self.known = false;
    }

    /// The motions of all agents. Each one was checked when it was read.
    ///
    /// # Errors
    /// [`Fault::NotBuilt`].
    pub fn motions(&self) -> Result<Motions<'_>, Fault> {
        if !self.known {
            return Err(Fault::NotBuilt);
        }
        self.all.iter().zip(0..).map(|(agent, number)| agent.motion().map_err(Fault::of_agent(number))).collect()
    }
}

//! Agents as the caller writes them, and their paths and motions.

use crate::message::Fault;
use heapless::Vec;
use pcr_core::{Limits, Motion, Path, Point, Pose, Profile, Radians};

/// Agents, at most.
pub const AGENTS: usize = 24;
/// Legs of a path, at most.
pub const LEGS: usize = 32;
/// Numbers of an agent: x, y, heading, radius, start, largest speed, largest acceleration, how many legs; and two a leg.
pub const STRIDE: usize = 8 + 2 * LEGS;

/// All agents, a row of [`STRIDE`] numbers each.
pub type Input = [f64; AGENTS * STRIDE];

/// What an agent is made of.
#[derive(Debug)]
pub struct Agent {
    path: Path<f64, LEGS>,
    profile: Profile<f64, 3>,
    radius: f64,
    start: f64,
}

impl Agent {
    /// From its numbers. A leg is a line of this length if its second number is 0, else an arc of this radius that turns by the
    /// second number, to the left if it is positive.
    fn read(agent: usize, row: &[f64]) -> Result<Self, Fault> {
        let &[x, y, heading, radius, start, speed, acceleration, legs, ref rest @ ..] = row else {
            return Err(Fault::Agents(agent));
        };
        let whole = Fault::of_agent(agent);
        let position = Point::new(x, y);
        let mut path = Path::starting_at(Pose { position, heading: Radians(heading) }).map_err(whole)?;
        let all = rest.chunks_exact(2).zip(0_usize..);
        // The number of legs is a whole number of `f64`; what is none of 0 to LEGS is refused.
        if !(0..=LEGS).any(|count| count as f64 == legs) {
            return Err(Fault::Legs(agent));
        }
        for (leg, place) in all.take(legs as usize) {
            let &[length, sweep] = leg else { return Err(Fault::Legs(agent)) };
            let next = if sweep == 0.0 { path.line(length) } else { path.arc_by(length, sweep) };
            path = next.map_err(Fault::of_leg(agent, place))?;
        }
        let limits = Limits { speed, acceleration };
        let profile = Profile::rest_to_rest(path.as_path().length(), limits).map_err(whole)?;
        Ok(Self { path, profile, radius, start })
    }

    fn motion(&self) -> Result<Motion<'_, f64>, pcr_core::Invalid> {
        Motion::new(self.path.as_path(), self.profile.as_profile(), self.radius, self.start)
    }
}

/// The agents of a fleet.
#[derive(Debug)]
pub struct Agents {
    all: Vec<Agent, AGENTS>,
    /// Whether these were taken. Until then there are no answers: none would be one about nobody.
    known: bool,
}

/// Their motions.
pub type Motions<'a> = Vec<Motion<'a, f64>, AGENTS>;

impl Agents {
    /// Nobody.
    pub const NONE: Self = Self { all: Vec::new(), known: false };

    /// Becomes the first so many agents of the input. If one of them is refused there are no answers.
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

    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.all.clear();
        self.known = false;
    }

    /// Their motions; all of them, as each was tried when it was read.
    ///
    /// # Errors
    /// [`Fault::NotBuilt`].
    pub fn motions(&self) -> Result<Motions<'_>, Fault> {
        if !self.known {
            return Err(Fault::NotBuilt);
        }
        Ok(self.all.iter().filter_map(|agent| agent.motion().ok()).collect())
    }
}

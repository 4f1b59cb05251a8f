//! Fleets of any number of agents, as dense as the paper's: 12 agents on 7 m by 7 m.

use crate::random::Random;
use crate::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use std::f64::consts::{FRAC_PI_2, PI};

/// Floor for each agent \[m²\].
const FLOOR: f64 = 49.0 / 12.0;

/// Agents of random sizes, speeds and paths of three to six segments, 4 to 12 m long, evenly spread over a square. The same
/// seed gives the same fleet.
pub fn crowd(agents: usize, seed: u64) -> Scenario {
    let mut random = Random(seed);
    let side = (FLOOR * agents as f64).sqrt();
    let agent = |id: usize| {
        let start = [random.within(0.0, side), random.within(0.0, side), random.within(-PI, PI)];
        let path = (0..3 + random.below(4)).map(|_| segment(&mut random)).collect();
        let (v_max, a_max) = (random.within(0.36, 0.58), 0.3);
        let motion = MotionSpec::RestToRest { v_max, a_max };
        Agent::disc(id as u64 + 1, random.within(0.11, 0.22), start, path, motion)
    };
    Scenario { name: format!("crowd of {agents}"), agents: (0..agents).map(agent).collect() }
}

fn segment(random: &mut Random) -> PathSegment {
    if random.below(2) == 0 {
        PathSegment::Line { length: random.within(1.0, 2.0) }
    } else {
        let (radius, sweep) = (random.within(0.5, 1.5), random.within(0.8, FRAC_PI_2));
        PathSegment::Arc { radius, sweep: if random.below(2) == 0 { sweep } else { -sweep } }
    }
}

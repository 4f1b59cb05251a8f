//! Fleets of any number of agents, as dense as the paper's: 12 agents on 7 m by 7 m.

use pcr_formats::scenario::PlacedSegment;
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use pcr_formats::splitmix64::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI};

/// Floor for each agent \[m²\].
const FLOOR: f64 = 49.0 / 12.0;

/// Segments that are tried before a path begins anew: it may have come into a corner.
const TRIES: usize = 8;

/// Agents of random sizes, speeds and paths of three to six segments, 4 to 12 m long, that begin anywhere on a square and
/// stay on it: so the agents of a small fleet, of which many are near its border, meet about as many others as those of a
/// large one. The same seed gives the same fleet.
pub fn crowd(agents: usize, seed: u64) -> Scenario {
    let mut random = SplitMix64(seed);
    let side = (FLOOR * agents as f64).sqrt();
    let agent = |id: usize| {
        let at = [random.uniform(0.0, side), random.uniform(0.0, side)];
        let segments = 3 + random.below(4);
        let (heading, path) = loop {
            let heading = random.uniform(-PI, PI);
            if let Some(path) = path(&mut random, side, at, heading, segments) {
                break (heading, path);
            }
        };
        let (v_max, a_max) = (random.uniform(0.36, 0.58), 0.3);
        let motion = MotionSpec::RestToRest { v_max, a_max };
        Agent::disc(id as u64 + 1, random.uniform(0.11, 0.22), [at[0], at[1], heading], path, motion)
    };
    Scenario::new(format!("crowd of {agents}"), (0..agents).map(agent).collect())
}

/// A path on the square, unless it gets stuck.
fn path(
    random: &mut SplitMix64,
    side: f64,
    mut at: [f64; 2],
    mut heading: f64,
    segments: usize,
) -> Option<Vec<PathSegment>> {
    let step = |_| {
        let fits = |placed: &PlacedSegment| {
            let middle = PlacedSegment { shape: half(placed.shape), ..*placed }.end();
            middle.iter().chain(&placed.end()).all(|x| (0.0..=side).contains(x))
        };
        let placed = (0..TRIES).map(|_| PlacedSegment { start: at, heading, shape: segment(random) }).find(fits)?;
        (at, heading) = (placed.end(), placed.heading_at_end());
        Some(placed.shape)
    };
    (0..segments).map(step).collect()
}

fn half(segment: PathSegment) -> PathSegment {
    match segment {
        PathSegment::Line { length } => PathSegment::Line { length: 0.5 * length },
        PathSegment::Arc { radius, sweep, steady } => PathSegment::Arc { radius, sweep: 0.5 * sweep, steady },
        _ => segment,
    }
}

fn segment(random: &mut SplitMix64) -> PathSegment {
    if random.below(2) == 0 {
        PathSegment::Line { length: random.uniform(1.0, 2.0) }
    } else {
        let (radius, sweep) = (random.uniform(0.5, 1.5), random.uniform(0.8, FRAC_PI_2));
        PathSegment::arc(radius, if random.below(2) == 0 { sweep } else { -sweep })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::DiscTrack;

    #[test]
    fn paths_stay_on_the_floor() {
        for (agents, seed) in [(1, 0), (12, 1), (200, 2)] {
            let side = (FLOOR * agents as f64).sqrt();
            for agent in crowd(agents, seed).agents {
                let track = DiscTrack::new(&agent);
                let length = agent.length();
                for k in 0..=100 {
                    let at = track.at(length * f64::from(k) / 100.0);
                    // Between its begin, middle and end, an arc of a quarter bulges a little.
                    assert!(at.iter().all(|x| (-0.15..side + 0.15).contains(x)), "{at:?} of {side}");
                }
            }
        }
    }
}

//! Dependencies: which waypoint has to be reached before another agent heads for one of its own.
//!
//! For each pair of agents a table of their collision regions says who passes first, by the times of the plan. Then the first agent is put at
//! each of its waypoints, one after the other: its movement authority says which waypoints the second one may head for meanwhile. The
//! authority grows as the first agent goes on, so each waypoint of the second one has one waypoint of the first one that it waits for.

use crate::Error;
use crate::motion::OwnedMotion;
use crate::trajectory::Trajectory;
use pcr_core::{AdmissionError, CapacityError, EcmEntry, Motion, Piece, PrecedenceTable, Progress, RegionPrecedence};
use std::collections::VecDeque;

/// Lengths of a path that differ by less are the same \[m\]: a waypoint at the end of a movement authority is within it.
const SAME: f64 = 1e-9;

/// An agent may head for a waypoint once another agent has reached one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Dependency {
    /// The agent that waits.
    pub agent: usize,
    /// Index of the waypoint that it may head for then, at least 1.
    pub waypoint: usize,
    /// The agent that goes first.
    pub waits_for: usize,
    /// Index of the waypoint that this agent has to have reached.
    pub reached: usize,
}

/// All dependencies of a plan.
#[derive(Clone, Debug)]
pub struct Dependencies {
    /// Of each agent, sorted by waypoint: the waypoint that waits, the other agent, and its waypoint.
    waits: Vec<Vec<(usize, usize, usize)>>,
    /// Number of waypoints of each agent.
    waypoints: Vec<usize>,
}

type Table = PrecedenceTable<f64, Vec<EcmEntry>, Vec<Piece<f64>>, Vec<RegionPrecedence<f64>>>;

impl Dependencies {
    /// The dependencies of trajectories that are free of collisions at their times.
    ///
    /// An agent that has been at waypoint k heads for waypoint k + 1, along the line or the turn between them and at any speed, only if
    /// [`Dependencies::may_proceed`]. Then no two agents ever touch, but for a nanometre of rounding, and none waits for ever. A dependency that another one of the
    /// same two agents implies is left out.
    ///
    /// Cost: for each pair of agents that of a table of two agents, and, if they have regions, of a movement authority for each waypoint.
    ///
    /// # Errors
    /// [`Error`], with the agent and the waypoint. There is no answer for a part of the agents.
    pub fn of(trajectories: &[Trajectory]) -> Result<Self, Error> {
        let owned: Vec<OwnedMotion> = (trajectories.iter().enumerate())
            .map(|(agent, trajectory)| OwnedMotion::new(agent, trajectory))
            .collect::<Result<_, _>>()?;
        let motions: Vec<Motion<'_, f64>> = (owned.iter().enumerate())
            .map(|(agent, owned)| owned.motion().map_err(|problem| Error::Invalid { agent, problem }))
            .collect::<Result<_, _>>()?;
        let mut waits = vec![Vec::new(); owned.len()];
        let mut table = Table::new(Vec::new(), Vec::new(), Vec::new());
        for second in 0..owned.len() {
            for first in 0..second {
                let pair = [first, second];
                let fleet = pair.map(|agent| motions[agent]);
                fill(&mut table, &fleet)?;
                if table.ecm().is_empty() {
                    continue;
                }
                table.as_planned(&fleet).map_err(|error| match error {
                    AdmissionError::Full(full) => Error::Memory(full),
                    _ => Error::Meeting { agents: pair },
                })?;
                for waiting in 0..2 {
                    let [own, other] = [pair[waiting], pair[1 - waiting]];
                    let found = pair_waits(&table, &fleet, waiting, [&owned[own].lengths, &owned[other].lengths]);
                    let found = found.ok_or(Error::Meeting { agents: pair })?;
                    waits[own].extend(found.into_iter().map(|(waypoint, reached)| (waypoint, other, reached)));
                }
            }
        }
        waits.iter_mut().for_each(|waits| waits.sort_unstable());
        let dependencies = Self { waits, waypoints: owned.iter().map(|owned| owned.lengths.len()).collect() };
        dependencies.check()?;
        Ok(dependencies)
    }

    /// All dependencies, by agent and waypoint.
    pub fn iter(&self) -> impl Iterator<Item = Dependency> {
        self.waits.iter().enumerate().flat_map(|(agent, waits)| {
            let named = move |&(waypoint, waits_for, reached)| Dependency { agent, waypoint, waits_for, reached };
            waits.iter().map(named)
        })
    }

    /// What an agent has to wait for before it heads for the waypoint of an index.
    ///
    /// # Errors
    /// [`Error::NoSuchAgent`], [`Error::NoSuchWaypoint`].
    pub fn before(&self, agent: usize, waypoint: usize) -> Result<impl Iterator<Item = Dependency>, Error> {
        let known = *self.waypoints.get(agent).ok_or(Error::NoSuchAgent { agent })?;
        if waypoint >= known {
            return Err(Error::NoSuchWaypoint { agent, waypoint });
        }
        let waits = self.waits[agent].iter();
        Ok(waits.filter(move |(own, ..)| *own == waypoint).map(move |&(waypoint, waits_for, reached)| Dependency {
            agent,
            waypoint,
            waits_for,
            reached,
        }))
    }

    /// Whether an agent may head for the waypoint after the one that it has reached. `reached` has the last waypoint that each agent has
    /// reached. At its last waypoint an agent does not proceed.
    ///
    /// # Errors
    /// [`Error::Agents`], [`Error::NoSuchAgent`], [`Error::NoSuchWaypoint`].
    pub fn may_proceed(&self, agent: usize, reached: &[usize]) -> Result<bool, Error> {
        let expected = self.waypoints.len();
        if reached.len() != expected {
            return Err(Error::Agents { given: reached.len(), expected });
        }
        if agent >= expected {
            return Err(Error::NoSuchAgent { agent });
        }
        if let Some(agent) = (0..expected).find(|&agent| reached[agent] >= self.waypoints[agent]) {
            return Err(Error::NoSuchWaypoint { agent, waypoint: reached[agent] });
        }
        let next = reached[agent] + 1;
        if next == self.waypoints[agent] {
            return Ok(false);
        }
        Ok(self.before(agent, next)?.all(|wait| reached[wait.waits_for] >= wait.reached))
    }

    /// Checks that nobody waits for ever: lets everybody proceed who may, until all have arrived.
    fn check(&self) -> Result<(), Error> {
        let mut reached = vec![0; self.waypoints.len()];
        // For each agent, whom its progress may let go on.
        let mut followers = vec![Vec::new(); reached.len()];
        for (agent, waits) in self.waits.iter().enumerate() {
            waits.iter().for_each(|&(_, other, _)| followers[other].push(agent));
        }
        followers.iter_mut().for_each(|followers| {
            followers.sort_unstable();
            followers.dedup();
        });
        // How many dependencies of each agent are met, which are sorted by waypoint.
        let mut met = vec![0; reached.len()];
        let mut queue: VecDeque<usize> = (0..reached.len()).collect();
        while let Some(agent) = queue.pop_front() {
            let before = reached[agent];
            while reached[agent] + 1 < self.waypoints[agent] {
                let next = reached[agent] + 1;
                let due = self.waits[agent][met[agent]..].iter().take_while(|(waypoint, ..)| *waypoint <= next);
                let is_free = due.clone().all(|&(_, other, least)| reached[other] >= least);
                if !is_free {
                    break;
                }
                met[agent] += due.count();
                reached[agent] = next;
            }
            if reached[agent] > before {
                queue.extend(&followers[agent]);
            }
        }
        let waits: Vec<(usize, usize)> = (0..reached.len())
            .filter(|&agent| reached[agent] + 1 < self.waypoints[agent])
            .map(|agent| (agent, reached[agent] + 1))
            .collect();
        if waits.is_empty() { Ok(()) } else { Err(Error::Circle { waits }) }
    }
}

/// Computes the table of two agents, with as much storage as it takes.
fn fill(table: &mut Table, fleet: &[Motion<'_, f64>; 2]) -> Result<(), Error> {
    loop {
        match table.fill(fleet) {
            Ok(()) => return Ok(()),
            Err(full @ CapacityError::Pair(_)) => return Err(Error::Memory(full)),
            Err(full) => table.grow(full).map_err(Error::Memory)?,
        }
    }
}

/// Which waypoints of one agent wait for which of the other one: pairs that grow in both. `None` if one waits for the other for ever.
fn pair_waits(
    table: &Table,
    fleet: &[Motion<'_, f64>; 2],
    waiting: usize,
    [own, other]: [&[f64]; 2],
) -> Option<Vec<(usize, usize)>> {
    let mut found = Vec::new();
    // The first waypoint that the agent may not head for yet.
    let mut next = 1;
    for (reached, &length) in other.iter().enumerate() {
        let mut progress = [Progress::at_rest(0.0); 2];
        progress[1 - waiting] = Progress::at_rest(length);
        let authority = table.hold(fleet, waiting, &progress).ok()?;
        let allowed = own.iter().skip(next).take_while(|length| authority.allows(**length - SAME)).count();
        if allowed > 0 && reached > 0 {
            found.push((next, reached));
        }
        next += allowed;
        if next >= own.len() {
            return Some(found);
        }
    }
    None
}

//! Closures that limit the speed: robots brake as soon as they can, and all times count with the limit from then on.
//!
//! Precedence and movement authority are lengths, not times, so nobody can touch because somebody is slower, and all still come to their ends.
//! What changes are the times by which routes and precedence are chosen.

use super::run_state::LifelongState;
use super::world_changes::{ChangeEffect, ChangeId};

impl LifelongState {
    /// Lets the speeds on all edges be what the present limits allow, computes all times anew, and looks for better routes for the robots that
    /// the limits which begin make slower.
    pub(super) fn limit_speeds(&mut self, begun: &[ChangeId], now: f64) {
        let limits = begun.iter().filter_map(|&change| Some((change, self.world.limit(change)?.1)));
        let limits: Vec<(ChangeId, f64)> = limits.collect();
        // Before the speeds change: the edges that each limit slows, and the robots that have them ahead.
        let slowed: Vec<(ChangeId, f64, Vec<usize>)> = limits
            .into_iter()
            .map(|(change, speed)| {
                let is_faster = |atom: &usize| self.site.atoms[*atom].speed > speed;
                (change, speed, self.limited_atoms(change).into_iter().filter(is_faster).collect())
            })
            .collect();
        self.set_speeds(now);
        for (change, speed, atoms) in slowed {
            for robot in 0..self.robots.len() {
                let Some(is_through) = self.comes_too_fast(robot, &atoms, speed) else { continue };
                if !is_through {
                    self.review(robot, now);
                }
                let effect = match self.comes_too_fast(robot, &atoms, speed) {
                    None => ChangeEffect::Rerouted,
                    Some(_) => ChangeEffect::Slowed,
                };
                let through = is_through.then_some((robot, ChangeEffect::Through));
                self.world.record(change).effects.extend(through.into_iter().chain([(robot, effect)]));
            }
        }
    }

    /// The edges that a change limits.
    fn limited_atoms(&self, change: ChangeId) -> Vec<usize> {
        let Some((element, _)) = self.world.limit(change) else { return Vec::new() };
        let is_in = |atom: &usize| self.site.atoms[*atom].edge.is_some_and(|edge| self.world.has_edge(element, edge));
        (0..self.site.edges).filter(is_in).collect()
    }

    /// Whether a robot is on some atoms of its route, or too near to brake before them; `None` if none of them is ahead.
    fn comes_too_fast(&self, robot: usize, atoms: &[usize], speed: f64) -> Option<bool> {
        let it = &self.robots[robot];
        let ahead = (0..it.way.atoms.len()).filter(|&k| it.way.offsets[k + 1] > it.at);
        let first = ahead.into_iter().find(|&k| atoms.contains(&it.way.atoms[k]))?;
        let left = (it.way.offsets[first] - it.at).max(0.0);
        Some(it.speed > speed && it.abilities.braking(it.speed) - it.abilities.braking(speed) > left)
    }

    /// Sets the speeds on all edges, and what depends on them.
    fn set_speeds(&mut self, now: f64) {
        let mut speeds = self.world.usual_speeds.clone();
        for &change in &self.world.present {
            let Some((_, speed)) = self.world.limit(change) else { continue };
            self.limited_atoms(change).into_iter().for_each(|atom| speeds[atom] = speeds[atom].min(speed));
        }
        for (atom, speed) in self.site.atoms.iter_mut().zip(speeds) {
            atom.speed = speed;
        }
        self.network.retime(&self.site);
        let slower: Vec<usize> =
            (0..self.robots.len()).filter(|&robot| self.robots[robot].way.retime(&self.site)).collect();
        for robot in slower {
            self.book.retime(robot, &self.robots);
        }
        // Decisions in a large fleet rely on the times of the ways as they are.
        if self.is_large()
            && let Ok(forecast) = self.scene(now).base()
        {
            self.timetable.change(forecast.robots.into_iter().zip(forecast.lines).collect());
        }
    }
}

//! Locks on edges: a robot holds the edges that it is on. It gets the next edge if no other robot holds an edge on
//! which they would touch, and if all could then still finish one after the other (the banker's check, Dijkstra 1965).
//! Locks on edges with deadlock avoidance do the same. No robot's end is on the way of another one, so the order in
//! which robots finish does not matter.

use super::robot::{LifelongRobot, SHORT};
use super::route::Route;
use super::route_graph::RouteGraph;

/// For each robot the number of atoms of its way that it has been given.
#[derive(Clone, Debug, Default)]
pub(super) struct RouteReservations(Vec<usize>);

/// The atoms that a robot holds, and those that it still needs.
struct ElementReservation<'w> {
    held: Vec<usize>,
    left: &'w [usize],
    end: usize,
}

/// For each atom the number of held atoms that it touches.
struct ReservationCounts<'s> {
    site: &'s RouteGraph,
    counts: Vec<usize>,
}

impl ReservationCounts<'_> {
    fn change(&mut self, held: &[usize], by: impl Fn(usize) -> usize) {
        for &atom in held {
            self.site.contacts(atom).for_each(|(near, _)| self.counts[near] = by(self.counts[near]));
        }
    }

    /// Whether no other robot holds an atom that touches this one; `own` are the atoms of the robot itself.
    fn is_free(&self, atom: usize, own: &[usize]) -> bool {
        self.counts[atom] == own.iter().filter(|&&held| self.site.touch(held, atom)).count()
    }
}

impl RouteReservations {
    /// The locks of robots that stand.
    pub(super) fn new(robots: usize) -> Self {
        Self(vec![0; robots])
    }

    /// Exchanges the way of a robot, which held this number of atoms of it before.
    pub(super) fn exchange(&mut self, robot: usize, atoms: usize) {
        self.0[robot] = atoms;
    }

    /// Gives atoms to robots that would otherwise have to brake, the one that has stood longest first.
    pub(super) fn give(&mut self, site: &RouteGraph, robots: &[LifelongRobot], far: impl Fn(usize) -> f64) {
        let mut order: Vec<usize> = (0..robots.len()).collect();
        order.sort_by(|&a, &b| robots[a].still_since.total_cmp(&robots[b].still_since));
        for robot in order {
            let way = &robots[robot].way;
            let needs = |given: usize| given < way.atoms.len() && way.offsets[given] <= far(robot);
            while !robots[robot].has_arrived() && needs(self.0[robot]) {
                self.0[robot] += 1;
                if !self.is_safe(site, robots, None) {
                    self.0[robot] -= 1;
                    break;
                }
            }
        }
    }

    /// Length up to which a robot may go: the end of what it holds.
    pub(super) fn reserved_length(&self, robot: usize, way: &Route) -> f64 {
        match self.0[robot] {
            given if given < way.atoms.len() => way.offsets[given] + SHORT,
            _ => f64::INFINITY,
        }
    }

    /// Whether no robot holds an atom that touches an atom held by another one, and all can finish. `other` exchanges the way
    /// of one robot: index, way, length, and number of atoms it holds of it.
    pub(super) fn is_safe(
        &self,
        site: &RouteGraph,
        robots: &[LifelongRobot],
        other: Option<(usize, &Route, f64, usize)>,
    ) -> bool {
        let claim = |robot: usize| {
            let it = &robots[robot];
            match other {
                Some((changed, way, at, given)) if changed == robot => ElementReservation::new(way, at, given, false),
                _ => ElementReservation::new(&it.way, it.at, self.0[robot], it.has_arrived()),
            }
        };
        let claims: Vec<ElementReservation> = (0..robots.len()).map(claim).collect();
        let mut all = ReservationCounts { site, counts: vec![0; site.atoms.len()] };
        claims.iter().for_each(|claim| all.change(&claim.held, |count| count + 1));
        if claims.iter().any(|claim| claim.held.iter().any(|&atom| !all.is_free(atom, &claim.held))) {
            return false;
        }
        let mut left: Vec<&ElementReservation> = claims.iter().collect();
        loop {
            let before = left.len();
            left.retain(|claim| {
                let finishes = claim.left.iter().all(|&atom| all.is_free(atom, &claim.held));
                if finishes {
                    all.change(&claim.held, |count| count - 1);
                    all.change(&[claim.end], |count| count + 1);
                }
                !finishes
            });
            if left.is_empty() || left.len() == before {
                return left.is_empty();
            }
        }
    }
}

impl<'w> ElementReservation<'w> {
    fn new(way: &'w Route, at: f64, given: usize, arrived: bool) -> Self {
        let end = way.poses[1];
        // At the end of what it holds, rounding may have put it beyond.
        let first = way.atom(at - SHORT);
        let held = match (arrived, given) {
            (true, _) => vec![end],
            (false, 0) => vec![way.poses[0]],
            (false, _) => way.atoms[first..given.max(first + 1)].to_vec(),
        };
        Self { held, left: if arrived { &[] } else { &way.atoms[given..] }, end }
    }
}

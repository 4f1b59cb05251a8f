//! Traffic by locks on edges, for comparison: a robot takes one atom after the other, with all that it touches, if a banker's
//! check finds that everybody could still finish. What VDA 5050 and mutexes on lanes come to.

use super::robot::Robot;
use super::site::Site;

/// How many atoms of its way each robot has been given.
#[derive(Clone, Debug)]
pub(super) struct EdgeLocks {
    granted: Vec<usize>,
}

impl EdgeLocks {
    pub(super) fn new(robots: usize) -> Self {
        Self { granted: vec![1; robots] }
    }

    /// A robot has another way, of which it cannot leave so many atoms any more.
    pub(super) fn exchanged(&mut self, robot: usize, kept: usize) {
        self.granted[robot] = kept;
    }

    /// Gives robots that come near the end of what they have another atom; returns how far each may go \[m\].
    pub(super) fn holds(&mut self, site: &Site, robots: &[Robot], ahead: impl Fn(usize) -> f64) -> Vec<f64> {
        for robot in 0..robots.len() {
            let way = &robots[robot].way;
            loop {
                let next = self.granted[robot];
                let near = next < way.atoms.len() && way.offsets[next] < ahead(robot);
                if !near || !self.is_free(site, robots, robot, way.atoms[next]) {
                    break;
                }
                self.granted[robot] = next + 1;
                if !self.is_safe(site, robots) {
                    self.granted[robot] = next;
                    break;
                }
            }
        }
        robots.iter().zip(&self.granted).map(|(robot, &granted)| robot.way.offsets[granted]).collect()
    }

    /// The atoms that a robot has: from where it is on, or the node where it stands.
    fn held(&self, site: &Site, robot: usize, robots: &[Robot]) -> Vec<usize> {
        let it = &robots[robot];
        let granted = self.granted[robot];
        if it.at >= it.way.length() && it.speed == 0.0 {
            return vec![site.standing(it.way.end())];
        }
        if granted == 0 {
            return vec![site.standing(site.atoms[it.way.atoms[0]].ends[0])];
        }
        let first = it.way.atom(it.at);
        it.way.atoms[first..granted.max(first + 1)].to_vec()
    }

    fn is_free(&self, site: &Site, robots: &[Robot], robot: usize, atom: usize) -> bool {
        let others = (0..robots.len()).filter(|&other| other != robot);
        others.into_iter().all(|other| self.held(site, other, robots).iter().all(|&held| !site.touch(held, atom)))
    }

    /// Whether there is an order in which everybody can take all the rest of its way.
    fn is_safe(&self, site: &Site, robots: &[Robot]) -> bool {
        let mut held: Vec<Vec<usize>> = (0..robots.len()).map(|robot| self.held(site, robot, robots)).collect();
        let mut left: Vec<usize> = (0..robots.len()).collect();
        loop {
            let before = left.len();
            left.retain(|&robot| {
                let way = &robots[robot].way;
                let rest = &way.atoms[self.granted[robot].saturating_sub(1)..];
                let others = (0..robots.len()).filter(|&other| other != robot);
                let free = others
                    .into_iter()
                    .all(|other| held[other].iter().all(|&held| rest.iter().all(|&atom| !site.touch(held, atom))));
                if free {
                    held[robot] = vec![site.standing(way.end())];
                }
                !free
            });
            if left.is_empty() || left.len() == before {
                return left.is_empty();
            }
        }
    }
}

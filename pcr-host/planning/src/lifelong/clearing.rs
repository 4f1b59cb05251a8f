//! Robots in the way of a mission: who stands there, and where they may go; and places that cut off few others, where there are more
//! robots than safe ends.

use super::dispatch::Admitted;
use super::scene::{Scene, TOLLS};

impl Scene<'_> {
    /// The route that a robot would take if those who stand on it went away.
    pub(super) fn wanted(&self, robot: usize, goal: usize) -> Option<Vec<usize>> {
        let from = self.kept(robot);
        let mut route = self.routes(robot, &from, [20.0, 0.0], |node| node == goal, Some(goal), 1).pop()?;
        route.push(self.site.standing(goal));
        Some(route)
    }

    /// Who stands for good on a route of a robot, the first one first.
    pub(super) fn standing_on(&self, robot: usize, route: &[usize]) -> Vec<usize> {
        let mut found = Vec::new();
        for &atom in route.iter().filter(|&&atom| self.parked[atom] > 0) {
            for (other, it) in self.robots.iter().enumerate() {
                if other != robot && !found.contains(&other) && self.site.passes(atom, it.way.end()) {
                    found.push(other);
                }
            }
        }
        found
    }

    /// Finds a way for a robot to where it is on none of some routes.
    ///
    /// # Errors
    /// The route that it would take if nobody stood on it, if there is any.
    pub(super) fn make_way(&self, robot: usize, routes: &[Vec<usize>]) -> Result<Admitted, Option<Vec<usize>>> {
        /// Nearest places that are tried.
        const PLACES: usize = 6;
        let kept = self.kept(robot);
        let here = self.robots[robot].way.end();
        let clear = |node: usize| {
            node != here
                && self.is_free(robot, node)
                && !routes.iter().flatten().any(|&atom| self.site.passes(atom, node))
        };
        let ends = self.routes(robot, &kept, TOLLS[0], |node| clear(node) && self.ends[node], None, PLACES);
        let found = if ends.is_empty() {
            let good = self.harmless(robot, clear);
            self.routes(robot, &kept, TOLLS[0], |node| good.contains(&node), None, PLACES)
        } else {
            ends
        };
        if let Some(admitted) =
            self.admitted(robot, &kept, found.into_iter().map(|route| (route, Vec::new())).collect())
        {
            return Ok(admitted);
        }
        Err(self.routes(robot, &kept, [20.0, 0.0], clear, None, 1).pop())
    }
}

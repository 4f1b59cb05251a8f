//! Finds the robots in the way of a mission, and where they may go. Also finds places that cut off few other places, if
//! there are more robots than safe ends.

use super::planning_context::{PlanningContext, TOLLS};
use super::route_admission::AdmittedRoute;

impl PlanningContext<'_> {
    /// The route that a robot would take if the robots that stand on it went away.
    pub(super) fn wanted(&self, robot: usize, goal: usize) -> Option<Vec<usize>> {
        let from = self.kept(robot);
        let mut route = self.routes(robot, &from, [20.0, 0.0], |node| node == goal, Some(goal), 1).pop()?;
        route.push(self.site.standing(goal));
        Some(route)
    }

    /// Robots that stand for good on a route of a robot, in the order of the route.
    pub(super) fn standing_on(&self, robot: usize, route: &[usize]) -> Vec<usize> {
        let mut found = Vec::new();
        for &atom in route.iter().filter(|&&atom| self.parked[atom] > 0) {
            for (other, it) in self.robots.iter().enumerate() {
                if other != robot && !found.contains(&other) && it.ends_on(self.site, atom) {
                    found.push(other);
                }
            }
        }
        found
    }

    /// For a robot that cuts off nodes where it stands: a way to a place where it cuts off fewer.
    pub(super) fn tidied(&self, robot: usize) -> Option<AdmittedRoute> {
        /// Number of nearest places that are tried.
        const PLACES: usize = 3;
        let kept = self.kept(robot);
        let own = self.burden(self.robots[robot].way.end(), &[]);
        let mut found = self.aside(robot, kept.end_pose, TOLLS[0], |_| true, PLACES);
        found.retain(|route| self.burden(kept.end_pose.node, route) < own);
        self.admitted(robot, &kept, found.into_iter().map(|route| (route, Vec::new())).collect())
    }

    /// Whether a robot stands on a route that is reserved for another one.
    pub(super) fn is_on_reserved(&self, robot: usize) -> bool {
        self.is_reserved(robot, self.robots[robot].way.end())
    }

    /// Finds a way for a robot to a place that is on no reserved route.
    ///
    /// # Errors
    /// The route that it would take if no robot stood on it, if there is one.
    pub(super) fn make_way(&self, robot: usize) -> Result<AdmittedRoute, Option<Vec<usize>>> {
        /// Number of nearest places that are tried.
        const PLACES: usize = 6;
        let kept = self.kept(robot);
        let here = self.robots[robot].way.end();
        let clear = |node: usize| node != here && self.is_free(robot, node);
        let safe = |node: usize| !self.crowded && clear(node) && self.ends.is_safe[node];
        let mut found = self.routes(robot, &kept, TOLLS[0], safe, None, PLACES);
        if found.is_empty() {
            found = self.aside(robot, kept.end_pose, TOLLS[0], clear, PLACES);
        }
        let admitted = self.admitted(robot, &kept, found.into_iter().map(|route| (route, Vec::new())).collect());
        admitted.ok_or_else(|| self.aside(robot, kept.end_pose, [20.0, 0.0], clear, 1).pop())
    }
}

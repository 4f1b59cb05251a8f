//! The data for a decision: the present fleet, and routes through it.

use super::CoordinationMethod;
use super::endpoints::Endpoints;
use super::forecast::{DeadlockedRobot, Forecast, ForecastInput};
use super::region_table::RegionTable;
use super::region_waits::FleetWaits;
use super::reservations::RouteReservations;
use super::robot::LifelongRobot;
use super::route::CommittedRoute;
use super::route_finder::RouteFinder;
use super::route_graph::{DeparturePose, RouteGraph};
use super::timetable::Timetable;

/// Extra cost of a route past a robot that stands for good, and for each oncoming robot \[s\]. Routes are searched with each pair in turn.
pub(super) const TOLLS: [[f64; 2]; 4] =
    [[f64::INFINITY, 0.0], [f64::INFINITY, 4.0], [f64::INFINITY, 15.0], [20.0, 4.0]];

/// Cost of a robot that stands for good where it cuts off nodes, per node \[s\]: about the wait of one other robot, or more than any route
/// where this must not be.
const HARM: [f64; 2] = [10.0, 1e6];

/// The input of a decision: the site, the robots and their orders.
#[derive(Clone, Copy)]
pub(super) struct PlanningContext<'s> {
    pub(super) site: &'s RouteGraph,
    pub(super) robots: &'s [LifelongRobot],
    pub(super) book: &'s RegionTable,
    pub(super) locks: &'s RouteReservations,
    pub(super) network: &'s RouteFinder,
    /// Nodes where robots may stand for good.
    pub(super) ends: &'s Endpoints,
    /// Whether there are more robots than safe ends, or as many and additional queue places where robots can make way for one
    /// another.
    pub(super) crowded: bool,
    /// Whether only the mission that has waited longest is served.
    pub(super) is_urgent: bool,
    /// Reserved routes as (robot, route): first that of the mission that has waited longest, then those of robots in its way.
    pub(super) reserved: &'s [(usize, Vec<usize>)],
    /// For each atom how many robots stand for good in its way.
    pub(super) parked: &'s [u16],
    /// Whether robots may stay at their goals if there is no end for them.
    pub(super) stays: bool,
    /// For each atom by how many closures it is closed.
    pub(super) closed: &'s [u16],
    pub(super) time: f64,
    /// In a large fleet: the times that the other robots keep while a decision about one is made.
    pub(super) timetable: Option<&'s Timetable>,
    pub(super) method: CoordinationMethod,
}

impl PlanningContext<'_> {
    /// The forecast for all robots with their present ways and orders.
    pub(super) fn base(&self) -> Result<Forecast, Vec<DeadlockedRobot>> {
        let PlanningContext { robots, time, .. } = *self;
        let waits = &FleetWaits::of(robots, self.book);
        let earlier = self.earlier();
        ForecastInput { robots, waits, time, changed: None, earlier, kept: None }.forecast()
    }

    /// Weight of the goals of a way before the last one. A robot that knows two goals is not twice as important as one that knows one,
    /// because each gets mission after mission. Where robots have no room to stand, robots near a goal go first all the same.
    pub(super) fn earlier(&self) -> f64 {
        /// A compromise: on the warehouse graph with 10 robots, 0.3 gives more missions than 0 or 1.
        const SOME: f64 = 0.3;
        if self.has_room() { SOME } else { 1.0 }
    }

    /// Whether each robot has a safe end and decisions look at all robots.
    fn has_room(&self) -> bool {
        !self.crowded && self.timetable.is_none()
    }

    /// Time before the goal at which the way for the next mission is searched \[s\].
    pub(super) fn ahead(&self) -> f64 {
        /// With and without room: in a crowd a robot that reserves a longer way is more in the way of others.
        const AHEAD: [f64; 2] = [25.0, 10.0];
        AHEAD[usize::from(!self.has_room())]
    }

    pub(super) fn kept(&self, robot: usize) -> CommittedRoute {
        let it = &self.robots[robot];
        it.way.committed_part(self.site, it.at, it.stop(), it.turned)
    }

    /// Whether no other robot stands for good where a robot at the node would touch it, and the node is on no route reserved
    /// for others.
    pub(super) fn is_free(&self, robot: usize, node: usize) -> bool {
        let it = &self.robots[robot];
        let own = match &it.cut {
            Some(cut) => cut.contains(&self.site.standing(node)),
            None => self.site.collide(it.way.end(), node),
        };
        let count = usize::from(self.parked[self.site.standing(node)]);
        count <= usize::from(own) && !self.is_reserved(robot, node)
    }

    /// Whether a robot that stands at a node is on a route that is reserved for another one.
    pub(super) fn is_reserved(&self, robot: usize, node: usize) -> bool {
        let mut others = self.reserved.iter().filter(|route| route.0 != robot);
        others.any(|(_, route)| route.iter().any(|&atom| self.site.passes(atom, node)))
    }

    /// Routes on from the place where a robot can leave its way.
    pub(super) fn routes(
        &self,
        robot: usize,
        kept: &CommittedRoute,
        [standing, coming]: [f64; 2],
        asked: impl Fn(usize) -> bool,
        towards: Option<usize>,
        count: usize,
    ) -> Vec<Vec<usize>> {
        self.onward(robot, kept.end_pose, [standing, coming], asked, towards, count)
    }

    pub(super) fn onward(
        &self,
        robot: usize,
        from: DeparturePose,
        [standing, coming]: [f64; 2],
        asked: impl Fn(usize) -> bool,
        towards: Option<usize>,
        count: usize,
    ) -> Vec<Vec<usize>> {
        let own = self.robots[robot].end_covers(self.site);
        let toll = |atom: usize| {
            if self.closed[atom] > 0 {
                return f64::INFINITY;
            }
            let mut parked = self.parked[atom];
            if parked > 0 && own.contains(&atom) {
                parked -= 1;
            }
            let mut toll = if parked > 0 { standing * f64::from(parked) } else { 0.0 };
            if coming > 0.0
                && let Some(back) = self.site.back[atom]
            {
                toll += coming * self.book.others_on(back, robot, self.robots).count() as f64;
            }
            toll
        };
        self.network.quickest(self.site, from, toll, asked, towards, count)
    }

    /// Routes to places where a robot may stand for good if there is no safe end for it: near places where it cuts off few
    /// others.
    pub(super) fn aside(
        &self,
        robot: usize,
        from: DeparturePose,
        tolls: [f64; 2],
        asked: impl Fn(usize) -> bool,
        count: usize,
    ) -> Vec<Vec<usize>> {
        let harm = self.ends.harm(self.site);
        let free = |node: usize| self.is_free(robot, node);
        let asked = |node: usize| harm[node] < usize::MAX && asked(node) && free(node) && self.ends.is_next(node, free);
        let found = self.onward(robot, from, tolls, asked, None, usize::MAX);
        let mut found: Vec<(f64, Vec<usize>)> =
            found.into_iter().map(|route| (self.burden(from.node, &route), route)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(count);
        found.into_iter().map(|found| found.1).collect()
    }

    /// Time of a route, plus the cost for others of a robot that stands at its end \[s\].
    pub(super) fn burden(&self, from: usize, route: &[usize]) -> f64 {
        let end = route.last().map_or(from, |&last| self.site.atoms[last].ends[1]);
        let time: f64 = route.iter().map(|&atom| self.site.atoms[atom].length / self.site.atoms[atom].speed).sum();
        let each = if self.is_urgent || !self.crowded { HARM[1] } else { HARM[0] };
        time + each * self.ends.harm(self.site)[end] as f64
    }
}

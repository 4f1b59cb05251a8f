//! Areas in which the speed is limited: the edges that a vehicle has not been released yet get a lower speed. A base cannot be changed, so the
//! manager is told of the edges that the vehicle has already with a higher one.

use super::VehicleAdapter;
use super::job::ActiveOrder;
use crate::closed_area::SpeedLimit;
use crate::owned_path::OwnedPath;
use crate::robot::SupervisedRobot;
use crate::supervisor::Supervisor;
use pcr_formats::vda5050::order::OrderEdge;
use pcr_formats::vda5050::state::{ErrorEntry, State};

impl VehicleAdapter {
    /// Takes the limits that hold now. The manager is told at once of what cannot be changed any more.
    pub(crate) fn follow_limits(&mut self, supervisor: &Supervisor) {
        let (Some(job), Ok(robot)) = (&mut self.job, supervisor.robot(&self.name)) else { return };
        if job.follow_limits(supervisor, robot) {
            self.mirror();
        }
    }

    /// Errors for the edges that the vehicle has with a higher speed than is allowed there now.
    pub(super) fn limit_errors(&self, state: &State) -> Vec<ErrorEntry> {
        let Some(job) = self.job.as_ref().filter(|job| job.order.order_id == state.order_id) else { return Vec::new() };
        let error = |(limit, edge): (&SpeedLimit, &OrderEdge)| {
            let SpeedLimit { closure, speed, .. } = limit;
            let why = format!(
                "edge {} was released before {closure} limited the speed there to {speed} m/s; the vehicle may be faster on it",
                edge.edge_id
            );
            ErrorEntry::warning("speedLimit", why, &[("closure", closure), ("edgeId", &edge.edge_id)])
        };
        job.unslowed(state, self.profile.abilities.speed).into_iter().map(error).collect()
    }
}

impl ActiveOrder {
    /// Computes where on its way the speed is limited, if that may have changed. Returns whether it has.
    fn follow_limits(&mut self, supervisor: &Supervisor, robot: &SupervisedRobot) -> bool {
        if !supervisor.limits_speed() && self.limits.is_empty() {
            return false;
        }
        // An update may replace the horizon by another one of the same length, and what is passed may be left out.
        let key = (supervisor.closure_revision(), self.order.update_id, self.path.length().to_bits());
        if self.limits_at == Some(key) {
            return false;
        }
        self.limits_at = Some(key);
        let shapes = self.path.shapes(None, self.order.nodes.len()).to_vec();
        let limits = match OwnedPath::new(self.path.start(), shapes) {
            Ok(course) => supervisor.speed_limits(&robot.name, &course, &robot.body),
            // The supervisor has admitted no such path, and nothing of it is released.
            Err(_) => Vec::new(),
        };
        let is_other = limits != self.limits;
        self.limits = limits;
        // The horizon is sent again.
        self.changed |= is_other && (self.last().between || self.last().node + 1 < self.order.nodes.len());
        is_other
    }

    /// The least limit of the speed between two lengths of its way \[m, m/s\].
    pub(super) fn limit_between(&self, from: f64, to: f64) -> Option<f64> {
        let limits = self.limits.iter().filter(|limit| limit.length[0] < to && limit.length[1] > from);
        limits.map(|limit| limit.speed).reduce(f64::min)
    }

    /// The edges ahead that the vehicle has, each with the limit which it does not know.
    fn unslowed(&self, state: &State, fastest: f64) -> Vec<(&SpeedLimit, &OrderEdge)> {
        let place = self.passed(state).unwrap_or(0);
        let mut found: Vec<(&SpeedLimit, &OrderEdge)> = Vec::new();
        for pair in self.stops.get(place..).unwrap_or_default().windows(2) {
            let Some(edge) = self.order.edges.get(pair[0].node) else { continue };
            let known = [pair[1].speed, edge.max_speed()].into_iter().flatten().fold(fastest, f64::min);
            let is_unknown = |limit: &&SpeedLimit| {
                limit.length[0] < pair[1].length && limit.length[1] > pair[0].length && limit.speed < known
            };
            for limit in self.limits.iter().filter(is_unknown) {
                if !found.iter().any(|it| it.0.closure == limit.closure && it.1.edge_id == edge.edge_id) {
                    found.push((limit, edge));
                }
            }
        }
        found
    }
}

//! Missions that no vehicle can do because others are in its way for ever: given up before anything moves.

use super::own_missions::{MissionOutcome, OwnMissions};
use super::passing_cells::PassingCells;
use super::passing_search::{PassingAnswer, PassingRobot, PassingSearch};
use super::run_state::LifelongState;
use std::collections::HashMap;

/// A search for a route of one vehicle counts as this many looks at pairs.
const ROUTE: usize = 200;

impl LifelongState {
    /// Gives up the missions for which every vehicle would have to pass others where nobody can pass, while all stand at nodes; other
    /// missions are not given to vehicles that would have to.
    pub(super) fn refuse_without_passing(&mut self) {
        let Some(own) = &self.own else { return };
        let cells = PassingCells::new(&self.site);
        let mut search = PassingSearch::new(cells, &self.network, self.world.changes.is_empty());
        let mut known: HashMap<(usize, &[usize]), Option<String>> = HashMap::new();
        let (mut refused, mut unable) = (Vec::new(), Vec::new());
        for (place, mission) in own.missions.iter().enumerate() {
            if mission.outcome != MissionOutcome::Open {
                continue;
            }
            let vehicles = match mission.request.vehicle {
                Some(vehicle) => vehicle..vehicle + 1,
                None => 0..self.robots.len(),
            };
            let stops = &mission.request.stops[..];
            let reasons: Vec<Option<String>> = vehicles
                .clone()
                .map(|vehicle| {
                    let why = known.entry((vehicle, stops));
                    let find = || match self.why_not(own, vehicle, stops) {
                        Some(impossible) => Some(impossible.why),
                        None => self.why_not_past_others(own, &mut search, vehicle, stops),
                    };
                    why.or_insert_with(find).clone()
                })
                .collect();
            unable.push((place, vehicles.zip(&reasons).filter(|it| it.1.is_some()).map(|it| it.0).collect::<Vec<_>>()));
            let all: Option<Vec<String>> = reasons.into_iter().collect();
            refused.extend(all.map(|reasons| (place, reasons.join("; "))));
        }
        if let Some(own) = &mut self.own {
            unable.into_iter().for_each(|(mission, vehicles)| own.missions[mission].unable = vehicles);
        }
        refused.into_iter().for_each(|(mission, why)| self.drop_mission(mission, why));
    }

    /// Why a vehicle cannot come to stops past others that can drive as they like; `None` if it can, or if that takes too long to find
    /// out.
    fn why_not_past_others(
        &self,
        own: &OwnMissions,
        search: &mut PassingSearch<'_>,
        vehicle: usize,
        stops: &[usize],
    ) -> Option<String> {
        let blocked = |robot: usize, others: &[usize]| {
            let mut blocked = self.blocked_for_ever(own, robot);
            let covers = others.iter().flat_map(|&other| self.end_covers(other).to_vec());
            covers.for_each(|atom| blocked[atom] = true);
            blocked
        };
        let mut outside: Vec<usize> = (0..self.robots.len()).filter(|&other| other != vehicle).collect();
        // Mostly it comes there while all others stay where they are.
        search.left = search.left.saturating_sub(ROUTE);
        if search.left == 0 || self.reaches(vehicle, stops, &blocked(vehicle, &outside)) {
            return None;
        }
        let member =
            |robot: usize| PassingRobot { robot, start: self.robots[robot].way.end(), blocked: blocked(robot, &[]) };
        let nodes: Vec<usize> = stops.iter().map(|&stop| self.node_of_layer(vehicle, stop)).collect();
        let mut group = vec![member(vehicle)];
        loop {
            let mut avoided = vec![false; self.site.atoms.len()];
            outside.iter().for_each(|&robot| self.end_covers(robot).iter().for_each(|&atom| avoided[atom] = true));
            match search.answer(&group, &nodes, &avoided) {
                PassingAnswer::Open => return None,
                PassingAnswer::Possible(edges) => {
                    let stands = |&robot: &usize| self.end_covers(robot).iter().any(|atom| edges.contains(atom));
                    let next = outside.iter().position(stands)?;
                    group.push(member(outside.remove(next)));
                }
                PassingAnswer::Impossible { stop } => {
                    let at = |it: &PassingRobot| {
                        let id = &own.fleet.vehicles[it.robot].id;
                        format!("{id} (at node {})", self.name_of(it.start % self.site.places()))
                    };
                    let names: Vec<String> = group.iter().map(at).collect();
                    // That it can come there alone has been found out before.
                    let (first, others) = names.split_first().filter(|(_, others)| !others.is_empty())?;
                    return Some(format!(
                        "vehicle {first}: {} cannot make way for it to node {} and drive on again",
                        others.join(", "),
                        self.name_of(stops[stop])
                    ));
                }
            }
        }
    }
}

//! The conflicts of a fleet sorted by time, and updated when motions change. A search over plans resolves them one
//! after the other.

use pcr_core::{Conflict, Encounter, Motion};
use std::collections::{BTreeMap, BTreeSet};

/// The first conflict of each pair of agents that is more than a touch.
///
/// ```
/// use pcr_core::{Motion, Path, Point, Pose, Profile, Radians};
/// use pcr_planning::conflict_queue::ConflictQueue;
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let mut fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
///
/// let mut queue = ConflictQueue::new(&fleet);
/// assert_eq!(queue.first().map(|(agents, _)| agents), Some([0, 1]));
/// fleet[1] = fleet[1].delayed(1.0)?;
/// queue.update(&fleet, 1);
/// assert!(queue.first().is_none());
/// # Ok::<(), pcr_core::InvalidInput>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ConflictQueue {
    /// By the pair, the lower place first.
    conflicts: BTreeMap<[usize; 2], Conflict<f64>>,
    /// By the time at which they begin.
    times: BTreeSet<(i64, [usize; 2])>,
}

impl ConflictQueue {
    /// The queue of a fleet. For each pair it costs as much as [`Encounter::conflicts`].
    pub fn new(fleet: &[Motion<'_, f64>]) -> Self {
        let mut queue = Self::default();
        for other in 0..fleet.len() {
            (0..other).for_each(|agent| queue.update_pair(fleet, [agent, other]));
        }
        queue
    }

    /// Looks at the pairs of one agent anew, whose motion is another one now, or that is new. O(agents).
    pub fn update(&mut self, fleet: &[Motion<'_, f64>], agent: usize) {
        for other in (0..fleet.len()).filter(|&other| other != agent) {
            self.update_pair(fleet, [agent.min(other), agent.max(other)]);
        }
    }

    fn update_pair(&mut self, fleet: &[Motion<'_, f64>], pair: [usize; 2]) {
        if let Some(old) = self.conflicts.remove(&pair) {
            self.times.remove(&(sortable(old.time.lo), pair));
        }
        let [Some(first), Some(second)] = pair.map(|agent| fleet.get(agent)) else { return };
        let encounter = Encounter::new(first, second);
        if let Some(conflict) = encounter.conflicts(encounter.time()).find(|conflict| !conflict.touching) {
            self.times.insert((sortable(conflict.time.lo), pair));
            self.conflicts.insert(pair, conflict);
        }
    }

    /// The pair whose conflict begins first, and that conflict as the first of the two sees it; of several the one of the lowest places.
    pub fn first(&self) -> Option<([usize; 2], Conflict<f64>)> {
        let (_, pair) = self.times.first()?;
        Some((*pair, *self.conflicts.get(pair)?))
    }

    /// All of them, in the order of the pairs.
    pub fn all(&self) -> impl Iterator<Item = ([usize; 2], Conflict<f64>)> {
        self.conflicts.iter().map(|(pair, conflict)| (*pair, *conflict))
    }

    /// How many pairs have conflicts.
    pub fn len(&self) -> usize {
        self.conflicts.len()
    }

    /// Whether no pair has any.
    pub fn is_empty(&self) -> bool {
        self.conflicts.is_empty()
    }
}

/// A number in the order of times.
fn sortable(time: f64) -> i64 {
    let bits = time.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::Fleet;
    use pcr_formats::scenario::Scenario;

    #[test]
    fn it_is_that_of_the_fleet_as_it_is_now() {
        let scenario = Scenario::from_json(pcr_formats::paper_example::SCENARIO).expect("a scenario");
        let fleet = Fleet::<f64>::new(&scenario).expect("a fleet");
        let mut motions = fleet.motions();
        let mut queue = ConflictQueue::new(&motions);
        let told = |queue: &ConflictQueue| queue.all().collect::<Vec<_>>();
        assert!(!queue.is_empty());
        for (round, agent) in [0, 7, 3, 3, 11, 5].into_iter().enumerate() {
            motions[agent] = motions[agent].delayed(1.5 * (round as f64 + 1.0)).expect("a delay");
            queue.update(&motions, agent);
            let anew = ConflictQueue::new(&motions);
            assert_eq!(told(&queue), told(&anew));
            let first = anew.all().map(|(_, conflict)| conflict.time.lo).fold(f64::INFINITY, f64::min);
            assert_eq!(queue.first().map(|(_, conflict)| conflict.time.lo), Some(first));
            assert_eq!(queue.len(), queue.times.len());
        }
    }

    #[test]
    fn times_are_in_order() {
        let times = [f64::NEG_INFINITY, -2.0, -1e-300, 0.0, 1e-300, 3.0, f64::INFINITY];
        assert!(times.windows(2).all(|pair| sortable(pair[0]) < sortable(pair[1])));
    }
}

//! A layout with vehicles that stand at some of its nodes, and a manager that sends them from one to another.

use super::drive::Abilities;
use super::manager::Manager;
use super::vehicle::Vehicle;
use crate::course::Start;
use crate::robot;
use crate::vda5050::lane::Profile;
use crate::vda5050::topics::Key;
use crate::vda5050::version::Version;
use crate::vda5050::way::TOLERANCE;
use pcr_formats::import::Layout;

/// What they call the map.
const MAP: &str = "map";

/// Who has made the vehicles.
const MANUFACTURER: &str = "sim";

/// All of it.
#[derive(Debug)]
pub struct World {
    /// What the supervisor is told of the vehicles.
    pub profiles: Vec<Profile>,
    /// They themselves.
    pub vehicles: Vec<Vehicle>,
    /// Who gives them missions.
    pub manager: Manager,
}

impl World {
    /// So many vehicles of these editions and abilities in turn, at the first of the goals.
    ///
    /// # Errors
    /// Too few goals, or some that are on the ways of others.
    pub fn new(
        layout: Layout,
        goals: Vec<usize>,
        count: usize,
        versions: &[Version],
        abilities: &[Abilities],
        seed: u64,
    ) -> Result<Self, String> {
        if count >= goals.len() {
            return Err(format!("{count} vehicles need {} places to stand at; there are {}", count + 1, goals.len()));
        }
        let (mut profiles, mut vehicles, mut clients) = (Vec::new(), Vec::new(), Vec::new());
        let kinds = versions.iter().cycle().zip(abilities.iter().cycle());
        for ((k, (&version, &can)), &goal) in kinds.enumerate().take(count).zip(&goals) {
            let key = Key::new(MANUFACTURER, &format!("{:03}", k + 1))?;
            let [x, y] = layout.nodes.get(goal).map(|node| node.at).ok_or("a goal that is no node")?;
            let start = Start { x, y, heading: 0.0 };
            profiles.push(profile(key.clone(), &can));
            let seed = seed.wrapping_mul(1_000).wrapping_add(k as u64);
            vehicles.push(Vehicle::new(key.clone(), version, MAP, can, start, seed));
            clients.push((key, version, goal));
        }
        let clearance = 2.0 * profiles.iter().map(|profile| profile.abilities.reach()).fold(0.0, f64::max);
        let manager = Manager::new(layout, MAP, goals, clearance, clients, seed)?;
        Ok(Self { profiles, vehicles, manager })
    }
}

/// What the supervisor has to know of a vehicle.
pub fn profile(key: Key, can: &Abilities) -> Profile {
    // Off its way, off the place that it reports, and that as it reports it; and some for what it does between two steps.
    let margin = TOLERANCE + can.drift + 2.0 * can.noise + 0.01;
    let abilities = robot::Abilities { radius: can.radius, margin, speed: can.speed, acceleration: can.acceleration };
    Profile { key, abilities, split: true }
}

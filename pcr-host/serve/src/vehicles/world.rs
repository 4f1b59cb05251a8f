//! A layout with vehicles that stand at some of its nodes, and a manager that sends them from one to another.

use super::drive::Abilities;
use super::manager::Manager;
use super::vehicle::Vehicle;
use crate::course::Start;
use crate::robot;
use crate::vda5050::lane::Profile;
use crate::vda5050::way::TOLERANCE;
use pcr_formats::import::Layout;
use pcr_formats::vda5050::topics::Key;
use pcr_formats::vda5050::version::Version;

/// Map id.
const MAP: &str = "map";

/// Manufacturer of the vehicles.
const MANUFACTURER: &str = "sim";

/// A layout with vehicles and a manager.
#[derive(Debug)]
pub struct World {
    /// Configuration of the vehicles for the supervisor.
    pub profiles: Vec<Profile>,
    /// The vehicles.
    pub vehicles: Vec<Vehicle>,
    /// The manager that gives them missions.
    pub manager: Manager,
}

impl World {
    /// This number of vehicles, with these editions and abilities in turn, at the first of the goals.
    ///
    /// # Errors
    /// Too few goals, or goals on the ways to others.
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

/// The configuration of a vehicle for the supervisor.
pub fn profile(key: Key, can: &Abilities) -> Profile {
    // Distance from its way, error of its position counted twice (in what it reports and in its reported deviation), and an
    // allowance for motion between two steps.
    let margin = TOLERANCE + can.drift + 2.0 * can.noise + 0.01;
    let abilities = robot::Abilities { radius: can.radius, margin, speed: can.speed, acceleration: can.acceleration };
    Profile { key, abilities, split: true }
}

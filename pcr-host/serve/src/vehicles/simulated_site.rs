//! A layout with vehicles that stand at some of its nodes, and a manager that sends them from one to another.

use super::manager::FleetManager;
use super::vehicle::SimulatedVehicle;
use super::vehicle_motion::SimulatedTraits;
use crate::owned_path::StartPose;
use crate::robot;
use crate::setup_error::SetupError;
use crate::vda5050::order_path::TOLERANCE;
use crate::vda5050::vehicle_adapter::VehicleConfig;
use pcr_formats::footprint::Footprint;
use pcr_formats::import::Layout;
use pcr_formats::vda5050::topics::VehicleId;
use pcr_formats::vda5050::version::ProtocolVersion;

/// Map id.
const MAP: &str = "map";

/// Manufacturer of the vehicles.
const MANUFACTURER: &str = "sim";

/// A layout with vehicles and a manager.
#[derive(Debug)]
pub struct SimulatedSite {
    /// Configuration of the vehicles for the supervisor.
    pub profiles: Vec<VehicleConfig>,
    /// The vehicles.
    pub vehicles: Vec<SimulatedVehicle>,
    /// The manager that gives them missions.
    pub manager: FleetManager,
}

impl SimulatedSite {
    /// This number of vehicles, with these editions and abilities in turn, at the first of the goals.
    ///
    /// # Errors
    /// Too few goals, or goals on the ways to others.
    pub fn new(
        layout: Layout,
        goals: Vec<usize>,
        count: usize,
        versions: &[ProtocolVersion],
        abilities: &[SimulatedTraits],
        seed: u64,
    ) -> Result<Self, SetupError> {
        if count >= goals.len() {
            return Err(SetupError::FewGoals { vehicles: count, goals: goals.len() });
        }
        let (mut profiles, mut vehicles, mut clients) = (Vec::new(), Vec::new(), Vec::new());
        let kinds = versions.iter().cycle().zip(abilities.iter().cycle());
        for ((k, (&version, &can)), &goal) in kinds.enumerate().take(count).zip(&goals) {
            let key = VehicleId::new(MANUFACTURER, &format!("{:03}", k + 1)).map_err(SetupError::Topic)?;
            let [x, y] = layout.nodes.get(goal).map(|node| node.point).ok_or(SetupError::NoNode(goal))?;
            let start = StartPose { x, y, heading: 0.0 };
            profiles.push(profile(key.clone(), &can));
            let seed = seed.wrapping_mul(1_000).wrapping_add(k as u64);
            vehicles.push(SimulatedVehicle::new(key.clone(), version, MAP, can, start, seed));
            clients.push((key, version, goal));
        }
        let clearance = 2.0 * profiles.iter().map(|profile| profile.abilities.radius_with_margin()).fold(0.0, f64::max);
        let manager = FleetManager::new(layout, MAP, goals, clearance, clients, seed)?;
        Ok(Self { profiles, vehicles, manager })
    }
}

/// The configuration of a vehicle for the supervisor.
pub fn profile(key: VehicleId, can: &SimulatedTraits) -> VehicleConfig {
    // Distance from its way, error of its position counted twice (in what it reports and in its reported deviation), and an
    // allowance for motion between two steps.
    let margin = TOLERANCE + can.drift + 2.0 * can.noise + 0.01;
    let footprint = can.footprint();
    let radius = footprint.as_ref().map_or(can.radius, Footprint::circumscribed_radius);
    let abilities = robot::RobotTraits { radius, footprint, margin, speed: can.speed, acceleration: can.acceleration };
    VehicleConfig { key, abilities, split: true, away: None, places: Vec::new() }
}

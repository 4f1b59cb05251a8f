//! VDA 5050: orders (2.x and 3.0) and states (3.0); each vehicle that is named becomes an agent, and each message that
//! names none. `updates` joins an order with its updates.
//!
//! A file holds one message, a list of them, or several one after the other. `null` counts as missing.
//! - An order is travelled from node to node by `sequenceId`, along its trajectories or straight, under its speed
//!   limits; the base ends where the first node or edge is not released, and the horizon is travelled only if
//!   requested.
//! - A state with an `intermediatePath` is a plan with times, in seconds since the time stamp of the first state with a
//!   path; one with a `plannedPath` travels that from rest, from its own time stamp on; one with neither stands where it
//!   is. It is refused if it goes on from where its path ends, or from where it stands, and if the vehicle does not know
//!   where it is. Loads in a state enlarge the vehicle.
//! - Orders do not say when they begin: all do at the time 0, and they are not read together with states with paths.

mod agent_start;
mod keys;
mod order;
mod order_element;
mod state;

pub(super) use state::position;

use super::json_access::{self, JsonObject};
use super::trajectory::FittedTrajectory;
use super::{
    ImportError, ImportOptions, VehicleTraits, WarningCode, Warnings, order_updates, trajectory, vehicle_heading,
    vehicle_loads,
};
use crate::json::{JsonData, JsonNode};
use crate::scenario::{Agent, LONGEST_LABEL, Scenario, label};
use agent_start::AgentStart;
use std::collections::BTreeSet;

/// Largest gap between the end of a path and its node, or the vehicle: it counts as deviation of the path \[m\].
const GAP: f64 = 0.05;

/// That actions are not read.
const ACTIONS: &str = "its actions take no time here: the file does not say how long they last";

/// Gap that is rounding and nothing else \[m\].
const CLOSED: f64 = 1e-9;

/// Whether a JSON value looks like an order or a state.
pub(super) fn is_message(root: &JsonNode<'_>) -> bool {
    let one = root.as_array().map_or(Some(root), |messages| messages.first());
    one.is_some_and(|one| one.get("orderId").is_some() || one.get("nodeStates").is_some())
}

/// The messages in a text: one, a list of them, or several one after the other.
fn messages<'t>(text: &'t str, warnings: &mut Warnings) -> Result<Vec<JsonNode<'t>>, ImportError> {
    let mut messages = Vec::new();
    for value in json_access::several(text) {
        match value? {
            JsonNode { data: JsonData::Array(several), .. } => messages.extend(several),
            one => messages.push(one),
        }
    }
    if messages.is_empty() {
        return Err(ImportError::new("there is no order and no state in it"));
    }
    order_updates::joined(messages, warnings)
}

/// Reads orders and states; returns the radii of the vehicles with their loads and corridors as well.
pub(super) fn read(
    text: &str,
    options: &ImportOptions,
    vehicle: &VehicleTraits,
    warnings: &mut Warnings,
) -> Result<(Scenario, Vec<f64>), ImportError> {
    let messages = messages(text, warnings)?;
    let mut reader = Vda5050Reader { options, vehicle, warnings, begins: Vec::new(), maps: BTreeSet::new() };
    let mut scenario = Scenario::new("", Vec::new());
    let mut radii = Vec::new();
    for (k, value) in messages.iter().enumerate() {
        let message = JsonObject::new(format!("message {}", k + 1), value)?;
        let (agent, radius) =
            reader.message(k as u64 + 1, &message).map_err(|error| error.or_in_json(value.position))?;
        scenario.agents.push(agent);
        radii.push(radius);
        // Several have no name in common.
        if messages.len() == 1 {
            scenario.name = message.text("orderId")?.unwrap_or_default().to_owned();
        }
    }
    agent_start::set(&mut scenario.agents, &reader.begins)?;
    let names = reader.begins.iter().map(|(name, _)| name.as_str());
    vehicle_heading::warn_of_half_turns(names.zip(&scenario.agents), reader.warnings);
    if reader.maps.len() > 1 {
        let maps = reader.maps.into_iter().collect::<Vec<_>>().join(", ");
        warnings.add(
            WarningCode::SeveralLevels,
            format_args!("maps {maps}"),
            "the agents are on several, which a scenario does not tell apart",
        );
    }
    Ok((scenario, radii))
}

struct Vda5050Reader<'a> {
    options: &'a ImportOptions,
    vehicle: &'a VehicleTraits,
    warnings: &'a mut Warnings,
    /// Names of the agents, and when each begins.
    begins: Vec<(String, AgentStart)>,
    /// The maps of all agents.
    maps: BTreeSet<String>,
}

impl Vda5050Reader<'_> {
    /// The agent of a message, and the radius that its vehicle has with what it carries, and with the room that it has beside its way.
    fn message(&mut self, id: u64, message: &JsonObject<'_>) -> Result<(Agent, f64), ImportError> {
        let name = message.text("orderId")?.unwrap_or_default();
        let robot = message.text("serialNumber")?.unwrap_or_default();
        let own = [robot, name].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ");
        let called = label(&own);
        if called != own {
            let problem =
                format!("its label becomes {called}: labels are printable text of up to {LONGEST_LABEL} characters");
            self.warnings.add(WarningCode::Renamed, format!("agent {id}"), problem);
        }
        let state = ["nodeStates", "mobileRobotPosition", "plannedPath", "intermediatePath"];
        let message = message.clone();
        if message.get("nodes").is_some() {
            let order = message.called(format!("order {name}"));
            self.begins.push((order.name.clone(), AgentStart::Unsaid));
            let (agent, radius) = self.order(id, &order)?;
            Ok((Agent { label: called, ..agent }, radius))
        } else if state.iter().any(|field| message.get(field).is_some()) {
            let state =
                message.called(if robot.is_empty() { format!("state {id}") } else { format!("state of {robot}") });
            let loaded = vehicle_loads::loaded(&state, self.vehicle, self.warnings)?;
            let (agent, begin) = self.state(id, &state, &loaded)?;
            self.begins.push((state.name, begin));
            Ok((Agent { label: called, ..agent }, loaded.radius))
        } else {
            Err(message.missing("nodes or nodeStates"))
        }
    }

    /// Reads a trajectory for the vehicle: with an outline it matters which way that faces there.
    fn trajectory(
        &mut self,
        trajectory: &JsonObject<'_>,
        vehicle: &VehicleTraits,
    ) -> Result<FittedTrajectory, ImportError> {
        let read = trajectory::read(trajectory, self.options.tolerance(), self.warnings)?;
        if let Some(outline) = &vehicle.footprint {
            vehicle_heading::along_trajectory(trajectory, &read.fit, outline, self.warnings)?;
        }
        Ok(read)
    }

    /// Keeps the map on which an agent is, which has to be one, as what is on different maps has no common coordinates.
    fn maps<'j>(
        &mut self,
        of: &JsonObject<'_>,
        positions: impl Iterator<Item = Result<Option<JsonObject<'j>>, ImportError>>,
    ) -> Result<(), ImportError> {
        let mut own: Option<&str> = None;
        for position in positions {
            let Some(map) = position?.map(|position| position.text("mapId")).transpose()?.flatten() else { continue };
            if own.is_some_and(|own| own != map) {
                let own = own.unwrap_or_default();
                return Err(ImportError::new(format!("{}: it leads from map {own} to map {map}", of.name)));
            }
            own = Some(map);
        }
        self.maps.extend(own.map(str::to_owned));
        Ok(())
    }
}

/// How far apart two points are \[m\]: nothing where that is rounding.
fn gap(a: [f64; 2], b: [f64; 2]) -> f64 {
    let apart = crate::plane_geometry::distance(a, b);
    if apart > CLOSED { apart } else { 0.0 }
}

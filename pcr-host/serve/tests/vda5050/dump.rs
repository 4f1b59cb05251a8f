//! What everybody believes, for whoever asks why nothing happens.

use pcr_formats::vda5050::state::State;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::Vda5050Bridge;
use pcr_serve::vehicles::manager::FleetManager;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;

/// A robot a line: what the supervisor knows of it, what its lane has sent, and what it has answered.
pub(crate) fn supervised(supervisor: &Supervisor, bridge: &Vda5050Bridge) -> Vec<String> {
    let lines = bridge.lanes().map(|lane| {
        let name = lane.name();
        let Ok(robot) = supervisor.robot(name) else { return format!("{name}: not there") };
        let waits = (supervisor.waits_for(robot), robot.waiting.as_ref().map(|waiting| &waiting.mission));
        let own = format!(
            "{name}: path {} of {:.2} m ({:?}), at {:.2}, granted {:.2}, told {:.2}, waits {waits:?}, {:?}, stopped {:?}, silent {}",
            robot.path, robot.course.length(), robot.mission, robot.arc_length, robot.granted, robot.notified_limit, robot.alarm, robot.stopped, robot.silent
        );
        let job = lane.job().map(|job| {
            format!(
                "job {} update {} base {} of {}, asked {}, stops {:?}, sent {:?}, acknowledged {:?}, changed {}, cancel {:?}",
                job.order.order_id, job.order.update_id, job.order.base, job.order.nodes.len(), job.requested_node, job.stops.last(), job.sent,
                job.received.acknowledged, job.changed, job.cancel
            )
        });
        format!("{own}\n    {job:?}\n    heard {:?}", lane.state_of().map(brief))
    });
    lines.collect()
}

/// What a vehicle would say now.
pub(crate) fn driven(vehicle: &mut SimulatedVehicle) -> String {
    vehicle.tell_state();
    let said = vehicle.out().into_iter().rev().find(|(kind, _)| *kind == TopicKind::State);
    let state = said.and_then(|(_, payload)| serde_json::from_slice::<State>(&payload).ok());
    format!("{}: says {:?} at {:?}", vehicle.key(), state.as_ref().map(brief), vehicle.true_position())
}

/// What the manager waits for.
pub(crate) fn ordered(manager: &FleetManager) -> Vec<String> {
    manager.orders().map(|(key, order, at)| format!("{key}: is to do {order:?} to node {at}")).collect()
}

fn brief(state: &State) -> String {
    let released = state.node_states.iter().filter(|node| node.released).count();
    format!(
        "order {} update {} node {}, {released} of {} nodes ahead released, driving {}, idle {}, errors {:?}",
        state.order_id,
        state.order_update_id,
        state.last_node_sequence_id,
        state.node_states.len(),
        state.driving,
        state.is_idle(),
        state.errors.iter().map(|error| &error.error_type).collect::<Vec<_>>()
    )
}

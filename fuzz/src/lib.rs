//! What the targets of the importers share.

use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, layout, scenario, vehicle};
use pcr_formats::scenario::Scenario;
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_planning::fleet::Fleet;

/// Agents, edges and segments up to which what a file becomes is computed with: a run stays short.
const MOST: usize = 24;

/// A scenario file that is read again (its profiles scaled by a rounding onto their paths), and motions or a message.
fn usable(scenario: &Scenario) {
    let again = Scenario::from_json(&scenario.to_json()).unwrap_or_else(|error| panic!("{error}"));
    assert!(again.agents.iter().zip(&scenario.agents).all(|(again, agent)| again.path == agent.path));
    if let Err(refused) = Fleet::<f64>::new(scenario) {
        assert!(!refused.to_string().is_empty());
    }
}

fn locks(imported: &ImportedLayout) {
    let pieces: usize = imported.layout.edges.iter().map(|edge| 1 + edge.curve.len()).sum();
    if pieces <= MOST
        && let Ok(locks) = ExclusionTable::compute(imported, true)
    {
        for lock in &locks.locks {
            assert!(lock.a_length[0] <= lock.a_length[1] && lock.b_length[0] <= lock.b_length[1], "{lock:?}");
        }
    }
}

/// Any bytes as a file of a format: refused with a message, or read as a layout with routes, or as agents.
pub fn import(format: InputFormat, bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let mut warnings = Warnings::default();
    let mut options = ImportOptions::default();
    match layout(format, text, &options, &mut warnings) {
        Ok(imported) => {
            locks(&imported);
            let nodes: Vec<String> = imported.layout.nodes.iter().map(|node| node.id.to_string()).collect();
            options.routes = nodes.windows(2).take(2).map(|pair| format!("{}:{}", pair[0], pair[1])).collect();
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    match scenario(format, text, &options, &mut warnings) {
        Ok(scenario) if scenario.agents.len() <= MOST => usable(&scenario),
        Ok(_) => {}
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    assert!(warnings.lines().iter().all(|line| !line.is_empty()));
}

/// Any bytes as what describes a vehicle: refused with a message, or convex parts.
pub fn fleet(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match vehicle(text, &ImportOptions::default(), &mut Warnings::default()) {
        Ok(vehicle) => {
            assert!(vehicle.radius > 0.0 && vehicle.speed > 0.0 && vehicle.acceleration > 0.0);
            if let Some(footprint) = &vehicle.footprint {
                assert!(footprint.parts().count() > 0 && footprint.circumscribed_radius() == vehicle.radius);
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

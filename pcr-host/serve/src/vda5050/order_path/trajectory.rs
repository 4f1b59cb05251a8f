//! Trajectories of edges, as lines and arcs.

use pcr_formats::import::{self, ImportOptions, InputFormat, Warnings};
use pcr_formats::scenario::PathSegment;
use pcr_formats::vda5050::decode::DecodeError;
use pcr_formats::vda5050::order::{OrderEdge, OrderNode};
use serde_json::{Value, json};

/// Bound on the distance of lines and arcs from a trajectory, and of a trajectory from its nodes \[m\]: margins have to cover
/// it.
pub const TOLERANCE: f64 = 2e-3;

/// Bound on the sideways distance of lines and arcs from a trajectory \[m\]. At equal lengths the distance grows with the
/// length of the trajectory.
const FIT: f64 = 1e-4;

/// Largest degree of a trajectory. Converting takes longer the larger degree and number of control points are, and all vehicles wait
/// for it.
const MOST_DEGREE: f64 = 8.0;

/// Most control points of a trajectory.
const MOST_POINTS: usize = 100;

/// Most control points of all trajectories that are converted together.
const MOST_POINTS_IN_ALL: usize = 1000;

/// Lines and arcs along the trajectory of an edge between two nodes, and the pose at which they begin \[m, rad\].
///
/// # Errors
/// [`DecodeError`] for a trajectory that cannot be read, or that is too far off its nodes.
pub(super) fn converted(
    [from, to]: [&OrderNode; 2],
    edge: &OrderEdge,
    k: usize,
) -> Result<([f64; 3], Vec<PathSegment>), DecodeError> {
    let mut edge = edge.clone();
    // The vehicle does not get it.
    edge.remove_corridor();
    let order = json!({ "orderId": "one", "nodes": [from, to], "edges": [edge] }).to_string();
    let one = Some(1.0);
    let options = ImportOptions {
        radius: one,
        speed: one,
        acceleration: one,
        rotation: one,
        rotation_acceleration: one,
        tolerance: Some(FIT),
        horizon: true,
        ..ImportOptions::default()
    };
    let field = || format!("edges[{k}].trajectory");
    let read = import::scenario(InputFormat::Vda5050, &order, &options, &mut Warnings::default());
    let read = read.map_err(|error| DecodeError::new(field(), error))?;
    let Some(agent) = read.agents.first() else { return Err(DecodeError::new(field(), "no way")) };
    if agent.radius > 1.0 + TOLERANCE {
        return Err(DecodeError::new(
            field(),
            format!("it is {:.4} m off its nodes, or off lines and arcs", agent.radius - 1.0),
        ));
    }
    Ok((agent.start, agent.path.clone()))
}

/// Refuses trajectories whose conversion would hold up the supervisor, before any is converted. What is no trajectory is left to the
/// importer.
pub(super) fn check_sizes(edges: &[OrderEdge], after: usize) -> Result<(), DecodeError> {
    let mut all = 0;
    for (k, trajectory) in
        edges.iter().enumerate().skip(after).filter_map(|(k, edge)| Some((k, edge.trajectory.as_ref()?)))
    {
        let refused = |problem: String| Err(DecodeError::new(format!("edges[{k}].trajectory"), problem));
        if let Some(degree) = trajectory.get("degree").and_then(Value::as_f64).filter(|degree| *degree > MOST_DEGREE) {
            return refused(format!("degree {degree}; a trajectory has at most {MOST_DEGREE}"));
        }
        let count = |key: &str| trajectory.get(key).and_then(Value::as_array).map_or(0, Vec::len);
        let (points, knots) = (count("controlPoints"), count("knotVector"));
        // Knots are as many as control points and degree together, and one more.
        if points > MOST_POINTS || knots > MOST_POINTS + MOST_DEGREE as usize + 1 {
            return refused(format!(
                "{points} control points and {knots} knots; a trajectory has at most {MOST_POINTS} control points"
            ));
        }
        all += points;
        if all > MOST_POINTS_IN_ALL {
            return refused(format!(
                "with it the order has {all} control points; those that are converted together are at most {MOST_POINTS_IN_ALL}"
            ));
        }
    }
    Ok(())
}

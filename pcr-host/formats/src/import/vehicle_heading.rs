//! Which way a vehicle faces as it travels: along its path, against it, at another angle to it, or as nobody knows.

use super::biarc::BiarcFit;
use super::json_access::JsonObject;
use super::vehicle::Facing;
use super::{ImportError, LayoutEdge, LayoutNode, WarningCode, Warnings};
use crate::footprint::Footprint;
use crate::plane_geometry::{distance, wrapped};
use crate::scenario::{Agent, KINK, PathSegment, PlacedSegment};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Angle that is rounding in a file and nothing else \[rad\].
const ROUNDING: f64 = 1e-3;

/// By how much an outline at this angle from its path is turned from where it covers what it covers along it \[rad\].
pub(super) fn askew(outline: &Footprint, angle: f64) -> f64 {
    let off = |angle: f64| wrapped(angle).abs();
    if outline.is_same_backward() { off(angle).min(off(angle - PI)) } else { off(angle) }
}

/// Whether an outline at this angle from its path covers what it covers when it faces along it.
pub(super) fn is_ahead(outline: &Footprint, angle: f64) -> bool {
    askew(outline, angle) <= ROUNDING
}

/// Whether it matters that the vehicle drives backward: neither to a disc nor to an outline that is the same then.
fn is_other_backward(outline: Option<&Footprint>) -> bool {
    outline.is_some_and(|outline| !outline.is_same_backward())
}

/// Says at which nodes (called so) an outline faces as on none of their edges, where a field has its direction \[rad\]: how it turns
/// there is not in any path or lock.
pub(super) fn warn_of_nodes(
    called: &str,
    field: &str,
    given: &[(usize, f64)],
    nodes: &[LayoutNode],
    edges: &[LayoutEdge],
    outline: Option<&Footprint>,
    warnings: &mut Warnings,
) {
    let Some(outline) = outline.filter(|_| !given.is_empty()) else { return };
    let mut headings = vec![Vec::new(); nodes.len()];
    for edge in edges {
        let Some((first, last)) = edge.curve.first().zip(edge.curve.last()) else { continue };
        headings[edge.ends[0]].push(first.heading);
        headings[edge.ends[1]].push(last.heading_at_end());
    }
    for &(node, angle) in given {
        if !headings[node].iter().any(|heading| is_ahead(outline, angle - heading)) {
            let name = format!("{called} {}", nodes[node].id);
            let problem =
                format!("its {field} is that of none of its edges, and not read: outlines face along their paths here");
            warnings.add(WarningCode::Orientation, name, problem);
        }
    }
}

/// Lets an outline face either way on the edges of nodes at which it faces as on none of them, where a field has its direction \[rad\]:
/// it turns there, or comes there backward.
pub(super) fn turn_at_nodes(given: &[(usize, f64)], edges: &mut [LayoutEdge], outline: Option<&Footprint>) {
    let Some(outline) = outline.filter(|_| !given.is_empty()) else { return };
    let mut of_nodes: HashMap<usize, Vec<usize>> = HashMap::new();
    for (place, edge) in edges.iter().enumerate() {
        edge.ends.iter().for_each(|node| of_nodes.entry(*node).or_default().push(place));
    }
    for (node, angle) in given {
        let own = of_nodes.get(node).map_or(&[][..], Vec::as_slice);
        let is_there = |place: &usize| {
            let Some(edge) = edges.get(*place) else { return false };
            let Some((first, last)) = edge.curve.first().zip(edge.curve.last()) else { return false };
            let faces = |heading: f64| match (edge.facing[0], edge.facing[0].angle_at(heading)) {
                (_, Some(off)) => is_ahead(outline, angle - heading - off),
                (Facing::Any, None) => true,
                (_, None) => [0.0, PI].iter().any(|off| is_ahead(outline, angle - heading - off)),
            };
            let at = |k: usize, heading: f64| edge.ends[k] == *node && faces(heading);
            at(0, first.heading) || at(1, last.heading_at_end())
        };
        if own.iter().any(is_there) {
            continue;
        }
        for place in own {
            if let Some(edge) = edges.get_mut(*place) {
                edge.facing = edge.facing.map(|facing| facing.or(Facing::Either));
            }
        }
    }
}

/// Says of which agents (each with a name) the outline turns in place by half a turn: a vehicle may do so to either side, and a path
/// has one of them.
pub(super) fn warn_of_half_turns<'a>(agents: impl Iterator<Item = (&'a str, &'a Agent)>, warnings: &mut Warnings) {
    for (name, agent) in agents {
        let half = |shape: &PathSegment| matches!(*shape, PathSegment::Turn { sweep } if sweep.abs() > PI - KINK);
        if is_other_backward(agent.footprint.as_ref()) && agent.path.iter().any(half) {
            warnings.add(
                WarningCode::HalfTurn,
                name,
                "turns by half a turn in place: to one side here, although it may turn to the other one",
            );
        }
    }
}

/// Adds the message about an orientation that was not read.
pub(super) fn lose(of: &JsonObject<'_>, field: &str, value: f64, warnings: &mut Warnings) {
    warnings.lose(of.error(format_args!("its {field} {value}, as outlines face along their paths here")));
}

/// Returns an angle of a file that can be one in radians.
///
/// # Errors
/// [`ImportError`] for more than one turn, which is an angle in degrees.
fn in_radians(object: &JsonObject<'_>, field: &str, angle: f64) -> Result<f64, ImportError> {
    if angle.abs() <= TAU + ROUNDING {
        return Ok(angle);
    }
    Err(object.field_error(field, format_args!("{angle} is more than one turn; the format has radians")))
}

/// Returns the heading `theta` of an object, if it has one \[rad\].
///
/// # Errors
/// [`ImportError`] for what is no number, and for more than one turn.
pub(super) fn theta(object: &JsonObject<'_>) -> Result<Option<f64>, ImportError> {
    object.number("theta")?.map(|theta| in_radians(object, "theta", theta)).transpose()
}

/// Which way a vehicle faces on an edge that says so, by orientations \[rad\] of which it takes any one: those on the map, which the vehicle keeps
/// where the edge is curved, or those with respect to the edge. A straight edge has a heading.
///
/// # Errors
/// [`ImportError`] for a type of orientation that is not known, and for an orientation beyond one turn, which is one in degrees.
pub(super) fn of_edge(
    edge: &JsonObject<'_>,
    field: &str,
    orientations: &[f64],
    heading: Option<f64>,
) -> Result<Option<Facing>, ImportError> {
    let is_global = match edge.text("orientationType")? {
        None => false,
        Some(kind) if kind.eq_ignore_ascii_case("TANGENTIAL") => false,
        Some(kind) if kind.eq_ignore_ascii_case("GLOBAL") => true,
        Some(other) => {
            return Err(edge.field_error("orientationType", format_args!("{other} is neither TANGENTIAL nor GLOBAL")));
        }
    };
    orientations.iter().try_for_each(|orientation| in_radians(edge, field, *orientation).map(drop))?;
    let ahead = if is_global { heading } else { Some(0.0) };
    // What is within half a turn keeps its digits.
    let off = |ahead: f64, orientation: f64| match orientation - ahead {
        off if off.abs() <= PI => off,
        off => wrapped(off),
    };
    let facing = |orientation: &f64| match ahead.map(|ahead| off(ahead, *orientation)) {
        Some(off) if off.abs() <= ROUNDING => Facing::Ahead,
        Some(off) if off.abs() >= PI - ROUNDING => Facing::Backward,
        Some(off) => Facing::sideways(off),
        None => Facing::steady(*orientation),
    };
    Ok(orientations.iter().map(facing).reduce(Facing::or))
}

/// Which way a vehicle faces along lines and arcs if nothing is said: along them, or either way where they turn back, because it may turn
/// round there or go on in the other gear.
pub(super) fn of_curve(pieces: &[PlacedSegment]) -> Facing {
    let turns_back =
        |[before, after]: [&PlacedSegment; 2]| wrapped(after.heading - before.heading_at_end()).abs() > FRAC_PI_2;
    let pieces: Vec<&PlacedSegment> = pieces.iter().filter(|piece| piece.shape.length() > 0.0).collect();
    let back = pieces.windows(2).any(|pair| turns_back([pair[0], pair[1]]));
    if back { Facing::Either } else { Facing::Ahead }
}

/// Loses orientations of control points, which are in world coordinates (VDA 5050 1.x), unless they are along the curve. Where on the
/// curve the inner ones are is not known: they have to be along it anywhere.
pub(super) fn along_trajectory(
    trajectory: &JsonObject<'_>,
    fit: &BiarcFit,
    outline: &Footprint,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let points = trajectory.list("controlPoints")?;
    for (k, value) in points.iter().enumerate() {
        let point = JsonObject::new(format!("{}, control point {}", trajectory.name, k + 1), value)?;
        let Some(orientation) = point.number("orientation")? else { continue };
        let is_along = |heading: f64| is_ahead(outline, orientation - heading);
        let mut pieces = fit.pieces.iter();
        let fits = match k {
            0 => pieces.next().is_some_and(|first| is_along(first.heading)),
            k if k + 1 == points.len() => pieces.next_back().is_some_and(|last| is_along(last.heading_at_end())),
            _ => pieces.any(|piece| turns_through(piece, outline, orientation)),
        };
        if !fits {
            lose(&point, "orientation", orientation, warnings);
            break;
        }
    }
    Ok(())
}

/// Whether an outline faces so somewhere on a line or an arc.
fn turns_through(piece: &PlacedSegment, outline: &Footprint, orientation: f64) -> bool {
    let sweep = piece.shape.sweep();
    let passes = |orientation: f64| {
        let ahead = (orientation - piece.heading) * if sweep < 0.0 { -1.0 } else { 1.0 };
        (ahead + ROUNDING).rem_euclid(TAU) <= sweep.abs() + 2.0 * ROUNDING
    };
    passes(orientation) || passes(orientation - PI) && outline.is_same_backward()
}

/// The heading of a line or an arc beside a point, if it passes no further than that from it.
pub(super) fn heading_beside(piece: &PlacedSegment, point: [f64; 2], within: f64) -> Option<f64> {
    let [x, y] = [point[0] - piece.start[0], point[1] - piece.start[1]];
    let (sin, cos) = piece.heading.sin_cos();
    let (ahead, left) = (x * cos + y * sin, y * cos - x * sin);
    let whole = piece.shape.length();
    let along = match piece.shape {
        PathSegment::Line { .. } => ahead,
        PathSegment::Turn { .. } | PathSegment::Kink { .. } | PathSegment::Facing { .. } => 0.0,
        PathSegment::Arc { radius, sweep, .. } => {
            // The centre is to the left of an arc that turns left. Half of what is missing to a full turn is before its begin.
            let angle = ahead.atan2(radius - left * sweep.signum());
            let spare = 0.5 * (TAU - sweep.abs()).max(0.0);
            radius * ((angle + spare).rem_euclid(TAU) - spare)
        }
    };
    let along = along.clamp(0.0, whole);
    let shape = match piece.shape {
        PathSegment::Arc { radius, sweep, .. } => PathSegment::arc(radius, (along / radius).copysign(sweep)),
        _ => PathSegment::Line { length: along },
    };
    let part = PlacedSegment { shape, ..*piece };
    (distance(part.end(), point) <= within).then(|| part.heading_at_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_is_that_beside_the_point() {
        let close = |heading: Option<f64>, expected: f64| heading.is_some_and(|it| (it - expected).abs() < 1e-12);
        let line = PlacedSegment::line([1.0, 1.0], [1.0, 5.0]);
        assert!(close(heading_beside(&line, [1.04, 3.0], 0.05), FRAC_PI_2));
        for apart in [[1.06, 3.0], [1.0, 5.06], [1.0, 0.94]] {
            assert_eq!(heading_beside(&line, apart, 0.05), None, "{apart:?}");
        }
        // From (2, 0) around the origin, to the left and to the right.
        for side in [1.0, -1.0] {
            let shape = PathSegment::arc(2.0, side * 3.0 * FRAC_PI_2);
            let arc = PlacedSegment { start: [2.0, 0.0], heading: side * FRAC_PI_2, shape };
            for turn in [0.0, 0.3, FRAC_PI_2, 3.0, 3.0 * FRAC_PI_2] {
                let at = [2.02 * f64::cos(turn), side * 2.02 * f64::sin(turn)];
                assert!(close(heading_beside(&arc, at, 0.05), side * (FRAC_PI_2 + turn)), "{side} {turn}");
            }
            assert_eq!(heading_beside(&arc, [1.5, side * -1.5], 0.05), None);
            assert!(close(heading_beside(&arc, [2.0, side * -0.01], 0.05), side * FRAC_PI_2));
        }
    }
}

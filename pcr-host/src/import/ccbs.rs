//! Continuous-CBS: roadmaps (GraphML) as layouts, and logs of plans as scenarios.
//!
//! A section goes straight at constant speed, one that goes nowhere is a wait. Agents begin at time 0 and stay at their goals.

use super::layout::{Edge, Id, Layout, Node, Placed};
use super::timed;
use super::xml::{child, children, number, parse};
use super::{ImportError, Options, Vehicle, Warnings};
use crate::scenario::Scenario;
use std::collections::HashMap;

/// Radius that the program takes where its configuration gives none \[m\].
pub(super) const RADIUS: f64 = std::f64::consts::SQRT_2 / 4.0;

/// Largest gap between two sections that counts as none \[m\].
const GAP: f64 = 1e-6;

/// Reads a roadmap: nodes with `x,y` as their first datum.
pub(super) fn roadmap(text: &str, options: &Options, warnings: &mut Warnings) -> Result<Layout, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    let graph = child(root, "graph").ok_or_else(|| {
        if is_task(root) {
            return task();
        }
        ImportError::new(format!("{}: there is no graph in it, which a roadmap is", root.tag_name().name()))
    })?;
    let mut layout = Layout { levels: vec![String::new()], corner_radius: options.corner_radius, ..Layout::default() };
    layout.name = graph.attribute("id").unwrap_or_default().to_owned();
    let mut places = HashMap::new();
    for (k, node) in children(graph, "node").enumerate() {
        let id = node.attribute("id").map_or_else(|| format!("node at place {}", k + 1), str::to_owned);
        let datum = child(node, "data").and_then(|data| data.text()).unwrap_or_default();
        let at = datum.split_once(',').and_then(|(x, y)| {
            let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.abs() <= crate::scenario::LIMIT);
            Some([number(x)?, number(y)?])
        });
        match at {
            None => warnings.add(format_args!("node {id}"), "left out: its first datum is not x,y"),
            Some(_) if places.contains_key(&id) => {
                warnings.add(format_args!("node {id}"), "given twice; the first is taken")
            }
            Some(at) => {
                places.insert(id.clone(), layout.nodes.len());
                layout.nodes.push(Node { id: Id::Text(id), name: None, level: 0, at });
            }
        }
    }
    let mut ids = HashMap::new();
    for (k, edge) in children(graph, "edge").enumerate() {
        let id = edge.attribute("id").map_or_else(|| format!("edge at place {}", k + 1), str::to_owned);
        let end = |name: &str| edge.attribute(name).and_then(|node| places.get(node).copied());
        let (Some(from), Some(to)) = (end("source"), end("target")) else {
            warnings.add(format_args!("edge {id}"), "left out: its source or its target is no node");
            continue;
        };
        if ids.insert(id.clone(), k).is_some() {
            warnings.add(format_args!("edge {id}"), "given twice; the first is taken");
            continue;
        }
        let at = |node: usize| layout.nodes.get(node).map_or([0.0; 2], |node| node.at);
        let line = Placed::line(at(from), at(to));
        let curve = if line.shape.length() > 0.0 { vec![line] } else { Vec::new() };
        let edge = Edge {
            id: Id::Text(id),
            ends: [from, to],
            curve,
            two_way: false,
            speed: None,
            rotation: None,
            deviation: 0.0,
        };
        layout.edges.push(edge);
    }
    if layout.nodes.is_empty() {
        return Err(ImportError::new("graph: there is no node in it"));
    }
    Ok(layout)
}

/// Whether a file says only who has to go where.
fn is_task(root: roxmltree::Node<'_, '_>) -> bool {
    child(root, "log").is_none() && child(root, "agent").is_some()
}

fn task() -> ImportError {
    ImportError::new("a task of Continuous-CBS without its plan; the plan is in the log that the program writes")
}

/// Reads the plan in a log.
pub(super) fn log(text: &str, vehicle: &Vehicle) -> Result<Scenario, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    if is_task(root) {
        return Err(task());
    }
    let log = child(root, "log")
        .ok_or_else(|| ImportError::new(format!("{}: there is no log in it, hence no plan", root.tag_name().name())))?;
    let mut agents = Vec::new();
    for (k, agent) in children(log, "agent").enumerate() {
        let id = agent.attribute("number").and_then(|number| number.trim().parse().ok()).unwrap_or(k as u64);
        let name = format!("agent {id}");
        let path = child(agent, "path").ok_or_else(|| ImportError::new(format!("{name}, path: missing")))?;
        let mut stops: Vec<timed::Stop> = Vec::new();
        for (k, section) in children(path, "section").enumerate() {
            let name = format!("{name}, section {k}");
            let field = |attribute: &str| number(section, &name, attribute);
            let (from, to) = ([field("start_i")?, field("start_j")?], [field("goal_i")?, field("goal_j")?]);
            match stops.last() {
                None => stops.push((from, 0.0)),
                Some((at, _)) if (at[0] - from[0]).hypot(at[1] - from[1]) > GAP => {
                    return Err(ImportError::new(format!("{name}: it does not begin where the one before it ends")));
                }
                Some(_) => {}
            }
            let before = stops.last().map_or(0.0, |(_, time)| *time);
            stops.push((to, before + field("duration")?));
        }
        let named = |error| ImportError::new(format!("{name}: {error}"));
        agents.push(timed::agent(id, vehicle.radius, &stops).map_err(named)?);
    }
    if agents.is_empty() {
        return Err(ImportError::new("log: there is no agent in it"));
    }
    Ok(Scenario { name: String::new(), agents })
}

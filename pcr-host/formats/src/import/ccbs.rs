//! Continuous-CBS: roadmaps (GraphML) as layouts, and logs of plans as scenarios.
//!
//! A section goes straight at constant speed; a section without length is a wait. Agents begin at time 0 and stay at
//! their goals.

use super::keys::Keys;
use super::layout::{ElementId, Layout, LayoutEdge, LayoutNode};
use super::timed_paths;
use super::unique_names::UniqueNames;
use super::xml::{astray, child, children, content, lose_astray, number, only, optional, parse, warn_of_unknown};
use super::{ImportError, VehicleTraits, WarningCode, Warnings};
use crate::plane_geometry::distance;
use crate::scenario::{Agent, PlacedSegment, Scenario};

/// Radius of a log where no other is given \[m\], and why. The program itself takes √2/4 m if its configuration gives none; its agents then
/// just touch, and the digits of a log would decide whether they do.
pub(super) const DEFAULT: (f64, &str) =
    (0.3535, "just below √2/4, the default of the program, with which agents touch");

/// Largest gap between two sections that counts as none \[m\].
const GAP: f64 = 1e-6;

/// By how much a path may last longer or shorter than its sections \[s\], and as a part of it: numbers are rounded in files.
const LATE: f64 = 1e-3;
const ROUNDED: f64 = 1e-4;

/// Those of `parse` tell how a file is written.
const GRAPH: Keys = Keys::new(
    &["id", "edgedefault"],
    &[
        "parse.nodeids",
        "parse.edgeids",
        "parse.order",
        "parse.nodes",
        "parse.edges",
        "parse.maxindegree",
        "parse.maxoutdegree",
    ],
);
const NODE: Keys = Keys::new(&["id"], &["parse.indegree", "parse.outdegree"]);
const EDGE: Keys = Keys::new(&["id", "source", "target", "directed"], &["sourceport", "targetport"]);

/// Reads a roadmap: nodes with `x,y` as their first datum.
pub(super) fn roadmap(text: &str, warnings: &mut Warnings) -> Result<Layout, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    let graph = only(root, "graph")?.ok_or_else(|| {
        if is_task(root) {
            return task();
        }
        if child(root, "log").is_some() {
            return ImportError::new("a plan of Continuous-CBS, with paths of its own; a layout is expected");
        }
        ImportError::new(format!("{}: there is no graph in it, which a roadmap is", root.tag_name().name()))
    })?;
    lose_astray(graph, &["node", "edge", "graph", "hyperedge"], warnings);
    warn_of_unknown(graph, &["node", "edge", "data", "desc", "hyperedge"], warnings);
    for hyperedge in children(graph, "hyperedge") {
        let id = hyperedge.attribute("id").unwrap_or_default();
        warnings.lose(format_args!("hyperedge {id}: it joins any number of nodes, and an edge joins two"));
    }
    GRAPH.check_attributes(graph, "graph", warnings)?;
    let undirected = match graph.attribute("edgedefault") {
        Some("undirected") => Some(true),
        Some("directed") => Some(false),
        None => None,
        Some(other) => return Err(ImportError::new(format!("graph, edgedefault: {other} is not read"))),
    };
    let mut nodes = UniqueNames::new();
    for (k, node) in children(graph, "node").enumerate() {
        let Some(id) = node.attribute("id").filter(|id| !id.trim().is_empty()).map(str::to_owned) else {
            // No edge leads to it.
            warnings.lose(format_args!("node at place {}: it has no id", k + 1));
            continue;
        };
        if let Err(error) = NODE.check_attributes(node, &format!("node {id}"), warnings) {
            warnings.lose(error);
            continue;
        }
        let datum = child(node, "data").map(content).unwrap_or_default();
        let at = datum.split_once(',').and_then(|(x, y)| {
            let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.abs() <= crate::scenario::LIMIT);
            Some([number(x)?, number(y)?])
        });
        match at {
            None => warnings.lose(format_args!("node {id}: its first datum is not x,y")),
            Some(at) => {
                nodes.add(LayoutNode { id: ElementId::Text(id), name: None, level: 0, point: at }, warnings);
            }
        }
    }
    if nodes.list().is_empty() {
        return Err(ImportError::new("graph: there is no node in it"));
    }
    let mut edges = UniqueNames::new();
    for (k, edge) in children(graph, "edge").enumerate() {
        let id = edge.attribute("id").map_or_else(|| format!("at place {}", k + 1), str::to_owned);
        if let Err(error) = EDGE.check_attributes(edge, &format!("edge {id}"), warnings) {
            warnings.lose(error);
            continue;
        }
        let end = |name: &str| {
            let node = edge.attribute(name).ok_or_else(|| format!("edge {id}, {name}: missing"))?;
            nodes.index_of(&ElementId::Text(node.to_owned())).map_err(|unclear| format!("edge {id}, {name}: {unclear}"))
        };
        let ends = match end("source").and_then(|from| Ok([from, end("target")?])) {
            Ok(ends) => ends,
            Err(problem) => {
                warnings.lose(format_args!("{problem}"));
                continue;
            }
        };
        let [from, to] = ends.map(|node| nodes.list()[node].point);
        let line = PlacedSegment::line(from, to);
        let straight = line.shape.length() > 0.0;
        if !straight {
            warnings.add(WarningCode::ZeroLength, format_args!("edge {id}"), "its length is 0");
        }
        let back = match edge.attribute("directed").map(str::trim) {
            None => undirected.ok_or_else(|| {
                let why = "neither it (directed) nor the graph (edgedefault) says whether it leads in both directions";
                ImportError::new(format!("edge {id}: {why}"))
            })?,
            Some("false" | "0") => true,
            Some("true" | "1") => false,
            Some(other) => {
                warnings.lose(format_args!("edge {id}, directed: {other} where true or false is expected"));
                continue;
            }
        };
        let edge = LayoutEdge::new(ElementId::Text(id), ends, if straight { vec![line] } else { Vec::new() });
        let edge = LayoutEdge { ways: [true, back], ..edge };
        edges.add(edge, warnings);
    }
    Ok(Layout {
        name: graph.attribute("id").unwrap_or_default().to_owned(),
        levels: vec![String::new()],
        nodes: nodes.into_list(),
        edges: edges.into_list(),
        ..Layout::default()
    })
}

/// Whether a file says only who has to go where.
fn is_task(root: roxmltree::Node<'_, '_>) -> bool {
    child(root, "log").is_none() && child(root, "agent").is_some()
}

fn task() -> ImportError {
    ImportError::new("a task of Continuous-CBS without its plan; the plan is in the log that the program writes")
}

/// Reads the plan in a log.
pub(super) fn log(text: &str, vehicle: &VehicleTraits) -> Result<Scenario, ImportError> {
    let document = parse(text)?;
    let root = document.root_element();
    if is_task(root) {
        return Err(task());
    }
    let log = only(root, "log")?
        .ok_or_else(|| ImportError::new(format!("{}: there is no log in it, hence no plan", root.tag_name().name())))?;
    let mut agents = Vec::new();
    for (k, agent) in children(log, "agent").enumerate() {
        agents.push(planned(k, agent, vehicle)?);
    }
    if agents.is_empty() {
        return Err(ImportError::new("log: there is no agent in it"));
    }
    complete(root, log, &agents)?;
    Ok(Scenario::new("", agents))
}

/// Refuses a plan that lacks agents of its task, which the program writes before it, or has them where they are not read.
fn complete(root: roxmltree::Node<'_, '_>, log: roxmltree::Node<'_, '_>, agents: &[Agent]) -> Result<(), ImportError> {
    let of_task = children(root, "agent").count();
    if of_task > 0 && of_task != agents.len() {
        let problem = format!("it has the paths of {} agents, and the task before it has {of_task}", agents.len());
        return Err(ImportError::new(format!("log: {problem}")));
    }
    for (k, agent) in agents.iter().enumerate() {
        if agents.iter().take(k).any(|other| other.id == agent.id) {
            return Err(ImportError::new(format!("agent {}: it is in the log twice", agent.id)));
        }
    }
    match astray(log, &["agent"]).find(|(agent, _)| agent.parent() != Some(root)) {
        Some((_, problem)) => Err(ImportError::new(problem)),
        None => Ok(()),
    }
}

/// The agent on its path.
fn planned(k: usize, agent: roxmltree::Node<'_, '_>, vehicle: &VehicleTraits) -> Result<Agent, ImportError> {
    let id = match agent.attribute("number") {
        None => k as u64,
        Some(number) => number.trim().parse().map_err(|_| {
            ImportError::new(format!("agent at place {}, number: a whole number from 0 is expected", k + 1))
        })?,
    };
    let name = format!("agent {id}");
    let path = only(agent, "path")?.ok_or_else(|| ImportError::new(format!("{name}, path: missing")))?;
    let (mut stops, mut widest): (Vec<timed_paths::TimedPoint>, f64) = (Vec::new(), 0.0);
    for (k, section) in children(path, "section").enumerate() {
        let name = format!("{name}, section {k}");
        let field = |attribute: &str| number(section, &name, attribute);
        if let Some(own) = optional(section, &name, "number")?.filter(|own| *own != k as f64) {
            return Err(ImportError::new(format!("{name}, number: {own}, as if some were missing before it")));
        }
        let (from, to) = ([field("start_i")?, field("start_j")?], [field("goal_i")?, field("goal_j")?]);
        match stops.last() {
            None => stops.push((from, 0.0)),
            Some((at, _)) => widest = widest.max(distance(*at, from)),
        }
        if widest > GAP {
            return Err(ImportError::new(format!("{name}: it does not begin where the one before it ends")));
        }
        let before = stops.last().map_or(0.0, |(_, time)| *time);
        stops.push((to, before + field("duration")?));
    }
    let travels = timed_paths::agent(id, vehicle.radius + widest, &stops);
    let travels = travels.map_err(|error| ImportError::new(format!("{name}: {error}")))?;
    let lasts = stops.last().map_or(0.0, |(_, time)| *time);
    if let Some(whole) = optional(path, &format!("{name}, path"), "duration")?
        && (whole - lasts).abs() > LATE.max(ROUNDED * whole.abs())
    {
        return Err(ImportError::new(format!("{name}, path, duration: {whole}, and its sections last {lasts}")));
    }
    Ok(travels)
}

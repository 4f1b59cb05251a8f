//! The project's own lock file: for each edge and node the stretches of edges that are locked while a vehicle is there.
//!
//! An edge locks itself. Lengths are those of the table of locks, outward to the next micrometre but one.

use crate::{Claim, Group, Rules, Section};
use pcr_formats::import::{Id, ImportError, Imported};
use pcr_planning::locks::Locks;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;

/// What the file says that it is.
const FORMAT: &str = "pcr-exclusions";

/// Whether a text is such a file.
pub(crate) fn is_locks(text: &str) -> bool {
    serde_json::from_str::<Value>(text).is_ok_and(|value| value["format"] == FORMAT)
}

fn outward([from, to]: [f64; 2]) -> [f64; 2] {
    [((from * 1e6).floor() - 1.0).max(0.0) / 1e6, ((to * 1e6).ceil() + 1.0) / 1e6]
}

/// Writes the locks of a table with nodes, an edge or a node a line.
pub(crate) fn write(imported: &Imported, locks: &Locks) -> String {
    let layout = &imported.layout;
    let mut edges: BTreeMap<&Id, Vec<Value>> = BTreeMap::new();
    for edge in &layout.edges {
        let whole = outward([0.0, edge.length()]);
        edges.insert(&edge.id, vec![json!({ "edge": edge.id, "own": whole, "other": whole })]);
    }
    for lock in &locks.locks {
        let [a, b] = [lock.a_length, lock.b_length].map(outward);
        edges.entry(&lock.a).or_default().push(json!({ "edge": lock.b, "own": a, "other": b }));
        edges.entry(&lock.b).or_default().push(json!({ "edge": lock.a, "own": b, "other": a }));
    }
    let mut nodes: BTreeMap<&Id, Vec<Value>> = layout.nodes.iter().map(|node| (&node.id, Vec::new())).collect();
    for lock in locks.nodes.iter().flatten() {
        nodes.entry(&lock.node).or_default().push(json!({ "edge": lock.edge, "other": outward(lock.edge_length) }));
    }
    let mut text = format!(
        "{{ \"format\": \"{FORMAT}\", \"version\": 1, \"layout\": {}, \"vehicle\": {},\n",
        json!(locks.layout),
        json!(locks.vehicle)
    );
    for (kind, lists, end) in [("edge", &edges, "],\n"), ("node", &nodes, "] }\n")] {
        let _ = writeln!(text, "  \"{kind}s\": [");
        for (k, (id, list)) in lists.iter().enumerate() {
            let comma = if k + 1 < lists.len() { "," } else { "" };
            let _ =
                writeln!(text, "    {{ \"{kind}\": {}, \"locks\": {} }}{comma}", json!(id), Value::from(list.clone()));
        }
        let _ = write!(text, "  {end}");
    }
    text
}

fn range(value: &Value) -> Option<[f64; 2]> {
    let number = |k: usize| value.get(k).and_then(Value::as_f64);
    Some([number(0)?, number(1)?]).filter(|[from, to]| from <= to)
}

/// A stretch of an edge with tokens.
struct Mark {
    range: [f64; 2],
    token: usize,
    bars: bool,
}

/// Reads the locks.
pub(crate) fn read(text: &str, imported: &Imported) -> Result<Rules, ImportError> {
    let root: Value = serde_json::from_str(text).map_err(|error| ImportError::new(format!("not JSON: {error}")))?;
    if root["format"] != FORMAT || root["version"] != 1 {
        return Err(ImportError::new(format!("format, version: {FORMAT}, 1 are expected")));
    }
    let layout = &imported.layout;
    let ids =
        |value: &Value| value.as_u64().map(Id::Number).or_else(|| value.as_str().map(|text| Id::Text(text.into())));
    let places: HashMap<&Id, usize> = layout.edges.iter().enumerate().map(|(k, edge)| (&edge.id, k)).collect();
    let spots: HashMap<&Id, usize> = layout.nodes.iter().enumerate().map(|(k, node)| (&node.id, k)).collect();
    let find = |places: &HashMap<&Id, usize>, value: &Value, what: &str| {
        let place = ids(value).and_then(|id| places.get(&id).copied());
        place.ok_or_else(|| ImportError::new(format!("{what} {value}: there is none in the layout")))
    };
    let mut marks: Vec<Vec<Mark>> = layout.edges.iter().map(|_| Vec::new()).collect();
    let mut nodes = vec![Claim::default(); layout.nodes.len()];
    let (mut groups, mut token) = (Vec::new(), 0);
    let numbers = || ImportError::new("locks: from and to are expected in each");
    for entry in root["edges"].as_array().into_iter().flatten() {
        let own = find(&places, &entry["edge"], "edge")?;
        let mut others = Vec::new();
        for lock in entry["locks"].as_array().into_iter().flatten() {
            let other = find(&places, &lock["edge"], "edge")?;
            marks[own].push(Mark { range: range(&lock["own"]).ok_or_else(numbers)?, token, bars: true });
            marks[other].push(Mark { range: range(&lock["other"]).ok_or_else(numbers)?, token, bars: false });
            others.push(layout.edges[other].id.to_string());
            token += 1;
        }
        groups.push(Group { name: layout.edges[own].id.to_string(), edges: others, nodes: Vec::new() });
    }
    for entry in root["nodes"].as_array().into_iter().flatten() {
        let node = find(&spots, &entry["node"], "node")?;
        for lock in entry["locks"].as_array().into_iter().flatten() {
            let other = find(&places, &lock["edge"], "edge")?;
            marks[other].push(Mark { range: range(&lock["other"]).ok_or_else(numbers)?, token, bars: false });
            nodes[node].bars.push(token);
            token += 1;
        }
    }
    let edges = layout.edges.iter().zip(marks).map(|(edge, marks)| {
        let sections = sections(edge.length(), &marks);
        let back = sections.iter().rev().cloned().collect();
        [sections, back]
    });
    Ok(Rules { edges: edges.collect(), nodes, groups, warnings: Vec::new() })
}

/// An edge, cut wherever a lock begins or ends.
fn sections(length: f64, marks: &[Mark]) -> Vec<Section> {
    let ends = marks.iter().flat_map(|mark| mark.range).chain([0.0, length]);
    let mut cuts: Vec<f64> = ends.map(|cut| cut.clamp(0.0, length)).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    if cuts.len() == 1 {
        cuts.push(length);
    }
    let section = |pair: &[f64]| {
        let there = || marks.iter().filter(|mark| mark.range[0] <= pair[0] && pair[1] <= mark.range[1]);
        let mut claim = Claim {
            takes: there().filter(|mark| !mark.bars).map(|mark| mark.token).collect(),
            bars: there().filter(|mark| mark.bars).map(|mark| mark.token).collect(),
            closed: false,
        };
        claim.takes.sort_unstable();
        claim.bars.sort_unstable();
        Section { length: [pair[0], pair[1]], claim }
    };
    cuts.windows(2).map(section).collect()
}

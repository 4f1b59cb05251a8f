//! The project's own lock file: for each edge and node, the stretches of edges that are locked while a vehicle is
//! there.
//!
//! An edge locks itself. Lengths are those of the table of locks, rounded outward to the next micrometre but one.

use crate::stamp::VehicleStamp;
use crate::{DirectedEdgeRules, ExclusionGroup, ExclusionRules, ResourceClaim, TokenSpan};
use pcr_formats::import::{ElementId, ImportError, ImportedLayout};
use pcr_planning::exclusion_table::ExclusionTable;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt::Write as _;

/// Name of the format.
const FORMAT: &str = "pcr-exclusions";

/// Format of a text.
#[derive(Deserialize)]
struct LockFileHeader {
    #[serde(default)]
    format: Value,
    #[serde(default)]
    version: Value,
}

/// The file, an edge or a node of it, and one of its locks. A layout can have hundreds of locks for each edge, so they are read
/// without a tree of values.
#[derive(Deserialize)]
struct LockFile {
    /// For which vehicle it was written; files of the first releases do not say that.
    written: Option<VehicleStamp>,
    edges: Vec<LockFileEntry>,
    nodes: Vec<LockFileEntry>,
}

#[derive(Deserialize)]
struct LockFileEntry {
    edge: Option<ElementId>,
    node: Option<ElementId>,
    locks: Vec<LockFileItem>,
}

#[derive(Serialize, Deserialize)]
struct LockFileItem {
    edge: ElementId,
    /// Lengths of the other edge.
    other: [f64; 2],
    /// Lengths of the edge that has the lock; `None` for a node.
    #[serde(skip_serializing_if = "Option::is_none")]
    own: Option<[f64; 2]>,
}

/// Whether a text is a file of this format.
pub(crate) fn is_locks(text: &str) -> bool {
    serde_json::from_str::<LockFileHeader>(text).is_ok_and(|said| said.format == FORMAT)
}

fn outward([from, to]: [f64; 2]) -> [f64; 2] {
    [((from * 1e6).floor() - 1.0).max(0.0) / 1e6, ((to * 1e6).ceil() + 1.0) / 1e6]
}

/// Writes the locks of a table that includes nodes, one edge or node on each line.
pub(crate) fn write(imported: &ImportedLayout, locks: &ExclusionTable) -> Result<String, ImportError> {
    let layout = &imported.layout;
    let mut edges: BTreeMap<&ElementId, Vec<LockFileItem>> = BTreeMap::new();
    let lock = |edge: &ElementId, other, own| LockFileItem { edge: edge.clone(), other, own };
    for edge in &layout.edges {
        let whole = outward([0.0, edge.length()]);
        edges.insert(&edge.id, vec![lock(&edge.id, whole, Some(whole))]);
    }
    for found in &locks.locks {
        let [a, b] = [found.a_length, found.b_length].map(outward);
        edges.entry(&found.a).or_default().push(lock(&found.b, b, Some(a)));
        edges.entry(&found.b).or_default().push(lock(&found.a, a, Some(b)));
    }
    let mut nodes: BTreeMap<&ElementId, Vec<LockFileItem>> =
        layout.nodes.iter().map(|node| (&node.id, Vec::new())).collect();
    for found in locks.nodes.iter().flatten() {
        nodes.entry(&found.node).or_default().push(lock(&found.edge, outward(found.edge_length), None));
    }
    let mut text = format!(
        "{{ \"format\": \"{FORMAT}\", \"version\": 1, \"layout\": {}, \"vehicle\": {},\n  \"written\": {},\n",
        json!(locks.layout),
        json!(locks.vehicle),
        VehicleStamp::of(imported).text()
    );
    for (kind, lists, end) in [("edge", &edges, "],\n"), ("node", &nodes, "] }\n")] {
        let _ = writeln!(text, "  \"{kind}s\": [");
        for (k, (id, list)) in lists.iter().enumerate() {
            let comma = if k + 1 < lists.len() { "," } else { "" };
            let list = serde_json::to_string(list).map_err(|error| ImportError::new(error.to_string()))?;
            let _ = writeln!(text, "    {{ \"{kind}\": {}, \"locks\": {list} }}{comma}", json!(id));
        }
        let _ = write!(text, "  {end}");
    }
    Ok(text)
}

/// Reads the locks.
pub(crate) fn read(text: &str, imported: &ImportedLayout) -> Result<ExclusionRules, ImportError> {
    let json = |error: serde_json::Error| ImportError::of_serde(text, &error, "JSON of the expected form");
    let said: LockFileHeader = serde_json::from_str(text).map_err(json)?;
    if said.format != FORMAT || said.version != 1 {
        return Err(ImportError::new(format!("format, version: {FORMAT}, 1 are expected")));
    }
    let file: LockFile = serde_json::from_str(text).map_err(json)?;
    let layout = &imported.layout;
    let places: HashMap<&ElementId, usize> = layout.edges.iter().enumerate().map(|(k, edge)| (&edge.id, k)).collect();
    let spots: HashMap<&ElementId, usize> = layout.nodes.iter().enumerate().map(|(k, node)| (&node.id, k)).collect();
    let find = |places: &HashMap<&ElementId, usize>, id: &Option<ElementId>, what: &str| {
        let Some(id) = id else { return Err(ImportError::new(format!("{what}: a name is expected in each entry"))) };
        let place = places.get(id).copied();
        place.ok_or_else(|| ImportError::new(format!("{what} {}: there is none in the layout", json!(id))))
    };
    let once = |there: &mut HashSet<usize>, place: usize, what: &str, id: &ElementId| {
        let first = there.insert(place);
        first.then_some(()).ok_or_else(|| ImportError::new(format!("{what} {}: there is another one of it", json!(id))))
    };
    let checked = |range: Option<[f64; 2]>| {
        let range = range.filter(|[from, to]| from <= to);
        range.ok_or_else(|| ImportError::new("locks: from and to are expected in each"))
    };
    let mut marks: Vec<Vec<TokenSpan>> = layout.edges.iter().map(|_| Vec::new()).collect();
    let mut nodes = vec![ResourceClaim::default(); layout.nodes.len()];
    let (mut groups, mut token) = (Vec::new(), 0);
    let mut there = HashSet::new();
    for LockFileEntry { edge, locks, .. } in file.edges {
        let own = find(&places, &edge, "edge")?;
        once(&mut there, own, "edge", &layout.edges[own].id)?;
        let mut others = Vec::new();
        for LockFileItem { edge, other, own: range } in locks {
            let there = find(&places, &Some(edge), "edge")?;
            marks[own].push(TokenSpan { range: checked(range)?, token, bars: true });
            marks[there].push(TokenSpan { range: checked(Some(other))?, token, bars: false });
            others.push(layout.edges[there].id.to_string());
            token += 1;
        }
        groups.push(ExclusionGroup {
            name: layout.edges[own].id.to_string(),
            edges: others,
            ..ExclusionGroup::default()
        });
    }
    let mut there = HashSet::new();
    for LockFileEntry { node, locks, .. } in file.nodes {
        let node = find(&spots, &node, "node")?;
        once(&mut there, node, "node", &layout.nodes[node].id)?;
        for LockFileItem { edge, other, .. } in locks {
            let there = find(&places, &Some(edge), "edge")?;
            marks[there].push(TokenSpan { range: checked(Some(other))?, token, bars: false });
            nodes[node].blocked.push(token);
            token += 1;
        }
    }
    let edges =
        layout.edges.iter().zip(marks).map(|(edge, marks)| DirectedEdgeRules::both(edge.length(), marks, Vec::new()));
    Ok(ExclusionRules { edges: edges.collect(), nodes, groups, stamp: file.written, ..ExclusionRules::default() })
}

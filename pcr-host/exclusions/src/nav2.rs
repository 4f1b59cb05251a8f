//! Route graphs of nav2: lists of the edges that are closed for other vehicles while a vehicle is on an edge or at a
//! node.
//!
//! The metadata of each edge and node have such a list as [`KEY`], in the form that the service
//! `DynamicEdgesScorer/adjust_edges` takes (`closed_edges` when the vehicle arrives, `opened_edges` when it has left).
//! An edge is in its own list, because two vehicles on one edge can touch. The service identifies edges by their ids,
//! which have 16 bits; edges with the same id are closed together.

use crate::stamp::{MEMBER, VehicleStamp};
use crate::text_edits::{TextEdits, ending};
use crate::{ExclusionGroup, ExclusionRules, ResourceClaim};
use pcr_formats::import::{ElementId, ImportError, ImportedLayout, graph_id, parse_json};
use pcr_formats::json::{self, JsonData, JsonNode};
use pcr_planning::exclusion_table::ExclusionTable;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// The member of `metadata` that holds them.
const KEY: &str = "closed_edges";

/// The largest id of the service.
const LARGEST: u64 = 65535;

/// The id in the file of an edge or a node of a layout: of several with one id all but the first have a longer name there.
fn id_in_file(id: &ElementId) -> Option<u64> {
    match id {
        ElementId::Number(number) => Some(*number),
        ElementId::Text(text) => text.split('#').next()?.parse().ok(),
    }
}

/// Nobody can ask the service to close this edge.
fn unknown(edge: u64) -> ImportError {
    ImportError::new(format!("edge {edge}: the service that closes edges knows ids up to {LARGEST}"))
}

/// Whether a feature is a node, or an edge; what is neither has no part in the graph.
fn is_node(feature: &Value) -> Option<bool> {
    match feature["geometry"]["type"].as_str()? {
        "Point" => Some(true),
        "LineString" | "MultiLineString" => Some(false),
        _ => None,
    }
}

/// Reads the lists.
pub(crate) fn read(text: &str, imported: &ImportedLayout) -> Result<ExclusionRules, ImportError> {
    let places = parse_json(text)?;
    let root = places.to_value();
    let mut lists: [BTreeMap<u64, BTreeSet<u64>>; 2] = Default::default();
    let mut groups = Vec::new();
    for (feature, place) in features(&root, &places) {
        let (Some(node), Some(id)) = (is_node(feature), graph_id(&feature["properties"]["id"])) else { continue };
        let what = if node { "node" } else { "edge" };
        let problem = || {
            let list = ["properties", "metadata", KEY].into_iter().try_fold(place, |place, key| place.get(key));
            let problem = format!("{what} {id}, metadata, {KEY}: ids of edges are expected");
            ImportError::in_json(list.unwrap_or(place).position, problem)
        };
        let list: BTreeSet<u64> = match &feature["properties"]["metadata"][KEY] {
            Value::Null => BTreeSet::new(),
            Value::Array(ids) => ids.iter().map(graph_id).collect::<Option<_>>().ok_or_else(problem)?,
            _ => return Err(problem()),
        };
        if let Some(large) = list.last().filter(|id| **id > LARGEST) {
            return Err(unknown(*large));
        }
        if !list.is_empty() {
            let edges = list.iter().map(ToString::to_string).collect();
            groups.push(ExclusionGroup { name: format!("{what} {id}"), edges, ..ExclusionGroup::default() });
        }
        // Of several features with one id, what all of them close.
        let known = lists[usize::from(node)].entry(id).or_insert_with(|| list.clone());
        *known = known.intersection(&list).copied().collect();
    }
    let [of_edges, of_nodes] = lists;
    let known: Vec<u64> = of_edges.keys().copied().collect();
    let tokens = |list: Option<&BTreeSet<u64>>| {
        let token =
            |id: &u64| known.binary_search(id).map_err(|_| ImportError::new(format!("{KEY}: there is no edge {id}")));
        list.into_iter().flatten().map(token).collect::<Result<Vec<_>, _>>()
    };
    let layout = &imported.layout;
    let edges = layout.edges.iter().map(|edge| {
        let id = id_in_file(&edge.id);
        let takes = id.and_then(|id| known.binary_search(&id).ok()).into_iter().collect();
        Ok(ResourceClaim { acquired: takes, blocked: tokens(id.and_then(|id| of_edges.get(&id)))?, closed: false })
    });
    let nodes = layout.nodes.iter().map(|node| {
        let bars = tokens(id_in_file(&node.id).and_then(|id| of_nodes.get(&id)))?;
        Ok(ResourceClaim { blocked: bars, ..ResourceClaim::default() })
    });
    let (edges, nodes) = (edges.collect::<Result<_, ImportError>>()?, nodes.collect::<Result<_, ImportError>>()?);
    let said = root.get(MEMBER).map(Value::to_string);
    Ok(ExclusionRules { groups, ..ExclusionRules::of_edges(imported, edges, nodes) }.stamped(said.as_deref()))
}

/// Writes the lists of a table with nodes.
pub(crate) fn write(text: &str, imported: &ImportedLayout, locks: &ExclusionTable) -> Result<String, ImportError> {
    let mut closed: [BTreeMap<u64, BTreeSet<u64>>; 2] = Default::default();
    let mut close = |node: bool, of: &ElementId, edge: &ElementId| {
        if let (Some(of), Some(edge)) = (id_in_file(of), id_in_file(edge)) {
            closed[usize::from(node)].entry(of).or_default().insert(edge);
        }
    };
    imported.layout.edges.iter().for_each(|edge| close(false, &edge.id, &edge.id));
    for lock in &locks.locks {
        close(false, &lock.a, &lock.b);
        close(false, &lock.b, &lock.a);
    }
    locks.nodes.iter().flatten().for_each(|lock| close(true, &lock.node, &lock.edge));
    if let Some((large, _)) = closed[0].iter().find(|(id, _)| **id > LARGEST) {
        return Err(unknown(*large));
    }
    let places = parse_json(text)?;
    let root = places.to_value();
    let mut edits = TextEdits::default();
    for (feature, place) in features(&root, &places) {
        let (Some(node), Some(id)) = (is_node(feature), graph_id(&feature["properties"]["id"])) else { continue };
        let ids: Vec<u64> = closed[usize::from(node)].get(&id).into_iter().flatten().copied().collect();
        if let Some(properties) = place.get("properties") {
            set(&mut edits, properties, &Value::from(ids).to_string());
        }
    }
    let stamp = VehicleStamp::of(imported).text();
    match (places.get(MEMBER), places.end_of_members()) {
        (Some(old), _) => edits.replace(old.span(), stamp),
        (None, Some((at, comma))) => edits.insert(at, format!("{comma}\"{MEMBER}\": {stamp}")),
        (None, None) => return Err(ImportError::new("graph: an object is expected")),
    }
    Ok(edits.apply(text))
}

/// Sets the list in the metadata of a feature.
fn set(edits: &mut TextEdits, properties: &JsonNode<'_>, list: &str) {
    let metadata = properties.get("metadata");
    if let Some(old) = metadata.and_then(|metadata| metadata.get(KEY)) {
        return edits.replace(old.span(), list);
    }
    match metadata.map(|metadata| (metadata, metadata.end_of_members())) {
        Some((_, Some((at, comma)))) => edits.insert(at, format!("{comma}\"{KEY}\": {list}")),
        // `null`, or what is no metadata.
        Some((other, None)) => edits.replace(other.span(), format!("{{ \"{KEY}\": {list} }}")),
        None => {
            if let Some((at, comma)) = properties.end_of_members() {
                edits.insert(at, format!("{comma}\"metadata\": {{ \"{KEY}\": {list} }}"));
            }
        }
    }
}

fn features<'a>(root: &'a Value, places: &'a JsonNode<'a>) -> impl Iterator<Item = (&'a Value, &'a JsonNode<'a>)> {
    let values = root["features"].as_array().into_iter().flatten();
    values.zip(places.get("features").map_or(&[][..], JsonNode::list))
}

/// Cuts edges into equal parts no longer than this \[m\]; returns the text, and which edges are left whole, and why.
pub(crate) fn split(text: &str, most: f64) -> Result<(String, Vec<String>), ImportError> {
    let places = parse_json(text)?;
    let root = places.to_value();
    let mut cutter = Nav2EdgeSplitter::new(&root, &places)?;
    let (mut edits, mut whole_ones) = (TextEdits::default(), Vec::new());
    let end = ending(text);
    let mut nodes = Vec::new();
    for (feature, place) in features(&root, &places).filter(|(feature, _)| is_node(feature) == Some(false)) {
        let properties = &feature["properties"];
        let (ends, at) = cutter.ends(properties).ok_or_else(|| {
            let problem = format!("edge {}: its nodes, or their coordinates, are not in the file", properties["id"]);
            ImportError::in_json(place.position, problem)
        })?;
        let length = (at[1][0] - at[0][0]).hypot(at[1][1] - at[0][1]);
        let parts = (length / most - 1e-9).ceil().max(1.0);
        if parts < 2.0 {
            continue;
        }
        let id = &properties["id"];
        // A list, or an object with a name for each, as nav2's loader goes over both.
        let operations = &properties["operations"];
        if operations.as_array().is_some_and(|list| !list.is_empty())
            || operations.as_object().is_some_and(|named| !named.is_empty())
        {
            whole_ones.push(format!("edge {id} is left whole: its operations belong to all of it"));
            continue;
        }
        if properties["cost"].as_f64().is_some_and(|cost| cost != 0.0) {
            whole_ones.push(format!("edge {id} is left whole: its cost belongs to all of it"));
            continue;
        }
        let chain = cutter.chain(ends, at, parts as usize, &mut nodes);
        let own = &text[place.span()];
        let copies = chain.windows(2).enumerate().map(|(k, pair)| {
            let id = if k == 0 { graph_id(id)? } else { cutter.new_edge() };
            copy(own, id, [&pair[0], &pair[1]])
        });
        let copies = copies.collect::<Option<Vec<_>>>();
        let copies = copies.ok_or_else(|| {
            ImportError::in_json(place.position, format!("edge {id}: a field that an edge needs is missing"))
        })?;
        edits.replace(place.span(), copies.join(&format!(",{end}")));
    }
    if let Some(list) = places.get("features")
        && let Some(last) = list.list().last()
    {
        edits.insert(last.span().end, nodes.iter().map(|node| format!(",{end}{node}")).collect::<String>());
    }
    Ok((edits.apply(text), whole_ones))
}

/// A node of a chain: its id, and where it is \[m\].
type SplitEdge = (u64, [f64; 2]);

struct Nav2EdgeSplitter {
    at: BTreeMap<u64, [f64; 2]>,
    frames: BTreeMap<u64, Value>,
    next: [u64; 2],
    /// The nodes between two others, from the lower id on.
    between: BTreeMap<(u64, u64, usize), Vec<SplitEdge>>,
}

impl Nav2EdgeSplitter {
    fn new(root: &Value, places: &JsonNode<'_>) -> Result<Self, ImportError> {
        let (mut at, mut frames, mut next) = (BTreeMap::new(), BTreeMap::new(), [0, 0]);
        for (feature, place) in features(root, places) {
            let refused = |problem| ImportError::in_json(place.position, problem);
            let (Some(node), Some(id)) = (is_node(feature), graph_id(&feature["properties"]["id"])) else { continue };
            let after = id.checked_add(1).ok_or_else(|| refused(format!("id {id}: no larger one is left")))?;
            next[usize::from(node)] = next[usize::from(node)].max(after);
            if node {
                let coordinate = |k: usize| {
                    let problem = || refused(format!("node {id}, coordinates: two numbers are expected"));
                    feature["geometry"]["coordinates"][k].as_f64().ok_or_else(problem)
                };
                at.insert(id, [coordinate(0)?, coordinate(1)?]);
                frames.insert(id, feature["properties"]["frame"].clone());
            }
        }
        Ok(Self { at, frames, next, between: BTreeMap::new() })
    }

    fn new_edge(&mut self) -> u64 {
        self.next[0] += 1;
        self.next[0] - 1
    }

    fn ends(&self, properties: &Value) -> Option<([u64; 2], [[f64; 2]; 2])> {
        let ends = [graph_id(&properties["startid"])?, graph_id(&properties["endid"])?];
        Some((ends, [*self.at.get(&ends[0])?, *self.at.get(&ends[1])?]))
    }

    /// The nodes along an edge, new ones where nothing has cut it there before.
    fn chain(&mut self, ends: [u64; 2], at: [[f64; 2]; 2], parts: usize, features: &mut Vec<Value>) -> Vec<SplitEdge> {
        let turned = ends[0] > ends[1];
        let (low, high) = if turned { (1, 0) } else { (0, 1) };
        let key = (ends[low], ends[high], parts);
        if !self.between.contains_key(&key) {
            let frame = self.frames.get(&ends[low]).cloned().unwrap_or_default();
            let link = |k: usize| {
                let share = k as f64 / parts as f64;
                let point = [0, 1].map(|x| at[low][x] + (at[high][x] - at[low][x]) * share);
                let id = self.next[1] + k as u64 - 1;
                let mut of = json!({ "id": id });
                if !frame.is_null() {
                    of["frame"] = frame.clone();
                }
                let geometry = json!({ "type": "Point", "coordinates": point });
                features.push(json!({ "type": "Feature", "properties": of, "geometry": geometry }));
                (id, point)
            };
            let links: Vec<SplitEdge> = (1..parts).map(link).collect();
            self.next[1] += links.len() as u64;
            self.between.insert(key, links);
        }
        let mut chain = self.between[&key].clone();
        if turned {
            chain.reverse();
        }
        chain.insert(0, (ends[0], at[0]));
        chain.push((ends[1], at[1]));
        chain
    }
}

/// The text of an edge with another id, other ends, and a line between them.
fn copy(text: &str, id: u64, [from, to]: [&SplitEdge; 2]) -> Option<String> {
    let spans = json::parse(text).ok()?;
    let properties = spans.get("properties")?;
    let mut edits = TextEdits::default();
    for (name, value) in [("id", id), ("startid", from.0), ("endid", to.0)] {
        edits.replace(properties.get(name)?.span(), value.to_string());
    }
    let geometry = spans.get("geometry")?;
    let (kind, line) = (geometry.get("type")?, json!([from.1, to.1]));
    edits.replace(kind.span(), "\"LineString\"");
    let drawn = geometry.get("coordinates")?;
    if let JsonData::Array(_) = drawn.data {
        edits.replace(drawn.span(), line.to_string());
    }
    Some(edits.apply(text))
}

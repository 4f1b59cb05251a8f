//! Buildings and navigation graphs of Open-RMF: mutex groups of vertices and lanes.
//!
//! A vertex or a lane is in one group at most. Before a robot sets off to a vertex it locks the group of the lane and
//! that of the vertex. The group of the vertex that it leaves is unlocked on the way, unless the lane is in it, too.
//! Hence a lane is put into the group of the vertex where it begins: on the way a robot then holds the groups of both
//! ends. A lane for both directions cannot be in both groups, so it is split into two, which the building tools do
//! anyway.
//!
//! At first every vertex is a group of its own, so that lanes with a common vertex exclude each other. Other contacts
//! are excluded by merging the groups of two vertices, repeatedly those that exclude most for their size.

mod lane_splitter;
mod mutex_groups;

pub(crate) use lane_splitter::prepare;

use crate::audit::groups;
use crate::options::WriteNotes;
use crate::stamp::{MEMBER, VehicleStamp};
use crate::text_edits::{TextEdits, column, ending};
use crate::{ExclusionRules, ResourceClaim};
use mutex_groups::united;
use pcr_formats::import::{ElementId, ImportError, ImportedLayout, is_navigation_graph};
use pcr_formats::json::JsonNode;
use pcr_formats::warning::WarningCode;
use pcr_formats::yaml::{CollectionStyle, YamlDocument, YamlNode, YamlValue as Kind};
use pcr_planning::exclusion_table::ExclusionTable;
use serde_json::{Value, json};
use std::collections::{BTreeSet, HashMap};

/// Prefix of the names of groups that are written here.
const PREFIX: &str = "pcr/";

/// The form of a file: where its parameters are, and how they are written.
#[derive(Clone, Copy)]
struct RmfDialect {
    /// Index of the parameters in the list of a vertex.
    vertex: usize,
    /// Whether a parameter is a list of its type and its value.
    typed: bool,
    /// Whether names of parameters are quoted, as in JSON, which is also YAML.
    quoted: bool,
}

impl RmfDialect {
    const LANE: usize = 2;

    fn of(text: &str, root: &JsonNode<'_>) -> Self {
        let quoted = serde_json::from_str::<serde::de::IgnoredAny>(text).is_ok();
        let graph = is_navigation_graph(root);
        Self { vertex: if graph { 2 } else { 4 }, typed: !graph, quoted }
    }

    /// A parameter, with its name and value.
    fn parameter(self, name: &str, value: &str) -> String {
        if self.quoted { format!("\"{name}\": {value}") } else { format!("{name}: {value}") }
    }

    /// A vertex without a name, in brackets.
    fn vertex(self, [x, y]: [f64; 2]) -> String {
        if self.typed {
            format!("[{x:?}, {y:?}, 0, \"\"]")
        } else {
            format!("[{x:?}, {y:?}, {{{}}}]", self.parameter("name", "\"\""))
        }
    }
}

/// Level of a vertex or lane, and its index there.
fn place_of(id: &ElementId) -> Option<(&str, usize)> {
    let ElementId::Text(text) = id else { return None };
    let (level, place) = text.rsplit_once('/')?;
    Some((level, place.parse().ok()?))
}

/// Reads the groups.
pub(crate) fn read(text: &str, imported: &ImportedLayout) -> Result<ExclusionRules, ImportError> {
    let (form, root, _) = opened(text)?;
    let mut names: Vec<String> = Vec::new();
    let mut known: HashMap<String, usize> = HashMap::new();
    let mut group = |kind: &str, id: &ElementId, parameters: usize| -> Result<Vec<usize>, ImportError> {
        let Some((level, place)) = place_of(id) else { return Ok(Vec::new()) };
        let given = &root["levels"][level][kind][place][parameters]["mutex"];
        let value = if let Value::Array(typed) = given { typed.get(1).unwrap_or(&Value::Null) } else { given };
        let name = match value {
            Value::Null => return Ok(Vec::new()),
            Value::String(name) if name.is_empty() => return Ok(Vec::new()),
            Value::String(name) => name.clone(),
            // Adapters accept any scalar as a name.
            Value::Number(number) => number.to_string(),
            Value::Bool(true) => "true".to_owned(),
            other => return Err(ImportError::new(format!("{kind} {id}, mutex: {other} where a name is expected"))),
        };
        Ok(vec![*known.entry(name).or_insert_with_key(|name| {
            names.push(name.clone());
            names.len() - 1
        })])
    };
    let layout = &imported.layout;
    let lanes =
        layout.edges.iter().map(|edge| group("lanes", &edge.id, RmfDialect::LANE)).collect::<Result<Vec<_>, _>>()?;
    let vertices =
        layout.nodes.iter().map(|node| group("vertices", &node.id, form.vertex)).collect::<Result<Vec<_>, _>>()?;
    let ways = layout.edges.iter().zip(&lanes).map(|(edge, own)| {
        [1, 0].map(|end| {
            let target = edge.ends[end];
            ResourceClaim::exclusive(own.iter().chain(vertices.get(target).into_iter().flatten()).copied().collect())
        })
    });
    let ways = ways.collect();
    let groups = groups(layout, &names, &lanes, &vertices);
    let nodes = vertices.into_iter().map(ResourceClaim::exclusive).collect();
    let said = root.get(MEMBER).map(Value::to_string);
    Ok(ExclusionRules { groups, ..ExclusionRules::of_ways(imported, ways, nodes) }.stamped(said.as_deref()))
}

/// A file: its form, all of it, and the same with its places.
fn opened(text: &str) -> Result<(RmfDialect, Value, YamlDocument<'_>), ImportError> {
    let document = YamlDocument::read(text).map_err(ImportError::of_yaml)?;
    let root = document.value().map_err(ImportError::of_yaml)?;
    Ok((RmfDialect::of(text, &root), root.to_value(), document))
}

/// A file to change: its form, and its values with their places.
fn placed(text: &str) -> Result<(RmfDialect, YamlNode<'_>), ImportError> {
    let (form, _, document) = opened(text)?;
    if document.is_placed {
        Ok((form, document.root))
    } else {
        Err(ImportError::new("YAML in which the places of values cannot be told"))
    }
}

/// The value of a parameter; in buildings a parameter is a list of type and value.
fn typed<'a>(parameters: Option<&'a YamlNode<'_>>, name: &str) -> Option<&'a str> {
    let given = parameters?.get(name)?;
    given.list().get(1).unwrap_or(given).text()
}

/// Refuses to change an element whose text also stands for another one.
fn own(element: &YamlNode<'_>, kind: &str, id: &ElementId) -> Result<(), ImportError> {
    let problem =
        || format!("{kind} {id}: there is an anchor or an alias in it; what is shared cannot be changed for one");
    if element.shared { Err(ImportError::new(problem())) } else { Ok(()) }
}

/// Writes the groups for a table that includes nodes; all lanes lead in one direction.
pub(crate) fn write(
    text: &str,
    imported: &ImportedLayout,
    locks: &ExclusionTable,
    notes: &mut WriteNotes,
) -> Result<String, ImportError> {
    let layout = &imported.layout;
    let group = united(layout, locks);
    let (form, root) = placed(text)?;
    let name = |node: usize| {
        let name = json!(format!("{PREFIX}{}", layout.nodes[group[node]].id));
        if form.typed { format!("[1, {name}]") } else { name.to_string() }
    };
    notes.groups = group.iter().collect::<BTreeSet<_>>().len();
    let mut edits = TextEdits::default();
    let mut replaced = BTreeSet::new();
    let element = |kind: &str, id: &ElementId| -> Option<&YamlNode<'_>> {
        let (level, place) = place_of(id)?;
        root.get("levels")?.get(level)?.get(kind)?.list().get(place)
    };
    let things = (layout.edges.iter().map(|edge| ("lanes", &edge.id, RmfDialect::LANE, edge.ends[0])))
        .chain(layout.nodes.iter().enumerate().map(|(k, node)| ("vertices", &node.id, form.vertex, k)));
    for (kind, id, place, node) in things {
        let found = element(kind, id)
            .ok_or_else(|| ImportError::new(format!("{kind} {id}: it is not where it is expected in the file")))?;
        own(found, kind, id)?;
        if let Some(old) =
            typed(found.list().get(place), "mutex").filter(|old| !old.is_empty() && !old.starts_with(PREFIX))
        {
            replaced.insert(old.to_owned());
        }
        set(&mut edits, text, form, found, place, &name(node))
            .ok_or_else(|| ImportError::new(format!("{kind} {id}: its parameters are not where they are expected")))?;
    }
    if !replaced.is_empty() {
        let names: Vec<String> = replaced.into_iter().collect();
        let text = format_args!("groups of the file are replaced: {}", names.join(", "));
        notes.warnings.push(WarningCode::ReplacedExclusions.text(text));
    }
    stamp(&mut edits, text, form, &root, imported)?;
    Ok(edits.apply(text))
}

/// Says for which vehicle the groups are.
fn stamp(
    edits: &mut TextEdits,
    text: &str,
    form: RmfDialect,
    root: &YamlNode<'_>,
    imported: &ImportedLayout,
) -> Result<(), ImportError> {
    let stamp = VehicleStamp::of(imported).text();
    if let Some(old) = root.get(MEMBER) {
        edits.replace(old.span.clone(), old.instead(&stamp));
        return Ok(());
    }
    let whole = form.parameter(MEMBER, &stamp);
    match &root.value {
        Kind::Mapping(CollectionStyle::Flow, members) if !members.is_empty() => {
            edits.insert(root.span.start + 1, format!("{whole}, "));
        }
        Kind::Mapping(CollectionStyle::Block, members) if !members.is_empty() => {
            let at = members[0].key.span.start;
            edits.insert(at, format!("{whole}{}{}", ending(text), " ".repeat(column(text, at))));
        }
        _ => return Err(ImportError::new("building: a mapping is expected")),
    }
    Ok(())
}

/// Sets the group in the parameters of a lane or a vertex.
fn set(
    edits: &mut TextEdits,
    text: &str,
    form: RmfDialect,
    element: &YamlNode<'_>,
    place: usize,
    group: &str,
) -> Option<()> {
    let whole = form.parameter("mutex", group);
    let Kind::Sequence(style, list) = &element.value else { return None };
    if let Some(parameters) = list.get(place) {
        let Kind::Mapping(style, members) = &parameters.value else { return None };
        match (parameters.get("mutex"), style, members.first(), members.last()) {
            (Some(old), ..) => edits.replace(old.span.clone(), old.instead(group)),
            (None, CollectionStyle::Flow, _, Some(last)) => edits.insert(last.value.span.end, format!(", {whole}")),
            (None, CollectionStyle::Flow, ..) => edits.insert(parameters.span.start + 1, whole),
            (None, CollectionStyle::Block, Some(first), _) => {
                let at = first.key.span.start;
                edits.insert(at, format!("{whole}{}{}", ending(text), " ".repeat(column(text, at))));
            }
            (None, CollectionStyle::Block, ..) => return None,
        }
        return Some(());
    }
    // A vertex of a building may lack height and name.
    let missing = match (list.len(), place) {
        (count, place) if count == place => &[][..],
        (3, 4) => &["\"\""],
        (2, 4) => &["0", "\"\""],
        _ => return None,
    };
    let (last, parameters) = (list.last()?, format!("{{{whole}}}"));
    let elements = missing.iter().copied().chain([parameters.as_str()]);
    let margin = " ".repeat(column(text, element.span.start));
    let before = match style {
        CollectionStyle::Flow => ", ".to_owned(),
        CollectionStyle::Block => format!("{}{margin}- ", ending(text)),
    };
    edits.insert(last.span.end, elements.map(|element| format!("{before}{element}")).collect::<String>());
    Some(())
}

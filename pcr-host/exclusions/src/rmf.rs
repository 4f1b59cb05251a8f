//! Buildings of Open-RMF: mutex groups of vertices and lanes.
//!
//! A vertex or a lane is in one group at most. Before a robot sets off to a vertex it locks the group of the lane and that of the
//! vertex; that of the vertex which it leaves is unlocked on the way, unless the lane is in it, too. Hence a lane is put into the group
//! of the vertex where it begins: on the way a robot has both ends. A lane for both ways cannot be in the groups of both, so that it becomes two,
//! which is what the building tools make of it anyway.
//!
//! At first every vertex is a group of its own, so that lanes with a common vertex exclude each other. What else can touch is excluded by
//! uniting the groups of two vertices, again and again those that exclude most for their size.

use crate::audit::groups;
use crate::edit::Edits;
use crate::settings::Notes;
use crate::yaml::Spanned;
use crate::{Claim, Rules};
use pcr_formats::import::{Id, ImportError, Imported, Layout};
use pcr_planning::locks::Locks;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// How the names of groups begin that are written here.
const PREFIX: &str = "pcr/";

/// Level and place in its list.
fn place_of(id: &Id) -> Option<(&str, usize)> {
    let Id::Text(text) = id else { return None };
    let (level, place) = text.rsplit_once('/')?;
    Some((level, place.parse().ok()?))
}

/// Reads the groups.
pub(crate) fn read(text: &str, imported: &Imported) -> Result<Rules, ImportError> {
    let root: Value = serde_saphyr::from_str(text).map_err(|error| ImportError::new(format!("not YAML: {error}")))?;
    let mut names: Vec<String> = Vec::new();
    let mut known: HashMap<String, usize> = HashMap::new();
    let mut group = |kind: &str, id: &Id, parameters: usize| -> Result<Vec<usize>, ImportError> {
        let Some((level, place)) = place_of(id) else { return Ok(Vec::new()) };
        let given = &root["levels"][level][kind][place][parameters]["mutex"];
        let value = if let Value::Array(typed) = given { typed.get(1).unwrap_or(&Value::Null) } else { given };
        match value {
            Value::Null => Ok(Vec::new()),
            Value::String(name) if name.is_empty() => Ok(Vec::new()),
            Value::String(name) => Ok(vec![*known.entry(name.clone()).or_insert_with(|| {
                names.push(name.clone());
                names.len() - 1
            })]),
            other => Err(ImportError::new(format!("{kind} {id}, mutex: {other} where a name is expected"))),
        }
    };
    let layout = &imported.layout;
    let lanes = layout.edges.iter().map(|edge| group("lanes", &edge.id, 2)).collect::<Result<Vec<_>, _>>()?;
    let vertices = layout.nodes.iter().map(|node| group("vertices", &node.id, 4)).collect::<Result<Vec<_>, _>>()?;
    let ways = layout.edges.iter().zip(&lanes).map(|(edge, own)| {
        [1, 0].map(|end| {
            let target = edge.ends[end];
            Claim::exclusive(own.iter().chain(vertices.get(target).into_iter().flatten()).copied().collect())
        })
    });
    let ways = ways.collect();
    let groups = groups(layout, &names, &lanes, &vertices);
    let nodes = vertices.into_iter().map(Claim::exclusive).collect();
    Ok(Rules { groups, ..Rules::of_ways(imported, ways, nodes) })
}

fn spans(text: &str) -> Result<Spanned, ImportError> {
    Spanned::of(text).ok_or_else(|| ImportError::new("YAML in which the places of values cannot be told"))
}

/// Cuts lanes into equal parts no longer than `most` \[m\], if that is asked for, and makes two lanes of each that leads both ways.
pub(crate) fn prepare(
    text: &str,
    imported: &Imported,
    most: Option<f64>,
    notes: &mut Notes,
) -> Result<String, ImportError> {
    let root = spans(text)?;
    let mut edits = Edits::default();
    let lanes: HashMap<(&str, usize), usize> =
        imported.layout.edges.iter().enumerate().filter_map(|(k, edge)| Some((place_of(&edge.id)?, k))).collect();
    for (name, level) in root.get("levels").map_or(&[][..], Spanned::members) {
        let (Some(list), Some(vertices)) = (level.get("lanes"), level.get("vertices")) else { continue };
        let mut cutter = Cutter { at: corners(vertices), added: Vec::new(), between: BTreeMap::new() };
        let mut further = Vec::new();
        for (k, lane) in list.list().iter().enumerate() {
            let Some(edge) = lanes.get(&(name.as_str(), k)).map(|&edge| &imported.layout.edges[edge]) else { continue };
            let own = &text[lane.span.clone()];
            if !own.starts_with('[') {
                return Err(ImportError::new(format!(
                    "lane {}: it is no list in brackets, which is what can be written",
                    edge.id
                )));
            }
            let mut parts = most.map_or(1.0, |most| (edge.length() / most - 1e-9).ceil().max(1.0)) as usize;
            let mock = |name: &str| typed(lane.list().get(2), name).is_some_and(|value| !value.is_empty());
            if parts > 1 && (mock("demo_mock_floor_name") || mock("demo_mock_lift_name")) {
                notes.said.push(format!("lane {} is left whole: it stands for a lift", edge.id));
                parts = 1;
            }
            if parts == 1 && !edge.two_way {
                continue;
            }
            let ends =
                [0, 1].map(|k| lane.list().get(k).and_then(Spanned::text).and_then(|text| text.parse::<usize>().ok()));
            let [Some(from), Some(to)] = ends else { continue };
            let chain = cutter.chain([from, to], parts);
            let ways: &[bool] = if edge.two_way { &[false, true] } else { &[false] };
            let mut copies = Vec::new();
            for &back in ways {
                let mut chain = chain.clone();
                if back {
                    chain.reverse();
                }
                for pair in chain.windows(2) {
                    copies.push(copy(own, [pair[0], pair[1]], back)?);
                }
            }
            edits.replace(lane.span.clone(), copies.remove(0));
            further.extend(copies);
        }
        append(&mut edits, text, list, &further)?;
        append(&mut edits, text, vertices, &cutter.added)?;
    }
    Ok(edits.made(text))
}

/// Positions of the vertices, as in the file.
fn corners(vertices: &Spanned) -> Vec<Option<[f64; 2]>> {
    let number = |vertex: &Spanned, k: usize| vertex.list().get(k)?.text()?.parse::<f64>().ok();
    vertices.list().iter().map(|vertex| Some([number(vertex, 0)?, number(vertex, 1)?])).collect()
}

struct Cutter {
    at: Vec<Option<[f64; 2]>>,
    added: Vec<String>,
    between: BTreeMap<(usize, usize, usize), Vec<usize>>,
}

impl Cutter {
    /// The vertices along a lane, new ones where no other lane has been cut between the same two.
    fn chain(&mut self, [from, to]: [usize; 2], parts: usize) -> Vec<usize> {
        let (low, high) = (from.min(to), from.max(to));
        let (Some(Some(a)), Some(Some(b))) = (self.at.get(low).copied(), self.at.get(high).copied()) else {
            return vec![from, to];
        };
        let first = self.at.len();
        let (at, added) = (&mut self.at, &mut self.added);
        let cut = self.between.entry((low, high, parts)).or_insert_with(|| {
            for k in 1..parts {
                let share = k as f64 / parts as f64;
                let [x, y] = [0, 1].map(|k| a[k] + (b[k] - a[k]) * share);
                at.push(Some([x, y]));
                added.push(format!("[{x:?}, {y:?}, 0, \"\"]"));
            }
            (first..first + parts - 1).collect()
        });
        let mut chain = vec![low];
        chain.extend(cut.iter().copied());
        chain.push(high);
        if from > to {
            chain.reverse();
        }
        chain
    }
}

/// The text of a lane with other ends, for one way only.
fn copy(text: &str, ends: [usize; 2], back: bool) -> Result<String, ImportError> {
    let spans = spans(text)?;
    let mut edits = Edits::default();
    for (k, end) in ends.iter().enumerate() {
        if let Some(old) = spans.list().get(k) {
            edits.replace(old.span.clone(), end.to_string());
        }
    }
    let parameters = spans.list().get(2);
    if let Some(two_way) = parameters.and_then(|parameters| parameters.get("bidirectional")) {
        edits.replace(two_way.span.clone(), "[4, false]");
    }
    if back && let Some(orientation) = parameters.and_then(|parameters| parameters.get("orientation")) {
        let turned = match typed(parameters, "orientation") {
            Some("forward") => Some("backward"),
            Some("backward") => Some("forward"),
            _ => None,
        };
        if let Some(turned) = turned {
            edits.replace(orientation.span.clone(), format!("[1, {turned}]"));
        }
    }
    Ok(edits.made(text))
}

/// The value of a parameter, which is a list of its type and itself.
fn typed<'a>(parameters: Option<&'a Spanned>, name: &str) -> Option<&'a str> {
    let given = parameters?.get(name)?;
    given.list().get(1).unwrap_or(given).text()
}

/// Adds elements to the end of a list, a line each where it has a line each.
fn append(edits: &mut Edits, text: &str, list: &Spanned, further: &[String]) -> Result<(), ImportError> {
    let Some(last) = list.list().last().filter(|_| !further.is_empty()) else { return Ok(()) };
    let line = text[..last.span.start].rfind('\n').map_or(0, |end| end + 1);
    let before = &text[line..last.span.start];
    let end = last.span.end;
    if text[list.span.clone()].starts_with('[') {
        edits.insert(end, further.iter().map(|element| format!(", {element}")).collect::<String>());
    } else if before.trim() == "-" {
        edits.insert(end, further.iter().map(|element| format!("\n{before}{element}")).collect::<String>());
    } else {
        return Err(ImportError::new(format!("a list that ends in {before:?}: nothing can be added to it")));
    }
    Ok(())
}

/// Writes the groups of a table with nodes; all lanes lead one way.
pub(crate) fn write(text: &str, imported: &Imported, locks: &Locks, notes: &mut Notes) -> Result<String, ImportError> {
    let layout = &imported.layout;
    let group = united(layout, locks);
    let name = |node: usize| format!("[1, \"{PREFIX}{}\"]", layout.nodes[group[node]].id.to_string().replace('"', "'"));
    notes.groups = group.iter().collect::<BTreeSet<_>>().len();
    let root = spans(text)?;
    let mut edits = Edits::default();
    let mut replaced = BTreeSet::new();
    let element = |kind: &str, id: &Id| -> Option<&Spanned> {
        let (level, place) = place_of(id)?;
        root.get("levels")?.get(level)?.get(kind)?.list().get(place)
    };
    let things = (layout.edges.iter().map(|edge| ("lanes", &edge.id, 2, edge.ends[0])))
        .chain(layout.nodes.iter().enumerate().map(|(k, node)| ("vertices", &node.id, 4, k)));
    for (kind, id, place, node) in things {
        let found = element(kind, id).filter(|found| text[found.span.clone()].starts_with('['));
        let Some(found) = found else {
            return Err(ImportError::new(format!(
                "{kind} {id}: it is no list in brackets, which is what can be written"
            )));
        };
        if let Some(old) =
            typed(found.list().get(place), "mutex").filter(|old| !old.is_empty() && !old.starts_with(PREFIX))
        {
            replaced.insert(old.to_owned());
        }
        set(&mut edits, found, place, &name(node), id)?;
    }
    if !replaced.is_empty() {
        let names: Vec<String> = replaced.into_iter().collect();
        notes.said.push(format!("groups of the file are replaced: {}", names.join(", ")));
    }
    Ok(edits.made(text))
}

/// Sets the group in the parameters of a lane or a vertex.
fn set(edits: &mut Edits, element: &Spanned, place: usize, group: &str, id: &Id) -> Result<(), ImportError> {
    let end = element.span.end - 1;
    let problem = || ImportError::new(format!("{id}: its parameters are not where they are expected"));
    match (element.list().get(place), element.list().len()) {
        (Some(parameters), _) => match (parameters.get("mutex"), &parameters.value) {
            (Some(old), _) => edits.replace(old.span.clone(), group),
            (None, crate::yaml::Value::Mapping(members)) => {
                let comma = if members.is_empty() { "" } else { ", " };
                edits.insert(parameters.span.end - 1, format!("{comma}mutex: {group}"));
            }
            _ => return Err(problem()),
        },
        (None, count) if count == place => edits.insert(end, format!(", {{mutex: {group}}}")),
        // A vertex without a name.
        (None, 3) if place == 4 => edits.insert(end, format!(", \"\", {{mutex: {group}}}")),
        _ => return Err(problem()),
    }
    Ok(())
}

/// For each node the first node of its group.
fn united(layout: &Layout, locks: &Locks) -> Vec<usize> {
    let edges: HashMap<&Id, [usize; 2]> = layout.edges.iter().map(|edge| (&edge.id, edge.ends)).collect();
    let nodes: HashMap<&Id, usize> = layout.nodes.iter().enumerate().map(|(k, node)| (&node.id, k)).collect();
    // What has to have a group in common: the ends of two lanes, or a vertex and the ends of a lane.
    let mut open: Vec<[Vec<usize>; 2]> = Vec::new();
    for lock in &locks.locks {
        if let (Some(a), Some(b)) = (edges.get(&lock.a), edges.get(&lock.b)) {
            open.push([a.to_vec(), b.to_vec()]);
        }
    }
    for lock in locks.nodes.iter().flatten() {
        if let (Some(&node), Some(edge)) = (nodes.get(&lock.node), edges.get(&lock.edge)) {
            open.push([vec![node], edge.to_vec()]);
        }
    }
    let mut group: Vec<usize> = (0..layout.nodes.len()).collect();
    let mut size = vec![1_usize; layout.nodes.len()];
    let distance = |a: usize, b: usize| {
        let [p, q] = [layout.nodes[a].at, layout.nodes[b].at];
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    loop {
        let common = |[a, b]: &[Vec<usize>; 2]| a.iter().any(|a| b.iter().any(|b| group[*a] == group[*b]));
        open.retain(|pair| !common(pair));
        let mut candidates: BTreeMap<[usize; 2], (usize, f64)> = BTreeMap::new();
        for [own, other] in &open {
            let pairs = own.iter().flat_map(|&a| other.iter().map(move |&b| (a, b)));
            let mut once = BTreeSet::new();
            for (a, b) in pairs {
                let key = [group[a].min(group[b]), group[a].max(group[b])];
                let entry = candidates.entry(key).or_insert((0, f64::INFINITY));
                entry.0 += usize::from(once.insert(key));
                entry.1 = entry.1.min(distance(a, b));
            }
        }
        let worth = |([a, b], (count, apart)): (&[usize; 2], &(usize, f64))| {
            (*count as f64 / (size[*a] * size[*b]) as f64, -apart)
        };
        let best = candidates.iter().max_by(|x, y| {
            let (x, y) = (worth((x.0, x.1)), worth((y.0, y.1)));
            x.0.total_cmp(&y.0).then(x.1.total_cmp(&y.1))
        });
        let Some((&[keep, gone], _)) = best else { return group };
        size[keep] += size[gone];
        group.iter_mut().filter(|group| **group == gone).for_each(|group| *group = keep);
    }
}

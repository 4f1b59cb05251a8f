//! Plant models of openTCS: blocks, or envelopes.
//!
//! Points and paths are resources of one vehicle each. A vehicle on a path holds the path and both of its points until
//! it reports that it is at the second point. With a resource it holds all blocks `SINGLE_VEHICLE_ONLY` that contain
//! it. If the vehicle has an envelope key, the envelopes of its resources with this key must not overlap those of
//! others.
//!
//! Blocks are written only for contacts that points do not exclude: two paths with a common point exclude each other.
//! Blocks of points are preferred, because a block of two points applies to all paths that end there.
//! `SAME_DIRECTION_ONLY` excludes no contact: it lets vehicles in that follow one another.

mod ids;
mod path_splitter;
#[cfg(test)]
mod tests;
mod version;
mod visual;

pub(crate) use path_splitter::split;

use crate::audit::groups;
use crate::clique_cover::cover;
use crate::convex_outline::{around, around_swept, depth, intersect};
use crate::options::{WriteNotes, WriteOptions};
use crate::stamp::{PROPERTY, VehicleStamp};
use crate::text_edits::{TextEdits, ending, indent};
use crate::{ExclusionRules, ResourceClaim};
use ids::Ids;
use pcr_formats::import::{ElementId, ImportError, ImportedLayout, Layout};
use pcr_formats::plane_geometry::hull;
use pcr_formats::scenario::PlacedSegment;
use pcr_formats::warning::WarningCode;
use pcr_planning::exclusion_table::{EdgeTraversals, ExclusionTable, SweptShape, corridor};
use roxmltree::{Document, Node};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;
use version::ModelVersion;
use visual::Visual;

/// Prefix of the names of blocks that are written here; such blocks are replaced when a file is written again.
const PREFIX: &str = "pcr-block-";

/// Colour of these blocks.
const COLOR: &str = "#A94022";

/// How far points at whole millimetres may be from where they are meant to be, and by how much envelopes reach beyond corridors for that
/// \[m\].
pub(crate) const ROUNDING: f64 = 1e-3;

fn parse(text: &str) -> Result<Document<'_>, ImportError> {
    Document::parse(text.trim_start_matches('\u{feff}')).map_err(|error| ImportError::of_xml(text, &error))
}

fn elements<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

fn name<'a>(node: Node<'a, '_>) -> &'a str {
    node.attribute("name").unwrap_or_default()
}

/// Indices of paths and points in the layout, by name: paths first.
fn resources(layout: &Layout) -> HashMap<String, usize> {
    let paths = layout.edges.iter().map(|edge| edge.id.to_string());
    let points = layout.nodes.iter().map(|node| node.id.to_string());
    paths.chain(points).enumerate().map(|(place, name)| (name, place)).collect()
}

/// Reads resources, blocks and envelopes.
pub(crate) fn read(text: &str, imported: &ImportedLayout) -> Result<ExclusionRules, ImportError> {
    let document = parse(text)?;
    let layout = &imported.layout;
    let ResourceTokens { tokens, names, warnings } = read_resources(document.root_element(), layout, |_| true)?;
    let blocks: Vec<Vec<usize>> = tokens
        .iter()
        .map(|tokens| {
            let of_blocks =
                tokens.iter().filter_map(|token| token.checked_sub(layout.edges.len() + layout.nodes.len()));
            of_blocks.filter(|block| *block < names.len()).collect()
        })
        .collect();
    let (of_paths, of_points) = blocks.split_at(layout.edges.len());
    let groups = groups(layout, &names, of_paths, of_points);
    let nodes: Vec<ResourceClaim> =
        tokens[layout.edges.len()..].iter().cloned().map(ResourceClaim::exclusive).collect();
    let edges = layout.edges.iter().enumerate().map(|(place, edge)| {
        let ends = edge.ends.iter().flat_map(|&end| &tokens[layout.edges.len() + end]);
        ResourceClaim::exclusive(tokens[place].iter().chain(ends).copied().collect())
    });
    let said = stamped(document.root_element()).map(|(_, said)| said);
    Ok(ExclusionRules { groups, warnings, ..ExclusionRules::of_edges(imported, edges.collect(), nodes) }.stamped(said))
}

/// What a vehicle has with each resource, paths first: tokens of the resource, of its blocks, and of envelopes that meet.
struct ResourceTokens {
    tokens: Vec<Vec<usize>>,
    /// Of the blocks.
    names: Vec<String>,
    warnings: Vec<String>,
}

/// Reads the blocks that are asked for by their names, and envelopes.
fn read_resources(
    root: Node<'_, '_>,
    layout: &Layout,
    is_asked: impl Fn(&str) -> bool,
) -> Result<ResourceTokens, ImportError> {
    let places = resources(layout);
    let count = layout.edges.len() + layout.nodes.len();
    // Each resource is a token of its own.
    let mut tokens: Vec<Vec<usize>> = (0..count).map(|place| vec![place]).collect();
    let (mut names, mut warnings) = (Vec::new(), Vec::new());
    let mut seen = BTreeSet::new();
    let locations: BTreeSet<&str> = elements(root, "location").map(name).collect();
    for block in elements(root, "block").filter(|block| is_asked(name(*block))) {
        if !seen.insert(name(block)) {
            return Err(ImportError::new(format!("block {}: there is another one of this name", name(block))));
        }
        if block.attribute("type").is_some_and(|kind| kind != "SINGLE_VEHICLE_ONLY") {
            warnings.push(WarningCode::UncountedExclusion.text(format_args!(
                "block {}: {} does not keep vehicles apart that follow one another; it is not counted",
                name(block),
                block.attribute("type").unwrap_or_default()
            )));
            continue;
        }
        for member in elements(block, "member").map(name) {
            match places.get(member) {
                Some(&place) => tokens[place].push(count + names.len()),
                None if locations.contains(member) => {}
                None => {
                    let problem = format!("block {}: there is no point, path or location {member}", name(block));
                    return Err(ImportError::new(problem));
                }
            }
        }
        names.push(name(block).to_owned());
    }
    envelopes(root, &places, count + names.len(), &mut tokens, &mut warnings)?;
    Ok(ResourceTokens { tokens, names, warnings })
}

/// Adds a token for every two resources of which the envelopes with the key of all vehicles meet.
fn envelopes(
    root: Node<'_, '_>,
    places: &HashMap<String, usize>,
    first: usize,
    tokens: &mut [Vec<usize>],
    warnings: &mut Vec<String>,
) -> Result<(), ImportError> {
    let keys: BTreeSet<Option<&str>> =
        elements(root, "vehicle").map(|vehicle| vehicle.attribute("envelopeKey")).collect();
    // Without a key a vehicle has no envelope.
    let key = keys.first().copied().flatten().filter(|_| keys.len() == 1);
    let mut outlines: Vec<(usize, Vec<[f64; 2]>)> = Vec::new();
    let mut other = false;
    for element in root.children().filter(|child| child.has_tag_name("point") || child.has_tag_name("path")) {
        for envelope in elements(element, "vehicleEnvelope") {
            if key.is_none() || envelope.attribute("key") != key {
                other = true;
                continue;
            }
            let vertex = |vertex: Node<'_, '_>| {
                let number = |attribute| vertex.attribute(attribute)?.trim().parse::<f64>().ok();
                Some([number("x")?, number("y")?])
            };
            let outline: Option<Vec<[f64; 2]>> = elements(envelope, "vertex").map(vertex).collect();
            let outline = outline.filter(|outline| !outline.is_empty()).ok_or_else(|| {
                ImportError::new(format!("{}, vehicleEnvelope: vertices are expected", name(element)))
            })?;
            if let Some(&place) = places.get(name(element)) {
                // A model has one for each key, and nobody knows which.
                if outlines.last().is_some_and(|(last, _)| *last == place) {
                    let problem = "vehicleEnvelope: there is another one with this key";
                    return Err(ImportError::new(format!("{}, {problem}", name(element))));
                }
                outlines.push((place, outline));
            }
        }
    }
    if other {
        let text = "envelopes: those that are not of the one key of all vehicles are not counted";
        warnings.push(WarningCode::UncountedExclusion.text(text));
    }
    let mut next = first;
    for (k, (a, own)) in outlines.iter().enumerate() {
        for (b, theirs) in &outlines[k + 1..] {
            if a != b && intersect(own, theirs) {
                tokens[*a].push(next);
                tokens[*b].push(next);
                next += 1;
            }
        }
    }
    Ok(())
}

/// Writes blocks, or envelopes if they are asked for.
pub(crate) fn write(
    text: &str,
    imported: &ImportedLayout,
    locks: &ExclusionTable,
    settings: &WriteOptions,
    notes: &mut WriteNotes,
) -> Result<String, ImportError> {
    let document = parse(text)?;
    let offset = text.len() - text.trim_start_matches('\u{feff}').len();
    let layout = &imported.layout;
    let mut names = BTreeSet::new();
    let all = layout.edges.iter().map(|edge| &edge.id).chain(layout.nodes.iter().map(|node| &node.id));
    for id in all.clone() {
        if !names.insert(id.to_string()) {
            return Err(ImportError::new(format!("{id}: a point and a path of one name cannot be told apart")));
        }
    }
    let there: BTreeSet<&str> = document.root_element().children().map(name).collect();
    if let Some(id) = all.into_iter().find(|id| !there.contains(id.to_string().as_str())) {
        return Err(ImportError::new(format!("{id}: the file has several of one name; a block cannot name them")));
    }
    let mut edits = TextEdits::default();
    let root = document.root_element();
    let prefixed = |child: &Node<'_, '_>| {
        let tag = text[child.range().start + offset..].split([' ', '\t', '\r', '\n', '/', '>']).next();
        child.is_element() && tag.is_some_and(|tag| tag.contains(':'))
    };
    if let Some(child) = root.children().find(prefixed) {
        let name = child.tag_name().name();
        return Err(ImportError::new(format!("{name}: names of elements with a prefix are not written")));
    }
    let version = ModelVersion::of(root)?;
    let model = Model { text, offset, root, version };
    if let Some(key) = &settings.envelopes {
        if !version.has_envelopes() {
            let problem = format!("--envelopes: models of version {version} have none; without it blocks are written");
            return Err(ImportError::new(problem));
        }
        notes.groups = write_envelopes(&model, imported, key, &mut edits)?;
    } else {
        write_blocks(&model, layout, locks, notes, &mut edits)?;
    }
    write_stamp(&model, imported, &mut edits)?;
    Ok(edits.apply(text))
}

/// What says in a model for which vehicle its exclusions were written, and what it says.
fn stamped<'a, 'i>(model: Node<'a, 'i>) -> Option<(Node<'a, 'i>, &'a str)> {
    let property = elements(model, "property").find(|property| name(*property) == PROPERTY);
    if let Some(property) = property {
        return Some((property, property.attribute("value").unwrap_or("nothing")));
    }
    let text = |comment: Node<'a, 'i>| comment.text().and_then(|text| text.trim().strip_prefix(PROPERTY));
    let mut comments = model.children().filter(Node::is_comment);
    comments.find_map(|comment| Some((comment, text(comment)?.trim())))
}

/// Says in a model for which vehicle its exclusions are: as the last of its properties or, where it has none, in a comment.
fn write_stamp(model: &Model<'_, '_>, imported: &ImportedLayout, edits: &mut TextEdits) -> Result<(), ImportError> {
    let &Model { text, offset, root, version } = model;
    let stamp = VehicleStamp::of(imported).text();
    let element = match version.has_properties() {
        true => format!("<property name=\"{PROPERTY}\" value=\"{}\"/>", escaped(&stamp)),
        false => format!("<!-- {PROPERTY} {stamp} -->"),
    };
    if let Some((old, _)) = stamped(root) {
        edits.replace(old.range().start + offset..old.range().end + offset, element);
        return Ok(());
    }
    let missing = || ImportError::new("model: there is nothing in it");
    let last = root.children().rfind(Node::is_element).ok_or_else(missing)?;
    let margin = indent(text, last.range().start + offset).unwrap_or("    ");
    edits.insert(last.range().end + offset, format!("{}{margin}{element}", ending(text)));
    Ok(())
}

/// Refuses a written model that has what its version has not, if the model before had not.
pub(crate) fn check(before: &str, after: &str) -> Result<(), ImportError> {
    let faults = |text: &str| -> Result<(ModelVersion, BTreeSet<String>), ImportError> {
        let document = parse(text)?;
        let version = ModelVersion::of(document.root_element())?;
        Ok((version, version::faults(document.root_element(), version)))
    };
    let ((version, known), (_, found)) = (faults(before)?, faults(after)?);
    match found.difference(&known).next() {
        None => Ok(()),
        Some(fault) => {
            Err(ImportError::new(format!("what would be written is no model of version {version}: {fault}")))
        }
    }
}

/// A model that is to be changed.
struct Model<'a, 'i> {
    text: &'a str,
    /// Offset of the document in the text.
    offset: usize,
    root: Node<'a, 'i>,
    version: ModelVersion,
}

/// What has to be in a block, and what may be: pairs of resources, paths first.
fn pairs(layout: &Layout, locks: &ExclusionTable) -> [Vec<[usize; 2]>; 2] {
    let paths: HashMap<&ElementId, usize> = layout.edges.iter().enumerate().map(|(k, edge)| (&edge.id, k)).collect();
    let points: HashMap<&ElementId, usize> = layout.nodes.iter().enumerate().map(|(k, node)| (&node.id, k)).collect();
    let ends = |path: usize| layout.edges[path].ends;
    let first = layout.edges.len();
    let ordered = |a: usize, b: usize| [a.min(b), a.max(b)];
    let two_points: BTreeSet<[usize; 2]> = (locks.node_pairs.iter().flatten())
        .filter_map(|[a, b]| Some(ordered(*points.get(a)?, *points.get(b)?)))
        .filter(|[a, b]| a != b)
        .collect();
    let point_path: BTreeSet<[usize; 2]> = (locks.nodes.iter().flatten())
        .filter_map(|lock| Some([*points.get(&lock.node)?, *paths.get(&lock.edge)?]))
        .filter(|[point, path]| !ends(*path).contains(point))
        .collect();
    let two_paths: BTreeSet<[usize; 2]> =
        locks.locks.iter().filter_map(|lock| Some(ordered(*paths.get(&lock.a)?, *paths.get(&lock.b)?))).collect();
    let by_points = |point: usize, path: usize| ends(path).iter().any(|&end| two_points.contains(&ordered(point, end)));
    let covered = |a: usize, b: usize| {
        let (own, other) = (ends(a), ends(b));
        own.iter().any(|end| other.contains(end) || by_points(*end, b) || point_path.contains(&[*end, b]))
            || other.iter().any(|end| point_path.contains(&[*end, a]))
    };
    let mut needed: Vec<[usize; 2]> = two_points.iter().map(|[a, b]| [first + a, first + b]).collect();
    let mixed = point_path.iter().filter(|[point, path]| !by_points(*point, *path));
    needed.extend(mixed.map(|[point, path]| [*path, first + point]));
    needed.extend(two_paths.iter().filter(|[a, b]| !covered(*a, *b)).copied());
    let mut allowed: Vec<[usize; 2]> = two_points.iter().map(|[a, b]| [first + a, first + b]).collect();
    allowed.extend(point_path.iter().map(|[point, path]| [*path, first + point]));
    allowed.extend(two_paths);
    [needed, allowed]
}

/// Whether a block has a name as they are given here.
fn is_ours(name: &str) -> bool {
    name.strip_prefix(PREFIX).is_some_and(|rest| rest.len() >= 4 && rest.bytes().all(|byte| byte.is_ascii_digit()))
}

fn write_blocks(
    &Model { text, offset, root, version }: &Model<'_, '_>,
    layout: &Layout,
    locks: &ExclusionTable,
    notes: &mut WriteNotes,
    edits: &mut TextEdits,
) -> Result<(), ImportError> {
    let [mut needed, allowed] = pairs(layout, locks);
    // What blocks and envelopes of the file exclude already needs no other block.
    let there = read_resources(root, layout, |name| !is_ours(name))?.tokens;
    let of = |place: usize| {
        let ends = layout.edges.get(place).into_iter().flat_map(|edge| edge.ends.map(|end| layout.edges.len() + end));
        let tokens = ends.chain([place]).flat_map(|place| there[place].iter().copied());
        ResourceClaim::exclusive(tokens.collect())
    };
    needed.retain(|[a, b]| !of(*a).excludes(&of(*b)));
    let cover = cover(layout.edges.len() + layout.nodes.len(), &allowed, &needed);
    (notes.groups, notes.at_least) = (cover.cliques.len(), Some(cover.at_least));
    let (old, kept): (Vec<Node<'_, '_>>, Vec<Node<'_, '_>>) =
        elements(root, "block").partition(|block| is_ours(name(*block)));
    let visual = Visual::of(root);
    let drawn = old.iter().filter_map(|block| visual.element(name(*block)));
    for element in old.iter().copied().chain(drawn) {
        let range = element.range();
        let from = text[..range.start + offset].trim_end().len();
        edits.replace(from..range.end + offset, "");
    }
    // Blocks come before the visual layout and the properties of the model.
    let after =
        |names: &[&str]| root.children().rfind(|child| child.is_element() && names.contains(&child.tag_name().name()));
    let last = kept.last().copied().or_else(|| after(&["location", "locationType", "vehicle", "path", "point"]));
    // A layout has points.
    let last = last.ok_or_else(|| ImportError::new("model: there is no point in it"))?;
    let at = last.range().end + offset;
    let margin = indent(text, last.range().start + offset).unwrap_or("    ").to_owned();
    let id = |place: usize| match place.checked_sub(layout.edges.len()) {
        None => &layout.edges[place].id,
        Some(point) => &layout.nodes[point].id,
    };
    // Names are those of one thing each in a model, of whatever kind.
    let taken: BTreeSet<&str> = root.children().filter(|child| !old.contains(child)).map(name).collect();
    let mut names = (1_u32..).map(|k| format!("{PREFIX}{k:04}")).filter(|name| !taken.contains(name.as_str()));
    let (mut blocks, mut drawn, end) = (String::new(), Vec::new(), ending(text));
    let mut ids = Ids::of(root, version, |element| old.contains(&element))?;
    let kind = if version.has_types_of_blocks() { " type=\"SINGLE_VEHICLE_ONLY\"" } else { "" };
    for (clique, name) in cover.cliques.iter().zip(&mut names) {
        let _ = write!(blocks, "{end}{margin}<block{} name=\"{name}\"{kind}>", ids.attribute());
        for place in clique {
            let _ = write!(blocks, "{end}{margin}    <member name=\"{}\"/>", escaped(&id(*place).to_string()));
        }
        if version.has_layouts() {
            let _ = write!(blocks, "{end}{margin}    <blockLayout color=\"{COLOR}\"/>");
        }
        let _ = write!(blocks, "{end}{margin}</block>");
        drawn.push(Visual::new_element(&name, "0", &[("COLOR", COLOR.to_owned())]));
    }
    edits.insert(at, blocks);
    visual.add(text, offset, &drawn, edits);
    Ok(())
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    text.replace('"', "&quot;").replace('\'', "&apos;")
}

/// The envelope of each point and path, by name: all that a vehicle may sweep there. Turns at the ends of a path are in the envelopes of its
/// points, which a vehicle on it holds as well.
fn envelope_outlines(imported: &ImportedLayout) -> BTreeMap<String, Vec<[f64; 2]>> {
    let (layout, rides) = (&imported.layout, EdgeTraversals::new(imported));
    let mut outlines: BTreeMap<String, Vec<[f64; 2]>> = BTreeMap::new();
    let has_outline = imported.vehicle.footprint.is_some();
    let standing = |node: usize| match has_outline {
        true => around_swept(&corridor(&[rides.at_node(node)]), ROUNDING),
        false => {
            let at = layout.position(node);
            around(&[PlacedSegment::line(at, at)], imported.vehicle.radius + imported.vehicle.margin + ROUNDING)
        }
    };
    for edge in &layout.edges {
        let outline = if has_outline {
            let points: Vec<Vec<[f64; 2]>> = edge.ends.map(standing).into();
            let is_held = |shape: &SweptShape| {
                let outline = around_swept(std::slice::from_ref(shape), 0.0);
                points.iter().any(|point| outline.iter().all(|&corner| depth(point, corner) >= 0.0))
            };
            let mut shapes = corridor(&rides.on_edge(edge));
            shapes.retain(|shape| !is_held(shape));
            // Of a path that hardly leads away from its points nothing else is left.
            if shapes.is_empty() { hull(points.concat()) } else { around_swept(&shapes, ROUNDING) }
        } else {
            let ends = edge.ends.map(|end| layout.position(end));
            let straight = || vec![PlacedSegment::line(ends[0], ends[1])];
            let curve = if edge.curve.is_empty() { straight() } else { edge.curve.clone() };
            around(&curve, imported.vehicle.radius + imported.vehicle.margin + edge.deviation + ROUNDING)
        };
        outlines.insert(edge.id.to_string(), outline);
    }
    outlines.extend((0..layout.nodes.len()).map(|node| (layout.nodes[node].id.to_string(), standing(node))));
    outlines
}

fn write_envelopes(
    &Model { text, offset, root, .. }: &Model<'_, '_>,
    imported: &ImportedLayout,
    key: &str,
    edits: &mut TextEdits,
) -> Result<usize, ImportError> {
    if elements(root, "vehicle").next().is_none() {
        return Err(ImportError::new("envelopes: there is no vehicle in the model that could have their key"));
    }
    let envelopes = envelope_outlines(imported);
    let mut count = 0;
    for element in root.children().filter(|child| child.has_tag_name("point") || child.has_tag_name("path")) {
        let Some(envelope) = envelopes.get(name(element)) else { continue };
        count += 1;
        let mut outline = millimetres(envelope);
        outline.extend(outline.first().copied());
        let vertices = outline.iter().map(|[x, y]| format!("<vertex x=\"{x}\" y=\"{y}\"/>")).collect::<String>();
        let envelope = format!("<vehicleEnvelope key=\"{}\">{vertices}</vehicleEnvelope>", escaped(key));
        let old = elements(element, "vehicleEnvelope").find(|old| old.attribute("key") == Some(key));
        if let Some(old) = old {
            edits.replace(old.range().start + offset..old.range().end + offset, envelope);
            continue;
        }
        // Before them come boxes and operations, in this order.
        let before = ["maxVehicleBoundingBox", "peripheralOperation", "vehicleEnvelope"];
        let last = element.children().rfind(|child| before.contains(&child.tag_name().name()));
        let first = element.children().find(Node::is_element);
        match (last, first) {
            (Some(last), _) => edits.insert(last.range().end + offset, envelope),
            (None, Some(first)) => edits.insert(first.range().start + offset, envelope),
            (None, None) => {
                let range = element.range().start + offset..element.range().end + offset;
                let tag = element.tag_name().name();
                // `<point .../>`, or `<point ...></point>`.
                match text[range.clone()].strip_suffix("/>") {
                    Some(open) => edits.replace(range.start + open.len()..range.end, format!(">{envelope}</{tag}>")),
                    None => {
                        let close = text[range.clone()].rfind("</").ok_or_else(|| {
                            ImportError::new(format!("{}: where the element ends cannot be told", name(element)))
                        })?;
                        edits.insert(range.start + close, envelope);
                    }
                }
            }
        }
    }
    for vehicle in elements(root, "vehicle") {
        let given = vehicle.attributes().find(|attribute| attribute.name() == "envelopeKey");
        match given {
            Some(given) => {
                let range = given.range_value();
                edits.replace(range.start + offset..range.end + offset, escaped(key));
            }
            None => {
                let at = vehicle.range().start + offset + "<vehicle".len();
                edits.insert(at, format!(" envelopeKey=\"{}\"", escaped(key)));
            }
        }
    }
    Ok(count)
}

/// The hull of corners at whole millimetres, each less than a millimetre from where it was.
fn millimetres(outline: &[[f64; 2]]) -> Vec<[i64; 2]> {
    let rounded = outline.iter().map(|corner| corner.map(|x| (x * 1e3).round())).collect();
    hull(rounded).into_iter().map(|corner| corner.map(|x| x as i64)).collect()
}

//! Cuts straight paths of a plant model into parts, with points in between.
//!
//! The routes of vehicles do not change. Each path has its own points, also if another path leads back along it, so
//! that no route begins, ends or turns around in between. The first part keeps the name of the path. A path with a
//! property that belongs to the whole of it is not cut.
//!
//! What new points are called, and where they say where they are, is that of the version of the model.

use super::ids::Ids;
use super::version::ModelVersion;
use super::visual::Visual;
use super::{elements, escaped, name, parse};
use crate::options::WriteNotes;
use crate::text_edits::{TextEdits, ending, indent};
use pcr_formats::import::{ImportError, ImportedLayout, LayoutEdge};
use pcr_formats::scenario::PathSegment;
use pcr_formats::warning::WarningCode;
use roxmltree::{Document, Node};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;
use std::ops::Range;

/// Shortest part \[m\]. Points are at whole millimetres; two shorter parts could differ in direction by more than 0.01 rad, at
/// which vehicles stop.
const LEAST: f64 = 0.3;

/// Cuts straight paths into equal parts of at most `most` \[m\]. Envelopes with the key will be written again.
pub(crate) fn split(
    text: &str,
    imported: &ImportedLayout,
    most: f64,
    key: Option<&str>,
    notes: &mut WriteNotes,
) -> Result<String, ImportError> {
    if most < LEAST {
        let problem = format!(
            "--split {most}: points of a plant model are at whole millimetres, and parts shorter than {LEAST} m would bend"
        );
        return Err(ImportError::new(problem));
    }
    let document = parse(text)?;
    let mut cutter = OpenTcsPathSplitter::new(text, &document, imported)?;
    let mut left_whole: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for path in elements(document.root_element(), "path") {
        let Some(edge) = cutter.edges.get(name(path)).copied() else { continue };
        let parts = (edge.length() / most - 1e-9).ceil();
        if parts < 2.0 {
            continue;
        }
        match cutter.belongs_to_all(path, edge, key) {
            Some(reason) => left_whole.entry(reason).or_default().push(name(path)),
            None => cutter.cut(path, parts as u32)?,
        }
    }
    let said =
        left_whole.into_iter().map(|(reason, names)| format!("paths left whole, {reason}: {}", names.join(", ")));
    notes.warnings.extend(said.map(|text: String| WarningCode::LeftWhole.text(text)));
    notes.warnings.extend(cutter.strange.iter().map(|name| {
        let version = cutter.version;
        let text =
            format_args!("point, {name}: models of version {version} do not have it; openTCS loads no such file");
        WarningCode::UnknownKey.text(text)
    }));
    if !cutter.of_one_cost.is_empty() {
        let names = cutter.of_one_cost.join(", ");
        let text = format_args!("routingCost: smaller than the number of parts, so each part has it: {names}");
        notes.warnings.push(WarningCode::UnsharedCost.text(text));
    }
    Ok(cutter.made())
}

/// A coordinate in millimetres, where it is said.
fn coordinate(node: Node<'_, '_>, what: &str, attribute: &str) -> Result<Option<f64>, ImportError> {
    let Some(text) = node.attribute(attribute) else { return Ok(None) };
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    let problem = || ImportError::new(format!("{what}, {attribute}: {text:?} where a number is expected"));
    number.map(Some).ok_or_else(problem)
}

/// A coordinate in millimetres that has to be said.
fn needed(node: Node<'_, '_>, what: &str, attribute: &str) -> Result<f64, ImportError> {
    let problem = || ImportError::new(format!("{what}, {attribute}: missing, which is where its version has it"));
    coordinate(node, what, attribute)?.ok_or_else(problem)
}

/// The names of the points at the ends of a path.
fn ends<'a>(path: Node<'a, '_>) -> Option<[&'a str; 2]> {
    Some([path.attribute("sourcePoint")?, path.attribute("destinationPoint")?])
}

/// Interpolates between two values, rounded to a whole number.
fn between([from, to]: [f64; 2], k: u32, parts: u32) -> i64 {
    (from + (to - from) * f64::from(k) / f64::from(parts)).round() as i64
}

struct OpenTcsPathSplitter<'a, 'i> {
    text: &'a str,
    /// Offset of the document in the text.
    offset: usize,
    /// Its line ending.
    end: &'static str,
    root: Node<'a, 'i>,
    version: ModelVersion,
    ids: Ids,
    visual: Visual<'a, 'i>,
    points: HashMap<&'a str, Node<'a, 'i>>,
    edges: HashMap<String, &'a LayoutEdge>,
    /// Members of blocks for vehicles in the same direction.
    of_one_direction: BTreeSet<&'a str>,
    /// Points one after the other on static routes.
    hops: BTreeSet<[&'a str; 2]>,
    /// Attributes for places that the version does not have.
    strange: BTreeSet<&'static str>,
    /// Paths whose routing cost could not be shared by their parts.
    of_one_cost: Vec<&'a str>,
    /// Names in the file, and new names.
    taken: BTreeSet<String>,
    added: String,
    /// New elements of the visual layout.
    drawn: Vec<String>,
    /// For each path that was cut, its parts other than the first one.
    resources: HashMap<&'a str, Vec<String>>,
    edits: TextEdits,
}

impl<'a, 'i> OpenTcsPathSplitter<'a, 'i> {
    fn new(text: &'a str, document: &'a Document<'i>, imported: &'a ImportedLayout) -> Result<Self, ImportError> {
        let root = document.root_element();
        let version = ModelVersion::of(root)?;
        let single = |block: &Node<'_, '_>| block.attribute("type").is_none_or(|kind| kind == "SINGLE_VEHICLE_ONLY");
        let others = elements(root, "block").filter(|block| !single(block));
        let mut hops = BTreeSet::new();
        for route in elements(root, "staticRoute") {
            let points: Vec<&str> = elements(route, "hop").map(name).collect();
            hops.extend(points.windows(2).map(|pair| [pair[0], pair[1]]));
        }
        Ok(Self {
            text,
            offset: text.len() - text.trim_start_matches('\u{feff}').len(),
            end: ending(text),
            root,
            version,
            ids: Ids::of(root, version, |_| false)?,
            visual: Visual::of(root),
            points: elements(root, "point").map(|point| (name(point), point)).collect(),
            edges: imported.layout.edges.iter().map(|edge| (edge.id.to_string(), edge)).collect(),
            of_one_direction: others.flat_map(|block| elements(block, "member")).map(name).collect(),
            hops,
            strange: BTreeSet::new(),
            of_one_cost: Vec::new(),
            taken: root.children().map(|child| name(child).to_owned()).collect(),
            added: String::new(),
            drawn: Vec::new(),
            resources: HashMap::new(),
            edits: TextEdits::default(),
        })
    }

    fn span(&self, range: Range<usize>) -> Range<usize> {
        range.start + self.offset..range.end + self.offset
    }

    /// The white space before an element at the start of its line.
    fn margin(&self, element: Node<'_, '_>) -> &'a str {
        indent(self.text, element.range().start + self.offset).unwrap_or("    ")
    }

    /// An unused name.
    fn fresh(&mut self, mut wanted: String) -> String {
        while !self.taken.insert(wanted.clone()) {
            wanted.push('+');
        }
        wanted
    }

    /// The reason why a path cannot be cut.
    fn belongs_to_all(&self, path: Node<'_, '_>, edge: &LayoutEdge, key: Option<&str>) -> Option<&'static str> {
        let straight = matches!(&edge.curve[..], [only] if matches!(only.shape, PathSegment::Line { .. }));
        let other_envelope = |envelope: Node<'_, '_>| key.is_none() || envelope.attribute("key") != key;
        if !straight || edge.deviation > 0.0 {
            Some("as a part of their curves, written in the units of the visual layout, would be another curve")
        } else if elements(path, "peripheralOperation").next().is_some() {
            Some("as their operations belong to all of them")
        } else if elements(path, "property").next().is_some() {
            Some("as their properties belong to all of them")
        } else if elements(path, "vehicleEnvelope").any(other_envelope) {
            Some("as their envelopes are around all of them")
        } else if self.of_one_direction.contains(name(path)) {
            Some("as their blocks ask by which path vehicles come in")
        } else if elements(path, "typeActions").next().is_some() {
            Some("as their actions are at distances along all of them")
        } else if ends(path).is_some_and(|ends| self.hops.contains(&ends)) {
            Some("as static routes lead over them")
        } else {
            None
        }
    }

    fn cut(&mut self, path: Node<'a, 'i>, parts: u32) -> Result<(), ImportError> {
        let called = name(path);
        let unknown = || ImportError::new(format!("path {called}: its points are not in the model"));
        let ends = ends(path).ok_or_else(unknown)?;
        let [Some(from), Some(to)] = ends.map(|end| self.points.get(end).copied()) else { return Err(unknown()) };
        let what = format!("path {called}");
        let length = self.edges[called].length();
        let mut points = vec![ends[0].to_owned()];
        points.extend(
            (1..parts).map(|k| self.fresh(format!("{called}+{:.3}", length * f64::from(k) / f64::from(parts)))),
        );
        points.push(ends[1].to_owned());
        let mut names = vec![called.to_owned()];
        names.extend((2..=parts).map(|k| self.fresh(format!("{called} part {k}"))));
        let typed = coordinate(path, &what, "length")?;
        let cost = coordinate(path, &what, "routingCost")?;
        let of_one_cost = cost.is_some_and(|cost| cost.abs() < f64::from(parts));
        if of_one_cost {
            self.of_one_cost.push(called);
        }
        // The parts have together what the path has.
        let share = |whole: Option<f64>, k: u32| {
            whole.map(|all| between([0.0, all], k + 1, parts) - between([0.0, all], k, parts))
        };
        let mut copies = Vec::new();
        for ((k, ends), name) in (0..parts).zip(points.windows(2)).zip(&names) {
            let changed = [
                ("id", if k == 0 { None } else { self.ids.next().map(|id| id.to_string()) }),
                ("name", Some(name.clone())),
                ("sourcePoint", Some(ends[0].clone())),
                ("destinationPoint", Some(ends[1].clone())),
                ("length", share(typed, k).map(|length| length.max(1).to_string())),
                ("routingCost", share(cost.filter(|_| !of_one_cost), k).map(|cost| cost.to_string())),
            ];
            copies.push(self.copy(path, &changed));
            if let Some(element) = self.visual.element(called).filter(|_| k > 0) {
                let copy = self.copy(element, &[("visualizedObjectName", Some(name.clone()))]);
                self.drawn.push(copy);
            }
        }
        let copies = copies.join(&format!("{}{}", self.end, self.margin(path)));
        for (k, (point, out)) in (1..parts).zip(points[1..].iter().zip(&names[1..])) {
            self.add_point(path, [from, to], [k, parts], [point, out])?;
        }
        self.edits.replace(self.span(path.range()), copies);
        let inner = points.len() - 1;
        self.resources.insert(called, names.drain(1..).chain(points.drain(1..inner)).collect());
        Ok(())
    }

    /// Adds the point after so many of all parts of a path, with its name and that of the path from there.
    fn add_point(
        &mut self,
        path: Node<'a, 'i>,
        ends: [Node<'a, 'i>; 2],
        [k, parts]: [u32; 2],
        [point, out]: [&str; 2],
    ) -> Result<(), ImportError> {
        let (version, end, margin) = (self.version, self.end, self.margin(ends[0]));
        let what = ends.map(|end| format!("point {}", name(end)));
        // A file may say it as another version does; openTCS does not load it, before or after.
        let says = |names: &[&str; 3]| ends.iter().all(|end| names[..2].iter().all(|name| end.has_attribute(*name)));
        let [usual, _] = version.places();
        let [x, y, z] = version.places().into_iter().find(says).unwrap_or(usual);
        if x != usual[0] {
            self.strange.insert(x);
        }
        let mut own = [[0.0; 2]; 2];
        for (k, end) in ends.iter().enumerate() {
            own[k] = [needed(*end, &what[k], x)?, needed(*end, &what[k], y)?];
        }
        let mut places: Vec<(&str, i64)> = [x, y]
            .into_iter()
            .enumerate()
            .map(|(at, name)| (name, between([own[0][at], own[1][at]], k, parts)))
            .collect();
        let heights = [0, 1].map(|k| coordinate(ends[k], &what[k], z));
        match heights {
            [Err(error), _] | [_, Err(error)] => return Err(error),
            // Before version 6 a point that says nothing is at height 0.
            [Ok(None), Ok(None)] if !version.has_boxes() => {}
            [Ok(low), Ok(high)] => {
                if version.has_boxes() {
                    needed(ends[0], &what[0], z)?;
                    needed(ends[1], &what[1], z)?;
                }
                places.push((z, between([low.unwrap_or(0.0), high.unwrap_or(0.0)], k, parts)));
            }
        }
        let attributes = places.iter().map(|(name, at)| format!(" {name}=\"{at}\"")).collect::<String>();
        let _ = write!(
            self.added,
            "{end}{margin}<point{} name=\"{}\"{attributes} vehicleOrientationAngle=\"NaN\" type=\"HALT_POSITION\">",
            self.ids.attribute(),
            escaped(point)
        );
        // A vehicle that may go to the end of the path may go to its new points.
        match elements(ends[1], "maxVehicleBoundingBox").next() {
            Some(room) => {
                let _ = write!(self.added, "{end}{margin}    {}", &self.text[self.span(room.range())]);
            }
            None if version.has_boxes() => {
                let problem =
                    "maxVehicleBoundingBox: missing, and new points have to have that of the end of their path";
                return Err(ImportError::new(format!("{}, {problem}", what[1])));
            }
            None => {}
        }
        let _ = write!(self.added, "{end}{margin}    <outgoingPath name=\"{}\"/>", escaped(out));
        let layer = elements(path, "pathLayout").find_map(|layout| layout.attribute("layerId"));
        if let Some(layer) = layer.filter(|_| version.has_layouts()) {
            let drawn = match version.drawn() {
                None => String::new(),
                Some(names) => {
                    let mut drawn = own;
                    for (k, end) in ends.iter().enumerate() {
                        // A point without a layout is drawn where it is.
                        let Some(layout) = elements(*end, "pointLayout").next() else { continue };
                        drawn[k] = [needed(layout, &what[k], names[0])?, needed(layout, &what[k], names[1])?];
                    }
                    let place = |at: usize| between([drawn[0][at], drawn[1][at]], k, parts);
                    format!("{}=\"{}\" {}=\"{}\" ", names[0], place(0), names[1], place(1))
                }
            };
            let [x, y] = version.label();
            let layout = format!("<pointLayout {drawn}{x}=\"-10\" {y}=\"-20\" layerId=\"{}\"/>", escaped(layer));
            let _ = write!(self.added, "{end}{margin}    {layout}");
        }
        let _ = write!(self.added, "{end}{margin}</point>");
        self.draw_point(ends, [k, parts], point)
    }

    /// Adds what the visual layout says of a new point, if it says something of both ends of its path.
    fn draw_point(&mut self, ends: [Node<'a, 'i>; 2], [k, parts]: [u32; 2], point: &str) -> Result<(), ImportError> {
        let [Some(from), Some(to)] = ends.map(|end| self.visual.element(name(end))) else { return Ok(()) };
        let mut values = Vec::new();
        for key in ["POSITION_X", "POSITION_Y"] {
            let given = [from, to].map(|element| Visual::value(element, key));
            let [Some(low), Some(high)] = given else { continue };
            let number = |text: &str| {
                let problem = || ImportError::new(format!("visualLayout, {key}: {text:?} where a number is expected"));
                text.parse::<f64>().ok().filter(|number| number.is_finite()).ok_or_else(problem)
            };
            values.push((key, between([number(low)?, number(high)?], k, parts).to_string()));
        }
        let layer = from.attribute("layer").or(to.attribute("layer"));
        let layer = layer.ok_or_else(|| ImportError::new("visualLayout, modelLayoutElement, layer: missing"))?;
        self.drawn.push(Visual::new_element(point, layer, &values));
        Ok(())
    }

    /// The text of a path with other attributes.
    fn copy(&self, path: Node<'_, '_>, changed: &[(&str, Option<String>)]) -> String {
        let begin = path.range().start;
        let mut edits = TextEdits::default();
        for (attribute, value) in changed {
            if let (Some(old), Some(value)) = (path.attribute_node(*attribute), value) {
                let range = old.range_value();
                edits.replace(range.start - begin..range.end - begin, escaped(value));
            }
        }
        edits.apply(&self.text[self.span(path.range())])
    }

    /// The model with the cut paths. Blocks that contain a path contain all of its parts.
    fn made(mut self) -> String {
        if let Some(last) = elements(self.root, "point").last() {
            self.edits.insert(last.range().end + self.offset, std::mem::take(&mut self.added));
        }
        self.visual.add(self.text, self.offset, &self.drawn, &mut self.edits);
        let groups = self.root.children().filter(|child| child.has_tag_name("block") || child.has_tag_name("group"));
        for member in groups.flat_map(|group| elements(group, "member")) {
            let margin = self.margin(member);
            for further in self.resources.get(name(member)).into_iter().flatten() {
                let at = member.range().end + self.offset;
                self.edits.insert(at, format!("{}{margin}<member name=\"{}\"/>", self.end, escaped(further)));
            }
        }
        self.edits.apply(self.text)
    }
}

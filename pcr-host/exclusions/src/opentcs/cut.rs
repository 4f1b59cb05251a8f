//! Cuts straight paths of a plant model into parts, with points in between.
//!
//! The routes of vehicles do not change. Each path has its own points, also if another path leads back along it, so
//! that no route begins, ends or turns around in between. The first part keeps the name of the path. A path with a
//! property that belongs to the whole of it is not cut.

use super::{elements, escaped, name, parse};
use crate::edit::{Edits, ending, indent};
use crate::settings::Notes;
use pcr_formats::import::{Edge, ImportError, Imported};
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
    imported: &Imported,
    most: f64,
    key: Option<&str>,
    notes: &mut Notes,
) -> Result<String, ImportError> {
    if most < LEAST {
        let problem = format!(
            "--split {most}: points of a plant model are at whole millimetres, and parts shorter than {LEAST} m would bend"
        );
        return Err(ImportError::new(problem));
    }
    let document = parse(text)?;
    let mut cutter = Cutter::new(text, &document, imported);
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
    notes.said.extend(said.map(|text: String| WarningCode::LeftWhole.text(text)));
    Ok(cutter.made())
}

struct Cutter<'a, 'i> {
    text: &'a str,
    /// Offset of the document in the text.
    offset: usize,
    /// Its line ending.
    end: &'static str,
    root: Node<'a, 'i>,
    points: HashMap<&'a str, Node<'a, 'i>>,
    edges: HashMap<String, &'a Edge>,
    /// Members of blocks for vehicles in the same direction.
    of_one_direction: BTreeSet<&'a str>,
    /// Names in the file, and new names.
    taken: BTreeSet<String>,
    added: String,
    /// For each path that was cut, its parts other than the first one.
    resources: HashMap<&'a str, Vec<String>>,
    edits: Edits,
}

impl<'a, 'i> Cutter<'a, 'i> {
    fn new(text: &'a str, document: &'a Document<'i>, imported: &'a Imported) -> Self {
        let root = document.root_element();
        let single = |block: &Node<'_, '_>| block.attribute("type").is_none_or(|kind| kind == "SINGLE_VEHICLE_ONLY");
        let others = elements(root, "block").filter(|block| !single(block));
        Self {
            text,
            offset: text.len() - text.trim_start_matches('\u{feff}').len(),
            end: ending(text),
            root,
            points: elements(root, "point").map(|point| (name(point), point)).collect(),
            edges: imported.layout.edges.iter().map(|edge| (edge.id.to_string(), edge)).collect(),
            of_one_direction: others.flat_map(|block| elements(block, "member")).map(name).collect(),
            taken: root.children().map(|child| name(child).to_owned()).collect(),
            added: String::new(),
            resources: HashMap::new(),
            edits: Edits::default(),
        }
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
    fn belongs_to_all(&self, path: Node<'_, '_>, edge: &Edge, key: Option<&str>) -> Option<&'static str> {
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
        } else {
            None
        }
    }

    fn cut(&mut self, path: Node<'a, 'i>, parts: u32) -> Result<(), ImportError> {
        let ends = ["sourcePoint", "destinationPoint"].map(|end| path.attribute(end).unwrap_or_default());
        let [Some(from), Some(to)] = ends.map(|end| self.points.get(end).copied()) else { return Ok(()) };
        let number = |node: Node<'_, '_>, attribute| node.attribute(attribute)?.trim().parse::<f64>().ok();
        let at = |attribute: &'static str| [from, to].map(|point| number(point, attribute).unwrap_or_default());
        let typed = number(path, "length");
        let share =
            |[from, to]: [f64; 2], k: u32| (from + (to - from) * f64::from(k) / f64::from(parts)).round() as i64;
        let (called, length) = (name(path), self.edges[name(path)].length());
        let mut points = vec![ends[0].to_owned()];
        points.extend(
            (1..parts).map(|k| self.fresh(format!("{called}+{:.3}", length * f64::from(k) / f64::from(parts)))),
        );
        points.push(ends[1].to_owned());
        let mut names = vec![called.to_owned()];
        names.extend((2..=parts).map(|k| self.fresh(format!("{called} part {k}"))));
        let margin = self.margin(from);
        let layer = elements(path, "pathLayout").find_map(|layout| layout.attribute("layerId"));
        let copies = (0..parts).zip(points.windows(2)).zip(&names).map(|((k, ends), name)| {
            let length = typed.map(|typed| (share([0.0, typed], k + 1) - share([0.0, typed], k)).max(1).to_string());
            let changed = [
                ("name", Some(name.clone())),
                ("sourcePoint", Some(ends[0].clone())),
                ("destinationPoint", Some(ends[1].clone())),
                ("length", length),
            ];
            self.copy(path, &changed)
        });
        let copies = copies.collect::<Vec<_>>().join(&format!("{}{}", self.end, self.margin(path)));
        for (k, (point, out)) in (1..parts).zip(points[1..].iter().zip(&names[1..])) {
            let [x, y, z] = ["positionX", "positionY", "positionZ"].map(|attribute| share(at(attribute), k));
            let end = self.end;
            let _ = write!(
                self.added,
                "{end}{margin}<point name=\"{}\" positionX=\"{x}\" positionY=\"{y}\" positionZ=\"{z}\" vehicleOrientationAngle=\"NaN\" type=\"HALT_POSITION\">",
                escaped(point)
            );
            // A vehicle that may go to the end of the path may go to its new points.
            if let Some(room) = elements(to, "maxVehicleBoundingBox").next() {
                let _ = write!(self.added, "{end}{margin}    {}", &self.text[self.span(room.range())]);
            }
            let _ = write!(self.added, "{end}{margin}    <outgoingPath name=\"{}\"/>", escaped(out));
            if let Some(layer) = layer {
                let layout = format!("<pointLayout labelOffsetX=\"-10\" labelOffsetY=\"-20\" layerId=\"{layer}\"/>");
                let _ = write!(self.added, "{end}{margin}    {layout}");
            }
            let _ = write!(self.added, "{end}{margin}</point>");
        }
        self.edits.replace(self.span(path.range()), copies);
        let inner = points.len() - 1;
        self.resources.insert(called, names.drain(1..).chain(points.drain(1..inner)).collect());
        Ok(())
    }

    /// The text of a path with other attributes.
    fn copy(&self, path: Node<'_, '_>, changed: &[(&str, Option<String>)]) -> String {
        let begin = path.range().start;
        let mut edits = Edits::default();
        for (attribute, value) in changed {
            if let (Some(old), Some(value)) = (path.attribute_node(*attribute), value) {
                let range = old.range_value();
                edits.replace(range.start - begin..range.end - begin, escaped(value));
            }
        }
        edits.made(&self.text[self.span(path.range())])
    }

    /// The model with the cut paths. Blocks that contain a path contain all of its parts.
    fn made(mut self) -> String {
        if let Some(last) = elements(self.root, "point").last() {
            self.edits.insert(last.range().end + self.offset, std::mem::take(&mut self.added));
        }
        for member in elements(self.root, "block").flat_map(|block| elements(block, "member")) {
            let margin = self.margin(member);
            for further in self.resources.get(name(member)).into_iter().flatten() {
                let at = member.range().end + self.offset;
                self.edits.insert(at, format!("{}{margin}<member name=\"{}\"/>", self.end, escaped(further)));
            }
        }
        self.edits.made(self.text)
    }
}

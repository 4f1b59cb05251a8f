//! Lanes cut into parts, and one lane for each direction.

use super::{RmfDialect, own, place_of, placed, typed};
use crate::options::WriteNotes;
use crate::text_edits::{TextEdits, column, ending, rest_of_line};
use pcr_formats::import::{ImportError, ImportedLayout};
use pcr_formats::warning::WarningCode;
use pcr_formats::yaml::{CollectionStyle, YamlNode, YamlValue};
use std::collections::{BTreeMap, HashMap};

/// Cuts lanes into equal parts no longer than `most` \[m\], if that is asked for, and makes two lanes of each that leads both ways.
pub(crate) fn prepare(
    text: &str,
    imported: &ImportedLayout,
    most: Option<f64>,
    notes: &mut WriteNotes,
) -> Result<String, ImportError> {
    let (form, root) = placed(text)?;
    let mut edits = TextEdits::default();
    let lanes: HashMap<(&str, usize), usize> =
        imported.layout.edges.iter().enumerate().filter_map(|(k, edge)| Some((place_of(&edge.id)?, k))).collect();
    for level in root.get("levels").map_or(&[][..], YamlNode::members) {
        let (name, level) = (level.key.text().unwrap_or_default(), &level.value);
        let (Some(list), Some(vertices)) = (level.get("lanes"), level.get("vertices")) else { continue };
        let mut cutter = RmfLaneSplitter { form, at: corners(vertices), added: Vec::new(), between: BTreeMap::new() };
        let mut further = Vec::new();
        for (k, lane) in list.list().iter().enumerate() {
            let Some(edge) = lanes.get(&(name, k)).map(|&edge| &imported.layout.edges[edge]) else { continue };
            let mut parts = most.map_or(1.0, |most| (edge.length() / most - 1e-9).ceil().max(1.0)) as usize;
            if let Some(reason) = whole(lane).filter(|_| parts > 1) {
                let text = format_args!("lane {} is left whole: {reason}", edge.id);
                notes.warnings.push(WarningCode::LeftWhole.text(text));
                parts = 1;
            }
            if parts == 1 && !edge.is_two_way() {
                continue;
            }
            own(lane, "lanes", &edge.id)?;
            if lane.list().get(RmfDialect::LANE).is_some_and(|parameters| parameters.get("<<").is_some()) {
                // A copy for one direction or part would still have what is merged.
                return Err(ImportError::new(format!(
                    "lanes {}: its parameters have a merge key (<<), and it has to become several lanes; write out what is merged",
                    edge.id
                )));
            }
            let ends =
                [0, 1].map(|k| lane.list().get(k).and_then(YamlNode::text).and_then(|text| text.parse::<usize>().ok()));
            let [Some(from), Some(to)] = ends else {
                return Err(ImportError::new(format!("lanes {}: indices of two vertices are expected", edge.id)));
            };
            let chain = cutter
                .chain([from, to], parts)
                .ok_or_else(|| ImportError::new(format!("lanes {}: places of its vertices are expected", edge.id)))?;
            let ways: &[bool] = if edge.is_two_way() { &[false, true] } else { &[false] };
            let mut copies = Vec::new();
            for &back in ways {
                let mut chain = chain.clone();
                if back {
                    chain.reverse();
                }
                copies.extend(chain.windows(2).map(|pair| copy(text, lane, [pair[0], pair[1]], back)));
            }
            edits.replace(lane.span.clone(), copies.remove(0));
            let at = column(text, lane.span.start);
            further.extend(copies.into_iter().map(|copy| (at, copy)));
        }
        append(&mut edits, text, list, &further);
        let at = vertices.list().last().map_or(0, |last| column(text, last.span.start));
        let added: Vec<(usize, String)> = cutter.added.into_iter().map(|vertex| (at, vertex)).collect();
        append(&mut edits, text, vertices, &added);
    }
    Ok(edits.apply(text))
}

/// Why a lane cannot be cut.
fn whole(lane: &YamlNode<'_>) -> Option<&'static str> {
    let has = |name: &str| typed(lane.list().get(RmfDialect::LANE), name).is_some_and(|value| !value.is_empty());
    if has("demo_mock_floor_name") || has("demo_mock_lift_name") {
        Some("it stands for a lift")
    } else if has("dock_name") {
        Some("a robot docks along all of it")
    } else if has("door_name") {
        Some("its door is open along all of it")
    } else {
        None
    }
}

/// Positions of the vertices, as in the file.
fn corners(vertices: &YamlNode<'_>) -> Vec<Option<[f64; 2]>> {
    let number = |vertex: &YamlNode<'_>, k: usize| vertex.list().get(k)?.text()?.parse::<f64>().ok();
    vertices.list().iter().map(|vertex| Some([number(vertex, 0)?, number(vertex, 1)?])).collect()
}

struct RmfLaneSplitter {
    form: RmfDialect,
    at: Vec<Option<[f64; 2]>>,
    added: Vec<String>,
    between: BTreeMap<(usize, usize, usize), Vec<usize>>,
}

impl RmfLaneSplitter {
    /// The vertices along a lane, new ones where no other lane has been cut between the same two.
    fn chain(&mut self, [from, to]: [usize; 2], parts: usize) -> Option<Vec<usize>> {
        let (low, high) = (from.min(to), from.max(to));
        let (a, b) = (self.at.get(low).copied()??, self.at.get(high).copied()??);
        let first = self.at.len();
        let (form, at, added) = (self.form, &mut self.at, &mut self.added);
        let cut = self.between.entry((low, high, parts)).or_insert_with(|| {
            for k in 1..parts {
                let share = k as f64 / parts as f64;
                let point = [0, 1].map(|k| a[k] + (b[k] - a[k]) * share);
                at.push(Some(point));
                added.push(form.vertex(point));
            }
            (first..first + parts - 1).collect()
        });
        let mut chain = vec![low];
        chain.extend(cut.iter().copied());
        chain.push(high);
        if from > to {
            chain.reverse();
        }
        Some(chain)
    }
}

/// The text of a lane with other ends, for one way only.
fn copy(text: &str, lane: &YamlNode<'_>, ends: [usize; 2], back: bool) -> String {
    let begin = lane.span.start;
    let mut edits = TextEdits::default();
    let mut replace =
        |old: &YamlNode<'_>, new: &str| edits.replace(old.span.start - begin..old.span.end - begin, old.instead(new));
    for (end, old) in ends.iter().zip(lane.list()) {
        replace(old, &end.to_string());
    }
    let parameters = lane.list().get(RmfDialect::LANE);
    if let Some(two_way) = parameters.and_then(|parameters| parameters.get("bidirectional")) {
        replace(two_way, "[4, false]");
    }
    if back && let Some(orientation) = parameters.and_then(|parameters| parameters.get("orientation")) {
        let turned = match typed(parameters, "orientation") {
            Some("forward") => Some("backward"),
            Some("backward") => Some("forward"),
            _ => None,
        };
        if let Some(turned) = turned {
            replace(orientation, &format!("[1, \"{turned}\"]"));
        }
    }
    edits.apply(&text[lane.span.clone()])
}

/// Adds elements to the end of a list, a line each where it has a line each. Each comes with the column in which its text began.
fn append(edits: &mut TextEdits, text: &str, list: &YamlNode<'_>, further: &[(usize, String)]) {
    let YamlValue::Sequence(style, elements) = &list.value else { return };
    let Some(last) = elements.last() else { return };
    let margin = column(text, list.span.start);
    let element = |(at, element): &(usize, String)| match style {
        CollectionStyle::Flow => format!(", {element}"),
        CollectionStyle::Block => {
            // An element that is a block has its further lines in the same column.
            let gap = at.saturating_sub(margin + 1).max(1);
            format!("{}{}-{}{element}", ending(text), " ".repeat(margin), " ".repeat(gap))
        }
    };
    let end = match style {
        CollectionStyle::Flow => last.span.end,
        CollectionStyle::Block => rest_of_line(text, last.span.end),
    };
    edits.insert(end, further.iter().map(element).collect::<String>());
}

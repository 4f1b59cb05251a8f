//! Roadmaps of Continuous-CBS, in GraphML, that were changed on purpose.

use crate::import_generated::{Meaning, Point, Way, options, points};
use crate::import_generated_xml::{Element, Format, Tally, change};
use pcr_formats::import::{InputFormat, Warnings, layout};
use std::collections::BTreeMap;

/// What a roadmap says; `None` if it does not say what it has to.
fn meaning(root: &Element) -> Option<Meaning> {
    let graph = root.all("graph").next()?;
    let mut places = BTreeMap::<&str, Point>::new();
    for node in graph.all("node") {
        let (x, y) = node.all("data").next()?.content().split_once(',')?;
        places.insert(node.get("id")?, [x.parse().ok()?, y.parse().ok()?]);
    }
    let mut ways = Meaning::new();
    for edge in graph.all("edge") {
        let [from, to] = ["source", "target"].map(|end| edge.get(end).and_then(|end| places.get(end)).copied());
        let (name, ends) = (edge.get("id").unwrap_or("one"), [from?, to?]);
        let one_way = match (edge.get("directed"), graph.get("edgedefault")) {
            (Some(own), _) => own == "true",
            (None, default) => default? == "directed",
        };
        ways.insert(name.to_owned(), Way::along(&ends, 0.0, None));
        if !one_way {
            ways.insert(format!("{name} back"), Way::along(&[ends[1], ends[0]], 0.0, None));
        }
    }
    Some(ways)
}

fn imported(root: &Element) -> Result<(Meaning, Vec<String>), String> {
    let mut warnings = Warnings::default();
    let read = layout(InputFormat::Ccbs, &root.text(), &options(), &mut warnings).map_err(|error| error.to_string())?;
    let mut ways = Meaning::new();
    for edge in &read.layout.edges {
        let there = points(&edge.curve);
        let back: Vec<Point> = there.iter().rev().copied().collect();
        for (is_open, way, name) in [(edge.ways[0], there, ""), (edge.ways[1], back, " back")] {
            if is_open {
                let id = edge.id.to_string();
                let id = if id.starts_with("at place") { "one" } else { &id };
                ways.insert(format!("{id}{name}"), Way::along(&way, 0.0, None));
            }
        }
    }
    Ok((ways, warnings.lines()))
}

fn roadmap(default: &str) -> Element {
    let node = |id: &str, at: &str| {
        Element::new("node", &[("id", id)], vec![Element::with_content("data", &[("key", "coords")], at)])
    };
    let edge = |id: &str, ends: [&str; 2], more: &[(&str, &str)]| {
        let attributes = [&[("id", id), ("source", ends[0]), ("target", ends[1])][..], more].concat();
        Element::new("edge", &attributes, vec![Element::with_content("data", &[("key", "weight")], "1")])
    };
    let children = vec![
        node("a", "0,0"),
        node("b", "6.0,0"),
        node("c", "6,5"),
        edge("ab", ["a", "b"], &[]),
        edge("bc", ["b", "c"], &[("directed", "true")]),
        edge("ca", ["c", "a"], &[("directed", "false")]),
    ];
    let graph = Element::new("graph", &[("id", "g"), ("edgedefault", default)], children);
    let key = Element::new("key", &[("id", "coords"), ("for", "node"), ("attr.type", "string")], Vec::new());
    Element::new("graphml", &[], vec![key, graph])
}

#[test]
fn what_was_changed_is_read_as_it_stands_or_refused_or_told() {
    let mut tally = Tally::default();
    for default in ["directed", "undirected"] {
        change(&Format { meaning, imported }, default, &roadmap(default), &mut tally);
    }
    let Tally { same, told, refused, wrong } = tally;
    assert!(wrong.is_empty(), "{} wrong: {wrong:#?}", wrong.len());
    assert!(same > 50 && told > 50 && refused > 50, "{same} the same, {told} told, {refused} refused");
}

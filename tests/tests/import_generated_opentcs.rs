//! Plant models of openTCS that were changed on purpose, as in `import_generated`: an attribute or element left out, misspelt, renamed, added or
//! in another element, in every version. A small reader that shares nothing with the importer says what each one means.

use crate::import_generated::{Meaning, Point, Way, options, points};
use crate::import_generated_xml::{Element, Format, Tally, change};
use pcr_formats::import::{InputFormat, Warnings, layout};
use std::collections::BTreeMap;

/// The first of two names that an attribute has in one version or another \[m\].
fn metres(element: &Element, names: &[&str]) -> Option<f64> {
    let text = names.iter().find_map(|name| element.get(name))?;
    Some(text.parse::<f64>().ok()? / 1000.0)
}

/// What a model says; `None` if it does not say what it has to.
fn meaning(model: &Element) -> Option<Meaning> {
    let drawn: BTreeMap<&str, &Element> = model
        .all("visualLayout")
        .flat_map(|layout| layout.all("modelLayoutElement"))
        .map(|element| Some((element.get("visualizedObjectName")?, element)))
        .collect::<Option<_>>()?;
    let property = |name: &str, key: &str| {
        drawn.get(name)?.all("property").find(|property| property.get("name") == Some(key))?.get("value")
    };
    let mut places = BTreeMap::<&str, Point>::new();
    for point in model.all("point") {
        let at = [metres(point, &["positionX", "xPosition"])?, metres(point, &["positionY", "yPosition"])?];
        places.insert(point.get("name")?, at);
    }
    let unit = |key: &str| match model.all("visualLayout").next() {
        None => Some(0.05),
        Some(layout) => metres(layout, &[key]),
    };
    let mut ways = Meaning::new();
    for path in model.all("path") {
        let name = path.get("name")?;
        let end = |key: &str| places.get(path.get(key)?).copied();
        let ends = [end("sourcePoint")?, end("destinationPoint")?];
        let (kind, control) = match path.all("pathLayout").next() {
            Some(layout) => {
                let number = |point: &Element, key: &str| point.get(key)?.parse::<f64>().ok();
                let point = |point: &Element| Some([number(point, "x")?, number(point, "y")?]);
                let control = layout.all("controlPoint").map(point).collect::<Option<Vec<_>>>()?;
                (layout.get("connectionType").unwrap_or("DIRECT"), control)
            }
            None => {
                let pair = |pair: &str| pair.split_once(',').map(|(x, y)| [x, y].map(|text| text.parse().ok()));
                let control = property(name, "CONTROL_POINTS").unwrap_or_default().split(';').filter_map(pair);
                let control = control.map(|[x, y]| Some([x?, y?])).collect::<Option<Vec<Point>>>()?;
                (property(name, "CONN_TYPE").unwrap_or("DIRECT"), control)
            }
        };
        let mut corners = vec![ends[0]];
        for [x, y] in &control {
            corners.push([x * unit("scaleX")?, -y * unit("scaleY")?]);
        }
        corners.push(ends[1]);
        let corners = match (kind, corners.len()) {
            ("DIRECT", 2) => corners,
            ("BEZIER", 4) => (0..=200).map(|k| bezier(&corners, f64::from(k) / 200.0)).collect(),
            _ => return None,
        };
        let speed = |key: &str| metres(path, &[key]);
        let locked = if path.get("locked") == Some("true") { ", locked" } else { "" };
        let back: Vec<Point> = corners.iter().rev().copied().collect();
        if let Some(speed) = speed("maxReverseVelocity").filter(|speed| *speed > 0.0) {
            ways.insert(format!("{name}{locked} back"), Way::along(&back, 0.0, Some(speed)));
        }
        if speed("maxVelocity").is_none_or(|speed| speed > 0.0) {
            ways.insert(format!("{name}{locked}"), Way::along(&corners, 0.0, speed("maxVelocity")));
        }
    }
    Some(ways)
}

fn bezier(points: &[Point], t: f64) -> Point {
    let weights = [(1.0 - t).powi(3), 3.0 * t * (1.0 - t).powi(2), 3.0 * t * t * (1.0 - t), t.powi(3)];
    [0, 1].map(|axis| weights.iter().zip(points).map(|(weight, point)| weight * point[axis]).sum())
}

fn imported(model: &Element) -> Result<(Meaning, Vec<String>), String> {
    let mut warnings = Warnings::default();
    let read =
        layout(InputFormat::OpenTcs, &model.text(), &options(), &mut warnings).map_err(|error| error.to_string())?;
    let mut ways = Meaning::new();
    for edge in &read.layout.edges {
        let locked = if edge.closed { ", locked" } else { "" };
        for step in edge.steps() {
            let back = if step.backward { " back" } else { "" };
            let way = Way::along(&points(&step.curve()), edge.room, step.speed());
            ways.insert(format!("{}{locked}{back}", edge.id), way);
        }
    }
    Ok((ways, warnings.lines()))
}

fn model(version: &str) -> Element {
    let [x, y] = if version >= "6" { ["positionX", "positionY"] } else { ["xPosition", "yPosition"] };
    let in_visual = version < "0.0.4";
    let point = |name: &str, at: [&str; 2]| {
        let layout = if in_visual {
            Vec::new()
        } else if version >= "7" {
            vec![Element::new("pointLayout", &[("layerId", "0")], Vec::new())]
        } else {
            vec![Element::new("pointLayout", &[(x, at[0]), (y, at[1]), ("layerId", "0")], Vec::new())]
        };
        Element::new("point", &[("name", name), (x, at[0]), (y, at[1]), ("type", "HALT_POSITION")], layout)
    };
    let path = |name: &str, ends: [&str; 2], speeds: [&str; 2], locked: &str, layout: Vec<Element>| {
        let [from, to] = ends;
        let attributes = [("name", name), ("sourcePoint", from), ("destinationPoint", to), ("maxVelocity", speeds[0])];
        let others = [("maxReverseVelocity", speeds[1]), ("locked", locked), ("length", "10000")];
        Element::new("path", &[&attributes[..], &others[..]].concat(), layout)
    };
    let control = |x: &str, y: &str| Element::new("controlPoint", &[("x", x), ("y", y)], Vec::new());
    let bent = vec![Element::new(
        "pathLayout",
        &[("connectionType", "BEZIER"), ("layerId", "0")],
        vec![control("300", "-100"), control("300", "-200")],
    )];
    let straight = vec![Element::new("pathLayout", &[("connectionType", "DIRECT"), ("layerId", "0")], Vec::new())];
    let [bent, straight] = if in_visual { [Vec::new(), Vec::new()] } else { [bent, straight] };
    let mut visual = Vec::new();
    if in_visual {
        let property =
            |name: &str, value: &str| Element::new("property", &[("name", name), ("value", value)], Vec::new());
        let shown = |name: &str, properties| {
            Element::new("modelLayoutElement", &[("visualizedObjectName", name), ("layer", "0")], properties)
        };
        for (name, x, y) in [("a", "0", "0"), ("b", "10000", "0"), ("c", "10000", "7000")] {
            visual.push(shown(name, vec![property("POSITION_X", x), property("POSITION_Y", y)]));
        }
        let points = property("CONTROL_POINTS", "300,-100;300,-200");
        visual.push(shown("bc", vec![property("CONN_TYPE", "BEZIER"), points]));
    }
    let children = vec![
        point("a", ["0", "0"]),
        point("b", ["10000", "0"]),
        point("c", ["10000", "7000"]),
        path("ab", ["a", "b"], ["1000", "300"], "false", straight.clone()),
        path("bc", ["b", "c"], ["750", "0"], "false", bent),
        path("ca", ["c", "a"], ["500", "0"], "true", straight),
        Element::new("visualLayout", &[("name", "v"), ("scaleX", "40.0"), ("scaleY", "40.0")], visual),
    ];
    Element::new("model", &[("name", "m"), ("version", version)], children)
}

#[test]
fn what_was_changed_is_read_as_it_stands_or_refused_or_told() {
    let mut tally = Tally::default();
    for version in ["0.0.2", "0.0.3", "0.0.4", "0.0.5", "6.0.0", "7.0.0"] {
        change(&Format { meaning, imported }, version, &model(version), &mut tally);
    }
    let Tally { same, told, refused, wrong } = tally;
    assert!(wrong.is_empty(), "{} wrong: {wrong:#?}", wrong.len());
    assert!(same > 300 && told > 50 && refused > 300, "{same} the same, {told} told, {refused} refused");
}

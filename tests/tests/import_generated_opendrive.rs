//! Roads of OpenDRIVE that were changed on purpose.

use crate::import_generated::{Meaning, Point, Way, options, points};
use crate::import_generated_xml::{Element, Format, Tally, change};
use pcr_formats::import::{InputFormat, Warnings, layout};
use std::collections::BTreeMap;

/// Steps in which a record is followed.
const STEPS: usize = 2000;

fn number(element: &Element, key: &str) -> Option<f64> {
    element.get(key)?.parse().ok()
}

/// The points of a record, by the midpoint rule where the shape is given by its curvature.
fn followed(record: &Element) -> Option<Vec<Point>> {
    let (start, heading, length) =
        ([number(record, "x")?, number(record, "y")?], number(record, "hdg")?, number(record, "length")?);
    let mut shapes = record.children.iter().filter(|child| !["userData", "dataQuality"].contains(&child.name()));
    let (shape, more) = (shapes.next()?, shapes.next());
    if more.is_some() {
        return None;
    }
    let by_curvature = |[first, last]: [f64; 2]| {
        let (mut at, mut turned, step) = (start, heading, length / STEPS as f64);
        let mut points = vec![at];
        for k in 0..STEPS {
            let curvature = first + (last - first) * (k as f64 + 0.5) / STEPS as f64;
            let middle = turned + 0.5 * step * curvature;
            at = [at[0] + step * middle.cos(), at[1] + step * middle.sin()];
            turned += step * curvature;
            points.push(at);
        }
        points
    };
    let cubic = |keys: [&str; 4], p: f64| -> Option<f64> {
        let mut value = 0.0;
        for key in keys.into_iter().rev() {
            value = value * p + number(shape, key)?;
        }
        Some(value)
    };
    let placed = |[u, v]: Point| {
        let (sin, cos) = heading.sin_cos();
        [start[0] + u * cos - v * sin, start[1] + u * sin + v * cos]
    };
    match shape.name() {
        "line" => Some(by_curvature([0.0, 0.0])),
        "arc" => Some(by_curvature([number(shape, "curvature")?; 2])),
        "spiral" => Some(by_curvature([number(shape, "curvStart")?, number(shape, "curvEnd")?])),
        "paramPoly3" => {
            let last = match shape.get("pRange") {
                None | Some("normalized") => 1.0,
                Some("arcLength") => length,
                Some(_) => return None,
            };
            let at = |k: usize| {
                let p = last * k as f64 / STEPS as f64;
                Some(placed([cubic(["aU", "bU", "cU", "dU"], p)?, cubic(["aV", "bV", "cV", "dV"], p)?]))
            };
            (0..=STEPS).map(at).collect()
        }
        _ => None,
    }
}

/// What a file says; `None` if it does not say what it has to.
fn meaning(root: &Element) -> Option<Meaning> {
    let mut ways = Meaning::new();
    let mut ends = BTreeMap::<&str, [Point; 2]>::new();
    for road in root.all("road") {
        let mut corners = Vec::new();
        for record in road.all("planView").next()?.all("geometry") {
            corners.extend(followed(record)?);
        }
        let mut least: Option<f64> = None;
        for speed in road.all("type").flat_map(|part| part.all("speed")) {
            let unit = match speed.get("unit") {
                None | Some("m/s") => 1.0,
                Some("km/h") => 1.0 / 3.6,
                Some("mph") => 0.447_04,
                Some(_) => return None,
            };
            let own = number(speed, "max")? * unit;
            least = Some(least.map_or(own, |least| least.min(own)));
        }
        let id = road.get("id")?;
        ends.insert(id, [*corners.first()?, *corners.last()?]);
        ways.insert(id.to_owned(), Way::along(&corners, 0.0, least));
    }
    let mut joined = Vec::new();
    for road in root.all("road") {
        for (side, name) in [(0, "predecessor"), (1, "successor")] {
            let Some(link) = road.all("link").next().and_then(|link| link.all(name).next()) else { continue };
            let other = link.get("elementId").and_then(|id| Some((id, ends.get(id)?)));
            let point = match link.get("contactPoint") {
                Some("start") => Some(0),
                Some("end") => Some(1),
                _ => None,
            };
            let (Some("road"), Some((other, places)), Some(point)) = (link.get("elementType"), other, point) else {
                continue;
            };
            let id = road.get("id")?;
            let [a, b] = [ends[id][side], places[point]];
            if (a[0] - b[0]).hypot(a[1] - b[1]) <= 0.05 {
                let mut names =
                    [format!("{id}/{}", ["start", "end"][side]), format!("{other}/{}", ["start", "end"][point])];
                names.sort();
                joined.push(names.join(" is "));
            }
        }
    }
    ways.extend(joined.into_iter().map(|name| (name, Way::along(&[], 0.0, None))));
    Some(ways)
}

fn imported(root: &Element) -> Result<(Meaning, Vec<String>), String> {
    let mut warnings = Warnings::default();
    let read =
        layout(InputFormat::OpenDrive, &root.text(), &options(), &mut warnings).map_err(|error| error.to_string())?;
    let layout = &read.layout;
    let mut ways = Meaning::new();
    for edge in &layout.edges {
        assert_eq!(edge.ways, [true; 2]);
        ways.insert(edge.id.to_string(), Way::along(&points(&edge.curve), edge.room, edge.speed[0]));
    }
    for (alias, node) in &layout.aliases {
        let mut names = [alias.clone(), layout.nodes[*node].id.to_string()];
        names.sort();
        ways.insert(names.join(" is "), Way::along(&[], 0.0, None));
    }
    Ok((ways, warnings.lines()))
}

fn record(s: f64, at: Point, heading: f64, length: f64, shape: &Element) -> Element {
    let [s, x, y, heading, length] = [s, at[0], at[1], heading, length].map(|value| value.to_string());
    let attributes = [("s", &*s), ("x", &*x), ("y", &*y), ("hdg", &*heading), ("length", &*length)];
    Element::new("geometry", &attributes, vec![shape.clone()])
}

/// Two roads, of a line, a spiral, an arc, and of a cubic curve whose parameter is in this range; both say that they are linked.
fn file(range: Option<&str>) -> Element {
    let shape = |name: &str, attributes: &[(&str, &str)]| Element::new(name, attributes, Vec::new());
    let parts = [
        (10.0, shape("line", &[])),
        (8.0, shape("spiral", &[("curvStart", "0"), ("curvEnd", "0.1")])),
        (6.0, shape("arc", &[("curvature", "0.1")])),
    ];
    let (mut at, mut heading, mut along, mut records) = ([1.0, 2.0], 0.0, 0.0, Vec::new());
    for (length, shape) in parts {
        let own = record(along, at, heading, length, &shape);
        let points = followed(&own).expect("a shape that is read");
        at = *points.last().expect("a point");
        heading += length * (number(&shape, "curvStart").unwrap_or(0.0) + number(&shape, "curvEnd").unwrap_or(0.0))
            / 2.0
            + length * number(&shape, "curvature").unwrap_or(0.0);
        along += length;
        records.push(own);
    }
    // A straight line of 5 m, then the same bent by 0.2 m, in either range of its parameter.
    let last = if range == Some("arcLength") { 5.0_f64 } else { 1.0 };
    let [along_u, along_v] = [5.0 / last, 0.2 / last.powi(3)].map(|value| value.to_string());
    let mut curve = vec![("aU", "0"), ("bU", &*along_u), ("cU", "0"), ("dU", "0")];
    curve.extend([("aV", "0"), ("bV", "0"), ("cV", "0"), ("dV", &*along_v)]);
    curve.extend(range.map(|range| ("pRange", range)));
    let bent = record(0.0, at, heading, 5.0072, &shape("paramPoly3", &curve));
    let link = |name: &str, id: &str, point: &str| {
        let attributes = [("elementType", "road"), ("elementId", id), ("contactPoint", point)];
        Element::new("link", &[], vec![Element::new(name, &attributes, Vec::new())])
    };
    let road = |id: &str, length: f64, link: Element, speed: &[(&str, &str)], records: Vec<Element>| {
        let speed = Element::new("speed", speed, Vec::new());
        let kind = Element::new("type", &[("s", "0"), ("type", "town")], vec![speed]);
        let view = Element::new("planView", &[], records);
        let length = length.to_string();
        let attributes = [("name", ""), ("id", id), ("length", &*length), ("junction", "-1")];
        Element::new("road", &attributes, vec![link, kind, view])
    };
    let first = road("1", along, link("successor", "2", "start"), &[("max", "18"), ("unit", "km/h")], records);
    let second = road("2", 5.0072, link("predecessor", "1", "end"), &[("max", "4")], vec![bent]);
    let header = Element::new("header", &[("revMajor", "1"), ("revMinor", "7")], Vec::new());
    Element::new("OpenDRIVE", &[], vec![header, first, second])
}

#[test]
fn what_was_changed_is_read_as_it_stands_or_refused_or_told() {
    let mut tally = Tally::default();
    for range in [None, Some("normalized"), Some("arcLength")] {
        change(&Format { meaning, imported }, range.unwrap_or("no range"), &file(range), &mut tally);
    }
    let Tally { same, told, refused, wrong } = tally;
    assert!(wrong.is_empty(), "{} wrong: {wrong:#?}", wrong.len());
    assert!(same > 200 && told > 100 && refused > 200, "{same} the same, {told} told, {refused} refused");
}

//! A page to explore a scenario: one HTML file that contains everything and sends no requests.
//!
//! It contains the paths and profiles as numbers, and evaluates the closed forms of the library itself, so that the
//! discs are exactly at their places at every time of the slider. Outlines of regions are computed by this module and
//! drawn by the page.

use super::axis::PlotArea;
use super::contour::{RegionOutline, is_thin};
use super::map::{RegionLabels, THIN, spans};
use super::region_scene::{DrawnRegion, RegionScene};
use super::template::PageTemplate;
use pcr_core::{Aabb, Crossing, Curve, Interval, Motion, Segment, TurnSide};
use pcr_formats::scenario::Agent;
use serde_json::{Value, json};
use std::fmt::Write as _;

const PAGE: PageTemplate = PageTemplate {
    kind: "collision regions",
    connect: "",
    body: include_str!("page/page.html"),
    style: include_str!("page/page.css"),
    script: concat!(include_str!("outward.js"), include_str!("crowd.js"), include_str!("page/page.js")),
};

/// Steps of the coordinates of outlines along each axis of a map: a twentieth of a pixel on a large screen.
const GRID: f64 = 20_000.0;

/// Size of a map as the script draws it \[px\].
const PIXELS: f64 = 700.0;

/// Size of the labels of regions there \[px\].
const LABEL_SIZE: f64 = 14.0;

/// The page.
pub(super) fn page(scene: &RegionScene<'_>) -> String {
    let name = if scene.scenario.name.is_empty() { "Collision regions" } else { &scene.scenario.name };
    PAGE.fill(name, &data(scene))
}

fn data(scene: &RegionScene<'_>) -> Value {
    let Aabb { x, y } = scene.bounds();
    let agents = scene.motions.iter().enumerate().map(|(place, motion)| agent(scene, place, motion));
    let mut maps = vec![Value::Null; scene.motions.len()];
    for ego in scene.egos() {
        if let Some(place) = maps.get_mut(ego) {
            *place = map(scene, ego);
        }
    }
    json!({
        "name": scene.scenario.name,
        "grid": GRID,
        "hulls": scene.has_hulls(),
        "horizon": interval(scene.horizon()),
        "bounds": [x.lo, x.hi, y.lo, y.hi],
        "ground": scene.ground.map(|ground| ground.lines()),
        "agents": agents.collect::<Vec<_>>(),
        "maps": maps,
    })
}

fn interval(interval: Interval<f64>) -> Value {
    json!([interval.lo, interval.hi])
}

/// The closed forms of a motion: segments as \[from, length, x, y, heading, bend\] with the radius of an arc as bend,
/// positive to the left, 0 on a line, followed by the lever on a turn in place; phases as \[time, duration, length, speed before, speed after, acceleration\].
fn agent(scene: &RegionScene<'_>, place: usize, motion: &Motion<'_, f64>) -> Value {
    let segments = motion.path().segments().iter().map(|segment| {
        let start = segment.point_at(0.0);
        let left = |turn, length: f64| if turn == TurnSide::Left { length } else { -length };
        let mut numbers = vec![segment.from(), segment.length(), start.x, start.y, segment.heading_at(0.0).0];
        match segment.curve() {
            Curve::Line => numbers.push(0.0),
            Curve::Arc { radius, turn } => numbers.push(left(turn, radius)),
            Curve::Pivot { lever, turn } => numbers.extend([0.0, left(turn, lever)]),
        }
        json!(numbers)
    });
    let phases = motion.profile().phases().iter().map(|phase| {
        let (time, length) = (phase.time(), phase.length());
        let speeds = [time.lo, time.hi].map(|time| phase.speed_at(time));
        let acceleration = if time.length() > 0.0 { (speeds[1] - speeds[0]) / time.length() } else { 0.0 };
        json!([time.lo, time.length(), length.lo, speeds[0], speeds[1], acceleration])
    });
    let facings = scene.facings(place);
    let parts = scene.scenario.agents.get(place).map_or_else(Vec::new, |agent| parts(agent, motion));
    let mut agent = json!({
        // Beyond 2⁵³ a number would lose its last digits in the browser.
        "id": scene.id(place).to_string(),
        "name": scene.display_name(place),
        "radius": motion.outline().reach(),
        "parts": parts,
        "outline": scene.polygon(place),
        "colour": scene.colour(place).to_string(),
        "time": interval(motion.time()),
        "length": motion.path().length(),
        "segments": segments.collect::<Vec<_>>(),
        "phases": phases.collect::<Vec<_>>(),
    });
    if !facings.is_empty() {
        agent["facings"] = json!(facings);
    }
    let steady: Vec<bool> = motion.path().segments().iter().map(Segment::is_steady).collect();
    if steady.contains(&true) {
        agent["steady"] = json!(steady);
    }
    agent
}

/// The convex shapes by which contacts are told, as \[corners, radius, from, to\]: on which lengths of the path each of them is there. Where a
/// load begins or ends, both outlines count.
fn parts(agent: &Agent, motion: &Motion<'_, f64>) -> Vec<Value> {
    let outlines = agent.outlines();
    let whole = outlines.len() == 1;
    if !whole && motion.path().segments().iter().any(|segment| matches!(segment.curve(), Curve::Pivot { .. })) {
        // Lengths of the path in the scenario are not those of the motion.
        let outline = motion.outline();
        let corners = outline.corners().iter().map(|corner| [corner.at().x, corner.at().y]);
        return vec![json!([corners.collect::<Vec<_>>(), outline.radius(), 0.0, f64::MAX])];
    }
    let mut before = vec![0.0];
    before.extend(agent.path.iter().scan(0.0, |length, segment| {
        *length += segment.length();
        Some(*length)
    }));
    let begin = |first: usize| before.get(first).copied().unwrap_or_default();
    let begins: Vec<f64> = outlines.iter().map(|outline| begin(outline.segments[0])).collect();
    let ends = begins.iter().skip(1).copied().chain([f64::MAX]);
    let mut all = Vec::new();
    for ((outline, &from), to) in outlines.iter().zip(&begins).zip(ends) {
        match outline.footprint {
            Some(footprint) => {
                let parts = footprint.parts().filter_map(|part| part.convex(0.0));
                all.extend(parts.map(|corners| json!([corners, footprint.growth(), from, to])));
            }
            None => all.push(json!([[[0.0, 0.0]], outline.radius, from, to])),
        }
    }
    all
}

fn map(scene: &RegionScene<'_>, ego: usize) -> Value {
    let [time, length] = spans(scene, ego);
    let frame = PlotArea::new(time, length, [0.0, 0.0, PIXELS, PIXELS]);
    let shapes = scene.shapes(ego, [frame.x.units_per_pixel(), frame.y.units_per_pixel()]);
    let names = RegionLabels::new(scene, ego, &shapes, &frame, LABEL_SIZE);
    let regions = shapes.iter().zip(&names.places).map(|(shape, place)| region(shape, *place, &frame));
    json!({
        "time": interval(frame.x.values()),
        "length": interval(frame.y.values()),
        "regions": regions.collect::<Vec<_>>(),
    })
}

fn region(shape: &DrawnRegion, place: Option<[f64; 2]>, frame: &PlotArea) -> Value {
    let strips = |strips: &[Interval<f64>]| strips.iter().copied().map(interval).collect::<Vec<_>>();
    let thin =
        |contour: &Vec<[f64; 2]>| is_thin(&contour.iter().map(|point| frame.at(*point)).collect::<Vec<_>>(), THIN);
    json!({
        "other": shape.other,
        "thin": shape.outline.iter().all(thin),
        "time": interval(shape.time),
        "length": interval(shape.length),
        "outline": path(&shape.outline, frame),
        "before": strips(&shape.before),
        "after": strips(&shape.after),
        "label": place.map(|[x, y]| [frame.x.value_at(x), frame.y.value_at(y)]),
        "types": shape.types.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "pieces": shape.pieces,
        "crossings": shape.crossings.iter().map(crossing).collect::<Vec<_>>(),
    })
}

/// The descriptor of the paper's Tables III and IV; radii are null on lines, positive to the left.
fn crossing(crossing: &Crossing<f64>) -> Value {
    let bend = |curve: Curve<f64>| match curve {
        // Nothing crosses a turn in place.
        Curve::Line | Curve::Pivot { .. } => None,
        Curve::Arc { radius, turn: TurnSide::Left } => Some(radius),
        Curve::Arc { radius, turn: TurnSide::Right } => Some(-radius),
    };
    json!({
        "type": crossing.piece_type.to_string(),
        "T": crossing.time,
        "L": crossing.length,
        "r": crossing.combined_radius,
        "v": crossing.speed,
        "theta": crossing.theta.0,
        "own": bend(crossing.ego_curve),
        "other": bend(crossing.other_curve),
    })
}

/// SVG path data of an outline on the grid: steps from point to point, which are short numbers.
fn path(outline: &RegionOutline, frame: &PlotArea) -> String {
    let on_grid = |pixel: f64| (pixel / PIXELS * GRID).round() as i64;
    let mut data = String::new();
    for contour in outline {
        let mut before: Option<[i64; 2]> = None;
        for point in contour {
            let [x, y] = frame.at(*point);
            let at = [on_grid(x), on_grid(y)];
            // Writing to a string does not fail.
            let _ = match before {
                None => write!(data, "M{} {}l", at[0], at[1]),
                Some(before) => write!(data, "{} {} ", at[0] - before[0], at[1] - before[1]),
            };
            before = Some(at);
        }
        // A point is a line of no length, which round caps make a dot.
        data.push_str("0 0z");
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::scenario::Scenario;
    use pcr_planning::fleet::{Fleet, build_ecm};

    fn page_of(text: &str) -> String {
        let scenario = Scenario::from_json(text).unwrap();
        let fleet = Fleet::<f64>::new(&scenario).unwrap();
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).unwrap();
        page(&RegionScene { scenario: &scenario, motions: &motions, ecm: &ecm, egos: None, ground: None })
    }

    fn data_of(page: &str) -> Value {
        let (_, rest) = page.split_once(r#"<script type="application/json" id="data">"#).unwrap();
        serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
    }

    #[test]
    fn names_cannot_break_out_of_the_page() {
        let name = r#"</script><script>alert("1")</script> {{data}} & more"#;
        let page = page_of(&json!({ "name": name, "agents": [] }).to_string());
        assert_eq!(page.matches("alert").count(), 3, "title, heading, data");
        assert!(!page.contains("<script>alert") && !page.contains("</script><script>"));
        assert_eq!(page.matches("</script>").count(), 2);
        assert_eq!(data_of(&page)["name"], json!(name));
    }

    #[test]
    fn the_page_asks_for_nothing() {
        let page = page_of(pcr_formats::paper_example::SCENARIO);
        let namespace = "http://www.w3.org/2000/svg";
        assert_eq!(page.matches("http").count(), page.matches(namespace).count() + page.matches("http-equiv").count());
        for request in ["src=", "href=", "@import", "url(", "fetch(", "import("] {
            assert!(!page.contains(request), "{request}");
        }
        assert!(page.contains("default-src 'none'"));
    }

    #[test]
    fn the_page_holds_all_regions_with_descriptors() {
        let data = data_of(&page_of(pcr_formats::paper_example::SCENARIO));
        let maps = data["maps"].as_array().unwrap();
        let regions = |map: &Value| map["regions"].as_array().unwrap().len();
        assert_eq!(maps.iter().map(regions).sum::<usize>(), 136);
        // Row 1 of the paper's Table VII: CR 3 10 (19.3, 0.9, 0.3, 0.4, -0.9).
        let of_ten = maps[2]["regions"].as_array().unwrap().iter().filter(|region| region["other"] == json!(9));
        let crossing = of_ten.map(|region| &region["crossings"][0]).find(|crossing| crossing["L"].as_f64() < Some(2.0));
        let crossing = crossing.unwrap();
        for (key, printed) in [("T", 19.3), ("L", 0.9), ("r", 0.3), ("v", 0.4), ("theta", -0.9)] {
            // Half of the last printed digit.
            assert!((crossing[key].as_f64().unwrap() - printed).abs() < 0.05 + 1e-9, "{key} {crossing}");
        }
    }

    #[test]
    fn contacts_are_those_of_the_shapes_on_their_stretches() {
        let line = json!({ "kind": "line", "length": 2.0 });
        let start = json!({ "x": 0.0, "y": 0.0, "heading": 0.0 });
        let agent = json!({ "id": 1, "radius": 0.3, "v_max": 1.0, "a_max": 1.0, "start": start, "path": [line, line, line],
            "loads": [{ "segments": [2, 2], "radius": 0.8 }] });
        let data = data_of(&page_of(&json!({ "agents": [agent] }).to_string()));
        let parts = data["agents"][0]["parts"].as_array().unwrap();
        let lengths = |k: usize| [1, 2, 3].map(|column| parts[k][column].as_f64().unwrap());
        assert_eq!((parts.len(), lengths(0), lengths(1)), (3, [0.3, 0.0, 2.0], [0.8, 2.0, 4.0]));
        assert_eq!(lengths(2)[..2], [0.3, 4.0]);
    }

    #[test]
    fn outlines_are_steps_on_the_grid() {
        let unit = Interval::new(0.0, 1.0);
        let frame = PlotArea::new(unit, unit, [0.0, 0.0, PIXELS, PIXELS]);
        let outline = vec![vec![[0.0, 1.0], [0.5, 1.0], [0.5, 0.5]], vec![[1.0, 0.0]]];
        assert_eq!(path(&outline, &frame), "M0 0l10000 0 0 10000 0 0zM20000 20000l0 0z");
    }
}

//! The workspace (paper Fig. 10): all paths with the discs at their starts and ends, in metres.

use super::axis::{PlotArea, ROOM_ABOVE, ROOM_BELOW, at_least_visible, room_at_left};
use super::labels::{LabelPlacer, SPACING, around};
use super::map::Legend;
use super::region_scene::RegionScene;
use super::svg::{PathData, PixelCoordinate, SvgWriter, text_width};
use pcr_core::{Aabb, Curve, Interval, Motion, Segment, TurnSide};
use std::f64::consts::PI;

/// Size of the numbers of agents \[px\].
const LABEL_SIZE: f64 = 9.5;

/// Distance of the arrows on a path \[px\].
const ARROWS: f64 = 110.0;

/// Smallest width and height of the plot \[px\].
const LEAST: [f64; 2] = [240.0, 110.0];

/// Points of a path at most that labels keep off.
const MOST_OBSTACLES: f64 = 2000.0;

/// Weight of covering a path.
const CROSSED: f64 = 2.0;

/// What a label may cover: about three paths that it crosses. Instead of one that covers more there is the number.
const MOST_CROSSED: f64 = 24.0;

/// The frame of a workspace that is at most `side` pixels wide and high, at this left top corner; equal scales.
pub(super) fn frame(scene: &RegionScene<'_>, side: f64, [left, top]: [f64; 2]) -> PlotArea {
    let Aabb { x, y } = scene.bounds();
    let [x, y] = [x, y].map(|values| {
        let margin = 0.03 * x.length().max(y.length());
        at_least_visible(Interval::new(values.lo - margin, values.hi + margin))
    });
    let metre = side / x.length().max(y.length());
    let fit = |values: Interval<f64>, least: f64| {
        let pixels = (values.length() * metre).max(least);
        let half = pixels / metre / 2.0;
        (pixels, Interval::new(values.middle() - half, values.middle() + half))
    };
    let ((width, x), (height, y)) = (fit(x, LEAST[0]), fit(y, LEAST[1]));
    let left = left + room_at_left(y, height);
    PlotArea::new(x, y, [left, top + ROOM_ABOVE, left + width, top + ROOM_ABOVE + height])
}

/// The workspace as a picture of its own.
pub(super) fn picture(scene: &RegionScene<'_>) -> String {
    let side = (340.0 + 5.0 * scene.motions.len() as f64).clamp(400.0, 800.0);
    let frame = frame(scene, side, [0.0, 0.0]);
    let [left, _, right, bottom] = frame.edges;
    let names = DiscLabels::new(scene, &frame);
    let legend = Legend::of_notes(names.left_out(), [left, right]);
    let mut svg = SvgWriter::new(right + 12.0, bottom + ROOM_BELOW + legend.height(), &title(scene).concat());
    draw(&mut svg, scene, &frame, &names);
    legend.draw(&mut svg, bottom + ROOM_BELOW);
    svg.finish()
}

/// The name of the scenario, with what stands before and after it.
fn title(scene: &RegionScene<'_>) -> [String; 3] {
    let agents = match scene.motions.len() {
        1 => "1 agent".to_owned(),
        count => format!("{count} agents"),
    };
    let name = scene.scenario.name.clone();
    let after = if name.is_empty() { format!("Workspace of {agents}") } else { format!(": workspace of {agents}") };
    [String::new(), name, after]
}

/// The workspace in a frame.
pub(super) fn draw(svg: &mut SvgWriter, scene: &RegionScene<'_>, frame: &PlotArea, names: &DiscLabels) {
    frame.draw_title(svg, title(scene).each_ref().map(String::as_str));
    frame.draw(svg, ["x [m]", "y [m]"]);
    if let Some(ground) = &scene.ground {
        ground.draw(svg, frame, false);
    }
    for (place, motion) in scene.motions.iter().enumerate() {
        let colour = scene.colour(place);
        svg.start("g", &[("fill", &"none"), ("stroke", &colour), ("stroke-width", &"1.2")]);
        svg.empty("path", &[("d", &path(motion, frame)), ("stroke-linejoin", &"round")]);
        let arrows = arrows(motion, frame);
        if !arrows.is_empty() {
            svg.empty("path", &[("d", &arrows), ("fill", &colour), ("stroke", &"none")]);
        }
        let length = motion.path().length();
        if length > 0.0 {
            let dashed: SvgAttributes<'_> = &[("stroke-dasharray", &"2.5 2"), ("stroke-width", &"0.9")];
            body(svg, scene, place, length, frame, dashed);
        }
        body(svg, scene, place, 0.0, frame, &[("fill", &colour), ("fill-opacity", &"0.35")]);
        svg.end();
    }
    names.draw(svg, scene);
    frame.draw_border(svg);
}

/// Attributes.
type SvgAttributes<'a> = &'a [(&'a str, &'a dyn std::fmt::Display)];

/// The disc or the outline of an agent at a length of its path.
fn body(
    svg: &mut SvgWriter,
    scene: &RegionScene<'_>,
    place: usize,
    length: f64,
    frame: &PlotArea,
    style: SvgAttributes<'_>,
) {
    let Some(pose) = scene.pose_at(place, length) else { return };
    let at = |ahead: f64, left: f64| {
        let (sin, cos) = pose.heading.0.sin_cos();
        frame.at([pose.position.x + ahead * cos - left * sin, pose.position.y + ahead * sin + left * cos])
    };
    let polygon = scene.polygon(place);
    if !polygon.is_empty() {
        let mut data = PathData::default();
        data.polygon(polygon.iter().map(|[ahead, left]| at(*ahead, *left)));
        svg.empty("path", &[&[("d", &data as &dyn std::fmt::Display)], style].concat());
    } else if let Some(motion) = scene.motions.get(place) {
        let [x, y] = at(0.0, 0.0);
        let (x, y, radius) = (PixelCoordinate(x), PixelCoordinate(y), PixelCoordinate(radius(motion, frame)));
        let circle: SvgAttributes<'_> = &[("cx", &x), ("cy", &y), ("r", &radius)];
        svg.empty("circle", &[circle, style].concat());
    }
}

/// Radius of a disc \[px\]; one that would not be seen is shown as a dot.
fn radius(motion: &Motion<'_, f64>, frame: &PlotArea) -> f64 {
    (motion.outline().reach() / frame.x.units_per_pixel()).max(1.2)
}

/// A path by lines and true arcs.
fn path(motion: &Motion<'_, f64>, frame: &PlotArea) -> PathData {
    let at = |segment: &Segment<f64>, u: f64| {
        let point = segment.point_at(u);
        frame.at([point.x, point.y])
    };
    let mut data = PathData::default();
    for (k, segment) in motion.path().segments().iter().enumerate() {
        if k == 0 {
            data.move_to(at(segment, 0.0));
        }
        match segment.curve() {
            Curve::Line => data.line_to(at(segment, segment.length())),
            Curve::Pivot { .. } => {}
            Curve::Arc { radius, turn } => {
                // Below half a turn two points and a radius leave no doubt which arc is meant.
                let parts = (segment.length() / radius / (0.75 * PI)).ceil().max(1.0) as usize;
                for part in 1..=parts {
                    let end = at(segment, segment.length() * part as f64 / parts as f64);
                    data.arc_to(radius / frame.x.units_per_pixel(), turn == TurnSide::Right, end);
                }
            }
        }
    }
    data
}

/// Arrow heads in the direction of travel.
fn arrows(motion: &Motion<'_, f64>, frame: &PlotArea) -> PathData {
    let length = motion.path().length();
    let mut data = PathData::default();
    let pixels = length / frame.x.units_per_pixel();
    if pixels < 2.0 * radius(motion, frame) + 8.0 {
        return data;
    }
    let count = (pixels / ARROWS).round().clamp(1.0, 12.0) as usize;
    for k in 0..count {
        let pose = motion.path().pose_at(length * (k as f64 + 0.5) / count as f64);
        data.arrow(frame.at([pose.position.x, pose.position.y]), pose.heading.0);
    }
    data
}

/// What the agents are called, in their discs at the start or beside them.
#[derive(Debug)]
pub(super) struct DiscLabels {
    /// Texts with their middles \[px\], by the places of the agents; none where there is no room for any.
    texts: Vec<Option<([f64; 2], String)>>,
    /// How many labels had to give way to a number.
    shortened: usize,
}

impl DiscLabels {
    /// Finds a place for the number of each agent, and then, where there is room left, for its label instead.
    pub(super) fn new(scene: &RegionScene<'_>, frame: &PlotArea) -> Self {
        let mut labels = LabelPlacer::default();
        for (place, motion) in scene.motions.iter().enumerate() {
            if !fits(&scene.id(place).to_string(), motion, frame) {
                labels.block(disc(motion, frame));
            }
            let length = motion.path().length();
            let count = (length / frame.x.units_per_pixel() / SPACING).clamp(1.0, MOST_OBSTACLES) as usize;
            labels.avoid(
                CROSSED,
                (0..=count).map(|k| {
                    let point = motion.path().point_at(length * k as f64 / count as f64);
                    frame.at([point.x, point.y])
                }),
            );
        }
        let number = |(place, motion): (usize, &Motion<'_, f64>)| {
            let text = scene.id(place).to_string();
            labels.best_position(extent(&text), candidates(&text, motion, frame), frame.edges).map(|at| (at, text))
        };
        let texts = scene.motions.iter().enumerate().map(number).collect();
        let mut names = Self { texts, shortened: 0 };
        names.lengthen(scene, frame, &mut labels);
        names
    }

    /// Labels instead of numbers.
    fn lengthen(&mut self, scene: &RegionScene<'_>, frame: &PlotArea, labels: &mut LabelPlacer) {
        let labelled = |place: usize| scene.display_name(place) != scene.id(place).to_string();
        for (place, motion) in scene.motions.iter().enumerate().filter(|(place, _)| labelled(*place)) {
            if fits(&scene.id(place).to_string(), motion, frame) && !fits(&scene.display_name(place), motion, frame) {
                labels.block(disc(motion, frame));
            }
        }
        for (place, motion) in scene.motions.iter().enumerate().filter(|(place, _)| labelled(*place)) {
            let Some(Some((at, text))) = self.texts.get_mut(place) else { continue };
            let (size, called) = (extent(text), scene.display_name(place));
            labels.free(*at, size);
            let longer = extent(&called);
            let seen = |(_, at): &(f64, [f64; 2])| labels.covers(*at, longer) <= MOST_CROSSED;
            let candidates: Vec<_> = candidates(&called, motion, frame).filter(seen).collect();
            match labels.best_position(longer, candidates, frame.edges) {
                Some(found) => (*at, *text) = (found, called),
                None => {
                    labels.block(around(*at, size));
                    self.shortened += 1;
                }
            }
        }
    }

    /// What is said about agents that are not called by all that they could be.
    pub(super) fn left_out(&self) -> Option<String> {
        let agents = |count: usize, one: &str, more: &str| match count {
            1 => format!("1 agent {one}"),
            count => format!("{count} agents {more}"),
        };
        let missing = self.texts.iter().filter(|text| text.is_none()).count();
        let short = agents(self.shortened, "has its number alone", "have their number alone");
        match (self.shortened, missing) {
            (0, 0) => None,
            (_, 0) => Some(format!("For want of room, {short}.")),
            (0, _) => Some(format!("For want of room, {}.", agents(missing, "has no number", "have no number"))),
            (_, _) => Some(format!("For want of room, {short}, and {missing} not even that.")),
        }
    }

    fn draw(&self, svg: &mut SvgWriter, scene: &RegionScene<'_>) {
        svg.start(
            "g",
            &[
                ("font-size", &PixelCoordinate(LABEL_SIZE)),
                ("stroke", &"#fff"),
                ("stroke-width", &"2"),
                ("paint-order", &"stroke"),
            ],
        );
        for (place, text) in self.texts.iter().enumerate() {
            let Some(([x, y], text)) = text else { continue };
            let ink = scene.colour(place).ink();
            svg.label([*x, y + 0.36 * LABEL_SIZE], "middle", &[("fill", &ink), ("stroke-linejoin", &"round")], text);
        }
        svg.end();
    }
}

/// The box around the disc of an agent at its start \[px\].
fn disc(motion: &Motion<'_, f64>, frame: &PlotArea) -> [f64; 4] {
    let r = radius(motion, frame);
    around(start(motion, frame), [2.0 * r, 2.0 * r])
}

/// Where an agent starts \[px\].
fn start(motion: &Motion<'_, f64>, frame: &PlotArea) -> [f64; 2] {
    let point = motion.path().point_at(0.0);
    frame.at([point.x, point.y])
}

/// Width and height of a text \[px\].
fn extent(text: &str) -> [f64; 2] {
    [text_width(text, LABEL_SIZE) + 1.0, LABEL_SIZE - 1.0]
}

/// Whether a text fits into the disc.
fn fits(text: &str, motion: &Motion<'_, f64>, frame: &PlotArea) -> bool {
    text_width(text, LABEL_SIZE) / 2.0 <= radius(motion, frame)
}

/// Where the text of an agent may go: into its disc, if it fits there, or about it.
fn candidates(text: &str, motion: &Motion<'_, f64>, frame: &PlotArea) -> impl Iterator<Item = (f64, [f64; 2])> {
    let ([x, y], size, radius) = (start(motion, frame), extent(text), radius(motion, frame));
    // Behind the start, where the path does not pass.
    let behind = (radius - text_width(text, LABEL_SIZE).hypot(LABEL_SIZE) / 2.0).max(0.0);
    let (sin, cos) = motion.path().pose_at(0.0).heading.0.sin_cos();
    let inside = fits(text, motion, frame).then_some([x - behind * cos, y + behind * sin]);
    let about = (0..3).flat_map(move |ring| {
        (0..16).map(move |k| {
            let (sin, cos) = (f64::from(k) * PI / 8.0).sin_cos();
            let gap = radius + 2.0 + 6.0 * f64::from(ring);
            [x + (gap + size[0] / 2.0) * cos, y - (gap + size[1] / 2.0) * sin]
        })
    });
    inside.into_iter().chain(about).map(|place| (0.0, place))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overview;
    use pcr_formats::scenario::Scenario;
    use pcr_planning::fleet::{Fleet, build_ecm};
    use serde_json::{Value, json};

    /// Agents on a spiral, near each other in its middle; `label` gives their labels.
    fn spiral(count: u32, apart: f64, label: impl Fn(u32) -> String) -> Value {
        let agent = |k: u32| {
            let (far, (sin, cos)) = (apart * f64::from(k).sqrt(), (2.4 * f64::from(k)).sin_cos());
            json!({ "id": k + 1, "label": label(k), "radius": 0.3, "v_max": 1.0, "a_max": 0.5,
                "start": { "x": far * cos, "y": far * sin, "heading": 0.7 * f64::from(k) },
                "path": [{ "kind": "line", "length": 4 + k % 5 }] })
        };
        let name = "A name of a scenario that somebody made from the path of a file in some build system";
        json!({ "name": name, "agents": (0..count).map(agent).collect::<Vec<_>>() })
    }

    fn with_scene<T>(scenario: &Value, look: impl FnOnce(&RegionScene<'_>) -> T) -> T {
        let scenario = Scenario::from_json(&scenario.to_string()).unwrap();
        let fleet = Fleet::<f64>::new(&scenario).unwrap();
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).unwrap();
        look(&RegionScene { scenario: &scenario, motions: &motions, ecm: &ecm, egos: None, ground: None })
    }

    /// The texts of all agents, after a check that they lie in the frame and apart, and what is said about those left out.
    fn texts(scenario: &Value) -> (Vec<Option<String>>, Option<String>) {
        with_scene(scenario, |scene| {
            let frame = frame(scene, 500.0, [0.0, 0.0]);
            let names = DiscLabels::new(scene, &frame);
            let boxes: Vec<[f64; 4]> =
                names.texts.iter().flatten().map(|(at, text)| around(*at, extent(text))).collect();
            let [left, top, right, bottom] = frame.edges;
            for (k, a) in boxes.iter().enumerate() {
                let within = left <= a[0] && top <= a[1] && a[2] <= right && a[3] <= bottom;
                assert!(within, "{a:?} in {:?}", frame.edges);
                let apart = |b: &&[f64; 4]| a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3];
                assert!(boxes[..k].iter().all(|b| apart(&b)), "{a:?}");
            }
            (names.texts.iter().map(|text| text.clone().map(|(_, text)| text)).collect(), names.left_out())
        })
    }

    #[test]
    fn long_labels_of_many_agents_do_not_overlap() {
        let label = |k: u32| format!("AGV-2024-{k:04} order 7f3a-{k:04}");
        let (texts, said) = texts(&spiral(60, 0.9, label));
        let numbers = texts.iter().flatten().filter(|text| !text.contains("AGV")).count();
        assert!(texts.iter().all(Option::is_some) && numbers > 30, "{texts:?}");
        assert_eq!(said, Some(format!("For want of room, {numbers} agents have their number alone.")));
    }

    #[test]
    fn few_agents_have_their_labels() {
        let (texts, said) = texts(&spiral(5, 4.0, |k| format!("AGV-{k}")));
        let expected: Vec<_> = (0..5).map(|k| Some(format!("{} AGV-{k}", k + 1))).collect();
        assert_eq!((texts, said), (expected, None));
    }

    #[test]
    fn numbers_without_room_are_counted() {
        let (texts, said) = texts(&spiral(400, 0.05, |_| String::new()));
        let missing = texts.iter().filter(|text| text.is_none()).count();
        assert!(missing > 100, "{missing}");
        assert_eq!(said, Some(format!("For want of room, {missing} agents have no number.")));
        let drawn = with_scene(&spiral(400, 0.05, |_| String::new()), picture);
        assert!(drawn.contains("For want of room,"), "the picture says so");
    }

    #[test]
    fn titles_stay_above_their_plots() {
        let scenario = spiral(60, 0.9, |k| format!("AGV-2024-{k:04} order 7f3a-{k:04}"));
        let svg = with_scene(&scenario, overview::picture);
        let document = roxmltree::Document::parse(&svg).unwrap();
        let number = |node: roxmltree::Node<'_, '_>, name| node.attribute(name).unwrap().parse::<f64>().unwrap();
        let titles = document.descendants().filter(|node| node.attribute("font-size") == Some("11.5"));
        let spans: Vec<[f64; 2]> = titles
            .map(|node| {
                let half = text_width(node.text().unwrap(), 11.5) / 2.0;
                [number(node, "x") - half, number(node, "x") + half]
            })
            .collect();
        let [left, right] = spans[..] else { panic!("{spans:?}") };
        let width = number(document.root_element(), "width");
        assert!(left[0] > 0.0 && left[1] < right[0] && right[1] < width, "{spans:?} of {width}");
        let whole = document.descendants().find(|node| node.has_tag_name("title")).and_then(|node| node.text());
        assert!(whole.is_some_and(|title| title.contains("order 7f3a-")), "whole for who cannot see it: {whole:?}");
    }
}

//! The labels of regions: the number of the other agent, in the region or beside it.

use super::super::axis::PlotArea;
use super::super::labels::{LabelPlacer, SPACING};
use super::super::region_scene::{DrawnRegion, RegionScene};
use super::super::svg::{PixelCoordinate, SvgWriter, text_width};
use super::LABEL_SIZE;
use pcr_core::Interval;
use pcr_planning::agent_regions::BoxGrid;

/// Weights of covering the trajectory, and the outline of a region.
const WEIGHTS: [f64; 2] = [8.0, 1.0];

/// Weight of a label that lies in the region of another agent.
const MISLEADING: f64 = 12.0;

/// Labels of a map at most, those of its largest regions: more would only hide one another.
const MOST: usize = 400;

/// The labels of the regions of a map.
#[derive(Debug)]
pub(in super::super) struct RegionLabels {
    /// Where the middle of each belongs \[px\]; none where there is no room for it.
    pub(in super::super) places: Vec<Option<[f64; 2]>>,
}

impl RegionLabels {
    /// Labels of this size for the regions of an ego.
    pub(in super::super) fn new(
        scene: &RegionScene<'_>,
        ego: usize,
        shapes: &[DrawnRegion],
        frame: &PlotArea,
        label_size: f64,
    ) -> Self {
        Self { places: places(scene, ego, shapes, frame, label_size) }
    }

    /// What is said about regions without a label.
    pub(in super::super) fn left_out(&self) -> Option<String> {
        let missing = self.places.iter().filter(|place| place.is_none()).count();
        let have = if missing == 1 { "has" } else { "have" };
        (missing > 0).then(|| format!("For want of room, {missing} of {} regions {have} no label.", self.places.len()))
    }

    /// Writes them.
    pub(super) fn draw(&self, svg: &mut SvgWriter, scene: &RegionScene<'_>, shapes: &[DrawnRegion]) {
        svg.start(
            "g",
            &[
                ("font-size", &PixelCoordinate(LABEL_SIZE)),
                ("stroke", &"#fff"),
                ("stroke-width", &"2.2"),
                ("paint-order", &"stroke"),
            ],
        );
        for (shape, place) in shapes.iter().zip(&self.places) {
            let Some([x, y]) = *place else {
                continue;
            };
            let (text, ink) = (scene.id(shape.other).to_string(), scene.colour(shape.other).ink());
            svg.label([x, y + 0.36 * LABEL_SIZE], "middle", &[("fill", &ink), ("stroke-linejoin", &"round")], &text);
        }
        svg.end();
    }
}

/// Where the middle of each label of this size belongs \[px\]: off the ego's trajectory, off one another and, where
/// possible, off outlines.
fn places(
    scene: &RegionScene<'_>,
    ego: usize,
    shapes: &[DrawnRegion],
    frame: &PlotArea,
    label_size: f64,
) -> Vec<Option<[f64; 2]>> {
    let mut labels = LabelPlacer::default();
    if let Some(motion) = scene.motions.get(ego) {
        let [left, _, right, _] = frame.edges;
        let steps = ((right - left) / SPACING).max(1.0) as usize;
        let (from, step) = (frame.x.values().lo, frame.x.values().length() / steps as f64);
        let at = |time| frame.at([time, motion.length_at(time)]);
        labels.avoid(WEIGHTS[0], (0..=steps).map(|k| at(from + step * k as f64)));
    }
    let on_frame = |contour: &Vec<[f64; 2]>| contour.iter().map(|point| frame.at(*point)).collect::<Vec<_>>();
    let outlines: Vec<Vec<Vec<[f64; 2]>>> =
        shapes.iter().map(|shape| shape.outline.iter().map(on_frame).collect()).collect();
    for contour in outlines.iter().flatten() {
        labels.avoid(WEIGHTS[1], spaced(contour));
    }
    let boxes = BoxGrid::new(outlines.iter().map(|outline| around(outline)).collect());
    // Small regions have the smallest choice.
    let mut order: Vec<(usize, &DrawnRegion)> = shapes.iter().enumerate().collect();
    let area = |shape: &DrawnRegion| shape.time.length() * shape.length.length();
    order.sort_by(|a, b| area(a.1).total_cmp(&area(b.1)));
    let mut places = vec![None; shapes.len()];
    for (k, shape) in order.into_iter().skip(shapes.len().saturating_sub(MOST)) {
        let text = scene.id(shape.other).to_string();
        let size = [text_width(&text, label_size) + 2.0, label_size];
        let misleading = |place: [f64; 2]| {
            let near = boxes.near(&[place[0], place[1], place[0], place[1]]);
            let others = near.into_iter().map(|other| other as usize).filter(|other| *other != k);
            let around = others.filter(|&other| outlines.get(other).is_some_and(|outline| encloses(outline, place)));
            MISLEADING * around.count() as f64
        };
        let candidates = candidates(shape, size, frame).into_iter().map(|place| (misleading(place), place));
        places[k] = labels.best_position(size, candidates, frame.edges);
    }
    places
}

/// Where the label of a region may go: into its roomiest slices, into its strips, or about it.
fn candidates(shape: &DrawnRegion, [width, height]: [f64; 2], frame: &PlotArea) -> Vec<[f64; 2]> {
    let [left, _, right, _] = frame.edges;
    let ends = [shape.time.lo, shape.time.hi].map(|time| frame.x.at(time));
    let mut inner: Vec<(f64, [f64; 2])> = Vec::new();
    for (time, slice) in &shape.slices {
        let [x, y] = frame.at([*time, slice.middle()]);
        let tall = (frame.y.at(slice.lo) - frame.y.at(slice.hi)) / height;
        let wide = 2.0 * (x - ends[0]).min(ends[1] - x) / width;
        inner.push((tall.min(wide), [x, y]));
    }
    inner.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (mut places, cramped): (Vec<_>, Vec<_>) = inner.into_iter().partition(|(room, _)| *room > 1.0);
    let beside = |x: f64, slices: &[Interval<f64>]| -> Vec<(f64, [f64; 2])> {
        slices.iter().map(|slice| (0.0, [x, frame.y.at(slice.middle())])).collect()
    };
    places.extend(beside(left + width, &shape.before));
    places.extend(beside(right - width, &shape.after));
    let (x, y) = ((ends[0] + ends[1]) / 2.0, frame.y.at(shape.length.middle()));
    let top = frame.y.at(shape.length.hi) - height / 2.0 - 2.0;
    let bottom = frame.y.at(shape.length.lo) + height / 2.0 + 2.0;
    let (before, after) = (ends[0] - width / 2.0 - 2.0, ends[1] + width / 2.0 + 2.0);
    let around = [
        [after, y],
        [before, y],
        [x, top],
        [x, bottom],
        [after, top],
        [before, top],
        [after, bottom],
        [before, bottom],
    ];
    let beside_slices = shape.slices.iter().flat_map(|(time, slice)| {
        let x = frame.x.at(*time);
        [[x, frame.y.at(slice.hi) - height / 2.0 - 2.0], [x, frame.y.at(slice.lo) + height / 2.0 + 2.0]]
    });
    places.extend(cramped.into_iter().take(1));
    places.into_iter().map(|(_, place)| place).chain(beside_slices).chain(around).collect()
}

/// The box around an outline: left, top, right and bottom \[px\].
fn around(outline: &[Vec<[f64; 2]>]) -> [f64; 4] {
    let hull = |b: [f64; 4], [x, y]: &[f64; 2]| [b[0].min(*x), b[1].min(*y), b[2].max(*x), b[3].max(*y)];
    let nowhere = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let found = outline.iter().flatten().fold(nowhere, hull);
    if found[0] <= found[2] { found } else { [0.0; 4] }
}

/// Whether a point lies inside of an outline: a ray from it to the right crosses the outline an odd number of times.
fn encloses(outline: &[Vec<[f64; 2]>], [x, y]: [f64; 2]) -> bool {
    let sides = outline.iter().flat_map(|contour| contour.iter().zip(contour.iter().cycle().skip(1)));
    let crossed =
        sides.filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
    !crossed.count().is_multiple_of(2)
}

/// Points on the sides of a polygon, [`SPACING`] apart.
fn spaced(polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    let mut due = 0.0;
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let side = (b[0] - a[0]).hypot(b[1] - a[1]);
        while due < side {
            let part = due / side;
            points.push([a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]);
            due += SPACING;
        }
        due -= side;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::spans;
    use pcr_formats::scenario::Scenario;
    use pcr_planning::fleet::{Fleet, build_ecm};

    #[test]
    fn a_hole_is_not_inside() {
        let square = |side: f64| vec![[-side, -side], [side, -side], [side, side], [-side, side]];
        let ring = [square(2.0), square(1.0)];
        assert!(encloses(&ring, [1.5, 0.0]) && !encloses(&ring, [0.0, 0.0]) && !encloses(&ring, [3.0, 0.0]));
    }

    #[test]
    fn a_map_without_room_says_how_many_labels_it_has_not() {
        let scenario = Scenario::from_json(pcr_formats::paper_example::SCENARIO).unwrap();
        let fleet = Fleet::<f64>::new(&scenario).unwrap();
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).unwrap();
        let scene = RegionScene { scenario: &scenario, motions: &motions, ecm: &ecm, egos: None, ground: None };
        let [time, length] = spans(&scene, 2);
        let frame = PlotArea::new(time, length, [0.0, 0.0, 60.0, 40.0]);
        let shapes = scene.shapes(2, [frame.x.units_per_pixel(), frame.y.units_per_pixel()]);
        let names = RegionLabels::new(&scene, 2, &shapes, &frame, LABEL_SIZE);
        let missing = names.places.iter().filter(|place| place.is_none()).count();
        assert!((1..shapes.len()).contains(&missing), "{missing} of {}", shapes.len());
        assert_eq!(names.left_out(), Some(format!("For want of room, {missing} of 18 regions have no label.")));
        for [x, y] in names.places.into_iter().flatten() {
            assert!((0.0..=60.0).contains(&x) && (0.0..=40.0).contains(&y), "{x} {y}");
        }
    }

    #[test]
    fn labels_of_the_paper_do_not_overlap() {
        let scenario = Scenario::from_json(pcr_formats::paper_example::SCENARIO).unwrap();
        let fleet = Fleet::<f64>::new(&scenario).unwrap();
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).unwrap();
        let scene = RegionScene { scenario: &scenario, motions: &motions, ecm: &ecm, egos: None, ground: None };
        for ego in 0..motions.len() {
            let [time, length] = spans(&scene, ego);
            let frame = PlotArea::new(time, length, [0.0, 0.0, 400.0, 320.0]);
            let shapes = scene.shapes(ego, [frame.x.units_per_pixel(), frame.y.units_per_pixel()]);
            let places: Vec<[f64; 2]> =
                places(&scene, ego, &shapes, &frame, LABEL_SIZE).into_iter().map(Option::unwrap).collect();
            let width = |k: usize| text_width(&scene.id(shapes[k].other).to_string(), LABEL_SIZE);
            for i in 0..places.len() {
                for j in 0..i {
                    let apart = [(places[i][0] - places[j][0]).abs(), (places[i][1] - places[j][1]).abs()];
                    let free = apart[0] >= (width(i) + width(j)) / 2.0 || apart[1] >= LABEL_SIZE;
                    assert!(free, "agent {}: regions {i} and {j}", scene.id(ego));
                }
            }
        }
    }
}

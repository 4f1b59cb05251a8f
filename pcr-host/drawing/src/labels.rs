//! Positions of labels: each label gets the best of its candidate positions that are free, or none.

use std::collections::HashMap;

/// A box: left, top, right, bottom \[px\].
type LabelBox = [f64; 4];

/// What may lie on another label or outside of the picture, by rounding \[px²\].
const SLACK: f64 = 1e-6;

/// Distance of the points by which lines are to be given \[px\].
pub(super) const SPACING: f64 = 3.0;

/// Weight of each step down the list of candidates.
const RANK: f64 = 0.6;

/// Side of the cells in which points are kept \[px\]: about as large as a label.
const CELL: f64 = 16.0;

/// The labels of a picture, and what they should keep off.
#[derive(Clone, Debug, Default)]
pub(super) struct LabelPlacer {
    taken: Vec<LabelBox>,
    /// Points of lines, by their cells.
    lines: HashMap<[i64; 2], Vec<(f64, [f64; 2])>>,
}

fn cell([x, y]: [f64; 2]) -> [i64; 2] {
    [x, y].map(|value| (value / CELL).floor() as i64)
}

impl LabelPlacer {
    /// Keeps labels off an area.
    pub(super) fn block(&mut self, area: LabelBox) {
        self.taken.push(area);
    }

    /// Keeps labels off a line through these points, [`SPACING`] apart; each that a label covers weighs `weight`.
    pub(super) fn avoid(&mut self, weight: f64, points: impl IntoIterator<Item = [f64; 2]>) {
        for point in points {
            self.lines.entry(cell(point)).or_default().push((weight, point));
        }
    }

    /// The weights of the points in an area.
    fn crossed(&self, area: LabelBox) -> f64 {
        let [from, to] = [cell([area[0], area[1]]), cell([area[2], area[3]])];
        let cells = (from[0]..=to[0]).flat_map(|column| (from[1]..=to[1]).map(move |row| [column, row]));
        let points = cells.filter_map(|cell| self.lines.get(&cell)).flatten();
        points.filter(|(_, point)| contains(area, *point)).map(|(weight, _)| weight).sum()
    }

    /// Place of the middle of a label of this width and height: the best of the candidates, which is then taken. A
    /// candidate comes with what speaks against it by itself; earlier ones are preferred. `None` if each of them would
    /// lie on what is taken, or reach out of the picture: a label there could not be read, nor what it lies on.
    pub(super) fn best_position(
        &mut self,
        size: [f64; 2],
        candidates: impl IntoIterator<Item = (f64, [f64; 2])>,
        within: LabelBox,
    ) -> Option<[f64; 2]> {
        let mut best: Option<(f64, [f64; 2])> = None;
        for (rank, (weight, candidate)) in candidates.into_iter().enumerate() {
            let cost = weight + RANK * rank as f64;
            if best.is_some_and(|(least, _)| least <= cost) {
                continue;
            }
            let area = around(candidate, size);
            let outside = size[0] * size[1] - overlap(area, within);
            if outside > SLACK || self.taken.iter().any(|taken| overlap(*taken, area) > SLACK) {
                continue;
            }
            let cost = cost + self.crossed(area);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, candidate));
            }
        }
        let (_, place) = best?;
        self.taken.push(around(place, size));
        Some(place)
    }

    /// The weights of the points that a label of this width and height would cover.
    pub(super) fn covers(&self, place: [f64; 2], size: [f64; 2]) -> f64 {
        self.crossed(around(place, size))
    }

    /// Frees the place of a label that is taken away again.
    pub(super) fn free(&mut self, place: [f64; 2], size: [f64; 2]) {
        let area = around(place, size);
        if let Some(found) = self.taken.iter().rposition(|taken| *taken == area) {
            self.taken.remove(found);
        }
    }
}

/// The box of a label about its middle.
pub(super) fn around([x, y]: [f64; 2], [width, height]: [f64; 2]) -> LabelBox {
    [x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0]
}

fn overlap(a: LabelBox, b: LabelBox) -> f64 {
    let width = a[2].min(b[2]) - a[0].max(b[0]);
    let height = a[3].min(b[3]) - a[1].max(b[1]);
    width.max(0.0) * height.max(0.0)
}

fn contains(area: LabelBox, [x, y]: [f64; 2]) -> bool {
    area[0] <= x && x <= area[2] && area[1] <= y && y <= area[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: LabelBox = [0.0, 0.0, 100.0, 100.0];

    #[test]
    fn labels_avoid_one_another_and_the_edge() {
        let mut labels = LabelPlacer::default();
        let places = [(0.0, [50.0, 50.0]), (0.0, [98.0, 50.0]), (0.0, [50.0, 70.0])];
        assert_eq!(labels.best_position([20.0, 10.0], places, ALL), Some([50.0, 50.0]));
        assert_eq!(labels.best_position([20.0, 10.0], places, ALL), Some([50.0, 70.0]));
        // The third one would lie on one of them, or reach out of the picture.
        assert_eq!(labels.best_position([20.0, 10.0], places, ALL), None);
        labels.free([50.0, 50.0], [20.0, 10.0]);
        assert_eq!(labels.best_position([20.0, 10.0], places, ALL), Some([50.0, 50.0]));
    }

    #[test]
    fn labels_avoid_lines() {
        let mut labels = LabelPlacer::default();
        labels.avoid(1.0, (0..10).map(|k| [45.0 + f64::from(k), 50.0]));
        assert_eq!(
            labels.best_position([20.0, 10.0], [(0.0, [50.0, 50.0]), (0.0, [50.0, 60.0])], ALL),
            Some([50.0, 60.0])
        );
    }

    #[test]
    fn a_label_without_candidates_has_no_place() {
        assert_eq!(LabelPlacer::default().best_position([1.0, 1.0], [], ALL), None);
    }
}

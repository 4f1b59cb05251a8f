//! Which agents may come near one another: boxes around all that they pass, in the order of their left sides.

use crate::ball::Ball;
use crate::double_double::DoubleDouble;
use crate::path::PreparedSegment;
use crate::plane::BallCarrier;

/// Left, bottom, right and top \[m\].
pub(crate) type PlainBox = [f64; 4];

/// Whether two boxes have a point in common.
fn meet(a: &PlainBox, b: &PlainBox) -> bool {
    a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
}

/// An index of boxes: rows as high as the highest box, and in each row the boxes whose lower side is in it, in the order of their left sides.
#[derive(Clone, Debug)]
pub(crate) struct BoxIndex {
    areas: Vec<PlainBox>,
    /// Places of the boxes, by their rows and left sides.
    order: Vec<usize>,
    /// No box is wider \[m\].
    widest: f64,
    /// No box is higher \[m\].
    highest: f64,
}

impl BoxIndex {
    pub(crate) fn new(areas: Vec<PlainBox>) -> Self {
        let most = |axis: usize| areas.iter().map(|area| (area[axis + 2] - area[axis]).next_up()).fold(0.0, f64::max);
        let mut near = Self { widest: most(0), highest: most(1), order: (0..areas.len()).collect(), areas };
        let mut order = std::mem::take(&mut near.order);
        order.sort_by(|&a, &b| near.row(a).total_cmp(&near.row(b)).then(near.left(a).total_cmp(&near.left(b))));
        Self { order, ..near }
    }

    fn left(&self, place: usize) -> f64 {
        self.areas[place][0]
    }

    fn row(&self, place: usize) -> f64 {
        self.row_of(self.areas[place][1])
    }

    /// The row of an ordinate; never less for a larger one.
    fn row_of(&self, y: f64) -> f64 {
        // All are in one row if one of them reaches without end. Adding 0 makes 0 of -0, which is equal to it and sorted before it: the boxes
        // of one row would not be in the order of their left sides.
        if self.highest < f64::INFINITY { (y / self.highest).floor() + 0.0 } else { 0.0 }
    }

    /// Places behind this one whose boxes meet its own, in order. O(boxes in the same rows and the rows beside them, no farther to the left
    /// than the widest box is wide).
    pub(crate) fn after(&self, place: usize) -> Vec<usize> {
        let Some(own) = self.areas.get(place) else { return Vec::new() };
        let (lowest, leftmost) = ((own[1] - self.highest).next_down(), (own[0] - self.widest).next_down());
        let (first, last) = (self.row_of(lowest), self.row_of(own[3]));
        let mut rest = &self.order[self.order.partition_point(|&place| self.row(place) < first)..];
        let mut near = Vec::new();
        while let Some(row) = rest.first().map(|&place| self.row(place)).filter(|row| *row <= last) {
            let (own_row, others) = rest.split_at(rest.partition_point(|&place| self.row(place) <= row));
            let begin = own_row.partition_point(|&place| self.left(place) < leftmost);
            let those = own_row[begin..].iter().copied().take_while(|&place| self.left(place) <= own[2]);
            near.extend(those.filter(|&other| other > place && meet(own, &self.areas[other])));
            rest = others;
        }
        near.sort_unstable();
        near
    }
}

/// The box around all stretches, grown by a reach. No point of a stretch is farther from its nearer end than half its length, and a line
/// lies between its ends.
pub(crate) fn area(stretches: &[PreparedSegment], reach: f64) -> PlainBox {
    let mut area = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for stretch in stretches {
        let (carrier, length) = (stretch.placed.exact, stretch.placed.length);
        let bulge = match carrier {
            BallCarrier::Line { .. } => 0.0,
            BallCarrier::Circle { .. } => (0.5 * length.to_f64()).next_up().next_up(),
        };
        for end in [Ball::from(0.0), Ball { mid: length, err: 0.0 }].map(|along| carrier.point(along)) {
            let mut add = |axis: usize, value: Ball<DoubleDouble>| {
                // Once for each sum: the number itself is rounded, too.
                let grown = (value.err + bulge).next_up() + reach;
                let (middle, grown) = (value.mid.to_f64(), grown.next_up());
                // What is no number may be anywhere.
                let outward = |side: f64, end: f64| if side.is_nan() { end } else { side };
                let (lo, hi) = ((middle.next_down() - grown).next_down(), (middle.next_up() + grown).next_up());
                area[axis] = area[axis].min(outward(lo, f64::NEG_INFINITY));
                area[axis + 2] = area[axis + 2].max(outward(hi, f64::INFINITY));
            };
            add(0, end.x);
            add(1, end.y);
        }
    }
    area
}

#[cfg(test)]
mod tests {
    use super::{BoxIndex, PlainBox, meet};
    use crate::dice::Dice;

    #[test]
    fn all_boxes_that_meet_are_found() {
        let inf = f64::INFINITY;
        let far = [[1e300, 1e300, 1e300, 1e300], [-1e300, -1e300, -1e300, -1e300], [0.0, 1e18, 1.0, 1e18]];
        let endless = [[-inf, -inf, inf, inf], [0.0, -inf, 1.0, inf], [-inf, 2.0, inf, 3.0]];
        // Their row is -0, unless it is made 0, and begins with their left sides where that of the others ends.
        let zeros = [[5.0, -0.0, 6.0, 1.0], [6.0, -5e-324, 7.0, 1.0], [7.0, 0.0, 8.0, 1.0]];
        for (count, others) in [(0, &[][..]), (400, &[]), (400, &zeros), (400, &far), (400, &endless), (0, &endless)] {
            let mut dice = Dice(1);
            let mut random = || dice.between(0.0, 16.0);
            let mut areas: Vec<PlainBox> = (0..count)
                .map(|k| {
                    // Sides on whole numbers touch, and some boxes are points.
                    let (x, y) = (random().floor() - 8.0, random().floor() - 8.0);
                    let [wide, high] =
                        [random(), random()].map(|size| if k % 2 == 0 { (0.25 * size).floor() } else { 0.0 });
                    [x, y, x + wide, y + high]
                })
                .collect();
            areas.extend(others);
            let near = BoxIndex::new(areas.clone());
            for place in 0..areas.len() {
                let behind = place + 1..areas.len();
                let all: Vec<usize> = behind.filter(|&other| meet(&areas[place], &areas[other])).collect();
                assert_eq!(near.after(place), all, "{:?}", areas[place]);
            }
        }
    }
}

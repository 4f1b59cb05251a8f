//! Which agents may come near one another: boxes around all that they pass, in the order of their left sides.

use crate::ball::Ball;
use crate::path::Stretch;
use crate::plane::Carrier;
use crate::twofold::Twofold;

/// Left, bottom, right and top \[m\].
pub(crate) type Area = [f64; 4];

/// Whether two boxes have a point in common.
fn meet(a: &Area, b: &Area) -> bool {
    a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
}

/// An index of boxes.
#[derive(Clone, Debug)]
pub(crate) struct Near {
    areas: Vec<Area>,
    /// Places of the boxes, by their left sides.
    order: Vec<usize>,
    /// No box is wider \[m\].
    widest: f64,
}

impl Near {
    pub(crate) fn new(areas: Vec<Area>) -> Self {
        let mut order: Vec<usize> = (0..areas.len()).collect();
        order.sort_by(|&a, &b| areas[a][0].total_cmp(&areas[b][0]));
        let widest = areas.iter().map(|area| (area[2] - area[0]).next_up()).fold(0.0, f64::max);
        Self { areas, order, widest }
    }

    /// Places behind this one whose boxes meet its own, in order. O(boxes no farther to the left than the widest box is wide).
    pub(crate) fn after(&self, place: usize) -> Vec<usize> {
        let Some(own) = self.areas.get(place) else { return Vec::new() };
        let left = |&place: &usize| self.areas[place][0];
        let first = self.order.partition_point(|place| left(place) < (own[0] - self.widest).next_down());
        let those = self.order[first..].iter().copied().take_while(|place| left(place) <= own[2]);
        let mut near: Vec<usize> = those.filter(|&other| other > place && meet(own, &self.areas[other])).collect();
        near.sort_unstable();
        near
    }
}

/// The box around all stretches, grown by a reach. No point of a stretch is farther from its nearer end than half its length, and a line
/// lies between its ends.
pub(crate) fn area(stretches: &[Stretch], reach: f64) -> Area {
    let mut area = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for stretch in stretches {
        let (carrier, length) = (stretch.placed.exact, stretch.placed.length);
        let bulge = match carrier {
            Carrier::Line { .. } => 0.0,
            Carrier::Circle { .. } => (0.5 * length.to_f64()).next_up().next_up(),
        };
        for end in [Ball::from(0.0), Ball { mid: length, err: 0.0 }].map(|along| carrier.point(along)) {
            let mut add = |axis: usize, value: Ball<Twofold>| {
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

//! Which agents may come near one another: boxes around all that they pass, in the order of their left sides.

use crate::mover::Mover;

/// Left, bottom, right and top \[m\].
pub(crate) type Area = [f64; 4];

/// Whether two boxes have a point in common.
fn meet(a: &Area, b: &Area) -> bool {
    a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
}

/// An index of boxes.
pub(crate) struct Near<'a> {
    movers: &'a [Mover],
    /// Places of the boxes, by their left sides.
    order: Vec<usize>,
    /// No box is wider \[m\].
    widest: f64,
}

impl<'a> Near<'a> {
    pub(crate) fn new(movers: &'a [Mover]) -> Self {
        let mut order: Vec<usize> = (0..movers.len()).collect();
        order.sort_by(|&a, &b| movers[a].area[0].total_cmp(&movers[b].area[0]));
        let widths = movers.iter().map(|mover| (mover.area[2] - mover.area[0]).next_up());
        Self { movers, order, widest: widths.fold(0.0, f64::max) }
    }

    /// Places behind this one whose boxes meet its own, in order. O(boxes no farther to the left than the widest box is wide).
    pub(crate) fn after(&self, place: usize) -> Vec<usize> {
        let Some(own) = self.movers.get(place).map(|mover| &mover.area) else { return Vec::new() };
        let left = |&place: &usize| self.movers[place].area[0];
        let first = self.order.partition_point(|place| left(place) < (own[0] - self.widest).next_down());
        let those = self.order[first..].iter().copied().take_while(|place| left(place) <= own[2]);
        let mut near: Vec<usize> =
            those.filter(|&other| other > place && meet(own, &self.movers[other].area)).collect();
        near.sort_unstable();
        near
    }
}

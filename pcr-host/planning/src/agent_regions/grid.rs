//! Finds boxes that meet, with an even grid: each box is in all cells that it covers. A cell has the average size of
//! the boxes, so in a fleet of constant density a box has a constant number of neighbours.

use crate::parallel;

/// Cells for each box at most: long boxes cannot fill the memory.
const CELLS: f64 = 4.0;

/// Boxes whose neighbours are counted at once.
const COUNTED: usize = 1024;

/// Left, bottom, right, top.
type GridBox = [f64; 4];

/// An index of boxes.
#[derive(Clone, Debug)]
pub struct BoxGrid {
    boxes: Vec<GridBox>,
    origin: [f64; 2],
    cell: f64,
    size: [usize; 2],
    /// Where the boxes of each cell begin in `members`, and after the last one its end.
    begins: Vec<u32>,
    members: Vec<u32>,
}

fn meet(a: &GridBox, b: &GridBox) -> bool {
    a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
}

impl BoxGrid {
    /// The index of some boxes. O(boxes) if they are of about the same size, O(boxes^1.5) at worst.
    pub fn new(boxes: Vec<GridBox>) -> Self {
        let all = boxes.iter().copied().reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]);
        let all = all.unwrap_or([0.0; 4]);
        let (width, height) = (all[2] - all[0], all[3] - all[1]);
        let count = boxes.len().max(1) as f64;
        let mean = boxes.iter().map(|b| 0.5 * (b[2] - b[0] + b[3] - b[1])).sum::<f64>() / count;
        let smallest = (width * height / (CELLS * count)).sqrt().max(width.max(height) / (CELLS * count));
        let cell = mean.max(smallest).max(f64::MIN_POSITIVE);
        let size = [width, height].map(|side| (side / cell) as usize + 1);
        let mut grid = Self { boxes, origin: [all[0], all[1]], cell, size, begins: Vec::new(), members: Vec::new() };
        grid.fill();
        grid
    }

    /// Sorts the boxes by their cells, in two passes.
    fn fill(&mut self) {
        let mut begins = vec![0_u32; self.size[0] * self.size[1] + 1];
        for b in &self.boxes {
            self.cells(b).for_each(|cell| begins[cell + 1] += 1);
        }
        for cell in 1..begins.len() {
            begins[cell] += begins[cell - 1];
        }
        let mut next = begins.clone();
        let mut members = vec![0; begins.last().map_or(0, |&end| end as usize)];
        for (k, b) in self.boxes.iter().enumerate() {
            for cell in self.cells(b) {
                members[next[cell] as usize] = k as u32;
                next[cell] += 1;
            }
        }
        (self.begins, self.members) = (begins, members);
    }

    fn cell_index(&self, axis: usize, value: f64) -> usize {
        // A cast saturates: what is left of the grid is in its first cell, what is right of it in the last one.
        (((value - self.origin[axis]) / self.cell) as usize).min(self.size[axis] - 1)
    }

    /// The cells that a box covers.
    fn cells(&self, b: &GridBox) -> impl Iterator<Item = usize> + use<> {
        let columns = self.cell_index(0, b[0])..=self.cell_index(0, b[2]);
        let rows = self.cell_index(1, b[1])..=self.cell_index(1, b[3]);
        let width = self.size[0];
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// The boxes along a Hilbert curve: neighbours come soon after one another.
    pub fn order(&self) -> Vec<u32> {
        let cell = |&place: &u32| {
            let b = &self.boxes[place as usize];
            hilbert([self.cell_index(0, b[0]), self.cell_index(1, b[1])].map(|place| place as u32))
        };
        let mut order: Vec<u32> = (0..self.boxes.len() as u32).collect();
        order.sort_by_cached_key(cell);
        order
    }

    /// The boxes that meet one, in increasing order. O(boxes in the cells that it covers).
    pub fn near(&self, b: &GridBox) -> Vec<u32> {
        let mut near = Vec::new();
        self.meeting(b, &mut near);
        near
    }

    /// The same in place of what is in `near`.
    pub fn meeting(&self, b: &GridBox, near: &mut Vec<u32>) {
        self.find(b, 0, near);
    }

    /// The boxes from a place on that meet one, in increasing order.
    fn find(&self, b: &GridBox, from: usize, near: &mut Vec<u32>) {
        near.clear();
        for cell in self.cells(b) {
            let members = &self.members[self.begins[cell] as usize..self.begins[cell + 1] as usize];
            let meets = |other: &GridBox| {
                // Two boxes may share many cells; the one with the lower left corner of what they share counts.
                let corner = [b[0].max(other[0]), b[1].max(other[1])];
                meet(b, other) && self.cell_index(1, corner[1]) * self.size[0] + self.cell_index(0, corner[0]) == cell
            };
            // Members are in increasing order.
            let members = &members[members.partition_point(|&member| (member as usize) < from)..];
            near.extend(members.iter().copied().filter(|&member| meets(&self.boxes[member as usize])));
        }
        near.sort_unstable();
    }

    /// The other boxes that meet this one, in increasing order, in place of what is in `near`.
    pub fn around(&self, place: usize, near: &mut Vec<u32>) {
        match self.boxes.get(place) {
            Some(b) => self.find(b, 0, near),
            None => near.clear(),
        }
        near.retain(|&other| other as usize != place);
    }

    /// How many others meet each box: what a pass over all of them looks at. O(boxes in the cells that they cover), on all cores.
    pub fn counts(&self) -> Vec<u32> {
        let count = self.boxes.len();
        let of_some = |some: usize| {
            let mut near = Vec::new();
            let places = some * COUNTED..count.min((some + 1) * COUNTED);
            let counted = places.map(|place| {
                self.around(place, &mut near);
                near.len() as u32
            });
            counted.collect::<Vec<u32>>()
        };
        parallel::map_parallel(0..count.div_ceil(COUNTED), &of_some).concat()
    }

    /// The boxes after this one that meet it, in increasing order, in place of what is in `near`.
    pub fn after(&self, place: usize, near: &mut Vec<u32>) {
        match self.boxes.get(place) {
            Some(b) => self.find(b, place + 1, near),
            None => near.clear(),
        }
    }
}

/// How far along a Hilbert curve a cell lies: from each cell it goes on to one beside it (Hilbert 1891).
fn hilbert([mut x, mut y]: [u32; 2]) -> u64 {
    let mut along = 0;
    for bit in (0..32).rev() {
        let [right, upper] = [x >> bit & 1, y >> bit & 1];
        along = along << 2 | u64::from((3 * right) ^ upper);
        // A quarter is a smaller curve, the lower two turned over.
        if upper == 0 {
            if right == 1 {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
    }
    along
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_from_each_cell_to_one_beside_it() {
        let mut cells: Vec<[u32; 2]> = (0..64).flat_map(|x| (0..64).map(move |y| [x, y])).collect();
        cells.sort_by_key(|&cell| hilbert(cell));
        assert_eq!(cells[0], [0, 0]);
        assert!(cells.windows(2).all(|pair| pair[0][0].abs_diff(pair[1][0]) + pair[0][1].abs_diff(pair[1][1]) == 1));
    }
}

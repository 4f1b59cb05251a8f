//! A few lengths along a segment, kept in a fixed room.
//!
//! Whether a root lies on its segment is as good as random to a processor: a length is written first and counted then, so
//! that no branch depends on it.

use crate::scalar::Scalar;
use core::cell::Cell;

/// Most events that a pair of segments has: 2 ends, 4 end contacts, 4 normal contacts, 4 for the whole circle and 2
/// changes of lap.
const MOST: usize = 16;

/// At most [`MOST`] lengths \[m\].
pub(crate) struct Lengths<S> {
    places: [S; MOST],
    count: usize,
}

impl<S: Scalar> Lengths<S> {
    pub(crate) fn new() -> Self {
        Self { places: [S::ZERO; MOST], count: 0 }
    }

    /// Adds a length if it `counts`.
    pub(crate) fn add(&mut self, length: S, counts: bool) {
        if let Some(place) = self.places.get_mut(self.count) {
            *place = length;
            // There is a place at it: no overflow.
            self.count = self.count.wrapping_add(usize::from(counts));
        }
    }

    /// Those that were added.
    pub(crate) fn as_slice(&self) -> &[S] {
        self.places.get(..self.count).unwrap_or_default()
    }

    /// Puts them in increasing order.
    pub(crate) fn sort(&mut self) {
        let places = Cell::from_mut(self.places.get_mut(..self.count).unwrap_or_default()).as_slice_of_cells();
        for last in 2..=places.len() {
            for neighbours in places.get(..last).unwrap_or_default().windows(2).rev() {
                let [below, above] = neighbours else { return };
                if below.get() <= above.get() {
                    break;
                }
                below.swap(above);
            }
        }
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;

    #[test]
    fn lengths_that_count_are_kept_in_order() {
        let mut lengths = Lengths::new();
        for (length, counts) in [(3.0, true), (1.0, true), (0.5, false), (2.0, true), (1.0, true), (9.0, false)] {
            lengths.add(length, counts);
        }
        assert_eq!(lengths.as_slice(), [3.0, 1.0, 2.0, 1.0]);
        lengths.sort();
        assert_eq!(lengths.as_slice(), [1.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn there_is_room_for_the_most_and_no_more() {
        let mut lengths = Lengths::new();
        (0..20_u8).for_each(|k| lengths.add(f64::from(20 - k), true));
        lengths.sort();
        assert_eq!(lengths.as_slice().len(), MOST);
        assert!(lengths.as_slice().is_sorted());
    }
}

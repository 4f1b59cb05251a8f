//! A short list of lengths along a segment.

use crate::array_vec::ArrayVec;
use crate::scalar::Scalar;
use core::cell::Cell;

/// Largest number of events of a pair of segments: 2 ends, 4 contacts with ends, 4 normal contacts and 2 changes of lap.
const MOST: usize = 12;

/// At most [`MOST`] lengths \[m\].
pub(crate) type LengthList<S> = ArrayVec<S, MOST>;

impl<S: Scalar, const N: usize> ArrayVec<S, N> {
    /// Sorts the lengths in increasing order.
    pub(crate) fn sort(&mut self) {
        let places = Cell::from_mut(self.as_mut_slice()).as_slice_of_cells();
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
    fn lengths_are_put_in_order() {
        let mut lengths = LengthList::new(0.0);
        (0..12_u8).for_each(|k| lengths.add(f64::from(7 * k % 12), true));
        lengths.sort();
        assert_eq!(lengths.as_slice().len(), MOST);
        assert!(lengths.as_slice().is_sorted());
    }
}

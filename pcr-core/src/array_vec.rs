//! A list of a few values, with a fixed capacity.
//!
//! A processor cannot predict whether a root lies on its segment. So a value is always written, and counted only if it
//! is valid, which needs no branch.

/// A list of at most `N` values.
#[derive(Clone, Copy)]
pub(crate) struct ArrayVec<T, const N: usize> {
    places: [T; N],
    count: usize,
}

impl<T: Copy, const N: usize> ArrayVec<T, N> {
    /// An empty list; its storage is filled with `anything`.
    pub(crate) fn new(anything: T) -> Self {
        Self { places: [anything; N], count: 0 }
    }

    /// Adds a value if it `counts`. `N` is chosen so that there is room for all values that count.
    pub(crate) fn add(&mut self, thing: T, counts: bool) {
        debug_assert!(!counts || self.count < N, "one more than {N}");
        if let Some(place) = self.places.get_mut(self.count) {
            *place = thing;
            // The index was in range, so this does not overflow.
            self.count = self.count.wrapping_add(usize::from(counts));
        }
    }

    /// Adds a value if there is room, and returns whether there was.
    pub(crate) fn push(&mut self, thing: T) -> bool {
        let Some(place) = self.places.get_mut(self.count) else { return false };
        *place = thing;
        // The index was in range, so this does not overflow.
        self.count = self.count.wrapping_add(1);
        true
    }

    /// Removes the last value.
    pub(crate) fn pop(&mut self) {
        self.count = self.count.saturating_sub(1);
    }

    /// Returns the values that were added, one by one.
    pub(crate) fn into_values(self) -> impl Iterator<Item = T> + Clone {
        self.places.into_iter().take(self.count)
    }

    /// Whether another value can be added.
    pub(crate) fn has_room(&self) -> bool {
        self.count < N
    }

    /// The values that were added.
    pub(crate) fn as_slice(&self) -> &[T] {
        self.places.get(..self.count).unwrap_or_default()
    }

    /// The values that were added.
    pub(crate) fn as_mut_slice(&mut self) -> &mut [T] {
        self.places.get_mut(..self.count).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::ArrayVec;

    #[test]
    fn what_counts_is_kept() {
        let mut few = ArrayVec::<_, 4>::new(0);
        for (thing, counts) in [(3, true), (1, true), (7, false), (2, true), (1, true), (9, false), (8, false)] {
            few.add(thing, counts);
        }
        assert_eq!(few.as_slice(), [3, 1, 2, 1]);
        few.as_mut_slice().sort_unstable();
        assert_eq!(few.as_slice(), [1, 1, 2, 3]);
    }

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "one more than 2")]
    fn one_too_many_is_noticed() {
        let mut few = ArrayVec::<_, 2>::new(0);
        (0..3).for_each(|thing| few.add(thing, true));
    }
}

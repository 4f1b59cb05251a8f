//! Random choices that are the same on every machine.

/// Choices from a seed: splitmix64 (Steele, Lea, Flood 2014).
pub(super) struct Choices(pub(super) u64);

impl Choices {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A place in a list of this length.
    fn below(&mut self, count: usize) -> usize {
        // The upper half of a product: below `count`, and as even as 64 bits allow.
        ((u128::from(self.next()) * count as u128) >> 64) as usize
    }

    /// The list in any order, each alike (Fisher and Yates).
    pub(super) fn shuffled(&mut self, list: &[usize]) -> Vec<usize> {
        let mut list = list.to_vec();
        for last in (1..list.len()).rev() {
            let other = self.below(last + 1);
            list.swap(last, other);
        }
        list
    }
}

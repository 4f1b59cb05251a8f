//! Random numbers that are the same on every machine: splitmix64 (Steele, Lea, Flood 2014).

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    /// Any 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In [lo, hi).
    pub fn uniform(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Whether something comes to pass that does so `rate` times a second, within a time \[s\].
    pub fn happens(&mut self, rate: f64, time: f64) -> bool {
        self.unit() < 1.0 - (-rate * time).exp()
    }

    /// From 0 to `count - 1`.
    pub fn below(&mut self, count: usize) -> usize {
        // The upper half of a product: below `count`, and as even as 64 bits allow.
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }

    /// The list in any order, each alike (Fisher and Yates).
    pub fn shuffled(&mut self, list: &[usize]) -> Vec<usize> {
        let mut list = list.to_vec();
        for last in (1..list.len()).rev() {
            list.swap(last, self.below(last + 1));
        }
        list
    }
}

//! Numbers for tests that look random and are the same in every run.

/// A generator of numbers, by its seed.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In [lo, hi).
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// One of a list.
    pub(crate) fn of<T: Copy>(&mut self, those: &[T]) -> T {
        those[(self.unit() * those.len() as f64) as usize]
    }
}

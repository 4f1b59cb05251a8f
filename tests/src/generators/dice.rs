//! Choices from a list of numbers in [0, 1).

use pcr_formats::splitmix64::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Numbers that a pair uses at most; what is asked beyond is 0.
pub const FACES: usize = 96;

/// A source of choices.
#[derive(Clone, Debug)]
pub struct Dice {
    faces: Vec<f64>,
    next: usize,
}

impl Dice {
    /// Choices from these numbers.
    pub fn new(faces: Vec<f64>) -> Self {
        Self { faces, next: 0 }
    }

    /// Choices from a seed (splitmix64).
    pub fn seeded(seed: u64) -> Self {
        let mut random = SplitMix64(seed);
        Self::new((0..FACES).map(|_| random.unit()).collect())
    }

    /// In [0, 1).
    pub fn face(&mut self) -> f64 {
        self.next += 1;
        self.faces.get(self.next - 1).copied().unwrap_or(0.0)
    }

    /// In [lo, hi).
    pub fn range(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.face()
    }

    /// In [lo, hi), every order of magnitude alike.
    pub fn magnitude(&mut self, lo: f64, hi: f64) -> f64 {
        lo * (hi / lo).powf(self.face())
    }

    /// From 0 to `count - 1`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.face() * count as f64) as usize
    }

    /// True so often.
    pub fn chance(&mut self, often: f64) -> bool {
        self.face() < often
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// A sweep in (0, 2π]: often a multiple of a quarter turn, or almost one.
    pub fn sweep(&mut self) -> f64 {
        let sweep = match self.below(6) {
            0 => TAU,
            1 => self.near(TAU).min(TAU),
            2 => self.near(PI),
            3 => self.near(FRAC_PI_2),
            _ => self.range(0.01, TAU),
        };
        sweep.clamp(1e-6, TAU)
    }

    /// The value, or one that differs by a few units in the last place of `f64` or `f32`, or by a little more.
    pub fn near(&mut self, value: f64) -> f64 {
        let steps = self.below(9) as f64 - 4.0;
        let relative = match self.below(5) {
            0 => 0.0,
            1 => f64::EPSILON,
            2 => f64::from(f32::EPSILON),
            3 => 1e-10,
            _ => 1e-4,
        };
        value * (1.0 + steps * relative)
    }
}

//! Random numbers of a run. Each robot has streams of its own, so that the same seed gives the same disturbances with
//! every controller.

use super::vector::{PlaneVector, norm, scale};
use pcr_formats::splitmix64::SplitMix64;

/// The purpose of a stream of random numbers.
#[derive(Clone, Copy, Debug)]
pub(super) enum NoiseSource {
    Missions,
    Camera,
    Wheels,
    Drift,
}

/// A stream of random numbers for one purpose.
#[derive(Clone, Debug)]
pub(super) struct NoiseStream(SplitMix64);

impl NoiseStream {
    pub(super) fn new(seed: u64, robot: usize, purpose: NoiseSource) -> Self {
        let mut random = SplitMix64(seed);
        // Streams of neighbouring numbers are far apart.
        for part in [robot as u64, purpose as u64] {
            random = SplitMix64(random.bits() ^ part);
        }
        Self(random)
    }

    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// From 0 to `count - 1`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        self.0.below(count)
    }

    /// Evenly spread over a disc of this radius.
    pub(super) fn in_disc(&mut self, radius: f64) -> PlaneVector {
        loop {
            let point = [2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0];
            if norm(point) <= 1.0 {
                return scale(point, radius);
            }
        }
    }
}

//! Random numbers of a run: each robot has streams of its own, so that the same seed means the same disturbances under
//! every controller.

use super::vector::{Vector, norm, scale};

/// What a stream of random numbers is for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    Missions,
    Camera,
    Wheels,
    Drift,
}

/// A stream of random numbers (splitmix64).
#[derive(Clone, Debug)]
pub(super) struct Noise {
    state: u64,
}

impl Noise {
    pub(super) fn new(seed: u64, robot: usize, purpose: Purpose) -> Self {
        let mut noise = Self { state: seed };
        // Streams of neighbouring numbers are far apart.
        for part in [robot as u64, purpose as u64] {
            noise.state = noise.next() ^ part;
        }
        noise
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// From 0 to `count - 1`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Evenly spread over a disc of this radius.
    pub(super) fn in_disc(&mut self, radius: f64) -> Vector {
        loop {
            let point = [2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0];
            if norm(point) <= 1.0 {
                return scale(point, radius);
            }
        }
    }
}

//! Robots and paths that are drawn at random.

use super::STEPS;
use super::rounded::Rounded;
use pcr_core::scalar::Angle;
use pcr_core::{Curve, Limits, Point, Pose, TurnSide};
use pcr_supervisor::{Agent, Step};

/// Weyl sequence with the finalizer of SplitMix64.
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(super) fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }

    pub(super) fn unit(&mut self) -> f64 {
        self.below(1 << 20) as f64 / f64::from(1 << 20)
    }

    pub(super) fn chance(&mut self, of_1000: usize) -> bool {
        self.below(1000) < of_1000
    }
}

/// A path through the middle of the arena.
pub(super) fn path<S: Rounded>(random: &mut Random) -> heapless::Vec<Step<S>, { pcr_supervisor::agent::MAX_STEPS }> {
    (0..1 + random.below(STEPS))
        .map(|_| {
            let length = S::from_f64(0.5 + 2.5 * random.unit());
            let turn = if random.chance(500) { TurnSide::Left } else { TurnSide::Right };
            let radius = S::from_f64(0.6 + 2.0 * random.unit());
            let curve = if random.chance(500) { Curve::Line } else { Curve::Arc { radius, turn } };
            Step { curve, length }
        })
        .collect()
}

pub(super) fn heading<S: Rounded>(random: &mut Random) -> S::Angle {
    let (sin, cos) = (std::f64::consts::TAU * random.unit()).sin_cos();
    <S::Angle as Angle<S>>::atan2(S::from_f64(sin), S::from_f64(cos))
}

pub(super) fn limits<S: Rounded>() -> Limits<S> {
    Limits { speed: S::from_f64(1.0), acceleration: S::from_f64(1.0) }
}

pub(super) fn agent<S: Rounded>(random: &mut Random) -> Agent<S> {
    let number = |value: f64| S::from_f64(value);
    let position = Point::new(number(5.0 * random.unit()), number(5.0 * random.unit()));
    Agent {
        radius: number(0.15 + 0.15 * random.unit()),
        start_time: number(0.0),
        limits: limits(),
        start: Pose { position, heading: heading::<S>(random) },
        path: path(random),
    }
}

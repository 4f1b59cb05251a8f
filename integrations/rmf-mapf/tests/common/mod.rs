//! What the tests share: random numbers, and places on a way.

use pcr_rmf_mapf::TimedPose;

pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// From 0 to 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }
}

/// Where an agent is while it is on the way to a waypoint, at a share of this way.
pub(crate) fn between(from: TimedPose, to: TimedPose, share: f64) -> TimedPose {
    let turn = (to.yaw - from.yaw + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
    TimedPose {
        time: from.time + share * (to.time - from.time),
        position: [0, 1].map(|axis| from.position[axis] + share * (to.position[axis] - from.position[axis])),
        yaw: from.yaw + share * turn,
    }
}

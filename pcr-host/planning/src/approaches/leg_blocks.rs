//! The legs of an agent, in blocks with boxes around them, so that agents that are far from one another are compared block by block.

use super::bounded_leg::BoundedLeg;
use super::convex_parts::ConvexParts;
use pcr_formats::import::{PoseLog, PoseTrack};
use std::ops::Range;

/// Most legs of a block.
const MOST: usize = 32;

/// Successive legs without a gap, on one map.
pub(super) struct LegBlock {
    pub(super) legs: Range<usize>,
    /// \[s\]
    pub(super) t: [f64; 2],
    pub(super) map: usize,
    /// Lowest and highest x and y of the centre \[m\], outward.
    area: [[f64; 2]; 2],
}

/// The legs of an agent.
pub(super) struct LegBlocks {
    pub(super) radius: f64,
    /// Its outline, if it is no disc; it is within the radius.
    pub(super) parts: Option<ConvexParts>,
    pub(super) legs: Vec<BoundedLeg>,
    pub(super) blocks: Vec<LegBlock>,
}

impl LegBlocks {
    /// Those of all agents.
    pub(super) fn all(log: &PoseLog) -> Vec<Self> {
        let times = || log.tracks.iter().flat_map(|track| &track.poses).map(|pose| pose.t);
        let span = [times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max)];
        let stands = log.stands_at_ends.then_some(span);
        let of = |track| Self::new(BoundedLeg::all(track, log.between, stands), track);
        log.tracks.iter().map(of).collect()
    }

    fn new(legs: Vec<BoundedLeg>, track: &PoseTrack) -> Self {
        let mut blocks: Vec<LegBlock> = Vec::new();
        for (k, leg) in legs.iter().enumerate() {
            let grown = leg.most() + leg.rounding();
            let [a, b] = leg.ends;
            let area = [0, 1].map(|axis| {
                let (lo, hi) = (a[axis].min(b[axis]) - grown, a[axis].max(b[axis]) + grown);
                [lo.next_down(), hi.next_up()]
            });
            match blocks.last_mut() {
                Some(block) if block.legs.len() < MOST && block.map == leg.map && block.t[1] == leg.t[0] => {
                    block.legs.end = k + 1;
                    block.t[1] = leg.t[1];
                    for (whole, part) in block.area.iter_mut().zip(area) {
                        *whole = [whole[0].min(part[0]), whole[1].max(part[1])];
                    }
                }
                _ => blocks.push(LegBlock { legs: k..k + 1, t: leg.t, map: leg.map, area }),
            }
        }
        let parts = track.footprint.as_ref().map(ConvexParts::new);
        Self { radius: track.radius, parts, legs, blocks }
    }
}

impl LegBlock {
    /// Distance of the centres of two agents on two blocks, from below \[m\].
    pub(super) fn distance(&self, other: &Self) -> f64 {
        let [x, y] = [0, 1].map(|axis| {
            let ([lo, hi], [other_lo, other_hi]) = (self.area[axis], other.area[axis]);
            (lo - other_hi).max(other_lo - hi).max(0.0)
        });
        x.hypot(y) * (1.0 - 8.0 * f64::EPSILON)
    }
}

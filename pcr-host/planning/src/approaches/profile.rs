//! How near two agents of a record were over time, for pictures: bounds in as many times as a picture has room for.

use super::leg_blocks::LegBlocks;
use super::pair_walk::PairWalk;
use pcr_formats::import::PoseLog;
use serde::Serialize;

/// How near two agents were in a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NearnessEntry {
    /// Begin and end \[s\].
    pub t: [f64; 2],
    /// Bounds of the least distance of the bodies in that time, below 0 where they overlap \[m\].
    pub clearance: [f64; 2],
}

/// Agents of a record, by their indices in [`PoseLog::tracks`], and how near any two of them were.
pub struct NearnessProfiles {
    blocks: Vec<LegBlocks>,
}

impl NearnessProfiles {
    /// Those of a record.
    pub fn new(log: &PoseLog) -> Self {
        Self { blocks: LegBlocks::all(log) }
    }

    /// How near two agents were in each of so many equal parts of a time; nothing of those in which they were not on one map at one time.
    pub fn of_pair(&self, pair: [usize; 2], [begin, end]: [f64; 2], parts: usize) -> Vec<NearnessEntry> {
        let (Some(a), Some(b)) = (self.blocks.get(pair[0]), self.blocks.get(pair[1])) else { return Vec::new() };
        let bins: Vec<[f64; 2]> =
            (0..parts).map(|k| [k, k + 1].map(|k| begin + (end - begin) * k as f64 / parts as f64)).collect();
        let mut least: Vec<Option<[f64; 2]>> = vec![None; parts];
        PairWalk::new([a, b], false).each_span([a, b], &bins, &mut |bin, clearance| {
            let known = least[bin].get_or_insert([f64::INFINITY; 2]);
            *known = [known[0].min(clearance[0]), known[1].min(clearance[1])];
        });
        let known =
            bins.into_iter().zip(least).filter_map(|(t, clearance)| Some(NearnessEntry { t, clearance: clearance? }));
        known.collect()
    }
}

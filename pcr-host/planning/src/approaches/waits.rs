//! Who stood at the end of what was released to it, while who moved.

use super::HeldEntry;
use super::profile::NearnessProfiles;
use pcr_formats::import::{HeldTime, PoseLog, PoseTrack};
use pcr_formats::plane_geometry::distance;
use serde::Serialize;

/// Agents that are named for a wait: those that came nearest.
const MOST: usize = 3;

/// Way from which on an agent moved \[m\]: poses of one that stands differ by less.
const MOVED: f64 = 0.1;

/// Somebody who moved while another one stood.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PassingEntry {
    /// Number of the agent.
    pub id: u64,
    /// How far it went, from pose to pose \[m\].
    pub way: f64,
    /// Bounds of the least distance of both bodies in that time \[m\].
    pub clearance: [f64; 2],
}

/// The waits of a record.
pub(super) fn of(log: &PoseLog, profiles: &NearnessProfiles) -> Vec<HeldEntry> {
    log.held.iter().filter_map(|held| wait(held, log, profiles)).collect()
}

/// Every agent that was held has a track.
fn wait(held: &HeldTime, log: &PoseLog, profiles: &NearnessProfiles) -> Option<HeldEntry> {
    let own = log.tracks.iter().position(|track| track.id == held.id)?;
    let passing = |(other, track): (usize, &PoseTrack)| {
        let way = way(track, held.t);
        let nearness = profiles.of_pair([own, other], held.t, 1);
        let clearance = nearness.first().filter(|_| other != own && way >= MOVED)?.clearance;
        Some(PassingEntry { id: track.id, way, clearance })
    };
    let mut passed: Vec<PassingEntry> = log.tracks.iter().enumerate().filter_map(passing).collect();
    passed.sort_by(|a, b| a.clearance[0].total_cmp(&b.clearance[0]));
    passed.truncate(MOST);
    Some(HeldEntry { id: held.id, t: held.t, passed })
}

/// How far an agent went from its first to its last pose in a time \[m\].
fn way(track: &PoseTrack, [from, to]: [f64; 2]) -> f64 {
    let pairs = track.poses.windows(2).filter(|pair| pair[1].is_joined && from <= pair[0].t && pair[1].t <= to);
    pairs.map(|pair| distance(pair[0].point, pair[1].point)).sum()
}

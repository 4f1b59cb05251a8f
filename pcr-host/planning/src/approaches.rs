//! Who came how near to whom, by poses at times: the answer of `pcr check` about records of what ran and plans of others.
//!
//! ```text
//! bounded_leg    where an agent may be between two poses
//! convex_parts   outlines, and how far two of them are apart
//! open_spans     when a contact is proved, or cannot be known, by bounds of a distance
//! body_pair      the same as leg_pair where one of two agents has an outline
//! leg_pair       two agents in a time in which both are on a leg: nearest approach, contact proved, excluded or not known
//! leg_blocks     the legs of an agent, in blocks with boxes around them
//! pair_walk      two agents over all of their common time
//! waits          who stood at the end of what was released, while who moved   HeldEntry
//! profile        how near two agents were over time                            NearnessProfiles
//! ```
//!
//! The types match the JSON output, field by field in this order. Intervals of distances contain the exact value: they are rounded
//! outward. A contact is excluded only where the lower bound of the distance of the bodies is above 0, and proved only where the upper bound
//! is below it, whatever the agents did within the stated bound.

mod body_pair;
mod bounded_leg;
mod convex_parts;
mod leg_blocks;
mod leg_pair;
mod open_spans;
#[cfg(test)]
mod outline_tests;
mod pair_walk;
mod profile;
#[cfg(test)]
mod tests;
mod waits;

use crate::memory_budget::{self, MemoryBudget, MemoryError};
use crate::parallel;
use crate::regions::ProgressFn;
use leg_blocks::LegBlocks;
use pair_walk::PairWalk;
use pcr_formats::import::{BetweenPoses, PoseLog};
use pcr_formats::scenario::Labels;
pub use profile::{NearnessEntry, NearnessProfiles};
use serde::Serialize;
pub use waits::PassingEntry;

/// The approaches of the agents of a record.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ApproachReport {
    /// Name of the record.
    pub name: String,
    /// Labels of the agents, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// When the time 0 is; `None` where times are those of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<String>,
    /// What agents may have done between two poses.
    pub between: BetweenEntry,
    /// The agents, by their numbers.
    pub agents: Vec<TrackEntry>,
    /// Number of pairs that were on one map at one time.
    pub pairs: usize,
    /// Number of pairs that never were.
    pub apart: usize,
    /// When a contact is not excluded, sorted by the begin, then by the agents.
    pub approaches: Vec<ApproachEntry>,
    /// The nearest approach of every pair, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closest: Option<Vec<NearestEntry>>,
    /// When agents stood because the rest of their orders was not released, as far as the record tells; by the begins.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub waits: Vec<HeldEntry>,
    /// When nothing is known of an agent between its first pose and its last one: nothing is excluded then.
    pub gaps: Vec<GapEntry>,
    /// Warnings of the reader.
    pub warnings: Vec<String>,
}

/// What agents may have done between two poses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BetweenEntry {
    /// They went straight at constant speed, to within this \[m\].
    Deviation(f64),
    /// They went anywhere at up to this speed \[m/s\].
    TopSpeed(f64),
    /// The same, and outlines turned at up to this rate \[m/s, rad/s\].
    #[serde(rename = "top_speed_and_rotation")]
    TopSpeedAndRotation([f64; 2]),
}

/// An agent of a record.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrackEntry {
    /// Its number.
    pub id: u64,
    /// Radius of its disc, or of that around its outline \[m\].
    pub radius: f64,
    /// Corners of its outline, ahead and left \[m\], if it is no disc.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outline: Option<Vec<[f64; 2]>>,
    /// Number of poses.
    pub poses: usize,
    /// Times of the first and the last one \[s\].
    pub t: [f64; 2],
    /// Longest time between two of them \[s\].
    pub longest: f64,
}

/// A time in which a contact of two agents is not excluded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ApproachEntry {
    /// Number of an agent.
    pub i: u64,
    /// Number of the other one, larger.
    pub j: u64,
    /// Name of their map, where the file has names.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub map: String,
    /// Begin and end \[s\]: just outside of it a contact is excluded, or the common record ends.
    pub t: [f64; 2],
    /// Whether there was a contact.
    pub verdict: ContactVerdict,
    /// Times in which a contact is proved \[s\]; none where it is not known whether there was one.
    pub contacts: Vec<[f64; 2]>,
    /// Bounds of the least distance of the centres in that time \[m\].
    pub separation: [f64; 2],
    /// Bounds of the least distance of the bodies in that time, below 0 where they overlap \[m\].
    pub clearance: [f64; 2],
}

/// Whether there was a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactVerdict {
    /// There was one, whatever the agents did within their bounds.
    Contact,
    /// It cannot be known.
    Unknown,
}

/// The nearest approach of two agents.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NearestEntry {
    /// Number of an agent.
    pub i: u64,
    /// Number of the other one, larger.
    pub j: u64,
    /// Name of their map, where the file has names.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub map: String,
    /// When the bodies are nearest if motions between their poses are straight \[s\].
    pub t: f64,
    /// Bounds of the least distance of the centres \[m\].
    pub separation: [f64; 2],
    /// Bounds of the least distance of the bodies, below 0 where they overlap \[m\].
    pub clearance: [f64; 2],
}

/// A time in which an agent stood because the rest of its order was not released.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeldEntry {
    /// Number of the agent.
    pub id: u64,
    /// Begin and end \[s\].
    pub t: [f64; 2],
    /// Who moved meanwhile, the nearest first, three at most.
    pub passed: Vec<PassingEntry>,
}

/// A time in which nothing is known of an agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GapEntry {
    /// Number of the agent.
    pub id: u64,
    /// Begin and end \[s\].
    pub t: [f64; 2],
}

/// Agents between two reports of progress.
const STRETCH: usize = 64;

impl ApproachReport {
    /// Computes the approaches of all pairs; with `closest` also the nearest approach of each.
    ///
    /// # Errors
    /// [`MemoryError`] where memory does not hold the answer.
    pub fn compute(
        name: &str,
        log: &PoseLog,
        closest: bool,
        warnings: Vec<String>,
        told: ProgressFn<'_>,
    ) -> Result<Self, MemoryError> {
        let count = log.tracks.len();
        if closest {
            let all = count.saturating_mul(count.saturating_sub(1)) / 2;
            let bytes = all.saturating_mul(size_of::<NearestEntry>());
            memory_budget::ask(bytes as u64, || format!("how near all {all} pairs come"))?;
        }
        let waits = waits::of(log, &NearnessProfiles::new(log));
        let blocks = LegBlocks::all(log);
        let (mut approaches, mut nearest, mut pairs) = (Vec::new(), Vec::new(), 0);
        let mut held = MemoryBudget::default();
        for first in (0..count).step_by(STRETCH) {
            let stretch = first..count.min(first + STRETCH);
            let of_agent = |i: usize| {
                let (mut found, mut near, mut met) = (Vec::new(), Vec::new(), 0);
                for j in i + 1..count {
                    let walk = PairWalk::new([&blocks[i], &blocks[j]], closest);
                    met += usize::from(walk.is_met);
                    let [i, j] = [i, j].map(|k| log.tracks[k].id);
                    found.extend(walk.approaches(i, j, &log.maps));
                    near.extend(walk.nearest(i, j, &log.maps));
                }
                (found, near, met)
            };
            for (found, near, met) in parallel::map_parallel(stretch.clone(), &of_agent) {
                held.extend(&mut approaches, found, 0, "approaches")?;
                nearest.extend(near);
                pairs += met;
            }
            told(stretch.end, count);
        }
        approaches.sort_by(|a: &ApproachEntry, b| a.t[0].total_cmp(&b.t[0]).then((a.i, a.j).cmp(&(b.i, b.j))));
        let tracks = log.tracks.iter();
        let gaps = tracks.clone().flat_map(|track| {
            let pairs = track.poses.windows(2).filter(|pair| !pair[1].is_joined);
            pairs.map(|pair| GapEntry { id: track.id, t: [pair[0].t, pair[1].t] })
        });
        let agents = tracks.map(|track| {
            let ends = [track.poses.first(), track.poses.last()].map(|pose| pose.map_or(0.0, |pose| pose.t));
            let longest = track.poses.windows(2).map(|pair| pair[1].t - pair[0].t).fold(0.0, f64::max);
            let outline = track.footprint.as_ref().map(|footprint| footprint.polygon().to_vec());
            TrackEntry { id: track.id, radius: track.radius, outline, poses: track.poses.len(), t: ends, longest }
        });
        Ok(Self {
            name: name.to_owned(),
            labels: log.labels.clone(),
            origin: log.origin.clone(),
            between: match log.between {
                BetweenPoses::Straight(deviation) => BetweenEntry::Deviation(deviation),
                BetweenPoses::TopSpeed { speed, rotation: 0.0 } => BetweenEntry::TopSpeed(speed),
                BetweenPoses::TopSpeed { speed, rotation } => BetweenEntry::TopSpeedAndRotation([speed, rotation]),
            },
            agents: agents.collect(),
            pairs,
            apart: count * count.saturating_sub(1) / 2 - pairs,
            approaches,
            closest: closest.then_some(nearest),
            waits,
            gaps: gaps.collect(),
            warnings,
        })
    }

    /// Whether any contact is proved.
    pub fn has_contact(&self) -> bool {
        self.approaches.iter().any(|approach| approach.verdict == ContactVerdict::Contact)
    }

    /// Whether all contacts are excluded, in the time in which agents are on record.
    pub fn is_free(&self) -> bool {
        self.approaches.is_empty() && (self.gaps.is_empty() || self.agents.len() < 2)
    }
}

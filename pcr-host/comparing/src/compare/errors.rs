//! The errors of an answer, compared with the reference.

use super::disc_track::near;
use super::reference::{self, ReferenceContact};
use super::{ComparisonFleet, MethodAnswer, MethodContact, RegionSet};
use serde::Serialize;

/// How far an answer is off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Accuracy {
    /// Of conflicts.
    Conflicts {
        /// In the reference, and deeper than 1e-10 m.
        conflicts: usize,
        /// Of these, not found.
        missed: usize,
        /// Found where there are none.
        invented: usize,
        /// Largest difference of a begin or end \[s\].
        time: f64,
    },
    /// Of regions.
    Regions {
        /// Of all regions \[m s\].
        area: f64,
        /// Of the symmetric difference to the reference \[m s\].
        difference: f64,
    },
}

/// The conflicts and regions of a fleet by the definition.
#[derive(Clone, Debug)]
pub(super) struct GroundTruth {
    /// By the agents, then by the begin.
    contacts: Vec<([usize; 2], Vec<ReferenceContact>)>,
    slices: Vec<CrossSectionSample>,
}

/// What an agent blocks of another one's path at a time, for about `step` \[s\].
#[derive(Clone, Debug)]
struct CrossSectionSample {
    agents: [usize; 2],
    time: f64,
    step: f64,
    parts: Vec<[f64; 2]>,
}

impl GroundTruth {
    /// With about so many slices.
    pub(super) fn new(field: &ComparisonFleet<'_>, count: usize) -> Self {
        let mut contacts = Vec::new();
        for (first, a) in field.tracks.iter().enumerate() {
            for (second, b) in field.tracks.iter().enumerate().skip(first + 1) {
                let found = reference::contacts(a, b, field.horizon);
                if !found.is_empty() {
                    contacts.push(([first, second], found));
                }
            }
        }
        Self { contacts, slices: slices(field, count) }
    }

    fn of(&self, agents: [usize; 2]) -> &[ReferenceContact] {
        let place = self.contacts.binary_search_by_key(&agents, |(agents, _)| *agents);
        place.map_or(&[], |place| &self.contacts[place].1)
    }

    fn conflicts(&self, found: &[MethodContact]) -> Accuracy {
        let first_only = found.iter().any(|found| found.end.is_none());
        let (mut conflicts, mut missed, mut time) = (0, 0, 0.0_f64);
        for (agents, contacts) in &self.contacts {
            let of_pair: Vec<&MethodContact> = found.iter().filter(|found| found.agents == *agents).collect();
            let asked = if first_only { &contacts[..1] } else { &contacts[..] };
            for contact in asked {
                conflicts += usize::from(contact.certain);
                match of_pair.iter().find(|found| meets(found, contact)) {
                    Some(found) => time = time.max(time_error(found, contact)),
                    None => missed += usize::from(contact.certain),
                }
            }
        }
        let invented = found.iter().filter(|found| !self.of(found.agents).iter().any(|contact| meets(found, contact)));
        Accuracy::Conflicts { conflicts, missed, invented: invented.count(), time }
    }
}

/// Whether they have any time in common; who tells the begin only is taken at their word.
fn meets(found: &MethodContact, contact: &ReferenceContact) -> bool {
    let [begin, end] = contact.time;
    found.end.is_none_or(|found_end| found.begin <= end && begin <= found_end)
}

fn time_error(found: &MethodContact, contact: &ReferenceContact) -> f64 {
    let [begin, end] = contact.time;
    let late = found.end.map_or(0.0, |found_end| (found_end - end).abs());
    late.max((found.begin - begin).abs())
}

/// Times at which each ordered pair is looked at, at least and at most.
const TIMES: [usize; 2] = [4, 200];

fn slices(field: &ComparisonFleet<'_>, count: usize) -> Vec<CrossSectionSample> {
    let bounds: Vec<[f64; 4]> = field.tracks.iter().map(|track| track.bounds()).collect();
    let mut pairs = Vec::new();
    for ego in 0..bounds.len() {
        let reach = |other: usize| field.tracks[ego].radius + field.tracks[other].radius;
        let others = (0..bounds.len()).filter(|&other| other != ego);
        pairs.extend(others.filter(|&other| near(bounds[ego], bounds[other], reach(other))).map(|other| [ego, other]));
    }
    let times = (count / pairs.len().max(1)).clamp(TIMES[0], TIMES[1]);
    let of_pair = |[ego, other]: [usize; 2]| {
        let (own, their) = (&field.tracks[ego], &field.tracks[other]);
        let step = (their.time[1] - their.time[0]) / times as f64;
        (0..times).map(move |k| {
            let time = their.time[0] + step * (k as f64 + 0.5);
            let parts = reference::slice(own, their.position(time), own.radius + their.radius);
            CrossSectionSample { agents: [ego, other], time, step, parts }
        })
    };
    pairs.into_iter().flat_map(of_pair).collect()
}

fn regions(slices: &[CrossSectionSample], regions: &dyn RegionSet) -> Accuracy {
    let (mut area, mut difference) = (0.0, 0.0);
    for CrossSectionSample { agents: [ego, other], time, step, parts } in slices {
        area += step * measure(parts);
        difference += step * symmetric_difference(parts, &regions.slice(*ego, *other, *time));
    }
    Accuracy::Regions { area, difference }
}

fn measure(parts: &[[f64; 2]]) -> f64 {
    parts.iter().map(|[from, to]| to - from).sum()
}

/// Length of what belongs to one of two sets only, by their borders.
fn symmetric_difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let mut borders: Vec<f64> = a.iter().chain(b).flatten().copied().collect();
    borders.sort_by(f64::total_cmp);
    let holds = |set: &[[f64; 2]], at: f64| set.iter().any(|[from, to]| *from <= at && at <= *to);
    let parts = borders.windows(2).map(|pair| (pair[1] - pair[0], 0.5 * (pair[0] + pair[1])));
    parts.filter(|(_, middle)| holds(a, *middle) != holds(b, *middle)).map(|(length, _)| length).sum()
}

/// How far an answer is off.
pub(super) fn errors(truth: &GroundTruth, answer: &MethodAnswer<'_>) -> Accuracy {
    match answer {
        MethodAnswer::Regions(given) => regions(&truth.slices, given.as_ref()),
        MethodAnswer::Conflicts(found) => truth.conflicts(found),
    }
}

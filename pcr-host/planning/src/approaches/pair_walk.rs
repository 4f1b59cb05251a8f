//! Two agents over all of their common time.

use super::leg_blocks::{LegBlock, LegBlocks};
use super::leg_pair::{LeastDistance, LegPair, OpenSpan};
use super::{ApproachEntry, ContactVerdict, NearestEntry};

/// What came of two agents.
pub(super) struct PairWalk {
    /// Whether both were ever on one map at one time.
    pub(super) is_met: bool,
    /// Sum of the radii \[m\].
    radii: f64,
    /// When a contact is not excluded, and on which map, in the order of time.
    spans: Vec<(OpenSpan, usize)>,
    least: Option<LeastDistance>,
}

impl PairWalk {
    /// Walks over the common time of two agents; with `closest` also for their nearest approach.
    pub(super) fn new(agents: [&LegBlocks; 2], closest: bool) -> Self {
        let radii = agents[0].radius + agents[1].radius;
        let mut walk = Self { is_met: false, radii, spans: Vec::new(), least: closest.then_some(LeastDistance::NONE) };
        let (mut place, mut pairs) = (0, Vec::new());
        for block in &agents[0].blocks {
            let others = &agents[1].blocks;
            while others.get(place).is_some_and(|other| other.t[1] < block.t[0]) {
                place += 1;
            }
            let common = others.get(place..).unwrap_or_default().iter().take_while(|other| other.t[0] <= block.t[1]);
            let common = common.filter(|other| other.map == block.map);
            pairs.extend(common.map(|other| (block.distance(other), [block, other])));
        }
        // What is nearest first: most of the others are farther than that then.
        pairs.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        for (distance, blocks) in pairs {
            walk.compare(agents, blocks, distance);
        }
        // Blocks that follow one another share an end, at which an instant may be there twice.
        walk.spans.sort_by(|(a, _), (b, _)| a.t[0].total_cmp(&b.t[0]).then(a.t[1].total_cmp(&b.t[1])));
        walk
    }

    fn compare(&mut self, agents: [&LegBlocks; 2], blocks: [&LegBlock; 2], distance: f64) {
        let [first, second] = [0, 1].map(|k| agents[k].legs.get(blocks[k].legs.clone()).unwrap_or_default());
        let is_apart = blocks[0].t[0].max(blocks[1].t[0]) >= blocks[0].t[1].min(blocks[1].t[1]);
        let is_far = |least: &Option<LeastDistance>, radii: f64| {
            distance > radii * (1.0 + f64::EPSILON) && least.as_ref().is_none_or(|least| distance > least.farthest())
        };
        if !is_apart && is_far(&self.least, self.radii) {
            self.is_met = true;
            if let Some(least) = &mut self.least {
                least.lower = least.lower.min(distance);
            }
            return;
        }
        let mut place = 0;
        for leg in first {
            while second.get(place).is_some_and(|other| other.t[1] < leg.t[0]) {
                place += 1;
            }
            let common = second.get(place..).unwrap_or_default().iter().take_while(|other| other.t[0] <= leg.t[1]);
            for other in common {
                let Some(time) = LegPair::common([leg, other]) else { continue };
                self.is_met = true;
                let pair = LegPair::new([leg, other], self.radii);
                let mut spans = Vec::new();
                pair.open_spans(time, &mut spans);
                self.spans.extend(spans.into_iter().map(|span| (span, leg.map)));
                if let Some(least) = &mut self.least {
                    pair.update(time, least);
                }
            }
        }
    }

    fn clearance(&self, [lower, upper]: [f64; 2]) -> [f64; 2] {
        [(lower - self.radii).next_down(), (upper - self.radii).next_up()]
    }

    /// The times in which a contact is not excluded; successive ones are one.
    pub(super) fn approaches(&self, i: u64, j: u64, maps: &[String]) -> Vec<ApproachEntry> {
        let mut entries: Vec<(ApproachEntry, usize)> = Vec::new();
        for (span, map) in &self.spans {
            let last = entries.last_mut().filter(|(last, on)| on == map && span.t[0] <= last.t[1]);
            let entry = match last {
                Some((entry, _)) => entry,
                None => {
                    let name = maps.get(*map).cloned().unwrap_or_default();
                    let empty = [f64::INFINITY; 2];
                    let verdict = ContactVerdict::Unknown;
                    let (contacts, separation, clearance) = (Vec::new(), empty, empty);
                    entries.push((
                        ApproachEntry { i, j, map: name, t: span.t, verdict, contacts, separation, clearance },
                        *map,
                    ));
                    let Some((entry, _)) = entries.last_mut() else { continue };
                    entry
                }
            };
            entry.t[1] = entry.t[1].max(span.t[1]);
            for (bound, of_span) in entry.separation.iter_mut().zip(span.separation) {
                *bound = bound.min(of_span);
            }
            if span.is_contact {
                entry.verdict = ContactVerdict::Contact;
                match entry.contacts.last_mut() {
                    Some(last) if span.t[0] <= last[1] => last[1] = last[1].max(span.t[1]),
                    _ => entry.contacts.push(span.t),
                }
            }
        }
        let finish = |(mut entry, _): (ApproachEntry, usize)| {
            entry.clearance = self.clearance(entry.separation);
            entry
        };
        entries.into_iter().map(finish).collect()
    }

    /// The nearest approach, if it was asked for and there is any.
    pub(super) fn nearest(&self, i: u64, j: u64, maps: &[String]) -> Option<NearestEntry> {
        let least = self.least.as_ref().filter(|least| least.upper < f64::INFINITY)?;
        let separation = [least.lower, least.upper];
        let map = maps.get(least.map).cloned().unwrap_or_default();
        Some(NearestEntry { i, j, map, t: least.straight.0, separation, clearance: self.clearance(separation) })
    }
}

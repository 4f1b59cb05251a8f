//! Two agents over all of their common time.

use super::body_pair::BodyPair;
use super::convex_parts::ConvexParts;
use super::leg_blocks::{LegBlock, LegBlocks};
use super::leg_pair::{LegPair, apart};
use super::open_spans::{BoundedDistance, LeastDistance, OpenSpan};
use super::{ApproachEntry, ContactVerdict, NearestEntry};

/// What came of two agents.
pub(super) struct PairWalk {
    /// Whether both were ever on one map at one time.
    pub(super) is_met: bool,
    /// Sum of the radii \[m\].
    radii: f64,
    /// Their bodies, if one of them is no disc.
    bodies: Option<[ConvexParts; 2]>,
    /// When a contact is not excluded, and on which map, in the order of time.
    spans: Vec<(OpenSpan, usize)>,
    /// Of the centres.
    least: Option<LeastDistance>,
    /// Of the bodies, if one of them is no disc.
    least_gap: Option<LeastDistance>,
}

impl PairWalk {
    /// Walks over the common time of two agents; with `closest` also for their nearest approach.
    pub(super) fn new(agents: [&LegBlocks; 2], closest: bool) -> Self {
        let radii = agents[0].radius + agents[1].radius;
        let body = |agent: &LegBlocks| agent.parts.clone().unwrap_or_else(|| ConvexParts::disc(agent.radius));
        let has_outline = agents.iter().any(|agent| agent.parts.is_some());
        let mut walk = Self {
            is_met: false,
            radii,
            bodies: has_outline.then(|| agents.map(body)),
            spans: Vec::new(),
            least: closest.then_some(LeastDistance::NONE),
            least_gap: (closest && has_outline).then_some(LeastDistance::NONE),
        };
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
        let gap = apart([distance; 2], self.radii)[0];
        let is_beyond =
            |least: &Option<LeastDistance>, distance: f64| least.as_ref().is_none_or(|it| distance > it.farthest());
        let is_far = distance > self.radii * (1.0 + f64::EPSILON)
            && is_beyond(&self.least, distance)
            && is_beyond(&self.least_gap, gap);
        if !is_apart && is_far {
            self.is_met = true;
            for (least, distance) in [(&mut self.least, distance), (&mut self.least_gap, gap)] {
                if let Some(least) = least {
                    least.lower = least.lower.min(distance);
                }
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
                let bodies = self.bodies.as_ref().map(|bodies| BodyPair::new([leg, other], bodies, &pair));
                match &bodies {
                    // What is excluded for the discs around them needs no outlines.
                    Some(bodies) => {
                        let (mut near, mut times): (Vec<OpenSpan>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
                        pair.open_spans(time, &mut near);
                        for span in near {
                            match times.last_mut().filter(|last| last[1] == span.t[0]) {
                                Some(last) => last[1] = span.t[1],
                                None => times.push(span.t),
                            }
                        }
                        times.into_iter().for_each(|time| bodies.open_spans(time, &mut spans));
                    }
                    None => pair.open_spans(time, &mut spans),
                }
                self.spans.extend(spans.into_iter().map(|span| (span, leg.map)));
                if let Some(least) = &mut self.least {
                    pair.update(time, least);
                }
                if let (Some(least), Some(bodies)) = (&mut self.least_gap, &bodies) {
                    bodies.update(time, least);
                }
            }
        }
    }

    /// Calls `each` with the index of a bin and bounds of the clearance in it, for every bin and every two legs that are in it.
    pub(super) fn each_span(&self, agents: [&LegBlocks; 2], bins: &[[f64; 2]], each: &mut dyn FnMut(usize, [f64; 2])) {
        let (mut place, mut first) = (0, 0);
        for leg in &agents[0].legs {
            let others = &agents[1].legs;
            while others.get(place).is_some_and(|other| other.t[1] < leg.t[0]) {
                place += 1;
            }
            while bins.get(first).is_some_and(|bin| bin[1] < leg.t[0]) {
                first += 1;
            }
            let common = others.get(place..).unwrap_or_default().iter().take_while(|other| other.t[0] <= leg.t[1]);
            for other in common.filter(|other| other.map == leg.map) {
                let Some(time) = LegPair::common([leg, other]) else { continue };
                let centres = LegPair::new([leg, other], self.radii);
                let bodies = self.bodies.as_ref().map(|bodies| BodyPair::new([leg, other], bodies, &centres));
                let within = bins.iter().enumerate().skip(first).take_while(|(_, bin)| bin[0] <= time[1]);
                for (index, bin) in within.filter(|(_, bin)| bin[1] >= time[0]) {
                    let part = [bin[0].max(time[0]), bin[1].min(time[1])];
                    let span = match &bodies {
                        Some(bodies) => bodies.span(part, &bodies.bounds(part), false),
                        None => centres.span(part, &centres.bounds(part), false),
                    };
                    each(index, span.clearance);
                }
            }
        }
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
            let bounds = entry.separation.iter_mut().chain(&mut entry.clearance);
            for (bound, of_span) in bounds.zip(span.separation.into_iter().chain(span.clearance)) {
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
        entries.into_iter().map(|(entry, _)| entry).collect()
    }

    /// The nearest approach, if it was asked for and there is any.
    pub(super) fn nearest(&self, i: u64, j: u64, maps: &[String]) -> Option<NearestEntry> {
        let least = self.least.as_ref().filter(|least| least.upper < f64::INFINITY)?;
        let separation = [least.lower, least.upper];
        let (nearest, clearance) = match &self.least_gap {
            Some(gap) => (gap, [gap.lower, gap.upper]),
            None => (least, apart(separation, self.radii)),
        };
        let map = maps.get(nearest.map).cloned().unwrap_or_default();
        Some(NearestEntry { i, j, map, t: nearest.straight.0, separation, clearance })
    }
}

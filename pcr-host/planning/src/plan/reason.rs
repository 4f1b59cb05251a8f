//! Why and where two agents cannot be planned: which of their starts and ends are in the way of the other agent, and on
//! what lengths.

use super::{grown, sides};
use crate::fleet::Fleet;
use crate::regions;
use pcr_core::{Interval, Motion, RegionRef};
use pcr_formats::scenario::{Agent, Scenario};
use serde::Serialize;

/// Where two agents are in one another's way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spot {
    /// Lengths along the paths of the first and of the second \[m\].
    pub lengths: [[f64; 2]; 2],
    /// In the middle of those of the first, abscissa and ordinate \[m\].
    pub at: [f64; 2],
}

/// What keeps a region from being passed before the other agent, or after it.
#[derive(Clone, Copy, PartialEq)]
enum Obstacle {
    /// The first stands at its start, in the way of the second.
    OwnStart,
    /// The first stays at its end, in the way of the second.
    OwnEnd,
    /// The second stands at its start, in the way of the first.
    OtherStart,
    /// The second stays at its end, in the way of the first.
    OtherEnd,
}

impl Obstacle {
    fn words(self) -> &'static str {
        match self {
            Self::OwnStart => "the first stands at its start in the way of the second",
            Self::OwnEnd => "the first stays at its end in the way of the second",
            Self::OtherStart => "the second stands at its start in the way of the first",
            Self::OtherEnd => "the second stays at its end in the way of the first",
        }
    }
}

/// Why two agents of a scenario meet whenever they start, or (not `always`) why the first does not find a start; and where.
/// By the discs around their outlines; without a place where they have no region.
pub(super) fn reason(scenario: &Scenario, ids: [u64; 2], always: bool) -> (String, Option<Spot>) {
    let general = match always {
        true => "they meet whenever they start",
        false => "the first cannot start because of the second in any order that was tried",
    };
    let found = pair(scenario, ids).and_then(|pair| {
        let fleet = Fleet::<f64>::new(&pair).ok()?;
        let motions = grown(&fleet);
        let ecm = regions::table(&pair, &motions).ok()?;
        let regions: Vec<_> = ecm.row(&motions, 0).expect("the table of the fleet").collect();
        let last = regions.iter().find(|region| sides(region)[0]);
        let first = regions.iter().find(|region| sides(region)[1]);
        let longest = || regions.iter().max_by(|a, b| a.length().length().total_cmp(&b.length().length()));
        let overlap = |at_end: bool| {
            let at =
                |motion: &Motion<'_, f64>| motion.path().point_at(if at_end { motion.path().length() } else { 0.0 });
            let [a, b] = [motions.first()?, motions.get(1)?];
            let apart = [at(a).x - at(b).x, at(a).y - at(b).y];
            Some(apart[0].hypot(apart[1]) < a.radius() + b.radius())
        };
        let standing = |at_end: bool| Some(Spot::standing([motions.first()?, motions.get(1)?], at_end));
        Some(match (always, first, last) {
            (true, ..) if overlap(false)? => ("they overlap at their starts".to_owned(), standing(false)?),
            (true, ..) if overlap(true)? => ("they overlap at the ends of their paths".to_owned(), standing(true)?),
            (true, Some(first), Some(last)) => (contradiction(last, first), Spot::of(last)),
            _ => (general.to_owned(), Spot::of(last.or_else(longest)?)),
        })
    });
    match found {
        Some((why, spot)) => (format!("{why}, {}", spot.words()), Some(spot)),
        None => (general.to_owned(), None),
    }
}

/// Two agents alone, each the disc around its outlines.
fn pair(scenario: &Scenario, ids: [u64; 2]) -> Option<Scenario> {
    let disc = |id: u64| {
        let agent = scenario.agents.iter().find(|agent| agent.id == id)?;
        Some(Agent { radius: agent.reach(), footprint: None, loads: Vec::new(), ..agent.clone() })
    };
    Some(Scenario { agents: ids.into_iter().map(disc).collect::<Option<_>>()?, ..Scenario::default() })
}

/// Each starts on the way of the other, or each ends there.
const HEAD_ON: &str = "head-on without a passing place";
/// One of them starts and ends on the way of the other.
const NO_ORDER: &str = "no order is possible";

/// In words: a region that has to be passed second, and one that has to be passed first.
fn contradiction(second: &RegionRef<'_, f64>, first: &RegionRef<'_, f64>) -> String {
    let (other_start, other_end) = (second.is_open_at_start(), first.is_open_at_end());
    let own_start = first.length().lo <= 0.0;
    let own_end = second.length().hi >= second.ego_motion().path().length();
    let (kind, not_first, not_second) = match () {
        () if other_start && own_start => (HEAD_ON, Obstacle::OtherStart, Obstacle::OwnStart),
        () if own_end && other_end => (HEAD_ON, Obstacle::OwnEnd, Obstacle::OtherEnd),
        () if other_start => (NO_ORDER, Obstacle::OtherStart, Obstacle::OtherEnd),
        () => (NO_ORDER, Obstacle::OwnEnd, Obstacle::OwnStart),
    };
    format!("{kind}: {}, and {}", not_first.words(), not_second.words())
}

impl Spot {
    /// Where a region is.
    pub(super) fn of(region: &RegionRef<'_, f64>) -> Self {
        let ends = |interval: Interval<f64>| [interval.lo, interval.hi];
        let (own, other) = (ends(region.length()), ends(region.other_length()));
        Self::at(region.ego_motion(), [own, other])
    }

    /// At these lengths of two paths.
    fn at(first: &Motion<'_, f64>, lengths: [[f64; 2]; 2]) -> Self {
        let point = first.path().point_at((lengths[0][0] + lengths[0][1]) / 2.0);
        Self { lengths, at: [point.x, point.y] }
    }

    /// At the starts of two agents, or at their ends.
    pub(super) fn standing([a, b]: [&Motion<'_, f64>; 2], ends: bool) -> Self {
        let length = |motion: &Motion<'_, f64>| if ends { motion.path().length() } else { 0.0 };
        Self::at(a, [[length(a); 2], [length(b); 2]])
    }

    pub(super) fn words(&self) -> String {
        let [[a, b], [c, d]] = self.lengths;
        let [x, y] = self.at;
        format!("on lengths {a:.3} to {b:.3} m and {c:.3} to {d:.3} m, around ({x:.3}, {y:.3})")
    }
}

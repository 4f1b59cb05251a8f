//! Why and where two agents cannot be planned: which of their starts and ends are in the way of the other agent, and on
//! what lengths.

use super::{motions_with_margins, sides_of};
use crate::agent_regions::AgentRegions;
use crate::bodies::{Body, BodyFleet};
use crate::figures::outward;
use crate::fleet::Fleet;
use pcr_core::{Encounter, Interval, Motion, RegionRef};
use pcr_formats::scenario::Scenario;
use serde::Serialize;

/// A place where two agents are in each other's way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlockingLocation {
    /// Lengths on the paths of the first and the second agent \[m\].
    pub lengths: [[f64; 2]; 2],
    /// Position in the middle of the lengths of the first, x and y \[m\].
    #[serde(rename = "at")]
    pub point: [f64; 2],
}

/// The reason why a region cannot be passed before the other agent, or after it.
#[derive(Clone, Copy, PartialEq)]
enum BlockingCause {
    /// The first stands at its start, in the way of the second.
    OwnStart,
    /// The first stays at its end, in the way of the second.
    OwnEnd,
    /// The second stands at its start, in the way of the first.
    OtherStart,
    /// The second stays at its end, in the way of the first.
    OtherEnd,
}

impl BlockingCause {
    fn words(self) -> &'static str {
        match self {
            Self::OwnStart => "the first stands at its start in the way of the second",
            Self::OwnEnd => "the first stays at its end in the way of the second",
            Self::OtherStart => "the second stands at its start in the way of the first",
            Self::OtherEnd => "the second stays at its end in the way of the first",
        }
    }
}

/// What is said of two agents that meet with all delays, if it is not known where.
pub(super) const ALWAYS: &str = "they meet whenever they start";

/// Reason why two agents of a scenario meet with all delays (`always`), or why the first finds no start; and the place.
/// Computed from their bodies; without a place if they have no region.
pub(super) fn reason(scenario: &Scenario, ids: [u64; 2], always: bool) -> (String, Option<BlockingLocation>) {
    let general = match always {
        true => ALWAYS,
        false => "the first cannot start because of the second in any order that was tried",
    };
    match found(scenario, ids, always, general) {
        Some((why, spot)) => (format!("{why}, {}", spot.words()), Some(spot)),
        None => (general.to_owned(), None),
    }
}

fn found(scenario: &Scenario, ids: [u64; 2], always: bool, general: &str) -> Option<(String, BlockingLocation)> {
    let agent = |id: u64| scenario.agents.iter().find(|agent| agent.id == id).cloned();
    let scenario = Scenario { agents: ids.into_iter().map(agent).collect::<Option<_>>()?, ..Scenario::default() };
    let fleet = Fleet::<f64>::new(&scenario).ok()?;
    let references = fleet.motions();
    let references = [references.first()?, references.get(1)?];
    let bodies = BodyFleet::<f64>::new(&scenario).ok()?;
    let (grown, exact) = (motions_with_margins(&bodies.fleet), bodies.fleet.motions());
    let pair = BlockedPair { references, bodies: &bodies.bodies, grown: &grown, exact: &exact };
    let others: Vec<u32> = pair.of(1).map(|body| body as u32).collect();
    let rows = pair.of(0).map(|body| AgentRegions::new(&grown, body, &others)).collect::<Result<Vec<_>, _>>().ok()?;
    let all: Vec<BodyPairRegion<'_>> = rows.iter().flat_map(|row| pair.met(row)).collect();
    let never = all.iter().find(|met| met.sides() == [true; 2]);
    let last = never.or_else(|| all.iter().find(|met| met.sides()[0]));
    let first = never.or_else(|| all.iter().find(|met| met.sides()[1]));
    let longest = || all.iter().max_by(|a, b| a.region.length().length().total_cmp(&b.region.length().length()));
    let stand = || always.then(|| pair.standing(false).or_else(|| pair.standing(true))).flatten();
    Some(match (stand(), always, first, last) {
        (Some(found), ..) => found,
        (None, true, Some(first), Some(last)) => {
            let is_contact = pair.has_contact(first) && pair.has_contact(last);
            let margins = match is_contact {
                true => "",
                false if scenario.agents.iter().any(|agent| agent.margin > 0.0) => ", within their margins",
                // What plans keep for the rounding of numbers.
                false => ", within rounding",
            };
            // Two regions, of which each has an order, are passed by other speeds, maybe.
            match never {
                Some(_) => (contradiction(last, first) + margins, last.spot(references[0])),
                None => (describe_distance(last, first, references[0]) + margins, first.spot(references[0])),
            }
        }
        _ => (general.to_owned(), last.or_else(longest)?.spot(references[0])),
    })
}

/// Two agents and their bodies.
struct BlockedPair<'a> {
    /// Motions of the agents.
    references: [&'a Motion<'a, f64>; 2],
    bodies: &'a [Body],
    /// Motions of the bodies, enlarged by margins and rounding.
    grown: &'a [Motion<'a, f64>],
    /// The same as they are.
    exact: &'a [Motion<'a, f64>],
}

impl<'a> BlockedPair<'a> {
    /// The bodies of an agent.
    fn of(&self, agent: usize) -> impl Iterator<Item = usize> + 'a {
        let bodies = self.bodies;
        (0..bodies.len()).filter(move |&body| bodies[body].agent == agent)
    }

    /// The regions of a body.
    fn met(&self, row: &'a AgentRegions<'a, f64>) -> impl Iterator<Item = BodyPairRegion<'a>> {
        let bodies = self.bodies;
        let body = move |place: usize| row.agents()[place] as usize;
        let regions = row.table().row(row.motions(), row.agent_index()).expect("the table of the row");
        regions.map(move |region| {
            let places = [region.ego(), region.other()].map(body);
            let [own, other] = places.map(|place| &bodies[place]);
            BodyPairRegion { region, places, own, other }
        })
    }

    /// How near the agents are at their starts or at their ends, if they are too near.
    fn standing(&self, at_end: bool) -> Option<(String, BlockingLocation)> {
        let Self { references, bodies, grown, exact } = *self;
        let there = |&body: &usize| bodies[body].stands()[usize::from(at_end)];
        let all = Motion::span(exact);
        let time = if at_end { all.hi } else { all.lo };
        let apart = |motions: [&Motion<'_, f64>; 2]| {
            let encounter = Encounter::new(motions[0], motions[1]);
            (encounter.closest(Interval::new(time, time)).separation - encounter.radius(), encounter.tolerance())
        };
        let pairs = self.of(0).filter(there).flat_map(|a| self.of(1).filter(there).map(move |b| [a, b]));
        let near = pairs.filter_map(|[a, b]| {
            let (gap, tolerance) = apart([&exact[a], &exact[b]]);
            let margin = exact[a].margin() + exact[b].margin();
            let (within, _) = apart([&grown[a], &grown[b]]);
            (within < 0.0).then_some((gap, ProximityKind::of(gap, margin, tolerance)))
        });
        let (_, nearest) = near.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let place = if at_end { "at the ends of their paths" } else { "at their starts" };
        Some((format!("{} {place}", nearest.words()), BlockingLocation::standing(references, at_end)))
    }

    /// Whether the bodies themselves meet in a region, and not only their margins.
    fn has_contact(&self, met: &BodyPairRegion<'_>) -> bool {
        let [own, other] = met.places;
        let Ok(row) = AgentRegions::new(self.exact, own, &[other as u32]) else { return true };
        let mut regions = row.table().row(row.motions(), row.agent_index()).expect("the table of the row");
        regions.any(|region| region.length().meets(met.region.length()))
    }
}

/// How near two agents are that stand too near.
enum ProximityKind {
    Overlap,
    Touch,
    Margins,
}

impl ProximityKind {
    /// The contact for a gap between the bodies, margins, and the error of the gap \[m\].
    fn of(gap: f64, margins: f64, tolerance: f64) -> Self {
        match () {
            () if gap < -tolerance => Self::Overlap,
            () if gap <= tolerance || margins == 0.0 => Self::Touch,
            () => Self::Margins,
        }
    }

    fn words(&self) -> &'static str {
        match self {
            Self::Overlap => "they overlap",
            Self::Touch => "they touch",
            Self::Margins => "they are nearer than their margins",
        }
    }
}

/// A region of two bodies.
struct BodyPairRegion<'a> {
    region: RegionRef<'a, f64>,
    /// Places of the two bodies.
    places: [usize; 2],
    own: &'a Body,
    other: &'a Body,
}

impl BodyPairRegion<'_> {
    /// Whether the first body has to pass the region after the second, and whether before.
    fn sides(&self) -> [bool; 2] {
        sides_of(&self.region, self.own.stands(), self.other.stands())
    }

    /// The place of the region on the paths of the agents; the first one has this motion.
    fn spot(&self, first: &Motion<'_, f64>) -> BlockingLocation {
        let ends = |interval: Interval<f64>| [interval.lo, interval.hi];
        let lengths =
            [self.own.on_agent(ends(self.region.length())), self.other.on_agent(ends(self.region.other_length()))];
        BlockingLocation::at(first, lengths)
    }
}

/// Each starts on the way of the other, or each ends there.
const HEAD_ON: &str = "head-on without a passing place";
/// One of them starts and ends on the way of the other.
const NO_ORDER: &str = "no order is possible";

/// The reason in words: a region that has to be passed second, and one that has to be passed first, if it is the same one.
fn contradiction(second: &BodyPairRegion<'_>, first: &BodyPairRegion<'_>) -> String {
    let (kind, not_first, not_second) = obstacles(second, first);
    format!("{kind}: {}, and {}", not_first.words(), not_second.words())
}

/// The reason in words if they are two; the place of the one to be passed first follows.
fn describe_distance(second: &BodyPairRegion<'_>, first: &BodyPairRegion<'_>, reference: &Motion<'_, f64>) -> String {
    let (_, not_first, not_second) = obstacles(second, first);
    let (second, not_first, not_second) = (second.spot(reference).words(), not_first.words(), not_second.words());
    format!("no start delays are possible, other speeds may be: {not_first}, {second}; and {not_second}")
}

/// What is in the way, in short, of passing one region first and the other one second.
fn obstacles(second: &BodyPairRegion<'_>, first: &BodyPairRegion<'_>) -> (&'static str, BlockingCause, BlockingCause) {
    let other_start = second.other.is_at_start() && second.region.is_open_at_start();
    let other_end = first.other.is_at_end() && first.region.is_open_at_end();
    let own_start = first.own.is_at_start() && first.region.length().lo <= 0.0;
    let path = second.region.ego_motion().path();
    let own_end = second.own.is_at_end() && second.region.length().hi >= path.length();
    match () {
        () if other_start && own_start => (HEAD_ON, BlockingCause::OtherStart, BlockingCause::OwnStart),
        () if own_end && other_end => (HEAD_ON, BlockingCause::OwnEnd, BlockingCause::OtherEnd),
        () if other_start => (NO_ORDER, BlockingCause::OtherStart, BlockingCause::OtherEnd),
        () => (NO_ORDER, BlockingCause::OwnEnd, BlockingCause::OwnStart),
    }
}

impl BlockingLocation {
    /// The spot at these lengths of two paths.
    fn at(first: &Motion<'_, f64>, lengths: [[f64; 2]; 2]) -> Self {
        let point = first.path().point_at((lengths[0][0] + lengths[0][1]) / 2.0);
        Self { lengths, point: [point.x, point.y] }
    }

    /// The spot of two agents at their starts or at their ends.
    pub(super) fn standing([a, b]: [&Motion<'_, f64>; 2], ends: bool) -> Self {
        let length = |motion: &Motion<'_, f64>| if ends { motion.path().length() } else { 0.0 };
        Self::at(a, [[length(a); 2], [length(b); 2]])
    }

    pub(super) fn words(&self) -> String {
        let [[a, b], [c, d]] = self.lengths.map(outward);
        let [x, y] = self.point;
        format!("on lengths {a} to {b} m and {c} to {d} m, around ({x:.3}, {y:.3})")
    }
}

//! An adversary of passing orders: it takes agents on paths that aim at degenerate cases to the very lengths that they may go to, in any
//! order and with old news, and exchanges paths anywhere. Distances are those of the oracle, along whole moves.
//!
//! Unlike robots with brakes ([`crate::execution`]) these agents use all that a hold allows, down to its last digit.

use crate::disc::{Course, Disc, Leg};
use crate::execution::Table;
use crate::generators::{Dice, leg, pair};
use crate::oracle::Pair;
use crate::oracle::line::below;
use pcr_core::{
    AdmissionError, CheckState, CheckTolerances, EcmEntry, Interval, Motion, MovementAuthority, PassingState,
    PathProposal, Piece, Progress, RegionPrecedence, excess,
};
use pcr_planning::fleet::HostScalar;

/// What became of the fleets.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Fleets whose agents are apart at the beginning.
    pub fleets: u32,
    /// Paths that were admitted, and of these such whose agent was between the ends of its old one.
    pub admitted: u32,
    /// Those that were admitted in the middle of the old path.
    pub amid: u32,
    /// Paths that were refused.
    pub refused: u32,
    /// Moves that ended at the hold.
    pub to_the_hold: u32,
    /// Moves from which another agent came within a thousandth of a metre.
    pub close: u32,
    /// Fleets of which all were at their ends at last.
    pub arrived: u32,
}

struct Agent<S: HostScalar> {
    disc: Disc,
    course: &'static Course<S>,
    /// What is known of it.
    known: Progress<S>,
    /// Where it is.
    at: S,
    /// How much less than the truth may be known of it.
    width: S,
    /// How far it may go.
    allowed: S,
}

impl<S: HostScalar> Agent<S> {
    fn new(disc: &Disc, width: S) -> Option<Self> {
        let disc = disc.rounded::<S>();
        // Tests are short.
        let course: &'static Course<S> = Box::leak(Box::new(Course::new(&disc).ok()?));
        let known = Progress::at_rest(S::ZERO);
        Some(Self { disc, course, known, at: S::ZERO, width, allowed: S::ZERO })
    }

    fn end(&self) -> S {
        self.course.motion().path().length()
    }

    /// The path up to a length, and other legs from there on.
    fn turned_off(&self, from: f64, legs: Vec<Leg>) -> Option<Self> {
        let mut left = from;
        let mut kept: Vec<Leg> = Vec::new();
        for leg in &self.disc.legs {
            let length = leg.length().min(left);
            left -= length;
            if length > 0.0 {
                kept.push(leg.with_length(length));
            }
        }
        let disc = Disc { legs: kept.into_iter().chain(legs).collect(), ..self.disc.clone() };
        let next = Self::new(&disc, self.width)?;
        let known = self.known;
        (known.stop <= next.end()).then_some(Self { known, at: self.at, allowed: known.stop, ..next })
    }
}

/// How orders come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Region by region at random, one side that is possible: nobody touches anybody, but not all need arrive.
    Decided,
    /// By admissions: everybody arrives.
    Admitted,
}

/// The fleet of a seed.
///
/// # Panics
/// With the seed, where two discs touch, a hold falls below where an agent may be already, a refusal has no reason, or one that was
/// admitted does not arrive.
pub fn run<S: HostScalar>(seed: u64, way: Way, tally: &mut Tally) {
    let mut state = seed ^ 0x0a5e;
    let mut dice = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Dice::seeded(state)
    };
    let Some(mut fleet) = placed::<S>(&mut dice(), way) else { return };
    tally.fleets += 1;
    let mut motions: Vec<Motion<'static, S>> = fleet.iter().map(|agent| agent.course.motion()).collect();
    let storage = (vec![EcmEntry::EMPTY; 400], vec![Piece::EMPTY; 2000], vec![RegionPrecedence::EMPTY; 800]);
    let Ok(mut orders) = Table::<S>::build(storage.0, storage.1, storage.2, &motions) else { return };
    let mut known: Vec<Progress<S>> = fleet.iter().map(|agent| agent.known).collect();
    // What each has heard of each other one.
    let mut heard = vec![known.clone(); fleet.len()];
    let mut reaches = vec![CheckState::EMPTY; fleet.len()];
    let rounding = |motions: &[Motion<'_, S>]| {
        let all = motions.iter().flat_map(|a| motions.iter().map(move |b| excess(a, b).to_f64()));
        all.fold(0.0, f64::max)
    };
    // Old and new paths of an agent are not the same to the last digit.
    let mut tolerance = 0.0;
    if way == Way::Decided {
        decide(&mut orders, &motions, &known, &mut dice());
    }
    let steps = 60;
    for step in 0..steps {
        let mut dice = dice();
        let random = dice.below(usize::MAX);
        if way == Way::Admitted && (step < 8 || dice.chance(0.3)) {
            let agent = if step < 8 { step % fleet.len() } else { dice.below(fleet.len()) };
            let Some(next) = proposal(&fleet[agent], &mut dice) else { continue };
            let width = fleet.iter().map(|agent| agent.width.to_f64()).fold(0.0, f64::max);
            let width = S::from_f64(width + 8.0 * rounding(&motions) + 1e-9);
            let tolerances = CheckTolerances { width, gain: S::from_f64(1e-3) };
            let mission = PathProposal { agent, motion: next.course.motion(), progress: next.known };
            let prefer = |region: &pcr_core::RegionRef<'_, S>| {
                if (random >> (region.other() % 60)) & 1 == 1 { PassingState::First } else { PassingState::Second }
            };
            match orders.admit(&mut motions, &mut known, mission, tolerances, &mut reaches, prefer) {
                Ok(()) => {
                    tally.admitted += 1;
                    tally.amid += u32::from(fleet[agent].at > S::ZERO && fleet[agent].at < fleet[agent].end());
                    tolerance += 4.0 * rounding(&motions);
                    fleet[agent] = next;
                    let unheard = if dice.chance(0.5) { known[agent] } else { Progress::default() };
                    heard.iter_mut().for_each(|heard| heard[agent] = unheard);
                    fleet.iter_mut().for_each(|agent| agent.allowed = agent.known.stop);
                    let found = orders.check(&motions, &known, tolerances, &mut reaches);
                    assert_eq!(found, Ok(()), "seed {seed}: what is admitted passes the check");
                }
                Err(AdmissionError::Stuck { .. } | AdmissionError::Blocked { .. } | AdmissionError::Late { .. }) => {
                    tally.refused += 1
                }
                // There is no more room.
                Err(AdmissionError::Full(_)) => {}
                Err(refused) => panic!("seed {seed}: {refused}"),
            }
        }
        let agent = dice.below(fleet.len());
        for other in 0..fleet.len() {
            if dice.chance(0.5) {
                heard[agent][other] = known[other];
            }
        }
        let hold = orders.hold(&motions, agent, &heard[agent]).expect("its fleet");
        advance(&mut fleet, agent, hold, &mut dice, tolerance, tally, seed);
        known[agent] = fleet[agent].known;
        if dice.chance(0.1) {
            orders.passed(&known);
        }
    }
    if way == Way::Admitted {
        finish(&mut fleet, &orders, &motions, &mut known, tolerance, tally, seed);
    }
}

/// Two to four agents that are apart at the beginning; before an admission they stand.
fn placed<S: HostScalar>(dice: &mut Dice, way: Way) -> Option<Vec<Agent<S>>> {
    let (a, b) = pair(dice);
    let mut discs = vec![a, b];
    if dice.chance(0.4) {
        let (c, d) = pair(&mut Dice::seeded((dice.face() * 1e9) as u64));
        discs.extend([c, d].into_iter().take(1 + dice.below(2)));
    }
    let width = S::from_f64(if dice.chance(0.5) { 0.0 } else { dice.range(0.001, 0.1) });
    let agents: Vec<Agent<S>> = discs.iter().map(|disc| Agent::new(disc, width)).collect::<Option<_>>()?;
    let apart = (0..agents.len())
        .all(|i| (0..i).all(|j| Pair::new(&agents[i].disc, &agents[j].disc).clearance(0.0, 0.0) > 0.0));
    if way == Way::Decided {
        return apart.then_some(agents);
    }
    let standing = |agent: Agent<S>| {
        let disc = Disc { legs: Vec::new(), ..agent.disc.clone() };
        // What it is to drive it knows by its disc.
        Some(Agent { course: Agent::<S>::new(&disc, width)?.course, ..agent })
    };
    let agents: Vec<Agent<S>> = agents.into_iter().map(standing).collect::<Option<_>>()?;
    apart.then_some(agents)
}

/// One of the sides that are possible for each region, if there is one.
fn decide<S: HostScalar>(orders: &mut Table<S>, motions: &[Motion<'_, S>], known: &[Progress<S>], dice: &mut Dice) {
    for agent in 0..motions.len() {
        let row: Vec<_> = orders
            .row(motions, agent)
            .expect("its fleet")
            .filter(|(_, region, _)| region.other() > agent)
            .map(|(place, region, _)| {
                let [own, their] = [agent, region.other()].map(|agent| known[agent]);
                let second = region.hold(own.at.lo, their.at.lo).allows(own.stop);
                let first = region.swapped().hold(their.at.lo, own.at.lo).allows(their.stop);
                let pass = match (first, second) {
                    (true, true) if dice.chance(0.5) => PassingState::First,
                    (true, false) => PassingState::First,
                    (_, true) => PassingState::Second,
                    (false, false) => PassingState::Undecided,
                };
                (place, pass)
            })
            .collect();
        for (place, pass) in row {
            orders.decide_at(motions, place, agent, pass, S::ZERO).expect("its fleet");
        }
    }
}

/// Another path for an agent: that of its disc where it stands yet, or one with another end.
fn proposal<S: HostScalar>(agent: &Agent<S>, dice: &mut Dice) -> Option<Agent<S>> {
    let legs = |dice: &mut Dice| (0..1 + dice.below(2)).map(|_| leg(dice)).collect::<Vec<_>>();
    if agent.end() == S::ZERO {
        return Agent::new(&agent.disc, agent.width);
    }
    let (stop, end) = (agent.known.stop.to_f64(), agent.end().to_f64());
    let from = match dice.below(4) {
        0 => stop,
        1 => end,
        _ => dice.range(stop, end.max(stop)),
    };
    let legs = if dice.chance(0.2) { Vec::new() } else { legs(dice) };
    agent.turned_off(from, legs)
}

/// Takes an agent on as far as it may go, or less far.
fn advance<S: HostScalar>(
    fleet: &mut [Agent<S>],
    agent: usize,
    hold: MovementAuthority<S>,
    dice: &mut Dice,
    tolerance: f64,
    tally: &mut Tally,
    seed: u64,
) {
    let (known, at) = (fleet[agent].known, fleet[agent].at);
    // Of two holds under the same orders the larger one counts.
    let allowed = hold.length(fleet[agent].end()).unwrap_or(S::ZERO).max(fleet[agent].allowed);
    let part = if dice.chance(0.6) { 1.0 } else { dice.face() };
    let hi = known.at.hi.max(S::from_f64(known.at.hi.to_f64() + part * (allowed.to_f64() - known.at.hi.to_f64())));
    let hi = hi.min(allowed);
    let stop = known.stop.max(hi);
    let stop = if dice.chance(0.3) { stop.max(allowed) } else { stop };
    let lo = known.at.lo.max(hi - fleet[agent].width);
    let now = at.max(if dice.chance(0.5) { hi } else { lo });
    for other in (0..fleet.len()).filter(|&other| other != agent) {
        let pair = Pair::new(&fleet[agent].disc, &fleet[other].disc);
        let theirs = fleet[other].at.to_f64();
        let clearance = |l: f64| pair.clearance(theirs, l);
        let deep = below(|l| clearance(l) + tolerance + 1e-11, at.to_f64(), now.to_f64(), 0.0, 1e-9).inner;
        assert!(
            deep.is_empty() && clearance(now.to_f64()) > -tolerance - 1e-11,
            "seed {seed}: {agent} goes from {at:?} to {now:?} and touches {other} at {theirs}: {deep:?}, {} m, {hold:?}",
            clearance(now.to_f64())
        );
        tally.close += u32::from(now > at && clearance(now.to_f64()) < 1e-3);
    }
    tally.to_the_hold += u32::from(now > at && hi == allowed);
    let it = &mut fleet[agent];
    (it.at, it.allowed) = (now, allowed);
    it.known = Progress { at: Interval::new(lo, hi), stop };
}

/// Everybody goes on as far as it may until all are at their ends.
fn finish<S: HostScalar>(
    fleet: &mut [Agent<S>],
    orders: &Table<S>,
    motions: &[Motion<'_, S>],
    known: &mut [Progress<S>],
    tolerance: f64,
    tally: &mut Tally,
    seed: u64,
) {
    let mut whole = Dice::new(vec![0.0; 8]);
    loop {
        let mut moved = false;
        for agent in 0..fleet.len() {
            let before = known[agent].at;
            let hold = orders.hold(motions, agent, known).expect("its fleet");
            advance(fleet, agent, hold, &mut whole, tolerance, tally, seed);
            known[agent] = fleet[agent].known;
            moved |= known[agent].at != before;
        }
        if !moved {
            break;
        }
    }
    for (agent, it) in fleet.iter().enumerate() {
        assert!(
            it.known.at.hi >= it.end() - S::from_f64(1e-3),
            "seed {seed}: {agent} stands at {:?} of {:?}",
            it.known,
            it.end()
        );
    }
    tally.arrived += 1;
}

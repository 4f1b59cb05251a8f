//! Tables that were changed are refuted by the checker, or have lost nothing: what it proves is tried by points, and every place that it
//! shows is looked at, with exact arithmetic that shares nothing with it.

use pcr_certify::pair::{Findings, TableProperty, Witness};
use pcr_certify::raw::{RawBranch, RawPair, RawPhase, RawTable};
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::HostScalar;
use pcr_tests::certified::{discs_of, table};
use pcr_tests::disc::{Disc, Drive, Leg};
use pcr_tests::exact::{DoubleDouble, Route};
use pcr_tests::generators::{Dice, certifiable};
use std::f64::consts::{FRAC_PI_2, TAU};

/// As many as are done in seconds.
const fn count(release: u64, debug: u64) -> u64 {
    if cfg!(optimized) { release } else { debug }
}

fn fleet() -> Scenario {
    Scenario::from_json(include_str!("../data/paper12.json")).unwrap()
}

fn findings(table: &RawTable) -> Findings {
    Checker::new(table).unwrap().check(CoverageMargin::Needed).unwrap()
}

/// The table of paths alone.
fn of_paths(mut table: RawTable) -> RawTable {
    table.agents.iter_mut().for_each(|agent| agent.travel = None);
    table.pairs.iter_mut().flat_map(|pair| &mut pair.regions).for_each(|region| region.times = None);
    table
}

/// Makes what is told of regions that of their pieces again; those that have none any more are gone.
fn tell(pair: &mut RawPair) {
    let mut regions = Vec::new();
    for (place, mut region) in std::mem::take(&mut pair.regions).into_iter().enumerate() {
        let those = pair.pieces.iter_mut().filter(|piece| piece.region == place);
        let hull = those.fold(None, |hull: Option<[[f64; 2]; 2]>, piece| {
            piece.region = regions.len();
            let hull = hull.unwrap_or(piece.lengths);
            let both = |k: usize| [hull[k][0].min(piece.lengths[k][0]), hull[k][1].max(piece.lengths[k][1])];
            Some([both(0), both(1)])
        });
        if let Some(hull) = hull {
            region.lengths = hull;
            regions.push(region);
        }
    }
    pair.regions = regions;
}

/// Whether there is a contact at these lengths, by points on the paths alone: where the checker says that a changed
/// table is none the worse.
fn touches(routes: &[Route; 2], lengths: [[f64; 2]; 2], radius: f64, steps: u32) -> bool {
    let at = |[lo, hi]: [f64; 2], k: u32| lo + (hi - lo) * f64::from(k) / f64::from(steps);
    (0..=steps).any(|i| {
        (0..=steps).any(|j| {
            let [p, q] = [routes[0].at(at(lengths[0], i).into()), routes[1].at(at(lengths[1], j).into())];
            let [x, y] = [p[0] - q[0], p[1] - q[1]];
            (x * x + y * y).sqrt() <= DoubleDouble::from(radius)
        })
    })
}

/// What came of changes of single pieces.
#[derive(Debug, Default)]
struct Changes {
    refuted: usize,
    undecided: usize,
    harmless: usize,
}

impl Changes {
    /// Certifies the changed pair alone. Where it is proved, `lost` has no contact.
    fn look(&mut self, table: &RawTable, mut changed: RawPair, lost: impl FnOnce() -> bool) {
        tell(&mut changed);
        let mut agents = table.agents.clone();
        for (place, agent) in agents.iter_mut().enumerate() {
            // One body, but for the two.
            agent.id = if changed.agents.contains(&place) { place as u64 } else { u64::MAX };
        }
        let pairs = changed.agents;
        let others = (0..agents.len()).filter(|place| !pairs.contains(place));
        let far: Vec<RawPair> = others
            .flat_map(|other| pairs.map(|one| [one.min(other), one.max(other)]))
            .filter_map(|pair| table.pairs.iter().find(|there| there.agents == pair).cloned())
            .collect();
        let small = RawTable { agents, pairs: far.into_iter().chain([changed]).collect(), apart: table.apart };
        let found = findings(&small);
        if !found.refuted.is_empty() {
            self.refuted += 1;
        } else if !found.undecided.is_empty() {
            self.undecided += 1;
        } else {
            self.harmless += 1;
            assert!(!lost());
        }
    }
}

fn changed_tables_are_refuted<S: HostScalar>(scenario: &Scenario) {
    let table = of_paths(discs_of::<S>(scenario));
    let routes: Vec<Route> =
        scenario.agents.iter().map(|agent| Route::new::<S>(&Disc::of_agent(agent).rounded::<S>())).collect();
    let [mut removed, mut shortened, mut enlarged] = [(); 3].map(|()| Changes::default());
    let mut pieces = 0;
    for pair in table.pairs.iter().filter(|pair| !pair.pieces.is_empty()) {
        let own = pair.agents.map(|place| routes[place].clone());
        let radius: f64 = pair.agents.iter().map(|&place| table.agents[place].radius).sum();
        for place in 0..pair.pieces.len() {
            pieces += 1;
            let piece = pair.pieces[place];
            let mut without = pair.clone();
            without.pieces.remove(place);
            removed.look(&table, without, || true);
            for (path, end) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let by = if end == 0 { 2.0 } else { -2.0 } * pair.excess;
                let segment = &table.agents[pair.agents[path]].path.segments[piece.segments[path]];
                for (out, changes) in [(false, &mut shortened), (true, &mut enlarged)] {
                    let mut other = pair.clone();
                    let before = piece.lengths[path][end];
                    let after = before + if out { -by } else { by };
                    let [lo, hi] = [0, 1].map(|k| if k == end { after } else { piece.lengths[path][k] });
                    if lo > hi || after < segment.from || after > segment.to {
                        continue;
                    }
                    other.pieces[place].lengths[path] = [lo, hi];
                    let mut strip = piece.lengths;
                    strip[path] = [before.min(after), before.max(after)];
                    changes.look(&table, other, || !out && touches(&own, strip, radius, 30));
                }
            }
        }
    }
    println!("{}: {pieces} pieces; removed {removed:?}, shortened {shortened:?}, enlarged {enlarged:?}", S::NAME);
    assert_eq!((removed.refuted, removed.undecided + removed.harmless), (pieces, 0));
    for changes in [shortened, enlarged] {
        let all = changes.refuted + changes.undecided + changes.harmless;
        assert!(all > 3 * pieces, "{changes:?}");
        // The paths meet at so small an angle now and then that 2ε of length are less than ε of distance.
        assert!(10 * changes.refuted > 9 * all, "{changes:?}");
    }
}

#[test]
fn changed_tables_are_refuted_unless_they_are_right() {
    let scenario = fleet();
    changed_tables_are_refuted::<f64>(&scenario);
    changed_tables_are_refuted::<f32>(&scenario);
    changed_tables_are_refuted::<Micro>(&scenario);
    changed_tables_are_refuted::<Q20>(&scenario);
    changed_tables_are_refuted::<Q16>(&scenario);
    changed_tables_are_refuted::<Q12>(&scenario);
}

fn exchanged_shares_are_not_proved<S: HostScalar>() {
    let (mut exchanged, mut refuted, mut proved) = (0, 0, 0);
    for seed in 0..count(1_500, 400) {
        let (pair, drives) = certifiable::<S>(seed);
        let Some(mut table) = table::<S>(&pair, &drives) else { continue };
        // One interval each at every length: else each may hold all there is of the other.
        let pieces = &mut table.pairs[0].pieces;
        if pieces.len() > 12 || !pieces.iter().any(|piece| piece.share != RawBranch::Only) {
            continue;
        }
        for piece in pieces {
            piece.share = match piece.share {
                RawBranch::Only => RawBranch::Only,
                RawBranch::Start => RawBranch::End,
                RawBranch::End => RawBranch::Start,
            };
        }
        exchanged += 1;
        let found = findings(&table);
        refuted += usize::from(!found.refuted.is_empty());
        proved += usize::from(found.refuted.is_empty() && found.undecided.is_empty());
    }
    println!("{}: {exchanged} tables with shares exchanged, {refuted} refuted, {proved} proved", S::NAME);
    assert!(exchanged > 20 && 10 * refuted > 9 * exchanged, "{exchanged} {refuted} {proved}");
}

#[test]
fn tables_with_their_shares_exchanged_are_refuted() {
    exchanged_shares_are_not_proved::<f64>();
    exchanged_shares_are_not_proved::<f32>();
    exchanged_shares_are_not_proved::<Micro>();
    exchanged_shares_are_not_proved::<Q20>();
    exchanged_shares_are_not_proved::<Q16>();
    exchanged_shares_are_not_proved::<Q12>();
}

fn falsified_tables_are_refuted<S: HostScalar>() {
    let table = discs_of::<S>(&fleet());
    let full: Vec<usize> = (0..table.pairs.len()).filter(|&place| !table.pairs[place].pieces.is_empty()).collect();
    let refuted = |change: &dyn Fn(&mut RawTable)| {
        let mut other = table.clone();
        change(&mut other);
        Checker::new(&other).and_then(|checker| checker.check(CoverageMargin::Needed)).map(|found| found.refuted)
    };
    let breaks = |found: &[Witness], promise| found.iter().any(|witness| witness.promise == promise);
    for &place in &full {
        // ε: less is not kept, of more a quarter is not covered.
        let less = refuted(&|table| table.pairs[place].excess *= 0.25).unwrap();
        assert!(breaks(&less, TableProperty::Near), "{}: {place}", S::NAME);
        let more = refuted(&|table| table.pairs[place].excess *= 8.0).unwrap();
        assert!(breaks(&more, TableProperty::Covered), "{}: {place}", S::NAME);
        // The pieces of another pair, with their regions.
        let next = full[(full.iter().position(|&other| other == place).unwrap() + 1) % full.len()];
        let exchanged = refuted(&|table| {
            let RawPair { regions, pieces, .. } = table.pairs[next].clone();
            let own = &mut table.pairs[place];
            (own.regions, own.pieces) = (regions, pieces);
        });
        assert!(exchanged.is_err() || exchanged.is_ok_and(|found| !found.is_empty()), "{}: {place}", S::NAME);
    }
    // A larger disc has contacts that are not covered, a smaller one is told of contacts that it has not.
    for (place, agent) in table.agents.iter().enumerate() {
        let own = table.pairs.iter().filter(|pair| pair.agents.contains(&place) && !pair.pieces.is_empty());
        let by = 3.0 * own.map(|pair| pair.excess).fold(0.0, f64::max);
        assert!(by > 0.0 && by < 0.5 * agent.radius, "{}: {place}", S::NAME);
        let larger = refuted(&|table| table.agents[place].radius += by).unwrap();
        let smaller = refuted(&|table| table.agents[place].radius -= by).unwrap();
        let found = [breaks(&larger, TableProperty::Covered), breaks(&smaller, TableProperty::Near)];
        assert_eq!(found, [true; 2], "{}: {place}", S::NAME);
    }
    // Times: shorter ones leave contacts out, longer ones are farther out than stated.
    let (mut shorter, mut longer) = ([0, 0], [0, 0]);
    for &place in &full {
        for region in 0..table.pairs[place].regions.len() {
            let times = table.pairs[place].regions[region].times.unwrap();
            for (k, end) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let [from, to] = times[k];
                let travel = table.agents[table.pairs[place].agents[k]].travel.as_ref().unwrap();
                let moved = |by: f64| {
                    refuted(&|table| {
                        let times = table.pairs[place].regions[region].times.as_mut().unwrap();
                        times[k][end] += if end == 0 { by } else { -by };
                    })
                };
                let less = moved(0.5 * (to - from).min(1.0)).unwrap();
                shorter = [shorter[0] + 1, shorter[1] + usize::from(breaks(&less, TableProperty::Timed))];
                let more = moved(-3.0 * travel.time_excess).unwrap();
                longer = [longer[0] + 1, longer[1] + usize::from(breaks(&more, TableProperty::Prompt))];
                let crossed = moved(1.5 * (to - from) + travel.time_excess);
                assert!(crossed.is_err(), "{}: {place}", S::NAME);
            }
        }
    }
    println!("{}: times made shorter {shorter:?}, longer {longer:?}: changed, refuted", S::NAME);
    assert!(shorter[0] > 200 && shorter[0] == shorter[1] && longer[0] == longer[1], "{shorter:?} {longer:?}");
}

#[test]
fn tables_with_a_number_falsified_are_refuted() {
    falsified_tables_are_refuted::<f64>();
    falsified_tables_are_refuted::<f32>();
    falsified_tables_are_refuted::<Micro>();
    falsified_tables_are_refuted::<Q20>();
    falsified_tables_are_refuted::<Q16>();
    falsified_tables_are_refuted::<Q12>();
}

/// Motions that go back, jump, or end before their path does: a region may then be left and come to again at a time that nobody tells.
fn motions_that_are_none_are_refused<S: HostScalar>() {
    let table = discs_of::<S>(&fleet());
    let refused = |why: &str, change: &dyn Fn(&mut Vec<RawPhase>)| {
        for place in 0..table.agents.len() {
            let mut other = table.clone();
            change(&mut other.agents[place].travel.as_mut().unwrap().phases);
            let found = Checker::new(&other).map(drop).unwrap_err().to_string();
            assert!(found.contains(why), "{}: {place}: {found}", S::NAME);
        }
    };
    let ends = |phases: &[RawPhase]| phases.last().map(|last| (last.time[1], last.length[1])).unwrap();
    refused("its phases end at 0 m", &|phases| phases.clear());
    refused("its phases end at", &|phases| phases.truncate(1));
    refused("too short a way", &|phases| {
        let (time, length) = ends(phases);
        *phases = vec![RawPhase { time: [0.0, time], length: [0.0, length], speed: [5.0 * length / time; 2] }];
    });
    // A tenth faster than it goes.
    refused("too short a way", &|phases| {
        let (time, length) = ends(phases);
        *phases = vec![RawPhase { time: [0.0, time], length: [0.0, length], speed: [1.1 * length / time, 9.0] }];
    });
    refused("takes no time", &|phases| {
        let (time, length) = ends(phases);
        let phase = |time, length| RawPhase { time, length, speed: [0.0; 2] };
        *phases = vec![phase([0.0, time], [0.0; 2]), phase([time; 2], [0.0, length])];
    });
}

#[test]
fn motions_that_go_back_or_jump_are_refused() {
    motions_that_are_none_are_refused::<f64>();
    motions_that_are_none_are_refused::<f32>();
    motions_that_are_none_are_refused::<Micro>();
    motions_that_are_none_are_refused::<Q20>();
    motions_that_are_none_are_refused::<Q16>();
    motions_that_are_none_are_refused::<Q12>();
}

/// Pairs that are special: full circles, several laps, legs and paths of length 0, contact from the start, disc as large as circle, far
/// away from the origin.
fn special(seed: u64, largest: f64) -> (Disc, Disc) {
    let mut dice = Dice::seeded(seed);
    let unit = 0.25 * (1 + dice.below(8)) as f64;
    let path = |dice: &mut Dice| -> Vec<Leg> {
        let turn = dice.sign();
        let circle = Leg::arc(unit, turn * TAU);
        match dice.below(7) {
            0 => vec![circle],
            1 => vec![circle, circle],
            2 => vec![Leg::arc(unit, turn * FRAC_PI_2), circle, Leg::Line(unit)],
            3 => vec![Leg::Line(0.0), Leg::Line(unit), Leg::Line(0.0), Leg::arc(unit, turn * TAU)],
            4 => vec![Leg::Line(0.0)],
            5 => vec![Leg::arc(unit, turn * dice.range(6.0, TAU)), Leg::arc(2.0 * unit, -turn * TAU)],
            _ => vec![Leg::Line(unit * dice.range(0.0, 4.0)), Leg::arc(unit * dice.magnitude(0.1, 3.0), turn * 3.0)],
        }
    };
    let (first, second) = (path(&mut dice), path(&mut dice));
    // R as large as the circle, as half of it, as twice, or anything.
    let radius = unit * [1.0, 0.5, 2.0, dice.magnitude(0.05, 3.0)][dice.below(4)];
    let away = if dice.chance(0.2) { [0.5 * largest, -0.5 * largest] } else { [0.0; 2] };
    let apart = match dice.below(4) {
        0 => [0.0, 0.0],
        1 => [0.0, unit],
        2 => [radius, 0.0],
        _ => [dice.range(-2.0, 2.0) * unit, dice.range(-2.0, 2.0) * unit],
    };
    let heading = FRAC_PI_2 * dice.below(4) as f64;
    let own = Disc { radius: 0.5 * radius, start: [away[0], away[1], 0.0], legs: first };
    let start = [away[0] + apart[0], away[1] + apart[1], heading];
    (own, Disc { radius: radius - 0.5 * radius, start, legs: second })
}

/// A change of one piece: its ends, its place, its share, or that it is there.
fn changed(pair: &mut RawPair, ends: [f64; 2], dice: &mut Dice) {
    let place = dice.below(pair.pieces.len());
    let mut copy = pair.pieces[place];
    match dice.below(8) {
        0 => drop(pair.pieces.remove(place)),
        1 => pair.pieces[place].lengths.swap(0, 1),
        2 => pair.pieces[place].segments.swap(0, 1),
        3 => pair.pieces[place].share = [RawBranch::Only, RawBranch::Start, RawBranch::End][dice.below(3)],
        4 => {
            // Two pieces with a gap between them.
            let k = dice.below(2);
            let [lo, hi] = copy.lengths[k];
            let at = dice.range(lo, hi);
            pair.pieces[place].lengths[k][1] = at;
            copy.lengths[k][0] = (at + (hi - lo) * dice.magnitude(1e-12, 1.0)).min(hi);
            pair.pieces.push(copy);
        }
        _ => {
            let (k, end) = (dice.below(2), dice.below(2));
            let by = dice.sign() * dice.magnitude(1e-14, 1.0) * ends[k].max(1.0);
            let length = &mut pair.pieces[place].lengths[k];
            length[end] = (length[end] + by).clamp(0.0, ends[k]);
        }
    }
}

/// The squared distance of the centres at two lengths, exactly but for 2^-100.
fn distance(routes: &[Route; 2], lengths: [f64; 2]) -> DoubleDouble {
    distance_at(routes, lengths.map(DoubleDouble::from))
}

fn distance_at(routes: &[Route; 2], lengths: [DoubleDouble; 2]) -> DoubleDouble {
    let [[a, b], [c, d]] = [0, 1].map(|k| routes[k].at(lengths[k]));
    let [x, y] = [a - c, b - d];
    (x * x + y * y).sqrt()
}

fn holds(pair: &RawPair, lengths: [f64; 2]) -> bool {
    pair.pieces
        .iter()
        .any(|piece| (0..2).all(|k| piece.lengths[k][0] <= lengths[k] && lengths[k] <= piece.lengths[k][1]))
}

/// The lengths of both paths, as the format sums them up.
fn ends(table: &RawTable) -> [f64; 2] {
    [0, 1].map(|k| table.agents[k].path.segments.last().map_or(0.0, |last| last.to))
}

/// A contact that no piece holds, if points show one: on a lattice of the whole paths, and about the ends of pieces.
fn left_out(routes: &[Route; 2], table: &RawTable, radius: DoubleDouble, dice: &mut Dice) -> Option<[f64; 2]> {
    let (pair, ends) = (&table.pairs[0], ends(table));
    let mut places: [Vec<f64>; 2] = ends.map(|end| (0..=12).map(|k| end.min(end * f64::from(k) / 12.0)).collect());
    for piece in &pair.pieces {
        for k in [0, 1] {
            for end in piece.lengths[k] {
                let by = dice.magnitude(1e-13, 0.1) * ends[k];
                places[k].extend([end - by, end + by].map(|place| place.clamp(0.0, ends[k])));
            }
            places[k].push(dice.range(piece.lengths[k][0], piece.lengths[k][1]));
        }
    }
    // A told length is that of a place on each segment that holds it, off by what the sum of lengths was rounded by.
    let exact = |k: usize, told: f64| -> Vec<DoubleDouble> {
        let mut before = DoubleDouble::ZERO;
        let mut found = Vec::new();
        for segment in &table.agents[k].path.segments {
            if segment.from <= told && told <= segment.to {
                let length = DoubleDouble::from(segment.length);
                let on = if told == segment.to {
                    length
                } else {
                    DoubleDouble::from(told) - DoubleDouble::from(segment.from)
                };
                found.push(before + on.clamp(DoubleDouble::ZERO, length));
            }
            before = before + DoubleDouble::from(segment.length);
        }
        found
    };
    let meet = |told: [f64; 2]| {
        let [first, second] = [0, 1].map(|k| exact(k, told[k]));
        first.iter().any(|&l| second.iter().any(|&s| distance_at(routes, [l, s]) <= radius))
    };
    let [first, second] = &places;
    let all = first.iter().flat_map(|&l| second.iter().map(move |&s| [l, s]));
    all.into_iter().find(|&told| !holds(pair, told) && meet(told))
}

/// What came of tables that were tried.
#[derive(Debug, Default)]
struct Tried {
    tables: usize,
    proved: usize,
    refuted: usize,
    undecided: usize,
    refused: usize,
}

/// The verdict about a table of two agents is that of points: where it is proved no contact is left out, and a place that is shown is
/// one, or is told without a contact.
fn is_right(table: &RawTable, routes: &[Route; 2], what: &str, dice: &mut Dice, tried: &mut Tried) {
    tried.tables += 1;
    let pair = &table.pairs[0];
    let found = match Checker::new(table).and_then(|checker| checker.check(CoverageMargin::Needed)) {
        Ok(found) => found,
        Err(_) => return tried.refused += 1,
    };
    let radius = DoubleDouble::from(table.agents[0].radius) + DoubleDouble::from(table.agents[1].radius);
    for witness in found.refuted.iter().filter(|witness| witness.promise != TableProperty::Shared) {
        let clearance = (distance(routes, witness.lengths) - radius).to_f64();
        // Lengths are rounded for messages, and those along a path are what the format sums up.
        let near = |k: usize| 1e-15 * routes[k].length().to_f64() + table.agents[k].path.rounding;
        assert!(
            (clearance - witness.clearance).abs() <= 8.0 * (near(0) + near(1)),
            "{what}: {witness:?}, {clearance:e}"
        );
        match witness.promise {
            TableProperty::Covered => assert!(witness.clearance < pair.excess, "{what}: {witness:?}"),
            _ => assert!(witness.clearance > 0.0, "{what}: {witness:?}"),
        }
    }
    if !found.refuted.is_empty() {
        tried.refuted += 1;
    } else if !found.undecided.is_empty() {
        tried.undecided += 1;
    } else {
        tried.proved += 1;
        let lost = left_out(routes, table, radius, dice);
        assert!(lost.is_none(), "{what}: proved, but for {lost:?} {pair:?}");
    }
}

/// Ends that the format has.
fn round(pair: &mut RawPair, step: f64) {
    if step > 0.0 {
        let ends = pair.pieces.iter_mut().flat_map(|piece| piece.lengths.iter_mut().flatten());
        ends.for_each(|end| *end = (*end / step).round() * step);
    }
}

fn attacked<S: HostScalar>(pairs: u64) -> [Tried; 2] {
    let [mut right, mut wrong] = [Tried::default(), Tried::default()];
    for seed in 0..pairs {
        let mut dice = Dice::seeded(seed ^ 0x5eed);
        let (discs, drives) = match seed % 3 {
            0 => certifiable::<S>(seed),
            _ => (special(seed, S::LIMIT.to_f64().min(1e6)), [(Drive::Unit, 0.0), (Drive::Unit, 0.0)]),
        };
        let Some(table) = table::<S>(&discs, &drives) else { continue };
        let table = of_paths(table);
        let routes = [&discs.0, &discs.1].map(|disc| Route::new::<S>(&disc.rounded::<S>()));
        let what = |change: u64| format!("{seed}.{change} in {}", S::NAME);
        is_right(&table, &routes, &what(0), &mut dice, &mut right);
        if table.pairs[0].pieces.is_empty() {
            continue;
        }
        let ends = ends(&table);
        for change in 1..=8 {
            let mut other = table.clone();
            changed(&mut other.pairs[0], ends, &mut Dice::seeded(seed * 8 + change));
            round(&mut other.pairs[0], other.agents[0].path.step);
            tell(&mut other.pairs[0]);
            is_right(&other, &routes, &what(change), &mut dice, &mut wrong);
        }
    }
    println!("{}: as computed {right:?}, changed {wrong:?}", S::NAME);
    assert_eq!(right.refuted + right.refused, 0, "{}: {right:?}", S::NAME);
    assert!(wrong.refuted * 4 > wrong.tables && wrong.proved * 50 > wrong.tables, "{}: {wrong:?}", S::NAME);
    [right, wrong]
}

#[test]
fn verdicts_are_those_of_points() {
    let pairs = count(150, 60);
    attacked::<f64>(pairs);
    attacked::<f32>(pairs);
    attacked::<Micro>(pairs / 2);
    attacked::<Q20>(pairs / 2);
    attacked::<Q16>(pairs / 2);
    attacked::<Q12>(pairs / 2);
}

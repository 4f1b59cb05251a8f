//! Compares with all choices of sides, for small fleets.

use super::branch_and_bound::DelaySearchResult;
use super::feasibility::{Feasibility, feasible};
use super::problem::DifferenceConstraint;
use super::*;
use pcr_formats::splitmix64::SplitMix64;

const FLEETS: u64 = 500;

/// Longest paths of constraints by as many rounds as there are agents; none if a round more still raises something.
fn longest(count: usize, constraints: &[DifferenceConstraint]) -> Option<Vec<i64>> {
    let mut delays = vec![0_i64; count];
    for round in 0..=count {
        let before = delays.clone();
        for &DifferenceConstraint { from, to, least } in constraints {
            delays[to] = delays[to].max(delays[from] + least);
        }
        if before == delays {
            return Some(delays);
        }
        if round == count {
            return None;
        }
    }
    None
}

/// The least cost of all choices of one gap of each pair, if any choice has delays.
fn by_force(problem: &DelayProblem, place: usize, chosen: &mut Vec<DifferenceConstraint>) -> Option<i128> {
    let Some(pair) = problem.pairs.get(place) else {
        return longest(problem.len(), chosen).map(|delays| problem.cost(&delays));
    };
    let intervals = pair.intervals();
    let mut best: Option<i128> = None;
    for gap in 0..=intervals.len() {
        let before = chosen.len();
        let above = gap.checked_sub(1).map(|last| pair.constraints_around(intervals[last])[1]);
        let below = intervals.get(gap).map(|&next| pair.constraints_around(next)[0]);
        let sides: Vec<DifferenceConstraint> = above.into_iter().chain(below).collect();
        if sides.iter().all(|side| side.least < NEVER) {
            chosen.extend(sides);
            let cost = by_force(problem, place + 1, chosen);
            best = best.into_iter().chain(cost).min();
        }
        chosen.truncate(before);
    }
    best
}

/// Two to five agents; most pairs forbid one or two intervals, some without an end.
fn random(seed: u64, objective: Objective) -> DelayProblem {
    let mut random = SplitMix64(seed);
    let count = 2 + random.below(4);
    let mut pairs = Vec::new();
    for j in 1..count {
        for i in 0..j {
            let intervals = (0..random.below(3)).map(|_| {
                let middle = random.below(41) as i64 - 20;
                let half = 1 + random.below(12) as i64;
                match random.below(5) {
                    0 => [-NEVER, middle],
                    1 => [middle, NEVER],
                    _ => [middle - half, middle + half],
                }
            });
            let intervals: Vec<[i64; 2]> = intervals.collect();
            if !intervals.is_empty() {
                pairs.push(ForbiddenPairDelays::new([i, j], intervals));
            }
        }
    }
    DelayProblem { objective, ends: (0..count).map(|_| random.below(50) as i64).collect(), pairs }
}

const OBJECTIVES: [Objective; 2] = [Objective::Sum, Objective::Makespan];

fn never() -> bool {
    false
}

#[test]
fn small_fleets_have_the_best_delays_of_all_choices() {
    let mut possible = 0_u64;
    for seed in 0..FLEETS {
        for objective in OBJECTIVES {
            let problem = random(seed, objective);
            let least = by_force(&problem, 0, &mut Vec::new());
            let found = best(&problem, &[], DelaySearchOptions::default(), true, &|_, _, _| {});
            let Some(least) = least else {
                assert!(!found.conflicts.is_empty() && found.delays.is_none_or(|all| all.contains(&None)), "{seed}");
                continue;
            };
            possible += 1;
            let delays: Vec<i64> = found.delays.unwrap().into_iter().map(Option::unwrap).collect();
            assert!(problem.allows(&delays) && found.conflicts.is_empty(), "{seed}: {delays:?}");
            assert_eq!((problem.cost(&delays), found.proved), (least, true), "{seed}");
            assert_eq!(found.bound, least - rounding_cost(&problem), "{seed}");
        }
    }
    assert!((FLEETS..2 * FLEETS).contains(&possible), "{possible}");
}

#[test]
fn the_fewest_are_left_out_and_every_conflict_is_one() {
    let mut larger = 0;
    for seed in 0..FLEETS {
        let problem = random(seed, Objective::Sum);
        let possible = |agents: &[usize]| by_force(&problem.of(agents), 0, &mut Vec::new()).is_some();
        let found = best(&problem, &[], DelaySearchOptions::default(), true, &|_, _, _| {});
        let stay = |mask: u32| (0..problem.len()).filter(|agent| mask >> agent & 1 == 1).collect::<Vec<_>>();
        let most =
            (0..1_u32 << problem.len()).map(stay).filter(|agents| possible(agents)).map(|agents| agents.len()).max();
        let delays = found.delays.unwrap();
        let staying: Vec<usize> = (0..problem.len()).filter(|&agent| delays[agent].is_some()).collect();
        assert_eq!(Some(staying.len()), most, "{seed}");
        assert!(problem.of(&staying).allows(&delays.iter().flatten().copied().collect::<Vec<_>>()), "{seed}");
        for conflict in found.conflicts {
            larger += usize::from(conflict.len() > 2);
            assert!(!possible(&conflict), "{seed}: {conflict:?}");
            for agent in &conflict {
                let others: Vec<usize> = conflict.iter().copied().filter(|other| other != agent).collect();
                assert!(possible(&others), "{seed}: {conflict:?} without {agent}");
            }
        }
    }
    assert!(larger > 0, "{larger}");
}

#[test]
fn who_is_left_out_takes_others_along() {
    let mut along = 0;
    for seed in 0..FLEETS {
        let problem = random(seed, Objective::Sum);
        let count = problem.len();
        let mut dice = SplitMix64(!seed);
        let mut with: Vec<Vec<usize>> = (0..count).map(|agent| vec![agent, dice.below(count)]).collect();
        // All that are taken along by those that are, too.
        for _ in 0..count {
            let further =
                |agents: &Vec<usize>| agents.iter().flat_map(|&agent| with[agent].clone()).collect::<Vec<_>>();
            let mut longer: Vec<Vec<usize>> = with.iter().map(further).collect();
            longer.iter_mut().for_each(|agents| {
                agents.sort_unstable();
                agents.dedup();
            });
            with = longer;
        }
        let stay = |mask: u32| (0..count).filter(|agent| mask >> agent & 1 == 1).collect::<Vec<_>>();
        let possible = |agents: &Vec<usize>| {
            let stays = |agent: usize| agents.contains(&agent);
            (0..count).all(|agent| stays(agent) || !with[agent].iter().any(|&other| stays(other)))
                && by_force(&problem.of(agents), 0, &mut Vec::new()).is_some()
        };
        let most = (0..1_u32 << count).map(stay).filter(possible).map(|agents| agents.len()).max().expect("nobody");
        let left = leave_out::agents_to_leave_out(&problem, &with, SearchLimits { nodes: 1_000, clock: &never }, true);
        let staying: Vec<usize> = (0..count).filter(|&agent| left.delays[agent].is_some()).collect();
        assert!(left.fewest && possible(&staying) && staying.len() == most, "{seed}: {staying:?} {most}");
        assert!(problem.of(&staying).allows(&left.delays.iter().flatten().copied().collect::<Vec<_>>()), "{seed}");
        along += usize::from(left.delays.contains(&None));
    }
    assert!(along > 20, "{along}");
}

#[test]
fn whether_there_are_delays_is_known_without_the_best_ones() {
    let (mut possible, mut stopped) = (0_u64, 0_u64);
    for seed in 0..FLEETS {
        let problem = random(seed, Objective::Sum);
        let least = by_force(&problem, 0, &mut Vec::new());
        for nodes in [0, 1, 1_000] {
            match (feasible(&problem, SearchLimits { nodes, clock: &never }).0, least) {
                (Feasibility::Delays(found), Some(_)) => {
                    assert!(problem.allows(&found), "{seed}: {found:?}");
                    possible += 1;
                }
                (Feasibility::Never, None) => {}
                (Feasibility::Stopped, _) if nodes < 1_000 => stopped += 1,
                (found, least) => panic!("{seed}: {found:?} {least:?}"),
            }
        }
    }
    assert!(possible > FLEETS && stopped > 0, "{possible} {stopped}");
}

#[test]
fn bounds_of_stopped_searches_are_below_the_optimum() {
    let mut stopped = 0_u64;
    for seed in 0..FLEETS {
        for objective in OBJECTIVES {
            let problem = random(seed, objective);
            let Some(least) = by_force(&problem, 0, &mut Vec::new()) else { continue };
            for nodes in [0, 1, 2, 4] {
                let stop = SearchLimits { nodes, clock: &never };
                let searches = [
                    BranchAndBound::new(&problem, stop).run([], i128::MAX),
                    BranchAndBound::new(&problem, stop).lowest(i128::MAX),
                    BranchAndBound::new(&problem, stop).lowest(least + 1),
                ];
                for found in searches {
                    stopped += u64::from(!found.complete);
                    assert!(found.bound <= least, "{seed}, {nodes} nodes: {} {least}", found.bound);
                    assert!(
                        !found.complete || found.delays.is_some_and(|found| problem.cost(&found) == least),
                        "{seed}"
                    );
                }
                assert!(BranchAndBound::new(&problem, stop).lowest(least).bound <= least, "{seed}, {nodes} nodes");
            }
            let (Feasibility::Delays(delays), _) = feasible(&problem, SearchLimits { nodes: 1_000, clock: &never })
            else {
                panic!("{seed}: there are delays");
            };
            let better = large_neighbourhood::improved(&problem, delays.clone(), 20, &never);
            assert!(
                problem.allows(&better) && (least..=problem.cost(&delays)).contains(&problem.cost(&better)),
                "{seed}"
            );
        }
    }
    assert!(stopped > FLEETS, "{stopped}");
}

/// Everybody goes through the same place, one after the other: the shorter the stay the earlier.
fn queue(stays: &[i64]) -> DelayProblem {
    let agents = 0..stays.len();
    let pairs = agents.clone().flat_map(|i| (i + 1..stays.len()).map(move |j| (i, j)));
    let pairs = pairs.map(|(i, j)| ForbiddenPairDelays::new([i, j], vec![[-stays[j], stays[i]]])).collect();
    DelayProblem { objective: Objective::Sum, ends: agents.map(|_| 0).collect(), pairs }
}

#[test]
fn a_queue_of_thirty_is_stopped_with_a_bound_and_is_the_same_every_time() {
    let stays: Vec<i64> = (0..30).map(|agent| 1_000 + 37 * (agent * 17 % 30)).collect();
    let problem = queue(&stays);
    let mut sorted = stays.clone();
    sorted.sort_unstable();
    let least: i64 = sorted.iter().zip((0..30).rev()).map(|(stay, after)| stay * after).sum();
    let found = || BranchAndBound::new(&problem, SearchLimits { nodes: 600, clock: &never }).run([], i128::MAX);
    let DelaySearchResult { delays, bound, complete, nodes } = found();
    let delays = delays.unwrap();
    assert!(problem.allows(&delays) && !complete && nodes > 600);
    let cost = problem.cost(&delays);
    assert!(bound <= i128::from(least) && i128::from(least) <= cost, "{bound} {least} {cost}");
    let bounds = [20, 200, 2_000]
        .map(|nodes| BranchAndBound::new(&problem, SearchLimits { nodes, clock: &never }).lowest(cost + 1).bound);
    assert!(bounds.is_sorted() && bounds[0] > bound && bounds[2] <= i128::from(least), "{bounds:?} {least}");
    assert_eq!(found().delays, Some(delays.clone()));
    let improved = || large_neighbourhood::improved(&problem, delays.clone(), 5, &never);
    assert!(problem.allows(&improved()) && problem.cost(&improved()) <= cost);
    assert_eq!(improved(), improved());
}

#[test]
fn times_are_rounded_outward() {
    let ticks = TickScale::up_to(100.0);
    let [lo, hi] = ticks.outward([-1.0, 0.1], 1e12);
    let [lo, hi] = [lo, hi].map(|end| ticks.seconds(end.into()));
    assert!(lo < -1.0 && hi > 0.1 && hi - 0.1 < 4e-9 && -1.0 - lo < 4e-9, "{lo} {hi}");
    assert_eq!(ticks.outward([-1e12, 1e12], 1e12), [-NEVER, NEVER]);
    // A year: differences of starts are right to less than a tick all the same.
    let ticks = TickScale::up_to(3.2e7);
    let [_, hi] = ticks.outward([0.0, 0.1], 1e12);
    let delay = ticks.seconds(hi.into());
    assert!(3.1e7 + delay - 3.1e7 > 0.1, "{delay}");
}

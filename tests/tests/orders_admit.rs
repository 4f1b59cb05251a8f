//! What an admission decides: who goes first where only one way is possible, what is turned round where somebody would wait for
//! ever, and what stays where nothing fits.

use pcr_core::{
    AdmissionError, CapacityError, CheckState, CheckTolerances, Ecm, EcmEntry, EcmError, Interval, MismatchError,
    Motion, MovementAuthority, PassingState, PathProposal, Piece, PrecedenceTable, Progress, RegionPrecedence,
};
use pcr_fixed::Q16;
use pcr_tests::disc::{Course, Disc, Leg};
use pcr_tests::execution::Table;
use std::f64::consts::FRAC_PI_2;

const TOLERANCES: CheckTolerances<f64> = CheckTolerances { width: 0.01, gain: 1e-4 };

/// A straight way of a disc of 0.3 m from one point to another.
fn way([x, y]: [f64; 2], to: [f64; 2]) -> Course<f64> {
    let (dx, dy) = (to[0] - x, to[1] - y);
    let disc = Disc { radius: 0.3, start: [x, y, dy.atan2(dx)], legs: vec![Leg::Line(dx.hypot(dy))] };
    Course::new(&disc).expect("a valid disc")
}

/// Along the x axis, with x = -4 at length 0.
fn east() -> Course<f64> {
    way([-4.0, 0.0], [4.0, 0.0])
}

/// Along the y axis, with y = -4 at length 0: within 0.6 m of the way east from 3.4 m to 4.6 m, for both.
fn north() -> Course<f64> {
    way([0.0, -4.0], [0.0, 4.0])
}

fn table(fleet: &[Motion<'_, f64>]) -> Table<f64> {
    PrecedenceTable::build(vec![EcmEntry::EMPTY; 12], vec![Piece::EMPTY; 40], vec![RegionPrecedence::EMPTY; 24], fleet)
        .expect("room")
}

/// Goes on to where it can stop, from some place on.
fn moving(at: f64, stop: f64) -> Progress<f64> {
    Progress { stop, ..Progress::at_rest(at) }
}

/// A fleet whose first agent asks for a path.
struct Scene<'a> {
    agents: &'a [(&'a Course<f64>, Progress<f64>)],
    /// Who goes first of the others: agent and other.
    first: &'a [[usize; 2]],
    /// What the new path would have: the other, and whether it goes first. Nobody else may be asked about.
    wanted: &'a [(usize, PassingState)],
}

impl Scene<'_> {
    /// The answer, and who passes whom by the new path, by agents in order; for each way to number the agents the same.
    fn admitted(&self) -> (Result<(), &'static str>, Vec<(usize, PassingState)>) {
        let count = self.agents.len();
        let numberings = (0..count).flat_map(|turn| {
            let turned = (0..count).map(move |agent| (agent + turn) % count);
            [turned.clone().collect::<Vec<_>>(), turned.map(|agent| count - 1 - agent).collect()]
        });
        // With a least gain of 0, too, or one that is less than the last digit of a place.
        let gains = [TOLERANCES.gain, 0.0, -1.0, 1e-30];
        let tolerances = gains.map(|gain| CheckTolerances { gain, ..TOLERANCES });
        let mut answers: Vec<_> =
            numberings.flat_map(|numbers| tolerances.map(|tolerances| self.numbered(&numbers, tolerances))).collect();
        let last = answers.pop().expect("a numbering");
        answers.iter().for_each(|answer| assert_eq!(answer, &last));
        last
    }

    fn numbered(
        &self,
        numbers: &[usize],
        tolerances: CheckTolerances<f64>,
    ) -> (Result<(), &'static str>, Vec<(usize, PassingState)>) {
        let agent_of = |number: usize| numbers.iter().position(|&other| other == number).expect("a number");
        let agents = || (0..numbers.len()).map(|number| self.agents[agent_of(number)]);
        let mut fleet: Vec<Motion<'_, f64>> = agents().map(|(course, _)| course.motion()).collect();
        let mut progress: Vec<Progress<f64>> = agents().map(|(_, progress)| progress).collect();
        let mission = PathProposal { agent: numbers[0], motion: fleet[numbers[0]], progress: progress[numbers[0]] };
        // Another path before, with orders of its own.
        let old = way([-4.0, 0.1], [3.9, 0.1]);
        (fleet[numbers[0]], progress[numbers[0]]) = (old.motion(), Progress::at_rest(0.25));
        let mut orders = table(&fleet);
        for &[agent, other] in self.first {
            orders.decide(&fleet, numbers[agent], numbers[other], PassingState::First, 0.0).expect("its fleet");
        }
        for other in (1..numbers.len()).step_by(2) {
            orders.decide(&fleet, numbers[0], numbers[other], PassingState::First, 0.0).expect("its fleet");
        }
        let row = |orders: &Table<f64>, fleet: &[Motion<'_, f64>], agent: usize| {
            let row = orders.row(fleet, numbers[agent]).expect("its fleet");
            let mut passes: Vec<_> = row.map(|(_, region, pass)| (agent_of(region.other()), pass)).collect();
            passes.sort_by_key(|&(other, _)| other);
            passes
        };
        let all = |orders: &Table<f64>, fleet: &[Motion<'_, f64>], progress: &[Progress<f64>]| {
            let rows: Vec<_> = (0..numbers.len()).map(|agent| row(orders, fleet, agent)).collect();
            (rows, fleet[numbers[0]].path().length(), progress.to_vec())
        };
        let before = all(&orders, &fleet, &progress);
        let mut reaches = vec![CheckState::EMPTY; numbers.len()];
        let found = orders.admit(&mut fleet, &mut progress, mission, tolerances, &mut reaches, |region| {
            let other = agent_of(region.other());
            self.wanted.iter().find(|wanted| wanted.0 == other).expect("both ways are possible").1
        });
        let after = all(&orders, &fleet, &progress);
        let found = found.map_err(|refused| {
            assert_eq!(after, before, "{refused} leaves traces");
            match refused {
                AdmissionError::Stuck { .. } => "stuck",
                AdmissionError::Blocked { .. } => "blocked",
                AdmissionError::Late { .. } => "late",
                _ => "other",
            }
        });
        if found.is_ok() {
            assert_eq!(orders.check(&fleet, &progress, tolerances, &mut reaches), Ok(()));
        }
        (found, row(&orders, &fleet, 0))
    }
}

const REST: Progress<f64> = Progress { at: Interval { lo: 0.0, hi: 0.0 }, stop: 0.0 };

#[test]
fn the_caller_is_asked_where_both_ways_are_possible() {
    let (east, north) = (east(), north());
    for pass in [PassingState::First, PassingState::Second] {
        let scene = Scene { agents: &[(&east, REST), (&north, REST)], first: &[], wanted: &[(1, pass)] };
        assert_eq!(scene.admitted(), (Ok(()), vec![(1, pass)]));
    }
    // Any other answer lets the other one go first.
    let scene = Scene { agents: &[(&east, REST), (&north, REST)], first: &[], wanted: &[(1, PassingState::Over)] };
    assert_eq!(scene.admitted(), (Ok(()), vec![(1, PassingState::Second)]));
}

#[test]
fn who_cannot_stop_before_a_region_goes_first_and_nobody_is_asked() {
    let (east, north) = (east(), north());
    // (its own progress, that of the other, who goes first)
    let cases = [
        (moving(3.0, 3.5), REST, Ok(PassingState::First)),
        (REST, moving(3.0, 3.5), Ok(PassingState::Second)),
        (moving(3.0, 3.5), moving(3.0, 3.5), Err("blocked")),
        // One that is through leaves nothing to decide, whatever the other one does.
        (moving(4.7, 4.7), moving(3.0, 3.5), Ok(PassingState::Over)),
        (moving(3.0, 3.5), moving(4.7, 4.7), Ok(PassingState::Over)),
        (REST, moving(4.7, 4.7), Ok(PassingState::Over)),
        (moving(4.7, 4.7), REST, Ok(PassingState::Over)),
    ];
    // A place in the region counts, also where the furthest place was given less than it.
    let late = |lo: f64| Progress { at: Interval::new(lo, 3.5), stop: lo };
    let late = [(late(3.0), REST, Ok(PassingState::First)), (REST, late(3.0), Ok(PassingState::Second))];
    for (own, their, expected) in cases.into_iter().chain(late) {
        let scene = Scene { agents: &[(&east, own), (&north, their)], first: &[], wanted: &[] };
        let (found, passes) = scene.admitted();
        let pass = passes[0].1;
        assert_eq!(found.map(|()| pass), expected, "{own:?} {their:?}");
    }
}

#[test]
fn nobody_waits_for_who_ends_within_the_width_behind_a_region() {
    // The region of the other one ends at 4.6 m of its path, which goes on for so long.
    for (beyond, asked) in [(0.005, false), (0.02, true)] {
        let (east, north) = (east(), way([0.0, -4.0], [0.0, 0.6 + beyond]));
        let wanted: &[_] = if asked { &[(1, PassingState::Second)] } else { &[] };
        let scene = Scene { agents: &[(&east, REST), (&north, REST)], first: &[], wanted };
        let pass = if asked { PassingState::Second } else { PassingState::First };
        assert_eq!(scene.admitted(), (Ok(()), vec![(1, pass)]), "{beyond} m beyond it");
        // One that is there already, and stays in reach: there is no way past it.
        let (end, stays) = (4.0 + 0.6 + beyond, way([0.0, -4.0], [0.0, 0.3]));
        let there = Scene { agents: &[(&east, REST), (&north, moving(end, end))], first: &[], wanted: &[] };
        assert_eq!(there.admitted(), (Ok(()), vec![(1, PassingState::Over)]), "{beyond} m beyond it");
        let there = Scene { agents: &[(&east, REST), (&stays, moving(4.3, 4.3))], first: &[], wanted: &[] };
        assert_eq!(there.admitted().0, Err("blocked"));
    }
}

#[test]
fn a_check_counts_places_and_the_width() {
    let (east, north) = (east(), way([0.0, -4.0], [0.0, 0.605]));
    let fleet = [east.motion(), north.motion()];
    let mut orders = table(&fleet);
    orders.decide(&fleet, 0, 1, PassingState::Second, 0.0).expect("its fleet");
    let mut check = |at: f64, width: f64| {
        let progress = [Progress::at_rest(at), Progress::at_rest(0.0)];
        orders.check(&fleet, &progress, CheckTolerances { width, ..TOLERANCES }, &mut [CheckState::EMPTY; 2])
    };
    assert_eq!(check(0.0, 0.001), Ok(()));
    assert!(
        matches!(check(0.0, 0.01), Err(AdmissionError::Stuck { agent: 0, by: 1, .. })),
        "it may stop short of its end"
    );
    assert!(matches!(check(3.6, 0.001), Err(AdmissionError::Late { agent: 0, by: 1, .. })));
}

/// Crosses the way north at y = 2 and the way east at x = 0.8, in this order.
fn down() -> Course<f64> {
    way([-0.8, 4.0], [1.6, -2.0])
}

/// Crosses the way north at y = 2 and ends on the way east at x = -0.8.
fn parks() -> Course<f64> {
    way([0.8, 4.0], [-0.8, 0.0])
}

#[test]
fn an_order_that_keeps_somebody_stuck_is_turned_round() {
    let (east, north, down) = (east(), north(), down());
    // East waits for down on the crossing with north, north for east, down for north.
    let stuck = [(1, PassingState::First), (2, PassingState::Second)];
    let scene = Scene { agents: &[(&east, REST), (&north, REST), (&down, REST)], first: &[[1, 2]], wanted: &stuck };
    assert_eq!(scene.admitted(), (Ok(()), vec![(1, PassingState::Second), (2, PassingState::Second)]));
    // The same where east cannot stop before north any more: its other order is turned round.
    let scene = Scene {
        agents: &[(&east, moving(3.0, 3.5)), (&north, REST), (&down, REST)],
        first: &[[1, 2]],
        wanted: &stuck[1..],
    };
    assert_eq!(scene.admitted(), (Ok(()), vec![(1, PassingState::First), (2, PassingState::First)]));
    // Before one that waits for others it stays first.
    let (east, across) = (way([-8.0, 0.0], [4.0, 0.0]), way([-2.4, -4.0], [4.8, 2.0]));
    let scene = Scene {
        agents: &[(&east, REST), (&north, REST), (&down, REST), (&across, REST)],
        first: &[[1, 2], [1, 3], [2, 3]],
        wanted: &[stuck[0], stuck[1], (3, PassingState::First)],
    };
    let passes = vec![(1, PassingState::Second), (2, PassingState::Second), (3, PassingState::First)];
    assert_eq!(scene.admitted(), (Ok(()), passes));
}

#[test]
fn orders_without_a_choice_are_not_turned_round() {
    let (east, north, parks) = (east(), north(), parks());
    // East has to go first where parks ends; north, which waits for parks, cannot stop before east.
    let scene =
        Scene { agents: &[(&east, REST), (&north, moving(3.0, 3.5)), (&parks, REST)], first: &[[2, 1]], wanted: &[] };
    assert_eq!(scene.admitted().0, Err("stuck"));
    // Had it a choice, it would go before north.
    let scene = Scene {
        agents: &[(&east, REST), (&north, REST), (&parks, REST)],
        first: &[[2, 1]],
        wanted: &[(1, PassingState::Second)],
    };
    assert_eq!(scene.admitted(), (Ok(()), vec![(1, PassingState::First), (2, PassingState::First)]));
}

#[test]
fn an_order_is_turned_round_once() {
    let (east, north, parks) = (east(), north(), parks());
    // Either way somebody waits for ever: for parks if north goes first, for up if east does.
    let up = way([-0.8, -4.0], [1.6, 2.0]);
    for pass in [PassingState::First, PassingState::Second] {
        let scene = Scene {
            agents: &[(&east, REST), (&north, REST), (&parks, REST), (&up, moving(0.0, 3.9))],
            first: &[[2, 1], [1, 3]],
            wanted: &[(1, pass)],
        };
        assert_eq!(scene.admitted().0, Err("stuck"));
    }
}

/// A robot that was put in the way of another one made the table refuse everybody's paths.
#[test]
fn who_waits_for_ever_anyway_keeps_nobody_from_a_path() {
    let (long, stands) = (way([-4.0, 0.0], [4.0, 0.0]), way([2.0, 0.0], [2.0, 0.0]));
    let (waits, far, across) =
        (way([9.0, 0.0], [9.0, 0.0]), way([9.0, 0.0], [9.0, 5.0]), way([-2.0, -3.0], [-2.0, 3.0]));
    let mut progress = [REST; 3];
    let fleet = [long.motion(), stands.motion(), waits.motion()];
    let mut orders = table(&fleet);
    let mut reaches = [CheckState::EMPTY; 3];
    let stuck = |found: Result<(), AdmissionError>| matches!(found, Err(AdmissionError::Stuck { agent: 0, by: 1, .. }));
    assert!(stuck(orders.check(&fleet, &progress, TOLERANCES, &mut reaches)));
    let mut admit = |orders: &mut Table<f64>, agent: usize, path: &Course<f64>, pass: PassingState| {
        let mission = PathProposal { agent, motion: path.motion(), progress: REST };
        let mut fleet = fleet;
        orders.clone().admit(&mut fleet, &mut progress, mission, TOLERANCES, &mut reaches, |_| pass)
    };
    assert_eq!(admit(&mut orders, 2, &far, PassingState::First), Ok(()));
    // It goes before the one that waits, and never behind it, whatever is preferred.
    for pass in [PassingState::First, PassingState::Second] {
        assert_eq!(admit(&mut orders, 2, &across, pass), Ok(()));
    }
    // Where its path ends on the way of the one that waits, it can only be second, and would wait itself.
    let parks = way([3.0, -3.0], [3.0, 0.0]);
    let found = admit(&mut orders, 2, &parks, PassingState::First);
    assert!(matches!(found, Err(AdmissionError::Stuck { agent: 2, by: 0, .. })), "{found:?}");
    assert_eq!(admit(&mut orders, 0, &long, PassingState::First), Err(AdmissionError::Blocked { agent: 0, by: 1 }));
    // A check excuses nobody.
    assert!(stuck(orders.check(&fleet, &[REST; 3], TOLERANCES, &mut [CheckState::EMPTY; 3])));
}

/// Nobody decides who goes first where a robot is put down; where one has been already, nothing is left to decide.
#[test]
fn an_undecided_region_that_one_has_left_holds_nobody() {
    let (east, north) = (east(), north());
    let fleet = [east.motion(), north.motion()];
    let mut orders = table(&fleet);
    let held = |hold: Result<MovementAuthority<f64>, MismatchError>| matches!(hold, Ok(MovementAuthority::At(at)) if (at - 3.4).abs() < 1e-9);
    for (own, their, is_held) in
        [(0.0, 0.0, true), (4.5, 0.0, true), (4.7, 0.0, false), (0.0, 4.7, false), (4.7, 4.7, false)]
    {
        let progress = [Progress::at_rest(own), Progress::at_rest(their)];
        for agent in [0, 1] {
            assert_eq!(held(orders.hold(&fleet, agent, &progress)), is_held, "{own} {their}");
            let free = orders.hold(&fleet, agent, &progress) == Ok(MovementAuthority::Free);
            assert_eq!(free, !is_held);
        }
        let found = orders.check(&fleet, &progress, TOLERANCES, &mut [CheckState::EMPTY; 2]);
        assert_eq!(found.is_ok(), !is_held, "{found:?}");
    }
    // A place that is not known exactly counts by its lower end; where nothing is known it is the start.
    let unsure = Progress { at: Interval::new(4.5, 4.8), stop: 4.8 };
    assert!(held(orders.hold(&fleet, 1, &[unsure, REST])));
    assert!(held(orders.hold(&fleet, 1, &[])));
}

#[test]
fn a_hold_counts_from_where_the_one_that_waits_is() {
    // North begins 2.5 m before east, at less than where that one is on its own path.
    let (east, north) = (east(), way([0.0, -2.5], [0.0, 4.0]));
    let cases = [(PassingState::First, 3.0, 0.0, 1.9), (PassingState::Second, 0.0, 1.5, 3.4)];
    for (pass, at, other_at, hold) in cases {
        for first in [true, false] {
            let (own, their) = if first { (0, 1) } else { (1, 0) };
            let mut fleet = [east.motion(); 2];
            fleet[their] = north.motion();
            let mut progress = [Progress::at_rest(0.0); 2];
            (progress[own], progress[their]) = (Progress::at_rest(at), Progress::at_rest(other_at));
            let mut orders = table(&fleet);
            let mission = PathProposal { agent: own, motion: fleet[own], progress: progress[own] };
            orders
                .admit(&mut fleet, &mut progress, mission, TOLERANCES, &mut [CheckState::EMPTY; 2], |_| pass)
                .expect("a way");
            let since: Vec<f64> = orders.decisions().map(|decision| decision.since).collect();
            let waits = if pass == PassingState::First { their } else { own };
            assert_eq!(since, [progress[waits].at.lo]);
            let (found, by) = orders.wait(&fleet, waits, &progress).expect("its fleet");
            assert!(matches!(found, MovementAuthority::At(length) if (length - hold).abs() < 1e-9), "{found:?}");
            assert_eq!(by, Some(1 - waits));
        }
    }
}

/// Along x = 0, to the west along y = 2.5, along x = -1.5, and a way that crosses the first and the last one twice.
fn crossed() -> ([Course<f64>; 3], Course<f64>) {
    let legs = vec![Leg::Line(6.0), Leg::arc(1.0, FRAC_PI_2), Leg::arc(1.0, FRAC_PI_2), Leg::Line(6.0)];
    let disc = Disc { radius: 0.3, start: [-3.0, -2.0, 0.0], legs };
    let ways = [way([0.0, -3.0], [0.0, 4.0]), way([2.0, 2.5], [-3.0, 2.5]), way([-1.5, 4.0], [-1.5, -3.0])];
    (ways, Course::new(&disc).expect("a valid disc"))
}

#[test]
fn a_path_for_which_there_is_no_room_changes_nothing() {
    let (ways, round) = crossed();
    let (start, longer) = (way([3.0, -2.0], [-2.5, -2.0]), way([3.0, -2.0], [-2.6, -2.0]));
    // (places for regions, pieces and orders, the new path, its regions or what is full): of four regions in as many pieces
    // two are those of the old path, which are kept meanwhile.
    let cases = [
        (6, 6, 8, &round, Ok(4)),
        (5, 6, 8, &round, Err(CapacityError::Regions { needed: 6, capacity: 5 })),
        (6, 5, 8, &round, Err(CapacityError::Pieces { needed: 6, capacity: 5 })),
        (6, 6, 7, &round, Err(CapacityError::Orders { needed: 8, capacity: 7 })),
        (6, 6, 5, &round, Err(CapacityError::Orders { needed: 6, capacity: 5 })),
        (4, 4, 6, &longer, Ok(2)),
    ];
    for (regions, pieces, orders, path, expected) in cases {
        let mut fleet = [ways[0].motion(), start.motion(), ways[1].motion(), ways[2].motion()];
        let (regions, pieces) = (vec![EcmEntry::EMPTY; regions], vec![Piece::EMPTY; pieces]);
        let mut table = PrecedenceTable::build(regions, pieces, vec![RegionPrecedence::EMPTY; orders], &fleet)
            .expect("room for one");
        for ([agent, other], pass) in
            [([0, 1], PassingState::First), ([0, 2], PassingState::Second), ([2, 3], PassingState::First)]
        {
            table.decide(&fleet, agent, other, pass, 0.0).expect("its fleet");
        }
        let passes = |table: &Table<f64>, fleet: &[Motion<'_, f64>], agent: usize| -> Vec<_> {
            let row = table.row(fleet, agent).expect("its fleet");
            row.map(|(place, region, pass)| (place, region.other(), region.length(), pass)).collect()
        };
        let before = [1, 2].map(|agent| passes(&table, &fleet, agent));
        assert_eq!(before.each_ref().map(Vec::len), [2, 2]);
        let found = table.replace(&mut fleet, 1, path.motion());
        assert_eq!(found, expected.map(drop).map_err(EcmError::Full));
        let after = [1, 2].map(|agent| passes(&table, &fleet, agent));
        match expected {
            Err(_) => assert_eq!(after, before),
            Ok(count) => {
                assert!(after[0].len() == count && after[0].iter().all(|(.., pass)| *pass == PassingState::Undecided));
                let others = |row: &Vec<(usize, usize, _, PassingState)>| -> Vec<_> {
                    row.iter().map(|&(_, other, _, pass)| (other, pass)).collect()
                };
                assert_eq!(others(&after[1]), others(&before[1]));
            }
        }
        let path = if expected.is_ok() { path } else { &start };
        assert_eq!(fleet[1].path().length(), path.motion().path().length());
    }
}

#[test]
fn the_row_of_an_agent_has_no_path_exchanged() {
    let (ways, _) = crossed();
    let mut fleet = [ways[1].motion(), ways[2].motion(), ways[0].motion()];
    let mut orders = table(&fleet);
    orders.fill_row(&fleet, 1).expect("room");
    assert_eq!(orders.replace(&mut fleet, 1, ways[0].motion()), Err(MismatchError::OnlyRow(1).into()));
    assert!(orders.hold(&fleet, 1, &[REST; 3]).is_ok());
}

#[test]
fn tolerances_of_any_size_are_taken_as_the_nearest_that_makes_sense() {
    let number = |bits| Q16::from_bits(bits);
    let course = |start: [f64; 3], length: f64| {
        Course::<Q16>::new(&Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] }).expect("a valid disc")
    };
    // Two crossings in a circle: with the first preferences nobody could go on.
    let (east, bend) = (
        course([-3.0, 0.0, 0.0], 9.0),
        Disc {
            radius: 0.25,
            start: [3.0, 3.0, -FRAC_PI_2],
            legs: vec![Leg::Line(4.0), Leg::arc(1.5, -3.0 * FRAC_PI_2 * 0.999), Leg::Line(5.0)],
        },
    );
    let (bend, stands) = (Course::<Q16>::new(&bend).expect("a valid disc"), course([3.0, 3.0, -FRAC_PI_2], 0.0));
    for (width, gain) in [(655, i32::MAX), (655, 1 << 28), (i32::MIN, 66), (-1, 66), (655, i32::MIN), (655, 0)] {
        let mut fleet = [east.motion(), stands.motion()];
        let storage = (vec![EcmEntry::EMPTY; 12], vec![Piece::EMPTY; 40], vec![RegionPrecedence::EMPTY; 24]);
        let mut orders = Table::<Q16>::build(storage.0, storage.1, storage.2, &fleet).expect("room");
        let rest = Progress::at_rest(number(0));
        let mission = PathProposal { agent: 1, motion: bend.motion(), progress: rest };
        let tolerances = CheckTolerances { width: number(width), gain: number(gain) };
        let admitted =
            orders.admit(&mut fleet, &mut [rest; 2], mission, tolerances, &mut [CheckState::EMPTY; 2], |region| {
                if region.other_length().lo < number(7 << 15) { PassingState::First } else { PassingState::Second }
            });
        assert!(gain > 66 || admitted.is_ok(), "{width} {gain}: {admitted:?}");
    }
}

#[test]
fn storage_grows_where_it_is_full_and_nowhere_else() {
    let (ways, round) = crossed();
    let fleet = [ways[1].motion(), ways[2].motion(), round.motion()];
    let mut orders = Table::<f64>::new(vec![], vec![], vec![]);
    let mut grown = Vec::new();
    while let Err(full) = orders.fill(&fleet) {
        orders.grow(full).expect("memory");
        grown.push(full);
        assert!(grown.len() < 20, "{grown:?}");
    }
    let is_full = |full: fn(&CapacityError) -> bool| grown.iter().any(full);
    assert!(is_full(|full| matches!(full, CapacityError::Regions { .. })), "{grown:?}");
    assert!(is_full(|full| matches!(full, CapacityError::Pieces { .. })), "{grown:?}");
    let regions = orders.ecm().len();
    assert!(grown.contains(&CapacityError::Orders { needed: regions, capacity: 0 }), "{grown:?}");
    assert_eq!(orders.ecm().len(), Ecm::grown(&fleet).expect("memory").len());
    let states = CapacityError::Reaches { needed: 3, capacity: 0 };
    assert_eq!(orders.grow(states), Err(states));
}

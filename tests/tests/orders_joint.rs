//! Joint admissions: several robots that move up at once, each to where the next one stands, and paths that are granted up to a
//! place behind one that stands.

use pcr_core::{
    AdmissionError, CapacityError, CheckState, CheckTolerances, EcmEntry, MismatchError, Motion, PassingState,
    PathProposal, Piece, PrecedenceTable, Progress, RegionPrecedence,
};
use pcr_fixed::{Q12, Q16};
use pcr_planning::fleet::HostScalar;
use pcr_tests::disc::{Course, Disc, Leg};
use pcr_tests::execution::Table;
use pcr_tests::generators::Dice;
use std::f64::consts::TAU;

const RADIUS: f64 = 0.3;

/// A straight way from one point to another.
fn way<S: HostScalar>([x, y]: [f64; 2], to: [f64; 2]) -> Course<S> {
    let (dx, dy) = (to[0] - x, to[1] - y);
    let disc = Disc { radius: RADIUS, start: [x, y, dy.atan2(dx)], legs: vec![Leg::Line(dx.hypot(dy))] };
    Course::new(&disc.rounded::<S>()).expect("a valid disc")
}

fn table<S: HostScalar>(fleet: &[Motion<'_, S>], orders: usize) -> Result<Table<S>, CapacityError> {
    let storage = (vec![EcmEntry::EMPTY; 200], vec![Piece::EMPTY; 400], vec![RegionPrecedence::EMPTY; orders]);
    PrecedenceTable::build(storage.0, storage.1, storage.2, fleet)
}

fn tolerances<S: HostScalar>(gain: f64) -> CheckTolerances<S> {
    CheckTolerances { width: S::from_f64(0.0), gain: S::from_f64(gain) }
}

/// Robots that stand at these points and are to go to others, all at once.
struct Batch<S: HostScalar> {
    stands: Vec<Course<S>>,
    ways: Vec<Course<S>>,
}

type Admitted<S> = (Result<(), AdmissionError>, Vec<(usize, [usize; 2], PassingState)>, Vec<S>);

impl<S: HostScalar> Batch<S> {
    fn new(moves: &[[[f64; 2]; 2]]) -> Self {
        let stands = moves.iter().map(|&[from, _]| way(from, from)).collect();
        Self { stands, ways: moves.iter().map(|&[from, to]| way(from, to)).collect() }
    }

    fn proposals(&self) -> Vec<PathProposal<'_, S>> {
        let rest = Progress::at_rest(S::from_f64(0.0));
        let ways = self.ways.iter().zip(0..);
        ways.map(|(way, agent)| PathProposal { agent, motion: way.motion(), progress: rest }).collect()
    }

    fn standing(&self) -> Vec<Motion<'_, S>> {
        self.stands.iter().map(|course| course.motion()).collect()
    }

    /// Admits all of them with room for so many orders. A refusal must leave everything as it was.
    fn admitted(&self, gain: f64, orders: usize, prefer: PassingState) -> Option<Admitted<S>> {
        let mut fleet = self.standing();
        let mut table = table(&fleet, orders).ok()?;
        let count = fleet.len();
        let mut progress = vec![Progress::at_rest(S::from_f64(0.0)); count];
        let (mut proposals, mut reaches) = (self.proposals(), vec![CheckState::EMPTY; count]);
        // Orders that are not the initial ones show whether they are put back.
        for ego in 1..count {
            table.decide(&fleet, ego, ego - 1, PassingState::First, S::from_f64(0.0)).expect("its fleet");
        }
        let all = |table: &Table<S>| -> Vec<_> { table.decisions().map(|it| (it.place, it.agents, it.pass)).collect() };
        let lengths = |motions: &mut dyn Iterator<Item = Motion<'_, S>>| -> Vec<S> {
            motions.map(|motion| motion.path().length()).collect()
        };
        let before = (all(&table), lengths(&mut fleet.iter().copied()));
        let asked = lengths(&mut proposals.iter().map(|it| it.motion));
        let found =
            table.admit_all(&mut fleet, &mut progress, &mut proposals, tolerances(gain), &mut reaches, |region| {
                assert!(region.ego() < region.other(), "the ego is the one that comes first");
                prefer
            });
        let after = (all(&table), lengths(&mut fleet.iter().copied()));
        let left = lengths(&mut proposals.iter().map(|it| it.motion));
        match found {
            Ok(()) => {
                assert_eq!((&after.1, &left), (&asked, &before.1), "paths are exchanged");
                assert_eq!(table.check(&fleet, &progress, tolerances(gain), &mut reaches), Ok(()));
            }
            Err(_) => assert_eq!((&after, &left), (&before, &asked), "{found:?} leaves traces"),
        }
        Some((found, after.0, after.1))
    }

    /// Whether any orders let all of them finish: all of them are tried. `None` if there are too many.
    fn is_possible(&self, gain: f64) -> Option<bool> {
        let fleet: Vec<Motion<'_, S>> = self.ways.iter().map(|course| course.motion()).collect();
        let mut table = table(&fleet, 200).ok()?;
        let progress = vec![Progress::at_rest(S::from_f64(0.0)); fleet.len()];
        let mut reaches = vec![CheckState::EMPTY; fleet.len()];
        let places: Vec<[usize; 2]> = table.decisions().map(|it| it.agents).collect();
        (places.len() <= 10).then(|| {
            (0..1_usize << places.len()).any(|bits| {
                for (place, &[lower, _]) in places.iter().enumerate() {
                    let pass = if bits >> place & 1 == 0 { PassingState::First } else { PassingState::Second };
                    table.decide_at(&fleet, place, lower, pass, S::from_f64(0.0)).expect("a region");
                }
                table.check(&fleet, &progress, tolerances(gain), &mut reaches).is_ok()
            })
        })
    }
}

fn polygon(sides: usize, side: f64) -> Vec<[[f64; 2]; 2]> {
    let around = 0.5 * side / (0.5 * TAU / sides as f64).sin();
    let corner = |k: usize| {
        let angle = TAU * (k % sides) as f64 / sides as f64;
        [around * angle.cos(), around * angle.sin()]
    };
    (0..sides).map(|k| [corner(k), corner(k + 1)]).collect()
}

/// On a regular polygon of which all corners are taken, everybody can move up if and only if d cos(π/n) > R.
fn rounds_pass_where_there_is_room<S: HostScalar>(near: f64, gain: f64) {
    for sides in [3, 4, 5, 6, 8, 12] {
        let least = 2.0 * RADIUS / (0.5 * TAU / sides as f64).cos();
        for (part, passes) in [(1.0 + near, true), (1.0 - near, false), (1.6, true)] {
            let batch = Batch::<S>::new(&polygon(sides, part * least));
            for prefer in [PassingState::First, PassingState::Second] {
                let (found, ..) = batch.admitted(gain, 200, prefer).expect("room");
                assert_eq!(found.is_ok(), passes, "{sides} sides, {part}: {found:?}");
            }
        }
    }
}

#[test]
fn full_rounds_move_up_if_and_only_if_there_is_room_in_every_format() {
    rounds_pass_where_there_is_room::<f64>(0.002, 1e-6);
    rounds_pass_where_there_is_room::<f32>(0.01, 1e-4);
    rounds_pass_where_there_is_room::<Q16>(0.03, 1e-3);
    rounds_pass_where_there_is_room::<Q12>(0.1, 4e-3);
}

#[test]
fn a_coarse_gain_refuses_rounds_that_are_nearly_full() {
    let batch = Batch::<f64>::new(&polygon(6, 1.002 * 2.0 * RADIUS / (TAU / 12.0).cos()));
    assert_eq!(batch.admitted(1e-6, 200, PassingState::First).expect("room").0, Ok(()));
    assert!(batch.admitted(0.1, 200, PassingState::First).expect("room").0.is_err());
}

#[test]
fn nobody_of_a_round_can_go_alone() {
    let batch = Batch::<f64>::new(&polygon(4, 2.0));
    for agent in 0..4 {
        let (mut fleet, mut progress) = (batch.standing(), vec![Progress::at_rest(0.0); 4]);
        let mut table = table(&fleet, 200).expect("room");
        let mission = batch.proposals()[agent];
        let mut reaches = [CheckState::EMPTY; 4];
        let found =
            table.admit(&mut fleet, &mut progress, mission, tolerances(1e-6), &mut reaches, |_| PassingState::First);
        assert_eq!(found, Err(AdmissionError::Blocked { agent, by: (agent + 1) % 4 }));
        // Nor can three of the four.
        let mut three: Vec<_> = batch.proposals().into_iter().filter(|it| it.agent != agent).collect();
        let found = table
            .admit_all(&mut fleet, &mut progress, &mut three, tolerances(1e-6), &mut reaches, |_| PassingState::First);
        assert_eq!(found, Err(AdmissionError::Blocked { agent: (agent + 3) % 4, by: agent }));
    }
}

#[test]
fn two_robots_do_not_change_places_on_one_lane() {
    let moves = [[[0.0, 0.0], [4.0, 0.0]], [[4.0, 0.0], [0.0, 0.0]]];
    let (found, ..) = Batch::<f64>::new(&moves).admitted(1e-6, 200, PassingState::First).expect("room");
    assert_eq!(found, Err(AdmissionError::Blocked { agent: 0, by: 1 }));
    // Nor do they if a third one moves up elsewhere, in whatever sequence.
    let more = [[[0.0, 9.0], [4.0, 9.0]], moves[0], moves[1]];
    assert!(Batch::<f64>::new(&more).admitted(1e-6, 200, PassingState::First).expect("room").0.is_err());
}

/// Those behind are listed first, so that no sequence of single admissions in this sequence would do.
#[test]
fn a_queue_moves_up_whoever_is_named_first() {
    let place = |k: usize| [k as f64, 0.0];
    let moves: Vec<_> = (0..6).map(|k| [place(k), place(k + 1)]).collect();
    let turned: Vec<_> = moves.iter().rev().copied().collect();
    for moves in [moves, turned] {
        for prefer in [PassingState::First, PassingState::Second] {
            assert_eq!(Batch::<f64>::new(&moves).admitted(1e-6, 200, prefer).expect("room").0, Ok(()));
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused_with_its_reason() {
    let batch = Batch::<f64>::new(&polygon(3, 2.0));
    let (mut fleet, mut progress) = (batch.standing(), vec![Progress::at_rest(0.0); 3]);
    let mut table = table(&fleet, 200).expect("room");
    let mut reaches = [CheckState::EMPTY; 3];
    let mut ask = |agents: &[usize], reaches: &mut [CheckState<f64>]| {
        let mut proposals: Vec<_> =
            agents.iter().map(|&agent| PathProposal { agent, ..batch.proposals()[agent % 3] }).collect();
        table.admit_all(&mut fleet, &mut progress, &mut proposals, tolerances(1e-6), reaches, |_| PassingState::First)
    };
    assert_eq!(ask(&[0, 1, 2, 1], &mut reaches), Err(AdmissionError::Repeated(1)));
    assert_eq!(ask(&[0, 1, 3], &mut reaches), Err(AdmissionError::Mismatch(MismatchError::NoSuchAgent(3))));
    assert_eq!(ask(&[0, 1, 2], &mut []), Err(AdmissionError::Full(CapacityError::Reaches { needed: 3, capacity: 0 })));
    assert_eq!(ask(&[], &mut reaches), Ok(()));
    assert_eq!(ask(&[2, 0, 1], &mut reaches), Ok(()));
}

/// From no room at all to room enough: either nothing happens, or everything.
#[test]
fn storage_that_is_too_small_changes_nothing() {
    let batch = Batch::<f64>::new(&polygon(5, 2.0));
    let mut full = 0;
    for orders in 0..60 {
        match batch.admitted(1e-6, orders, PassingState::First) {
            None => assert_eq!(full, 0, "there was room for less"),
            Some((Err(refused), ..)) => {
                let AdmissionError::Full(CapacityError::Orders { needed, capacity }) = refused else {
                    panic!("{orders}: {refused}")
                };
                assert!(needed > orders && capacity == orders, "{orders}: {refused}");
                full += 1;
            }
            Some((Ok(()), ..)) => assert!(full > 0 && orders > 4, "{orders}"),
        }
    }
    assert!(full < 50, "{full}");
}

/// Robots on a lattice, some of them near enough to be in one another's way, go to random places; all orders are tried.
#[test]
fn joint_admissions_are_those_that_some_orders_allow() {
    let (mut possible, mut impossible, mut missed) = (0, 0, 0);
    for seed in 0..3000 {
        let mut dice = Dice::seeded(seed);
        let count = 2 + dice.below(3);
        let pitch = [0.75, 0.9, 1.3][dice.below(3)];
        let free = |taken: &[[f64; 2]], dice: &mut Dice| loop {
            let place = [pitch * dice.below(3) as f64, pitch * dice.below(3) as f64];
            if !taken.contains(&place) {
                return place;
            }
        };
        let (mut from, mut to) = (Vec::new(), Vec::new());
        for _ in 0..count {
            from.push(free(&from, &mut dice));
        }
        // Often to where another one stands.
        for k in 0..count {
            let next = from[(k + 1) % count];
            to.push(if dice.chance(0.6) && !to.contains(&next) { next } else { free(&to, &mut dice) });
        }
        let moves: Vec<_> = from.into_iter().zip(to).map(|(from, to)| [from, to]).collect();
        let batch = Batch::<f64>::new(&moves);
        let Some(is_possible) = batch.is_possible(1e-6) else { continue };
        let prefer = [PassingState::First, PassingState::Second][dice.below(2)];
        let (found, ..) = batch.admitted(1e-6, 200, prefer).expect("room");
        assert!(is_possible || found.is_err(), "{seed}: {moves:?} is admitted against the search");
        (possible, impossible) = (possible + usize::from(is_possible), impossible + usize::from(!is_possible));
        missed += usize::from(is_possible && found.is_err());
    }
    assert!(possible > 500 && impossible > 500, "{possible} {impossible}");
    // Choosing orders is NP-hard, so some are missed.
    assert!(100 * missed <= possible, "{missed} of {possible}");
}

#[test]
fn a_path_is_granted_up_to_the_last_place_that_is_free() {
    let place = |k: usize| [k as f64, 0.0];
    for taken in 1..6 {
        let stands = [way::<f64>(place(0), place(0)), way(place(taken), place(taken))];
        let parts: Vec<Course<f64>> = (1..6).rev().map(|k| way(place(0), place(k))).collect();
        let shorter: Vec<Motion<'_, f64>> = parts[1..].iter().map(|course| course.motion()).collect();
        let mut fleet: Vec<Motion<'_, f64>> = stands.iter().map(|course| course.motion()).collect();
        let (mut progress, mut reaches) = ([Progress::at_rest(0.0); 2], [CheckState::EMPTY; 2]);
        let mut table = table(&fleet, 20).expect("room");
        let whole = PathProposal { agent: 0, motion: parts[0].motion(), progress: progress[0] };
        let mut ask = |shorter: &[Motion<'_, f64>]| {
            let mut fleet = fleet.clone();
            let found = table.clone().admit_longest(
                &mut fleet,
                &mut progress,
                whole,
                shorter,
                tolerances(1e-6),
                &mut reaches,
                |_| PassingState::Second,
            );
            (found, fleet[0].path().length())
        };
        let refused = Err(AdmissionError::Blocked { agent: 0, by: 1 });
        let expected = if taken == 1 { (refused, 0.0) } else { (Ok(6 - taken), taken as f64 - 1.0) };
        assert_eq!(ask(&shorter), expected, "{taken}");
        assert_eq!(ask(&[]), (refused, 0.0));
        let _ = (&mut fleet, &mut table);
    }
    // Nobody in the way: the whole path.
    let (stand, far) = (way::<f64>(place(0), place(0)), way(place(0), place(5)));
    let (mut fleet, mut progress) = ([stand.motion()], [Progress::at_rest(0.0)]);
    let mut table = table(&fleet, 4).expect("room");
    let whole = PathProposal { agent: 0, motion: far.motion(), progress: progress[0] };
    let shorter = [stand.motion()];
    let found = table.admit_longest(
        &mut fleet,
        &mut progress,
        whole,
        &shorter,
        tolerances(1e-6),
        &mut [CheckState::EMPTY; 1],
        |_| PassingState::First,
    );
    assert_eq!(found, Ok(0));
}

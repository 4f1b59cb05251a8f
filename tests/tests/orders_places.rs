//! What places say of orders: both ends of an interval count, each for something else, and boxes around regions for nothing.

use pcr_core::{
    CheckState, CheckTolerances, EcmEntry, Interval, Motion, MovementAuthority, PassingState, PathProposal, Piece,
    PrecedenceTable, Progress, RegionPrecedence,
};
use pcr_tests::disc::{Course, Disc, Leg};
use pcr_tests::execution::Table;
use std::f64::consts::FRAC_PI_2;

const TOLERANCES: CheckTolerances<f64> = CheckTolerances { width: 0.01, gain: 1e-4 };

/// A straight way of a disc of 0.3 m.
fn way(start: [f64; 3], length: f64) -> Course<f64> {
    Course::new(&Disc { radius: 0.3, start, legs: vec![Leg::Line(length)] }).expect("a valid disc")
}

fn table(fleet: &[Motion<'_, f64>]) -> Table<f64> {
    PrecedenceTable::build(vec![EcmEntry::EMPTY; 8], vec![Piece::EMPTY; 20], vec![RegionPrecedence::EMPTY; 16], fleet)
        .expect("room")
}

fn between(lo: f64, hi: f64) -> Progress<f64> {
    Progress { at: Interval::new(lo, hi), stop: hi }
}

#[test]
fn a_region_is_left_by_the_lower_end_of_a_place() {
    // Within 0.6 m of one another from 3.4 m to 4.6 m, for both.
    let (east, north) = (way([-4.0, 0.0, 0.0], 8.0), way([0.0, -4.0, FRAC_PI_2], 8.0));
    let fleet = [east.motion(), north.motion()];
    for (place, free) in [(between(4.5, 4.9), false), (between(4.61, 4.9), true)] {
        let mut orders = table(&fleet);
        orders.decide(&fleet, 0, 1, PassingState::Second, 0.0).expect("its fleet");
        let progress = [Progress::at_rest(0.0), place];
        for _ in 0..2 {
            let hold = orders.hold(&fleet, 0, &progress).expect("its fleet");
            assert_eq!(hold == MovementAuthority::Free, free, "{place:?}: {hold:?}");
            orders.passed(&progress);
        }
        let over = orders.decisions().all(|decision| decision.pass == PassingState::Over);
        assert_eq!(over, free, "{place:?}");
    }
}

#[test]
fn who_is_second_is_so_by_the_upper_end_of_its_place() {
    let (east, north) = (way([-4.0, 0.0, 0.0], 8.0), way([0.0, -4.0, FRAC_PI_2], 8.0));
    // Both may wait; then the first one may be in the region already, and the other one is first.
    for (place, asked) in [(between(3.0, 3.39), true), (between(3.0, 3.41), false)] {
        let mut fleet = [east.motion(), north.motion()];
        let mut progress = [place, Progress::at_rest(0.0)];
        let mut orders = table(&fleet);
        let mission = PathProposal { agent: 0, motion: fleet[0], progress: place };
        let mut times = 0;
        let found = orders.admit(&mut fleet, &mut progress, mission, TOLERANCES, &mut [CheckState::EMPTY; 2], |_| {
            times += 1;
            PassingState::Second
        });
        assert_eq!((found, times == 1), (Ok(()), asked), "{place:?}");
        let pass = orders.row(&fleet, 0).expect("its fleet").next().expect("a region").2;
        assert_eq!(pass, if asked { PassingState::Second } else { PassingState::First }, "{place:?}");
    }
}

#[test]
fn agents_that_follow_one_another_are_within_the_box_of_their_region_and_go_on() {
    // On one lane, 1.5 m apart: each is between the ends of the region, and only the one behind can be second.
    let (behind, ahead) = (way([-4.0, 0.0, 0.0], 8.0), way([-4.0, 0.0, 0.0], 10.0));
    for (agent, pass) in [(0, PassingState::Second), (1, PassingState::First)] {
        let mut fleet = [behind.motion(), ahead.motion()];
        let mut progress = [Progress::at_rest(2.0), Progress::at_rest(3.5)];
        let mut orders = table(&fleet);
        let mission = PathProposal { agent, motion: fleet[agent], progress: progress[agent] };
        let nobody = |_: &pcr_core::RegionRef<'_, f64>| -> PassingState { panic!("there is no choice") };
        let found = orders.admit(&mut fleet, &mut progress, mission, TOLERANCES, &mut [CheckState::EMPTY; 2], nobody);
        assert_eq!(found, Ok(()));
        assert_eq!(orders.row(&fleet, agent).expect("its fleet").next().expect("a region").2, pass);
        let hold = orders.hold(&fleet, 0, &progress).expect("its fleet");
        assert!(matches!(hold, MovementAuthority::At(hold) if (hold - 2.9).abs() < 1e-9), "{hold:?}");
    }
}

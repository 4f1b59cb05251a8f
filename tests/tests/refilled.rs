//! Tables that are filled again, exchanged, or full: nothing of before stays, and nothing of what does not fit.

use pcr_core::{
    CapacityError, Ecm, EcmEntry, EcmError, MismatchError, Motion, PassingState, Piece, PrecedenceTable, Progress,
    RegionPrecedence,
};
use pcr_tests::disc::{Course, Disc, Leg};
use pcr_tests::execution::Table;
use std::f64::consts::{FRAC_PI_2, TAU};

/// So many ways north, 2 m apart, after one that crosses them all on its way east.
fn ways(count: usize) -> Vec<Course<f64>> {
    let line = |start, length| Disc { radius: 0.3, start, legs: vec![Leg::Line(length)] };
    let north = (0..count).map(|k| line([2.0 * k as f64, -3.0, FRAC_PI_2], 6.0));
    let discs = std::iter::once(line([-3.0, 0.0, 0.0], 2.0 * count as f64 + 4.0)).chain(north);
    discs.map(|disc| Course::new(&disc).expect("a valid disc")).collect()
}

fn motions(courses: &[Course<f64>]) -> Vec<Motion<'_, f64>> {
    courses.iter().map(Course::motion).collect()
}

fn passes(orders: &Table<f64>, fleet: &[Motion<'_, f64>]) -> Vec<(usize, PassingState)> {
    orders.row(fleet, 0).expect("its fleet").map(|(_, region, pass)| (region.other(), pass)).collect()
}

fn empty(regions: usize, pieces: usize) -> Table<f64> {
    PrecedenceTable::new(
        vec![EcmEntry::EMPTY; regions],
        vec![Piece::EMPTY; pieces],
        vec![RegionPrecedence::EMPTY; 2 * regions],
    )
}

#[test]
fn what_is_filled_again_has_nothing_of_before() {
    let (courses, mut orders) = (ways(3), empty(3, 3));
    let fleet = motions(&courses);
    for _ in 0..3 {
        orders.fill(&fleet).expect("room for one table");
        assert_eq!(passes(&orders, &fleet), [1, 2, 3].map(|other| (other, PassingState::Undecided)));
        assert_eq!((orders.ecm().len(), orders.ecm().pieces()), (3, 3));
        for other in 1..=3 {
            orders.decide(&fleet, 0, other, PassingState::First, 0.0).expect("its fleet");
        }
        orders.fill_row(&fleet, 0).expect("room for one row");
        assert_eq!(passes(&orders, &fleet), [1, 2, 3].map(|other| (other, PassingState::Undecided)));
        for other in 1..=3 {
            orders.decide(&fleet, 0, other, PassingState::Second, 0.0).expect("its row");
        }
    }
}

#[test]
fn what_is_decided_stays_so_and_decides_nothing_else() {
    let (courses, mut orders) = (ways(3), empty(3, 3));
    let fleet = motions(&courses);
    orders.fill(&fleet).expect("room");
    orders.decide(&fleet, 0, 2, PassingState::First, 0.0).expect("its fleet");
    assert_eq!(
        passes(&orders, &fleet),
        [(1, PassingState::Undecided), (2, PassingState::First), (3, PassingState::Undecided)]
    );
    orders.decide(&fleet, 2, 0, PassingState::First, 0.0).expect("its fleet");
    orders.decide(&fleet, 0, 3, PassingState::Second, 0.0).expect("its fleet");
    assert_eq!(
        passes(&orders, &fleet),
        [(1, PassingState::Undecided), (2, PassingState::First), (3, PassingState::Second)]
    );
    // Who goes first is through: 5 m and 0.6 m of its path for the first, 3.6 m of that of agent 3.
    let mut progress = vec![Progress::at_rest(0.0); 4];
    (progress[0], progress[3]) = (Progress::at_rest(5.5), Progress::at_rest(3.5));
    orders.passed(&progress);
    assert_eq!(
        passes(&orders, &fleet),
        [(1, PassingState::Undecided), (2, PassingState::First), (3, PassingState::Second)]
    );
    (progress[0], progress[3]) = (Progress::at_rest(5.7), Progress::at_rest(3.5));
    orders.passed(&progress);
    assert_eq!(
        passes(&orders, &fleet),
        [(1, PassingState::Undecided), (2, PassingState::Over), (3, PassingState::Second)]
    );
    progress[3] = Progress::at_rest(3.7);
    orders.passed(&progress);
    assert_eq!(
        passes(&orders, &fleet),
        [(1, PassingState::Undecided), (2, PassingState::Over), (3, PassingState::Over)]
    );
}

#[test]
fn an_agent_that_does_not_fit_leaves_no_pieces() {
    let courses = ways(4);
    let fleet = motions(&courses);
    let without = motions(&courses[1..]);
    // The last agent of this fleet crosses four others: room for three regions.
    let fleet = [&without[..], &fleet[..1]].concat();
    let mut ecm = Ecm::new(vec![EcmEntry::EMPTY; 3], vec![Piece::EMPTY; 8]);
    ecm.fill(&without).expect("no regions");
    for _ in 0..5 {
        assert_eq!(ecm.insert(&fleet, 4), Err(EcmError::Full(CapacityError::Regions { needed: 4, capacity: 3 })));
        assert_eq!((ecm.len(), ecm.pieces()), (0, 0));
    }
    let mut ecm = Ecm::new(vec![EcmEntry::EMPTY; 4], vec![Piece::EMPTY; 4]);
    ecm.fill(&without).expect("no regions");
    ecm.insert(&fleet, 4).expect("room");
    assert_eq!((ecm.len(), ecm.pieces()), (4, 4));
}

#[test]
fn a_table_that_is_not_filled_is_empty() {
    let courses = ways(4);
    let fleet = motions(&courses);
    let fulls = [
        (3, 8, CapacityError::Regions { needed: 4, capacity: 3 }),
        (8, 3, CapacityError::Pieces { needed: 4, capacity: 3 }),
    ];
    for (regions, pieces, full) in fulls {
        let mut ecm = Ecm::new(vec![EcmEntry::EMPTY; regions], vec![Piece::EMPTY; pieces]);
        assert_eq!(ecm.fill(&fleet), Err(full));
        assert_eq!((ecm.len(), ecm.pieces(), ecm.is_empty()), (0, 0, true));
        // Nothing of it is found by those who come one after the other.
        (0..2).for_each(|agent| ecm.insert(&fleet[..=agent], agent).expect("room for the first region"));
        assert_eq!((ecm.len(), ecm.pieces()), (1, 1));
    }
}

/// All that a table holds, to be compared.
fn held(ecm: &Ecm<f64, Vec<EcmEntry>, Vec<Piece<f64>>>, fleet: &[Motion<'_, f64>]) -> Vec<String> {
    let regions = ecm.regions(fleet).expect("its fleet");
    regions.map(|region| format!("{:?}", (region.ego(), region.other(), region.pieces().collect::<Vec<_>>()))).collect()
}

#[test]
fn a_table_in_parts_is_that_in_one() {
    for count in 0..6 {
        let courses = ways(count);
        let fleet = motions(&courses);
        for agents in 0..=fleet.len() {
            let fleet = &fleet[..agents];
            let whole = Ecm::build(vec![EcmEntry::EMPTY; 8], vec![Piece::EMPTY; 8], fleet).expect("room");
            for pairs in 1..8 {
                let mut ecm = Ecm::new(vec![EcmEntry::EMPTY; 8], vec![Piece::EMPTY; 8]);
                ecm.begin_fill(fleet);
                let (all, mut calls) = (agents * agents.saturating_sub(1) / 2, 0);
                while !ecm.fill_pairs(fleet, pairs).expect("room and its fleet") {
                    calls += 1;
                    assert!(calls * pairs < all, "{agents} agents, {pairs} pairs a call");
                }
                assert_eq!(held(&ecm, fleet), held(&whole, fleet));
                assert_eq!(ecm.fill_pairs(fleet, 1), Ok(true));
            }
        }
    }
}

#[test]
fn a_table_that_is_not_complete_answers_nothing() {
    let courses = ways(4);
    let fleet = motions(&courses);
    let mut orders = empty(8, 8);
    orders.begin_fill(&fleet);
    assert_eq!(orders.fill_pairs(&fleet, 3), Ok(false));
    assert_eq!(orders.ecm().len(), 3);
    assert!(orders.ecm().regions(&fleet).is_err_and(|error| error == MismatchError::Unfinished));
    assert!(orders.ecm().row(&fleet, 0).is_err_and(|error| error == MismatchError::Unfinished));
    assert!(orders.ecm().pair(&fleet, 0, 1).is_err_and(|error| error == MismatchError::Unfinished));
    assert_eq!(orders.hold(&fleet, 0, &[Progress::at_rest(0.0); 5]).err(), Some(MismatchError::Unfinished));
    assert_eq!(orders.remove(&fleet, 4), Err(MismatchError::Unfinished));
    let last = fleet[4];
    assert_eq!(orders.insert(&fleet, 4), Err(EcmError::Mismatch(MismatchError::Unfinished)));
    assert_eq!(orders.replace(&mut fleet.clone(), 4, last), Err(EcmError::Mismatch(MismatchError::Unfinished)));
    // Another fleet is refused, and what is there stays.
    assert_eq!(orders.fill_pairs(&fleet[..4], 3), Err(EcmError::Mismatch(MismatchError::OtherFleet)));
    assert_eq!(orders.fill_pairs(&fleet, 100), Ok(true));
    orders.decide(&fleet, 0, 2, PassingState::First, 0.0).expect("its fleet");
    assert_eq!(orders.fill_pairs(&fleet, 1), Ok(true));
    let undecided = |other| (other, PassingState::Undecided);
    assert_eq!(passes(&orders, &fleet), [undecided(1), (2, PassingState::First), undecided(3), undecided(4)]);
    // One that does not fit is empty, and can be filled again.
    let mut ecm = Ecm::new(vec![EcmEntry::EMPTY; 3], vec![Piece::EMPTY; 8]);
    ecm.begin_fill(&fleet);
    assert_eq!(ecm.fill_pairs(&fleet, 3), Ok(false));
    assert_eq!(ecm.fill_pairs(&fleet, 1), Err(EcmError::Full(CapacityError::Regions { needed: 4, capacity: 3 })));
    assert_eq!((ecm.len(), ecm.pieces()), (0, 0));
    assert_eq!(ecm.fill(&fleet[..4]), Ok(()));
}

#[test]
fn no_path_of_another_fleet_or_of_another_row_is_exchanged() {
    let (courses, others) = (ways(3), ways(4));
    let (mut fleet, mut stranger) = (motions(&courses), motions(&others[..4]));
    stranger[3] = others[0].motion();
    let mut ecm = Ecm::grown(&fleet).expect("memory");
    let motion = fleet[1];
    assert_eq!(ecm.replace(&mut stranger, 1, motion), Err(MismatchError::OtherFleet.into()));
    assert_eq!(ecm.replace(&mut fleet, 4, motion), Err(MismatchError::NoSuchAgent(4).into()));
    assert_eq!(ecm.row(&fleet, 0).expect("its fleet").count(), 3);
    let mut orders = empty(6, 6);
    orders.fill_row(&fleet, 0).expect("room");
    orders.decide(&fleet, 0, 2, PassingState::First, 0.0).expect("its row");
    assert_eq!(orders.replace(&mut fleet, 0, motion), Err(MismatchError::OnlyRow(0).into()));
    assert_eq!(orders.erase(&fleet, 2), Err(MismatchError::OnlyRow(0)));
    assert_eq!(orders.remove(&fleet, 2), Err(MismatchError::OnlyRow(0)));
    assert_eq!(
        passes(&orders, &fleet),
        [(1, PassingState::Undecided), (2, PassingState::First), (3, PassingState::Undecided)]
    );
}

#[test]
fn a_circle_to_the_other_side_is_another_path() {
    // The same start, end, length and radius.
    let circle = |sweep: f64| {
        let disc = Disc { radius: 0.3, start: [0.0, 0.0, 0.0], legs: vec![Leg::arc(1.0, sweep)] };
        Course::<f64>::new(&disc).expect("a valid disc")
    };
    let (left, right, courses) = (circle(TAU), circle(-TAU), ways(1));
    let table = Ecm::grown(&[left.motion(), courses[0].motion()]).expect("memory");
    assert_eq!(table.row(&[left.motion(), courses[0].motion()], 0).map(drop), Ok(()));
    assert_eq!(table.row(&[right.motion(), courses[0].motion()], 0).map(drop), Err(MismatchError::OtherFleet));
}

/// The lag of one motion grew, and a region that was none of the table's is one now, for which there is no room. Once the table lost all
/// regions of another agent over it, and answered that its way is free.
#[test]
fn a_table_without_room_for_a_larger_lag_stays_as_it_was() {
    let line = |start, length| Disc { radius: 0.3, start, legs: vec![Leg::Line(length)] };
    let discs = [
        line([0.0, 0.0, 0.0], 1000.0),
        // Beside it, farther than both radii by half a millimetre.
        line([0.0, 0.6005, 0.0], 1000.0),
        line([500.0, -3.0, FRAC_PI_2], 2.9),
        // Across the ways of two.
        line([500.2, 8.0, -FRAC_PI_2], 8.0),
    ];
    let courses = discs.map(|disc| Course::<f64>::new(&disc).expect("a valid disc"));
    let mut fleet = [0, 1, 2].map(|k| courses[k].motion());
    let longer = pcr_core::Profile::<f64, 1>::from_pieces(1.0, [(1000.0009, 0.0)]).expect("small");
    let across = courses[3].motion();
    let mut orders = PrecedenceTable::new([EcmEntry::EMPTY; 1], [Piece::EMPTY; 1], [RegionPrecedence::EMPTY; 4]);
    orders.fill(&fleet).expect("room for the one region");
    let mut ecm = Ecm::new([EcmEntry::EMPTY; 1], [Piece::EMPTY; 1]);
    ecm.fill(&fleet).expect("room for the one region");
    let drifts = Motion::new(fleet[1].path(), longer.as_profile(), 0.3, 0.0).expect("a millimetre is allowed");
    assert!(drifts.lag() > 0.8e-3);
    let before = fleet;
    for is_table in [true, false] {
        let rows = |ecm: &Ecm<_, _, _>, orders: &PrecedenceTable<_, _, _, _>, fleet: &[Motion<'_, f64>]| {
            if is_table { ecm.row(fleet, 0).map(Iterator::count) } else { orders.row(fleet, 0).map(Iterator::count) }
        };
        // Of a motion that the table does not hold for, nothing is told.
        fleet[1] = drifts;
        assert_eq!(rows(&ecm, &orders, &fleet), Err(MismatchError::OtherFleet));
        let refused = if is_table { ecm.replace(&mut fleet, 0, across) } else { orders.replace(&mut fleet, 0, across) };
        assert_eq!(refused, Err(MismatchError::OtherFleet.into()));
        assert_eq!(fleet[0].path().length(), before[0].path().length(), "the fleet is as it was");
        // Given to the table, it needs room, and without it all is as it was.
        fleet = before;
        let refused = if is_table { ecm.replace(&mut fleet, 1, drifts) } else { orders.replace(&mut fleet, 1, drifts) };
        assert!(matches!(refused, Err(EcmError::Full(_))), "{refused:?}");
        assert_eq!((rows(&ecm, &orders, &fleet), fleet[1].lag()), (Ok(1), before[1].lag()));
    }
}

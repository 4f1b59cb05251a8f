//! A table of orders answers for its own fleet only, a row for its own agent only; what it refuses changes nothing.

use pcr_core::{
    AdmissionError, CapacityError, CheckState, CheckTolerances, EcmEntry, EcmError, MismatchError, Motion,
    MovementAuthority, PassingState, PathProposal, Piece, PrecedenceTable, Progress, RegionPrecedence,
};
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::execution::Table;
use std::f64::consts::FRAC_PI_2;

const TOLERANCES: CheckTolerances<f64> = CheckTolerances { width: 0.0, gain: 1e-4 };

/// Four lanes around a block, each crossing the next one.
fn lanes(radius: f64) -> [Course<f64>; 4] {
    [0.0, 1.0, 2.0, 3.0].map(|quarter| {
        let heading = FRAC_PI_2 * quarter;
        let (sin, cos) = heading.sin_cos();
        let start = [cos * -3.0 + sin, sin * -3.0 - cos, heading];
        let disc = Disc { radius, start, legs: vec![Leg::Line(6.0)] };
        Course::driven(&disc, &Drive::Unit, 0.0).expect("a valid disc")
    })
}

fn empty(orders: usize) -> Table<f64> {
    PrecedenceTable::new(vec![EcmEntry::EMPTY; 8], vec![Piece::EMPTY; 40], vec![RegionPrecedence::EMPTY; orders])
}

fn table(fleet: &[Motion<'_, f64>], orders: usize) -> Table<f64> {
    let storage = (vec![EcmEntry::EMPTY; 8], vec![Piece::EMPTY; 40], vec![RegionPrecedence::EMPTY; orders]);
    PrecedenceTable::build(storage.0, storage.1, storage.2, fleet).expect("room")
}

/// Holds and passes of everybody.
fn trace(orders: &Table<f64>, fleet: &[Motion<'_, f64>]) -> String {
    let progress = [Progress::at_rest(0.0); 4];
    let of = |agent| {
        let row = orders.row(fleet, agent).expect("the table of the fleet");
        let passes: Vec<_> = row.map(|(place, region, pass)| (place, region.other(), pass)).collect();
        format!("{:?} {passes:?}\n", orders.hold(fleet, agent, &progress).expect("the table of the fleet"))
    };
    (0..fleet.len()).map(of).collect()
}

/// All that a table refuses for the same reason, asked about these agents.
fn refusals<'m>(
    orders: &mut Table<f64>,
    fleet: &mut [Motion<'m, f64>],
    motion: Motion<'m, f64>,
    agents: [usize; 2],
) -> [Option<MismatchError>; 8] {
    let [agent, other] = agents;
    let mut progress = [Progress::at_rest(0.0); 4];
    let mut reaches = [CheckState::EMPTY; 4];
    let mission = PathProposal { agent, motion, progress: Progress::at_rest(0.0) };
    let refused = |found: Result<(), AdmissionError>| match found {
        Err(AdmissionError::Mismatch(mismatch)) => Some(mismatch),
        _ => None,
    };
    [
        orders.hold(fleet, agent, &progress).err(),
        orders.hold_before(fleet, agent, &progress, MovementAuthority::At(1.0)).err(),
        orders.row(fleet, agent).err(),
        orders.decide(fleet, agent, other, PassingState::First, 0.0).err(),
        orders.remove(fleet, agent).err(),
        refused(orders.check(fleet, &progress, TOLERANCES, &mut reaches)),
        refused(orders.as_planned(fleet)),
        refused(orders.admit(fleet, &mut progress, mission, TOLERANCES, &mut reaches, |_| PassingState::First)),
    ]
}

#[test]
fn another_fleet_is_refused_and_changes_nothing() {
    let (lanes, wide) = (lanes(0.3), lanes(0.4));
    let fleet = lanes.each_ref().map(Course::motion);
    let mut orders = table(&fleet, 8);
    orders.decide(&fleet, 0, 3, PassingState::Second, 0.0).expect("the table of the fleet");
    orders.decide(&fleet, 1, 0, PassingState::First, 0.0).expect("the table of the fleet");
    let before = trace(&orders, &fleet);
    let [first, second, third, fourth] = fleet;
    let strangers =
        [vec![first, second, third], vec![second, first, third, fourth], vec![first, second, third, wide[3].motion()]];
    for mut stranger in strangers {
        let refused = refusals(&mut orders, &mut stranger, first, [0, 1]);
        assert_eq!(refused, [Some(MismatchError::OtherFleet); 8]);
        assert_eq!(orders.decide_at(&stranger, 0, 0, PassingState::First, 0.0), Err(MismatchError::OtherFleet));
        assert_eq!(orders.insert(&stranger, 0), Err(EcmError::Mismatch(MismatchError::OtherFleet)));
        assert_eq!(trace(&orders, &fleet), before);
    }
    let nobody = refusals(&mut orders, &mut fleet.clone(), first, [4, 1]);
    for (place, refused) in nobody.into_iter().enumerate() {
        // Two of them are about the whole fleet.
        let expected = (!(5..7).contains(&place)).then_some(MismatchError::NoSuchAgent(4));
        assert_eq!(refused, expected, "number {place}");
    }
}

#[test]
fn only_agents_of_a_region_decide_about_it() {
    let lanes = lanes(0.3);
    let fleet = lanes.each_ref().map(Course::motion);
    let mut orders = table(&fleet, 8);
    let before = trace(&orders, &fleet);
    let count = orders.ecm().len();
    let place = orders.row(&fleet, 0).expect("the table of the fleet").next().expect("a region").0;
    assert_eq!(orders.decide_at(&fleet, count, 0, PassingState::First, 0.0), Err(MismatchError::NoSuchRegion(count)));
    assert_eq!(orders.decide_at(&fleet, place, 2, PassingState::First, 0.0), Err(MismatchError::NoSuchRegion(place)));
    assert_eq!(orders.decide_at(&fleet, place, 4, PassingState::First, 0.0), Err(MismatchError::NoSuchAgent(4)));
    assert_eq!(trace(&orders, &fleet), before);
}

#[test]
fn a_row_answers_for_its_agent_only() {
    let lanes = lanes(0.3);
    let mut fleet = lanes.each_ref().map(Course::motion);
    let (mut orders, mut whole) = (empty(2), table(&fleet, 4));
    orders.fill_row(&fleet, 1).expect("room");
    let before = [Progress::at_rest(0.0); 4];
    let mut after = before;
    after[0] = Progress::at_rest(6.0);
    for progress in [before, after] {
        for table in [&mut orders, &mut whole] {
            table.decide(&fleet, 1, 0, PassingState::Second, 0.0).expect("its row");
            table.decide(&fleet, 2, 1, PassingState::Second, 0.0).expect("its row");
        }
        assert_eq!(orders.hold(&fleet, 1, &progress), whole.hold(&fleet, 1, &progress));
    }
    assert!(matches!(orders.hold(&fleet, 1, &before), Ok(MovementAuthority::At(_))));
    assert_eq!(orders.hold(&fleet, 1, &after), Ok(MovementAuthority::Free));
    let motion = fleet[2];
    let refused = refusals(&mut orders, &mut fleet, motion, [2, 3]);
    assert_eq!(refused, [Some(MismatchError::OnlyRow(1)); 8]);
    assert_eq!(orders.hold(&fleet, 1, &after), Ok(MovementAuthority::Free));
    // An agent that is not there has no row; the table stays as it is.
    assert_eq!(orders.fill_row(&fleet, 4), Err(MismatchError::NoSuchAgent(4).into()));
    assert_eq!(orders.hold(&fleet, 1, &after), Ok(MovementAuthority::Free));
    // Where there is no room for its orders the table is that of nobody.
    let mut small = empty(1);
    assert_eq!(small.fill_row(&fleet, 1), Err(CapacityError::Orders { needed: 2, capacity: 1 }.into()));
    assert_eq!(small.hold(&fleet, 1, &before), Err(MismatchError::OtherFleet));
}

#[test]
fn who_comes_and_goes_leaves_the_orders_of_the_others() {
    let lanes = lanes(0.3);
    let fleet = lanes.each_ref().map(Course::motion);
    let mut orders = table(&fleet[..3], 3);
    orders.decide(&fleet[..3], 0, 1, PassingState::Second, 0.0).expect("the table of the fleet");
    orders.decide(&fleet[..3], 1, 2, PassingState::First, 0.0).expect("the table of the fleet");
    let before = trace(&orders, &fleet[..3]);
    assert_eq!(orders.insert(&fleet, 3), Err(EcmError::Full(CapacityError::Orders { needed: 4, capacity: 3 })));
    assert_eq!(trace(&orders, &fleet[..3]), before);
    let mut roomy = table(&fleet[..3], 4);
    roomy.decide(&fleet[..3], 0, 1, PassingState::Second, 0.0).expect("the table of the fleet");
    roomy.decide(&fleet[..3], 1, 2, PassingState::First, 0.0).expect("the table of the fleet");
    roomy.insert(&fleet, 3).expect("room");
    assert!(
        matches!(roomy.hold(&fleet, 3, &[Progress::at_rest(0.0); 4]), Ok(MovementAuthority::At(_))),
        "nothing is decided"
    );
    roomy.remove(&fleet, 3).expect("the table of the fleet");
    assert_eq!(trace(&roomy, &fleet[..3]), before);
}

#[test]
fn who_leaves_for_good_moves_the_others_up_with_their_orders() {
    let lanes = lanes(0.3);
    let fleet = lanes.each_ref().map(Course::motion);
    for gone in 0..4 {
        let (mut orders, mut fresh) = (table(&fleet, 8), empty(8));
        let rest: Vec<_> = (0..4).filter(|&agent| agent != gone).map(|agent| fleet[agent]).collect();
        fresh.fill(&rest).expect("room");
        let number = |agent: usize| agent - usize::from(agent > gone);
        for [agent, other] in [[0, 1], [1, 2], [3, 2], [3, 0]] {
            orders.decide(&fleet, agent, other, PassingState::First, 0.0).expect("the table of the fleet");
            if ![agent, other].contains(&gone) {
                fresh
                    .decide(&rest, number(agent), number(other), PassingState::First, 0.0)
                    .expect("the table of the fleet");
            }
        }
        assert_eq!(orders.erase(&rest, 0), Err(MismatchError::OtherFleet));
        assert_eq!(orders.erase(&fleet, 4), Err(MismatchError::NoSuchAgent(4)));
        orders.erase(&fleet, gone).expect("the table of the fleet");
        assert_eq!(trace(&orders, &rest), trace(&fresh, &rest), "without {gone}");
        assert_eq!(orders.hold(&fleet, 0, &[]), Err(MismatchError::OtherFleet));
        orders.insert(&[&rest[..], &[fleet[gone]]].concat(), 3).expect("room for one more");
    }
    let mut none = table(&fleet, 4);
    none.clear();
    assert_eq!(none.hold(&fleet, 0, &[]), Err(MismatchError::OtherFleet));
    assert_eq!(empty(3).fill(&fleet), Err(CapacityError::Orders { needed: 4, capacity: 3 }));
}

#[test]
fn a_path_that_is_exchanged_is_decided_anew_and_those_of_the_others_are_not() {
    let lanes = lanes(0.3);
    let mut fleet = lanes.each_ref().map(Course::motion);
    let mut orders = table(&fleet, 6);
    for [agent, other] in [[0, 1], [1, 2], [2, 3]] {
        orders.decide(&fleet, agent, other, PassingState::First, 0.0).expect("the table of the fleet");
    }
    let (before, other) = (trace(&orders, &fleet), fleet[0]);
    let passes = |orders: &Table<f64>, fleet: &[Motion<'_, f64>]| {
        let row = orders.row(fleet, 1).expect("the table of the fleet");
        row.map(|(_, region, pass)| (region.other(), pass)).collect::<Vec<_>>()
    };
    assert_eq!(passes(&orders, &fleet), [(0, PassingState::Second), (2, PassingState::First)]);
    orders.replace(&mut fleet, 1, other).expect("room");
    assert!(passes(&orders, &fleet).iter().all(|&(_, pass)| pass == PassingState::Undecided));
    let row = orders.row(&fleet, 2).expect("the table of the fleet");
    assert_eq!(row.map(|(_, region, pass)| (region.other(), pass)).collect::<Vec<_>>(), [(3, PassingState::First)]);
    // Without room for what there was meanwhile, nothing changes.
    let mut fleet = lanes.each_ref().map(Course::motion);
    let mut narrow = table(&fleet, 5);
    for [agent, other] in [[0, 1], [1, 2], [2, 3]] {
        narrow.decide(&fleet, agent, other, PassingState::First, 0.0).expect("the table of the fleet");
    }
    assert_eq!(
        narrow.replace(&mut fleet, 1, other),
        Err(EcmError::Full(CapacityError::Orders { needed: 6, capacity: 5 }))
    );
    assert_eq!(trace(&narrow, &fleet), before);
    assert_eq!(narrow.replace(&mut fleet, 9, other), Err(MismatchError::NoSuchAgent(9).into()));
}

#[test]
fn motions_that_meet_are_not_a_plan() {
    let lanes = lanes(0.3);
    // Lane 0 passes the crossing that it has with lane 3 after 2 s, that one its own after 4 s.
    let fleet = |delay: f64| [lanes[0].motion().delayed(delay).expect("a small delay"), lanes[3].motion()];
    for (delay, pass) in
        [(0.0, Some(PassingState::First)), (1.5, None), (2.0, None), (2.5, None), (5.0, Some(PassingState::Second))]
    {
        let fleet = fleet(delay);
        let mut orders = table(&fleet, 1);
        let found = orders.as_planned(&fleet);
        let passes: Vec<_> = orders.row(&fleet, 0).expect("the table of the fleet").map(|(.., pass)| pass).collect();
        match pass {
            Some(pass) => assert_eq!((found, passes), (Ok(()), vec![pass]), "{delay}"),
            None => assert_eq!(
                (found, passes),
                (Err(AdmissionError::Meeting([0, 1])), vec![PassingState::Undecided]),
                "{delay}"
            ),
        }
    }
    // Earlier decisions stay, also those of regions that come before the one in which they meet.
    let fleet = [lanes[0].motion(), lanes[1].motion(), lanes[3].motion(), lanes[3].motion()];
    let mut orders = table(&fleet, 12);
    let all: Vec<_> = orders.decisions().map(|decision| (decision.place, decision.agents[0])).collect();
    assert!(all.len() > 2);
    for (place, lower) in all {
        orders.decide_at(&fleet, place, lower, PassingState::Second, 0.0).expect("a region");
    }
    assert!(matches!(orders.as_planned(&fleet), Err(AdmissionError::Meeting(_))));
    assert!(orders.decisions().all(|decision| decision.pass == PassingState::Second));
}

//! The table of a fleet: order, exchange of agents, and what happens when it is full.

use pcr_core::scalar::Angle;
use pcr_core::{
    CapacityError, Ecm, EcmCapacity, EcmEntry, EcmError, Interval, Limits, MismatchError, Motion, Path, Piece,
    PlanError, Point, Pose, Profile, Radians, RegionRef, TurnSide, first_conflict, plan_delays,
};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, HostEcm, HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Leg};
use pcr_tests::generators::Dice;
use std::f64::consts::{FRAC_PI_2, PI};

/// What a region is, for comparison.
type Entry = ([usize; 2], [Interval<f64>; 3], usize);

fn entry(region: &RegionRef<'_, f64>) -> Entry {
    let ranges = [region.time(), region.length(), region.other_length()];
    ([region.ego(), region.other()], ranges, region.pieces().count())
}

fn entries<R, P>(ecm: &Ecm<f64, R, P>, motions: &[Motion<'_, f64>]) -> Vec<Entry>
where
    R: AsRef<[EcmEntry]>,
    P: AsRef<[Piece<f64>]>,
{
    ecm.regions(motions).expect("the table of the fleet").map(|region| entry(&region)).collect()
}

fn twelve() -> Fleet<f64> {
    let scenario = Scenario::from_json(include_str!("../data/paper12.json")).expect("a valid scenario");
    Fleet::new(&scenario).expect("a valid fleet")
}

/// Another motion for one of the twelve: a detour through the middle of the square.
fn detour(k: usize) -> Course<f64> {
    let legs = vec![Leg::Line(1.0 + 0.2 * k as f64), Leg::arc(0.8, 2.5), Leg::Line(2.0), Leg::arc(0.5, -3.0)];
    let disc = Disc { radius: 0.12, start: [2.0 + 0.3 * k as f64, 1.0, 0.3 * k as f64], legs };
    Course::driven(&disc, &Drive::Limits(0.5, 0.3), k as f64).expect("a valid disc")
}

fn exact(motions: &[Motion<'_, f64>]) -> (HostEcm<f64>, usize, usize) {
    let roomy = build_ecm(motions).expect("a small fleet");
    let (regions, pieces) = (roomy.len(), roomy.pieces());
    let tight = Ecm::build(vec![EcmEntry::EMPTY; regions], vec![Piece::EMPTY; pieces], motions);
    (tight.expect("as much room as is used"), regions, pieces)
}

#[test]
fn rows_are_in_the_order_of_the_agents_and_complete() {
    let fleet = twelve();
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).expect("a small fleet");
    let all = entries(&ecm, &motions);
    assert_eq!(all.len(), 2 * ecm.len());
    assert!(all.iter().map(|entry| entry.0).is_sorted(), "by ego, then by the other");
    // Each of them once, and once seen by the other agent.
    let once = || ecm.regions_once(&motions).expect("the table of the fleet");
    let lower: Vec<_> = all.iter().filter(|entry| entry.0[0] < entry.0[1]).copied().collect();
    assert_eq!(once().map(|region| entry(&region)).collect::<Vec<_>>(), lower);
    let mut swapped: Vec<_> = once().map(|region| entry(&region.swapped())).collect();
    swapped.sort_by_key(|entry| entry.0);
    let upper: Vec<_> = all.iter().filter(|entry| entry.0[0] > entry.0[1]).copied().collect();
    assert_eq!(swapped, upper);
    for ego in 0..motions.len() {
        let row: Vec<_> =
            ecm.row(&motions, ego).expect("the table of the fleet").map(|region| entry(&region)).collect();
        let expected: Vec<_> = all.iter().filter(|entry| entry.0[0] == ego).copied().collect();
        assert_eq!(row, expected);
        for other in 0..motions.len() {
            let pair: Vec<_> =
                ecm.pair(&motions, ego, other).expect("the table of the fleet").map(|region| entry(&region)).collect();
            let expected: Vec<_> = row.iter().filter(|entry| entry.0[1] == other).copied().collect();
            assert_eq!(pair, expected);
        }
    }
}

/// More of them than are compared at once.
#[test]
fn an_agent_that_crosses_seventy_others_has_a_region_with_each() {
    let line = |x, y, heading, length| {
        format!(
            r#"{{"id":0,"radius":0.2,"v_max":1,"a_max":1,"start":{{"x":{x},"y":{y},"heading":{heading}}},"path":[{{"kind":"line","length":{length}}}]}}"#
        )
    };
    for place in [0, 31, 32, 33, 70] {
        let mut agents: Vec<_> = (0..70).map(|k| line(f64::from(k), -1.0, std::f64::consts::FRAC_PI_2, 2.0)).collect();
        agents.insert(place, line(-1.0, 0.0, 0.0, 72.0));
        let numbered: Vec<_> =
            (0..).zip(&agents).map(|(id, agent)| agent.replace(r#""id":0"#, &format!(r#""id":{id}"#))).collect();
        let scenario = Scenario::from_json(&format!(r#"{{"agents":[{}]}}"#, numbered.join(","))).unwrap();
        let fleet = Fleet::<f64>::new(&scenario).unwrap();
        let mut motions = fleet.motions();
        let mut ecm = build_ecm(&motions).unwrap();
        let others = |ecm: &HostEcm<f64>, motions: &[Motion<'_, f64>]| -> Vec<usize> {
            ecm.row(motions, place).expect("the table of the fleet").map(|region| region.other()).collect()
        };
        let all: Vec<_> = (0..=70).filter(|&other| other != place).collect();
        assert_eq!((others(&ecm, &motions), ecm.len()), (all.clone(), 70));
        let own = motions[place];
        ecm.replace(&mut motions, place, own).unwrap();
        assert_eq!((others(&ecm, &motions), ecm.len()), (all, 70));
    }
}

#[test]
fn agents_that_are_not_there_are_refused() {
    let fleet = twelve();
    let mut motions = fleet.motions();
    let mut ecm = build_ecm(&motions).expect("a small fleet");
    let before = entries(&ecm, &motions);
    assert_eq!(ecm.row(&motions, 12).err(), Some(MismatchError::NoSuchAgent(12)));
    assert_eq!(ecm.pair(&motions, 0, 12).err(), Some(MismatchError::NoSuchAgent(12)));
    assert_eq!(ecm.pair(&motions, usize::MAX, 0).err(), Some(MismatchError::NoSuchAgent(usize::MAX)));
    assert_eq!(ecm.pair(&motions, 3, 3).map(Iterator::count), Ok(0), "nobody meets itself");
    assert_eq!(ecm.remove(&motions, 12), Err(MismatchError::NoSuchAgent(12)));
    assert_eq!(ecm.insert(&motions, 99), Err(EcmError::Mismatch(MismatchError::NoSuchAgent(99))));
    let motion = motions[0];
    assert_eq!(ecm.replace(&mut motions, 12, motion), Err(EcmError::Mismatch(MismatchError::NoSuchAgent(12))));
    assert_eq!(entries(&ecm, &motions), before);
    let nobody: [Motion<'_, f64>; 0] = [];
    let empty = Ecm::<f64, _, _>::build([], [], &nobody).expect("nothing to store");
    assert!(empty.is_empty() && empty.regions(&nobody).expect("nobody").next().is_none());
}

/// Of every table but that of the fleet nothing is told, above all not that there is nothing.
#[test]
fn the_table_of_another_fleet_is_refused() {
    let fleet = twelve();
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).expect("a small fleet");
    let refused = |fleet: &[Motion<'_, f64>], why: &str| {
        assert_eq!(ecm.row(fleet, 0).err(), Some(MismatchError::OtherFleet), "{why}");
        assert_eq!(ecm.pair(fleet, 0, 1).err(), Some(MismatchError::OtherFleet), "{why}");
        assert_eq!(ecm.regions(fleet).err(), Some(MismatchError::OtherFleet), "{why}");
        assert_eq!(ecm.regions_once(fleet).err(), Some(MismatchError::OtherFleet), "{why}");
        let (mut plan, mut order) = (fleet.to_vec(), (0..fleet.len()).collect::<Vec<_>>());
        let refused = Err(PlanError::Table(MismatchError::OtherFleet));
        assert_eq!(plan_delays(&ecm, fleet, &mut plan, &mut order), refused, "{why}");
    };
    refused(&motions[..11], "a shorter fleet");
    refused(&[&motions[..], &motions[..1]].concat(), "a longer one");
    for (a, b) in (0..12).flat_map(|a| (0..a).map(move |b| (a, b))) {
        let mut swapped = motions.clone();
        swapped.swap(a, b);
        refused(&swapped, "another order");
    }
    let detours: Vec<_> = (0..12).map(detour).collect();
    for agent in 0..12 {
        let mut other = motions.clone();
        other[agent] = detours[agent].motion();
        refused(&other, "another path");
        let motion = &motions[agent];
        let radius = motion.radius().next_up();
        other[agent] = Motion::new(motion.path(), motion.profile(), radius, motion.time().lo).expect("a disc");
        refused(&other, "another radius");
    }
    // The last digit of any number of a path.
    let path = |numbers: [f64; 6]| {
        let [x, y, heading, line, radius, arc] = numbers;
        let start = Pose { position: Point::new(x, y), heading: Radians(heading) };
        let path =
            Path::<f64, 2>::starting_at(start).and_then(|path| path.line(line)?.arc(radius, TurnSide::Left, arc));
        path.expect("a path")
    };
    let numbers = [1.0, 2.0, 0.5, 3.0, 1.5, 2.0];
    let standing = |path: &Path<f64, 2>| {
        let profile =
            Profile::<f64, 3>::rest_to_rest(path.as_path().length(), Limits { speed: 1.0, acceleration: 1.0 });
        let profile = profile.expect("a profile");
        let motion = Motion::new(path.as_path(), profile.as_profile(), 0.5, 0.0).expect("a motion");
        Ecm::<f64, _, _>::build([], [], &[motion]).map(|table| (table, path.clone(), profile)).expect("one agent")
    };
    let (table, ..) = standing(&path(numbers));
    for place in 0..numbers.len() {
        let mut other = numbers;
        other[place] = other[place].next_up();
        let (_, path, profile) = standing(&path(other));
        let motion = Motion::new(path.as_path(), profile.as_profile(), 0.5, 0.0).expect("a motion");
        assert_eq!(table.row(&[motion], 0).err(), Some(MismatchError::OtherFleet), "number {place}");
    }
    // What may change: start, profile, margin and lateness; and the same path in another place of memory.
    let again = twelve();
    let mut others = again.motions();
    others[3] = others[3].delayed(1.0).and_then(|late| late.with_margin(0.1)?.with_lateness(0.5)).expect("a motion");
    assert_eq!(ecm.row(&others, 0).map(Iterator::count).ok(), ecm.row(&motions, 0).map(Iterator::count).ok());
}

/// Numbers that two agents exchange do not cancel, nor does what begins and ends at the same points hide another path.
fn exchanged<S: HostScalar>() {
    const FLEETS: usize = 2000;
    let mut dice = Dice::seeded(7);
    let limits = Limits { speed: S::from_f64(1.0), acceleration: S::from_f64(1.0) };
    for _ in 0..FLEETS {
        let mut tenths = |lo, hi| (dice.range(lo, hi) * 10.0).round() / 10.0;
        let lane = |x: f64, y: f64, length: f64| {
            let disc = Disc { radius: 0.25, start: [x, y, 0.0], legs: vec![Leg::Line(length)] };
            Course::<S>::new(&disc).expect("a valid disc")
        };
        let y = tenths(-9.0, 9.0);
        let lanes = [0.0, 0.6, 20.0].map(|aside| lane(tenths(-9.0, 9.0), y + aside, tenths(1.0, 9.0)));
        let fleet = |radii: [f64; 3]| {
            [0, 1, 2].map(|agent: usize| {
                let motion = lanes[agent].motion();
                Motion::new(motion.path(), motion.profile(), S::from_f64(radii[agent]), S::ZERO).expect("a motion")
            })
        };
        for [a, b] in [[0.25, 0.5], [0.2, 0.4], [0.25, 0.3]] {
            let (right, wrong) = (fleet([a, b, a]), fleet([b, a, a]));
            let ecm = build_ecm(&right).expect("a small fleet");
            assert_eq!(ecm.row(&wrong, 0).err(), Some(MismatchError::OtherFleet), "{a} and {b} m");
        }
    }
    // A whole circle begins and ends at the same point whatever its heading.
    let circle = |heading: f64| {
        let start = Pose {
            position: Point::new(S::from_f64(5.0), S::from_f64(5.0)),
            heading: S::angle(heading).expect("an angle"),
        };
        let radius = S::from_f64(2.0);
        let path = Path::<S, 1>::starting_at(start)
            .and_then(|path| path.arc(radius, TurnSide::Left, S::Angle::circumference(radius)))
            .expect("a circle");
        let profile = Profile::<S, 3>::rest_to_rest(path.as_path().length(), limits).expect("a profile");
        (path, profile)
    };
    let circles = [0.0, 0.5, FRAC_PI_2, PI, -FRAC_PI_2].map(circle);
    let motions = circles.each_ref().map(|(path, profile)| {
        Motion::new(path.as_path(), profile.as_profile(), S::from_f64(0.25), S::ZERO).expect("a motion")
    });
    let other = Course::<S>::new(&Disc { radius: 0.25, start: [-5.0, 7.0, 0.0], legs: vec![Leg::Line(8.0)] });
    let other = other.expect("a valid disc");
    for (k, motion) in motions.iter().enumerate() {
        let fleet = [*motion, other.motion()];
        let ecm = build_ecm(&fleet).expect("a small fleet");
        for (l, stranger) in motions.iter().enumerate().filter(|&(l, _)| l != k) {
            assert_eq!(
                ecm.row(&[*stranger, fleet[1]], 0).err(),
                Some(MismatchError::OtherFleet),
                "circles {k} and {l}"
            );
            let always = Interval::new(-S::LIMIT, S::LIMIT);
            let found = first_conflict(stranger, ecm.row(&fleet, 0).expect("its fleet"), always);
            assert!(found.is_err() || ecm.is_empty(), "circles {k} and {l}: {found:?}");
        }
    }
}

#[test]
fn exchanged_numbers_and_turned_circles_are_another_fleet() {
    exchanged::<f64>();
    exchanged::<f32>();
    exchanged::<Q12>();
    exchanged::<Q16>();
    exchanged::<Q20>();
}

#[test]
fn the_row_of_one_agent_answers_for_that_one_only() {
    let fleet = twelve();
    let motions = fleet.motions();
    let full = build_ecm(&motions).expect("a small fleet");
    let mut row = Ecm::new(vec![EcmEntry::EMPTY; full.len()], vec![Piece::EMPTY; full.pieces()]);
    for agent in 0..12 {
        row.fill_row(&motions, agent).expect("enough room");
        let all = |ecm: &HostEcm<f64>| -> Vec<Entry> {
            ecm.row(&motions, agent).expect("its row").map(|region| entry(&region)).collect()
        };
        assert_eq!(all(&row), all(&full));
        for other in (0..12).filter(|&other| other != agent) {
            assert_eq!(row.row(&motions, other).err(), Some(MismatchError::OnlyRow(agent)));
            let pairs = [[agent, other], [other, agent]].map(|[a, b]| row.pair(&motions, a, b).map(Iterator::count));
            let expected = full.pair(&motions, agent, other).map(Iterator::count);
            assert_eq!(pairs, [expected; 2]);
            let third = (0..12).find(|&third| third != agent && third != other).expect("twelve");
            assert_eq!(row.pair(&motions, other, third).err(), Some(MismatchError::OnlyRow(agent)));
        }
        assert_eq!(row.regions(&motions).err(), Some(MismatchError::OnlyRow(agent)));
        assert_eq!(row.regions_once(&motions).err(), Some(MismatchError::OnlyRow(agent)));
        assert_eq!(row.insert(&motions, agent), Err(MismatchError::OnlyRow(agent).into()));
        assert!(row.remove(&motions, agent).is_err());
    }
    row.fill(&motions).expect("enough room");
    assert_eq!(entries(&row, &motions), entries(&full, &motions));
}

#[test]
fn an_agent_is_removed_and_inserted_once() {
    let fleet = twelve();
    let motions = fleet.motions();
    let full = entries(&build_ecm(&motions).expect("a small fleet"), &motions);
    for agent in 0..motions.len() {
        let mut ecm = build_ecm(&motions).expect("a small fleet");
        let all = (ecm.len(), ecm.pieces());
        let twice = Err(EcmError::Mismatch(MismatchError::OtherFleet));
        assert_eq!(ecm.insert(&motions, agent), twice, "it is there");
        ecm.remove(&motions, agent).expect("it is there");
        // A fleet of which it does not know an agent.
        assert_eq!(ecm.row(&motions, (agent + 1) % 12).err(), Some(MismatchError::OtherFleet));
        assert_eq!(ecm.remove(&motions, agent), Err(MismatchError::OtherFleet));
        let lost = full.iter().filter(|entry| entry.0[0] == agent).count();
        assert_eq!(ecm.len(), all.0 - lost);
        if agent == 11 {
            let kept: Vec<_> = full.iter().filter(|entry| !entry.0.contains(&agent)).copied().collect();
            assert_eq!(entries(&ecm, &motions[..11]), kept);
        }
        let other = (agent + 1) % 12;
        assert_eq!(ecm.insert(&motions, other), twice, "another one is missing");
        ecm.insert(&motions, agent).expect("there was room before");
        assert_eq!((entries(&ecm, &motions), (ecm.len(), ecm.pieces())), (full.clone(), all));
    }
}

#[test]
fn replacing_agents_equals_building_anew_without_losing_room() {
    const ROUNDS: u64 = 200;
    let fleet = twelve();
    let originals = fleet.motions();
    let detours: Vec<_> = (0..12).map(detour).collect();
    let mut motions = originals.clone();
    let (mut regions, mut pieces) = (0, 0);
    let choose = |round| {
        let mut dice = Dice::seeded(round);
        let agent = dice.below(12);
        (agent, if dice.chance(0.5) { detours[agent].motion() } else { originals[agent] })
    };
    // Room for the largest of the fleets on the way, and no more: a leaked slot would be missed.
    for round in 0..ROUNDS {
        let (agent, motion) = choose(round);
        motions[agent] = motion;
        let ecm = build_ecm(&motions).expect("a small fleet");
        (regions, pieces) = (regions.max(ecm.len()), pieces.max(ecm.pieces()));
    }
    let first = build_ecm(&originals).expect("a small fleet");
    (regions, pieces) = (regions.max(first.len()), pieces.max(first.pieces()));
    let mut motions = originals.clone();
    let mut ecm =
        Ecm::build(vec![EcmEntry::EMPTY; regions], vec![Piece::EMPTY; pieces], &motions).expect("enough room");
    for round in 0..ROUNDS {
        let (agent, motion) = choose(round);
        ecm.replace(&mut motions, agent, motion).expect("enough room");
        if cfg!(not(optimized)) && round % 10 != 0 {
            continue;
        }
        let fresh = build_ecm(&motions).expect("a small fleet");
        assert_eq!(entries(&ecm, &motions), entries(&fresh, &motions), "after round {round}");
        assert_eq!((ecm.len(), ecm.pieces()), (fresh.len(), fresh.pieces()));
    }
}

#[test]
fn a_table_that_is_exactly_full_is_built_and_a_smaller_one_is_refused() {
    let fleet = twelve();
    let motions = &fleet.motions()[..6];
    let (tight, regions, pieces) = exact(motions);
    let roomy = build_ecm(motions).expect("a small fleet");
    assert_eq!(entries(&tight, motions), entries(&roomy, motions));
    for room in 0..regions {
        let outcome = Ecm::build(vec![EcmEntry::EMPTY; room], vec![Piece::EMPTY; pieces], motions);
        let full = CapacityError::Regions { needed: room + 1, capacity: room };
        assert_eq!(outcome.err(), Some(full), "{room} of {regions} regions");
    }
    for room in 0..pieces {
        let outcome = Ecm::build(vec![EcmEntry::EMPTY; regions], vec![Piece::EMPTY; room], motions);
        let full = CapacityError::Pieces { needed: room + 1, capacity: room };
        assert_eq!(outcome.err(), Some(full), "{room} of {pieces} pieces");
    }
}

#[test]
fn a_table_that_is_too_small_counts_what_the_fleet_needs() {
    let fleet = twelve();
    let motions = fleet.motions();
    let (_, regions, pieces) = exact(&motions);
    let most = (0..12).flat_map(|first| (0..first).map(move |second| [first, second]));
    let most = most.map(|[first, second]| exact(&[motions[first], motions[second]]).2).max().expect("a pair");
    assert!(most < pieces, "a pair with {most} of {pieces} pieces");
    let counted = Ok(EcmCapacity { regions, pieces });
    let mut ecm = Ecm::new([EcmEntry::EMPTY; 0], vec![Piece::EMPTY; most]);
    assert_eq!(ecm.needed(&motions), counted);
    // It is empty and can be used; a table that had regions counts as well.
    assert!(ecm.is_empty() && ecm.pieces() == 0);
    assert_eq!(exact(&motions).0.needed(&motions), counted);
    let mut short = Ecm::new([EcmEntry::EMPTY; 0], vec![Piece::EMPTY; most - 1]);
    assert_eq!(short.needed(&motions), Err(CapacityError::Pieces { needed: most, capacity: most - 1 }));
    assert_eq!(Ecm::<f64, _, _>::new([], []).needed(&motions[..1]), Ok(EcmCapacity::default()));
}

#[test]
fn an_agent_that_does_not_fit_leaves_the_table_as_it_was() {
    let fleet = twelve();
    let motions = &fleet.motions()[..6];
    let (_, regions, pieces) = exact(motions);
    let others = &motions[..5];
    let (_, least_regions, least_pieces) = exact(others);
    for (room, space) in (least_regions..=regions)
        .map(|room| (room, pieces))
        .chain((least_pieces..=pieces).map(|space| (regions, space)))
    {
        let storage = (vec![EcmEntry::EMPTY; room], vec![Piece::EMPTY; space]);
        let mut ecm = Ecm::build(storage.0, storage.1, others).expect("room for the others");
        let before = entries(&ecm, others);
        let outcome = ecm.insert(motions, 5);
        if room == regions && space == pieces {
            assert_eq!(outcome, Ok(()));
            continue;
        }
        let full = if room < regions {
            CapacityError::Regions { needed: room + 1, capacity: room }
        } else {
            CapacityError::Pieces { needed: space + 1, capacity: space }
        };
        assert_eq!(outcome, Err(EcmError::Full(full)));
        assert_eq!(entries(&ecm, others), before, "{room} regions, {space} pieces");
        // And it still works: what was given back is free again.
        ecm.remove(others, 4).expect("it is there");
        ecm.insert(others, 4).expect("it fitted before");
        assert_eq!(entries(&ecm, others), before);
    }
}

#[test]
fn a_replacement_that_does_not_fit_leaves_table_and_fleet_as_they_were() {
    let fleet = twelve();
    let detours: Vec<_> = (0..12).map(detour).collect();
    let mut refused = 0;
    for (agent, course) in detours.iter().enumerate() {
        let mut motions = fleet.motions();
        let (mut ecm, regions, pieces) = exact(&motions);
        let before = entries(&ecm, &motions);
        let start = motions[agent].path().point_at(0.0);
        match ecm.replace(&mut motions, agent, course.motion()) {
            Ok(()) => {
                let fresh = build_ecm(&motions).expect("a small fleet");
                assert_eq!(entries(&ecm, &motions), entries(&fresh, &motions));
                assert!(ecm.len() <= regions && ecm.pieces() <= pieces);
            }
            Err(_) => {
                refused += 1;
                assert_eq!(motions[agent].path().point_at(0.0), start);
                assert_eq!(entries(&ecm, &motions), before);
            }
        }
    }
    assert!(refused > 0, "no detour is too much for a full table");
}

#[test]
fn a_delay_needs_no_change_of_the_table() {
    let fleet = twelve();
    let mut motions = fleet.motions();
    let ecm = build_ecm(&motions).expect("a small fleet");
    let before = entries(&ecm, &motions);
    motions[3] = motions[3].delayed(4.0).expect("a small delay");
    let fresh = build_ecm(&motions).expect("a small fleet");
    let after = entries(&ecm, &motions);
    assert_eq!(after, entries(&fresh, &motions));
    for (early, late) in before.iter().zip(&after) {
        // Only who looks at the delayed agent sees it later.
        let shift = if early.0[1] == 3 { 4.0 } else { 0.0 };
        assert!((late.1[0].lo - early.1[0].lo - shift).abs() < 1e-12);
        assert!((late.1[0].hi - early.1[0].hi - shift).abs() < 1e-12);
        assert_eq!((early.0, early.1[1], early.1[2]), (late.0, late.1[1], late.1[2]));
    }
}

#[test]
fn storage_may_be_arrays_slices_or_vectors() {
    let fleet = twelve();
    let motions = &fleet.motions()[..2];
    let on_heap = build_ecm(motions).expect("a small fleet");
    let in_arrays = Ecm::build([EcmEntry::EMPTY; 16], [Piece::EMPTY; 32], motions).expect("enough room");
    let (mut regions, mut pieces) = ([EcmEntry::EMPTY; 16], [Piece::EMPTY; 32]);
    let borrowed = Ecm::build(&mut regions[..], &mut pieces[..], motions).expect("enough room");
    assert_eq!(entries(&on_heap, motions), entries(&in_arrays, motions));
    assert_eq!(entries(&on_heap, motions), entries(&borrowed, motions));
}

#[test]
fn a_table_that_grows_agent_by_agent_is_that_of_the_fleet() {
    let fleet = twelve();
    let motions = fleet.motions();
    let mut table: HostEcm<f64> = Ecm::new(Vec::new(), Vec::new());
    for agent in 0..motions.len() {
        let known = &motions[..=agent];
        while let Err(error) = table.insert(known, agent) {
            let EcmError::Full(full) = error else { panic!("{error}") };
            table.grow(full).expect("more room helps");
        }
    }
    assert_eq!(entries(&table, &motions), entries(&build_ecm(&motions).expect("a small fleet"), &motions));
    // What no storage helps comes back as it was.
    assert_eq!(table.grow(CapacityError::Pair([3, 4])), Err(CapacityError::Pair([3, 4])));
    assert_eq!(entries(&table, &motions).len(), 2 * table.len());
}

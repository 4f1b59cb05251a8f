//! The broad phase of fleets: it leaves out no contact, tells what pairs one by one tell, and does leave out most of the rest.
//! `conflicts.rs` holds its contacts to the oracle.

use pcr_core::scalar::Micro;
use pcr_core::{Aabb, BroadPhase, CapacityError, Encounter, Interval, MismatchError, Motion};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, HostScalar};
use pcr_tests::disc::Course;
use pcr_tests::generators::Dice;
use pcr_tests::oracle::contact::Meeting;
use pcr_tests::plans::fleet;

fn boxes<S: HostScalar>(fleet: &[Motion<'_, S>], parts: usize) -> Vec<Aabb<S>> {
    vec![Aabb::default(); fleet.len() * (1 + parts)]
}

/// At no time at which two discs overlap their pair is left out, nor as long as both stand before and after.
fn leaves_out_no_contact<S: HostScalar>(seeds: u64) {
    let (mut overlaps, mut left_out) = (0, 0);
    for seed in 0..seeds {
        let dice = &mut Dice::seeded(seed);
        let Some(courses) = fleet(dice).iter().map(Course::<S>::rounded).collect::<Option<Vec<_>>>() else { continue };
        let motions: Vec<Motion<'_, S>> = courses.iter().map(|(course, _)| course.motion()).collect();
        let one = S::from_f64(1.0);
        let Interval { lo, hi } = Motion::span(&motions);
        let during = Interval::new(lo - one, hi + one);
        let broad_phase = BroadPhase::new(boxes(&motions, 1 << dice.below(6)), &motions, during).unwrap();
        let candidates: Vec<_> = broad_phase.candidates().collect();
        assert!(candidates.is_sorted_by(|a, b| (a.0, a.1.hi) < (b.0, b.1.lo)), "seed {seed}: {candidates:?}");
        for (second, (_, other)) in courses.iter().enumerate() {
            for (first, (_, own)) in courses[..second].iter().enumerate() {
                let truth = Meeting::new(own, other);
                let mut own_candidates = candidates.iter().filter(|candidate| candidate.0 == [first, second]);
                for k in 0..=200 {
                    let (lo, hi) = (during.lo.to_f64(), during.hi.to_f64());
                    let time = (lo + (hi - lo) * f64::from(k) / 200.0).min(hi);
                    let told =
                        own_candidates.clone().any(|(_, run)| run.lo.to_f64() <= time && time <= run.hi.to_f64());
                    let overlap = truth.clearance(time) <= 0.0;
                    assert!(told || !overlap, "seed {seed}: {first} and {second} at {time}");
                    overlaps += u32::from(overlap);
                    left_out += u32::from(!told);
                }
                assert!(own_candidates.all(|(_, run)| during.lo <= run.lo && run.lo < run.hi && run.hi <= during.hi));
            }
        }
    }
    assert!(overlaps > 100 && left_out > overlaps, "{overlaps} overlaps, {left_out} left out");
}

const SEEDS: u64 = if cfg!(optimized) { 1_000 } else { 50 };

#[test]
fn no_contact_is_left_out_in_floating_point() {
    leaves_out_no_contact::<f64>(SEEDS);
    leaves_out_no_contact::<f32>(SEEDS);
    leaves_out_no_contact::<Micro>(SEEDS);
}

#[test]
fn no_contact_is_left_out_in_fixed_point() {
    leaves_out_no_contact::<Q12>(SEEDS);
    leaves_out_no_contact::<Q16>(SEEDS);
    leaves_out_no_contact::<Q20>(SEEDS);
}

/// The contacts of each pair, one by one.
fn one_by_one(fleet: &[Motion<'_, f64>], during: Interval<f64>) -> Vec<([usize; 2], Interval<f64>)> {
    let pairs = (0..fleet.len()).flat_map(|first| (first + 1..fleet.len()).map(move |second| [first, second]));
    let contacts = |agents: [usize; 2]| {
        let encounter = Encounter::new(&fleet[agents[0]], &fleet[agents[1]]);
        encounter.contacts(during).map(move |time| (agents, time))
    };
    pairs.flat_map(contacts).collect()
}

#[test]
fn a_fleet_has_the_contacts_of_its_pairs_however_many_the_parts() {
    for (json, contacts, most) in
        [(include_str!("../data/paper12.json"), 9, 66), (include_str!("../data/table6-100.json"), 258, 4950)]
    {
        let fleet = Fleet::<f64>::new(&Scenario::from_json(json).unwrap()).unwrap();
        let motions = fleet.motions();
        let time = Motion::span(&motions);
        let known = one_by_one(&motions, time);
        assert_eq!(known.len(), contacts);
        let mut candidates = most + 1;
        for parts in [1, 2, 4, 8, 16, 32] {
            let broad_phase = BroadPhase::new(boxes(&motions, parts), &motions, time).unwrap();
            assert_eq!(broad_phase.parts() as usize, parts);
            let found: Vec<_> = broad_phase.contacts().collect();
            assert_eq!(found.len(), known.len());
            for ((agents, found), (pair, known)) in found.iter().zip(&known) {
                assert!(agents == pair && found.meets(*known), "{agents:?} {found:?} is not {pair:?} {known:?}");
                // Either tells a time at which the discs are apart by the tolerance at most.
                let [one, other] = pair.map(|agent| &motions[agent]);
                let apart = |time| (one.position_at(time) - other.position_at(time)).norm_squared().sqrt();
                for (found, known) in [(found.lo, known.lo), (found.hi, known.hi)] {
                    let off = (apart(found) - apart(known)).abs();
                    assert!(off <= 2.0 * Encounter::new(one, other).tolerance(), "{pair:?}: {off} at {found}");
                }
            }
            // In any order.
            let mut shared: Vec<_> = broad_phase.candidates().collect();
            shared.reverse();
            let mut shared: Vec<_> = shared
                .into_iter()
                .flat_map(|(agents, time)| broad_phase.contacts_of(agents, time).expect("agents of the fleet"))
                .collect();
            shared.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.lo.total_cmp(&b.1.lo)));
            assert_eq!(shared, found);
            let stranger = broad_phase.contacts_of([0, motions.len()], time).err();
            assert_eq!(stranger, Some(MismatchError::NoSuchAgent(motions.len())));
            // The more parts, the fewer pairs are left.
            let before = std::mem::replace(&mut candidates, pairs_of(&broad_phase));
            assert!(candidates <= before && (parts < 16 || candidates < most / 2), "{candidates} of {most} at {parts}");
        }
    }
}

/// Pairs that may be in contact.
fn pairs_of<B: AsRef<[Aabb<f64>]>>(broad_phase: &BroadPhase<'_, f64, B>) -> usize {
    let mut pairs: Vec<_> = broad_phase.candidates().map(|(agents, _)| agents).collect();
    pairs.dedup();
    pairs.len()
}

#[test]
fn a_moment_has_the_contacts_of_that_moment() {
    let fleet = Fleet::<f64>::new(&Scenario::from_json(include_str!("../data/paper12.json")).unwrap()).unwrap();
    let motions = fleet.motions();
    let (agents, contact) = one_by_one(&motions, Motion::span(&motions))[0];
    for (moment, there) in [(contact.middle(), true), (contact.hi + 1e-3, false)] {
        let during = Interval::new(moment, moment);
        let broad_phase = BroadPhase::new(boxes(&motions, 4), &motions, during).unwrap();
        assert_eq!(broad_phase.contacts().any(|(pair, time)| pair == agents && time == during), there);
    }
}

#[test]
fn room_for_less_than_two_boxes_an_agent_is_refused() {
    let fleet = Fleet::<f64>::new(&Scenario::from_json(include_str!("../data/paper12.json")).unwrap()).unwrap();
    let motions = fleet.motions();
    let refused = BroadPhase::new(vec![Aabb::default(); 23], &motions, Motion::span(&motions));
    assert_eq!(refused.err(), Some(CapacityError::Boxes { needed: 24, capacity: 23 }));
    assert_eq!(BroadPhase::new(vec![Aabb::default(); 24], &motions, Motion::span(&motions)).unwrap().parts(), 1);
    let nobody = BroadPhase::<f64, _>::new([], &[], Interval::default()).unwrap();
    assert_eq!((nobody.candidates().count(), nobody.contacts().count()), (0, 0));
    let alone = BroadPhase::new(vec![Aabb::default(); 2], &motions[..1], Motion::span(&motions)).unwrap();
    assert_eq!(alone.candidates().count(), 0);
}

//! Proofs of outlines: of random fleets in every format, and of what was changed.

use super::*;
use crate::check::{CheckReport, ConflictEntry};
use crate::fleet::HostScalar;
use crate::outline_judge::{Course, Outline, TRUCK, agent, line, read};
use crate::regions::{RegionOptions, RegionsReport, table_of};
use pcr_certify::outline::RawOutlineTable;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::Scenario;
use pcr_formats::splitmix64::SplitMix64;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};

fn random_fleet(dice: &mut SplitMix64) -> Scenario {
    let agents: Vec<Value> = (1..=4).map(|id| Course::random(dice, 2.0).agent(id, &Outline::random(dice))).collect();
    read(&agents)
}

/// Two trucks that cross, and a disc beside them.
fn crossing() -> Scenario {
    let truck = Outline::polygon(&TRUCK);
    let disc = Outline { corners: vec![[0.0; 2]], radius: 0.3 };
    read(&[
        agent(1, &truck, [-4.0, 0.0, 0.0], &[line(8.0)]),
        agent(2, &truck, [0.0, -4.0, FRAC_PI_2], &[line(8.0)]),
        agent(3, &disc, [4.0, 0.5, PI], &[line(8.0)]),
    ])
}

fn table<S: HostScalar>(scenario: &Scenario) -> RawOutlineTable {
    let tables = table_of::<S>(scenario).expect("tables");
    tables.into_iter().next().and_then(CertificateTable::outlines).expect("a table of outlines")
}

fn verdict(table: RawOutlineTable) -> Option<&'static str> {
    CertifyReport::prove("", &table.into(), false).verdict
}

/// Joints of less than a hundredth of a radian are passed without a stop, some by less than a format can tell.
#[test]
fn small_turns_on_the_way_are_proved_in_every_format() {
    fn all<S: HostScalar>() {
        let truck = Outline::polygon(&TRUCK);
        for sweep in [1e-10, 1e-7, 4e-5, 1e-4, -1e-3, 0.01] {
            let kink = json!({ "kind": "arc", "radius": 1e-9, "sweep": sweep });
            let path = [line(2.0), kink.clone(), line(1.0), kink, line(2.0)];
            let mut bent = agent(1, &truck, [-4.0, 0.0, 0.0], &path);
            let turned = 2.0 * 1e-9 * f64::abs(sweep);
            bent["profile"] = json!({ "v0": 0.5, "pieces": [{ "duration": (5.0 + turned) / 0.5, "accel": 0.0 }] });
            let scenario = read(&[bent, agent(2, &truck, [0.0, -4.0, FRAC_PI_2], &[line(8.0)])]);
            for table in table_of::<S>(&scenario).unwrap_or_else(|refused| panic!("{} {sweep}: {refused}", S::NAME)) {
                let certified = CertifyReport::prove("bent", &table, false);
                assert_eq!(certified.verdict, Some("proved"), "{} {sweep}: {certified:?}", S::NAME);
            }
        }
    }
    all::<f64>();
    all::<f32>();
    all::<Q20>();
    all::<Q16>();
    all::<Q12>();
}

#[test]
fn tables_of_random_outlines_are_proved_in_every_format() {
    fn all<S: HostScalar>() {
        let (mut dice, mut pieces, mut outlines, mut undecided) = (SplitMix64(1056), 0, 0, 0);
        for number in 0..10 {
            let scenario = random_fleet(&mut dice);
            for table in table_of::<S>(&scenario).expect("tables") {
                let certified = CertifyReport::prove("random", &table, false);
                // Rounding of the checker may leave open where a region ends.
                let is_known =
                    certified.refuted.is_empty() && certified.error.is_none() && certified.undecided.len() <= 2;
                assert!(is_known, "{} {number}: {certified:?}", S::NAME);
                undecided += usize::from(certified.verdict == Some("undecided"));
                (pieces, outlines) = (pieces + certified.pieces, outlines + certified.outlines);
            }
            // The motions have the contacts that the check finds; whether those that only touch do depends on rounding.
            let (proof, check) =
                (MotionCertificate::prove::<S>(&scenario), CheckReport::compute::<S>(&scenario, false));
            let (proof, check) = (proof.expect("it fits"), check.expect("it fits"));
            assert_eq!(proof.error, None);
            let met: Vec<[u64; 2]> =
                proof.contacts.iter().map(|found| [found.i.min(found.j), found.i.max(found.j)]).collect();
            let found = |pair: &[u64; 2]| check.conflicts.iter().any(|found| [found.i, found.j] == *pair);
            assert!(met.iter().all(found), "{} {number}: {met:?}", S::NAME);
            let is_deep = |found: &&ConflictEntry| !found.touching;
            let mut deep = check.conflicts.iter().filter(is_deep).map(|found| [found.i, found.j]);
            assert!(deep.all(|pair| met.contains(&pair)), "{} {number}: {met:?}", S::NAME);
        }
        println!("{}: {undecided} of 10 undecided", S::NAME);
        assert!(pieces > 40 && outlines > 20 && undecided <= 1, "{}: {pieces} {outlines} {undecided}", S::NAME);
    }
    all::<f64>();
    all::<f32>();
    all::<Q20>();
    all::<Q16>();
    all::<Q12>();
}

#[test]
fn what_is_removed_from_a_table_of_outlines_is_missed() {
    let whole = table::<f64>(&crossing());
    assert_eq!(verdict(whole.clone()), Some("proved"));
    let mut removed = 0;
    for place in 0..whole.pairs.len() {
        let pair = &whole.pairs[place];
        for region in 0..pair.regions.len() {
            // The region with all its pieces.
            let mut other = whole.clone();
            let changed = &mut other.pairs[place];
            changed.regions.remove(region);
            changed.pieces.retain(|piece| piece.region != region);
            changed.pieces.iter_mut().for_each(|piece| piece.region -= usize::from(piece.region > region));
            assert_eq!(verdict(other), Some("refuted"), "pair {place} without region {region}");
            removed += 1;
        }
        for piece in 0..pair.pieces.len() {
            let mut other = whole.clone();
            let [own, _] = &mut other.pairs[place].pieces[piece].lengths;
            own[0] = own[0].midpoint(own[1]);
            let changed = CertifyReport::prove("", &other.into(), false);
            // A region is the hull of its pieces: if the piece is its only one, the table contradicts itself.
            assert_ne!(changed.verdict, Some("proved"), "pair {place} without a part of piece {piece}");
            removed += 1;
        }
    }
    assert!(removed > 3, "{removed}");
    // Outlines that are larger than those that were computed with.
    let mut wider = whole.clone();
    wider.bodies[0].outline.radius += 1e-3;
    assert_eq!(verdict(wider), Some("refuted"));
    // And smaller ones: what is told is no contact.
    let mut smaller = whole;
    smaller.bodies[0].outline.corners.iter_mut().flatten().for_each(|x| *x *= 0.9);
    assert_eq!(verdict(smaller), Some("refuted"));
}

#[test]
fn a_table_of_outlines_is_read_as_it_was_written_and_compared_with_its_regions() {
    let mut scenario = crossing();
    scenario.agents[0].margin = 0.1;
    let request = RegionOptions { certificate: true, ..RegionOptions::default() };
    let answer = RegionsReport::compute::<f64>(&scenario, request).expect("an answer");
    assert!(answer.bodies.is_empty());
    let value = serde_json::to_value(&answer).expect("JSON");
    let dump = CertifyInput::of_json(&value.to_string()).expect("a certificate");
    assert_eq!(Some(&dump.certificate), answer.certificate.as_ref());
    for table in &dump.certificate {
        let certified = CertifyReport::prove(&dump.name, table, true);
        assert_eq!((certified.verdict, certified.discs, certified.outlines), (Some("proved"), 1, 2));
        assert!(certified.margin.is_some_and(|margin| margin >= 0.25), "{certified:?}");
    }
    let refused = |pointer: &str, to: Value| {
        let mut other = value.clone();
        *other.pointer_mut(pointer).expect(pointer) = to;
        CertifyInput::of_json(&other.to_string()).expect_err(pointer).to_string()
    };
    let why = refused("/regions/0/t/0", json!(0.5));
    assert!(why.starts_with("regions[0], of agents 1 and 2: t is [0.5, "), "{why}");
    let why = refused("/certificate/1/bodies/0/outline/corners/0/0", json!(-0.7));
    assert_eq!(why, "certificate: bodies[0] of the two tables differ: outline");
    let why = refused("/certificate/1/bodies/0/outline/radius", json!(-0.1));
    assert!(why.contains("radius, which is smaller with the margin"), "{why}");
}

#[test]
fn motions_that_were_changed_have_contacts() {
    let mut scenario = crossing();
    scenario.agents.truncate(2);
    assert_eq!(MotionCertificate::prove::<f64>(&scenario).expect("it fits").verdict, "contact");
    scenario.agents[1].t_start = 2.001;
    let proof = MotionCertificate::prove::<f64>(&scenario).expect("it fits");
    assert_eq!((proof.verdict, proof.outlines, proof.pairs), ("proved", 2, 1));
    scenario.agents[1].t_start = 1.999;
    let proof = MotionCertificate::prove::<f64>(&scenario).expect("it fits");
    assert_eq!((proof.verdict, proof.contacts.len()), ("contact", 1));
    let certified = CheckReport::certified::<f64>(&scenario, true, &|_, _| {}).expect("an answer");
    assert!(certified.bodies.is_empty() && certified.conflicts.len() == 1);
    assert_eq!(certified.certificate.map(|proof| proof.outlines), Some(2));
}

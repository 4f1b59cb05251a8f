//! The reference regions (`data/README.md`): every one is found, none is invented, in `f64`.

use pcr_core::{Motion, RegionRef};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, HostEcm, build_ecm};
use pcr_tests::disc::{Disc, Drive};
use pcr_tests::oracle::{Pair, Travel};
use pcr_tests::reference::{Component, Regions, cases, fleets};

/// Largest difference of a time \[s\] or length \[m\]: the reference is good to 1e-10, and the slack moves the ends of an overlap of a
/// micrometre by 1.6e-9.
const TOLERANCE: f64 = 2e-9;

/// A contact of an uncertain case is closer to critical than this \[m\]; slices there may differ by as much clearance.
const UNCERTAIN: f64 = 1e-8;

fn with_table<T>(scenario: &Scenario, check: impl FnOnce(&[Motion<'_, f64>], &HostEcm<f64>) -> T) -> T {
    let fleet = Fleet::<f64>::new(scenario).expect("a valid fleet");
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).expect("a small fleet");
    check(&motions, &ecm)
}

fn differences(got: [[f64; 2]; 2], want: &Component) -> f64 {
    let ends = |pair: [[f64; 2]; 2]| pair.into_iter().flatten();
    ends(got).zip(ends([want.time, want.length])).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// What is wrong with the regions of an ordered pair.
fn problems(regions: &[RegionRef<'_, f64>], want: &Regions) -> Vec<String> {
    let ranges = |region: &RegionRef<'_, f64>| {
        let (time, length) = (region.time(), region.length());
        [[time.lo, time.hi], [length.lo, length.hi]]
    };
    if regions.len() != want.components.len() {
        return vec![format!("{} regions, reference {}", regions.len(), want.components.len())];
    }
    let mut problems = Vec::new();
    let mut rest: Vec<_> = regions.iter().collect();
    for component in &want.components {
        let distance = |region: &&RegionRef<'_, f64>| differences(ranges(region), component);
        let nearest = (0..rest.len()).min_by(|&a, &b| distance(&rest[a]).total_cmp(&distance(&rest[b])));
        let region = rest.remove(nearest.expect("as many regions as components"));
        if distance(&region) > TOLERANCE {
            problems.push(format!("{:?}, reference {:?} {:?}", ranges(region), component.time, component.length));
        }
        for (time, section) in &component.sections {
            let slices: Vec<_> = region.slice_at(*time).collect();
            let near = |(slice, want): (&pcr_core::Interval<f64>, &[f64; 2])| {
                (slice.lo - want[0]).abs() <= TOLERANCE && (slice.hi - want[1]).abs() <= TOLERANCE
            };
            if slices.len() != section.len() || !slices.iter().zip(section).all(near) {
                problems.push(format!("at {time}: {slices:?}, reference {section:?}"));
            }
        }
    }
    problems
}

fn assert_none(problems: &[String]) {
    assert!(problems.is_empty(), "{} problems:\n{}", problems.len(), problems.join("\n"));
}

#[test]
fn every_pair_has_the_reference_regions() {
    let cases = cases();
    let mut found = Vec::new();
    for case in cases.iter().filter(|case| !case.regions.uncertain) {
        with_table(&case.scenario, |motions, ecm| {
            let regions: Vec<_> = ecm.pair(motions, 0, 1).expect("the table of the fleet").collect();
            found.extend(problems(&regions, &case.regions).into_iter().map(|p| format!("{}: {p}", case.name)));
        });
    }
    assert_eq!(cases.len(), 304, "the reference file is complete");
    assert_none(&found);
}

#[test]
fn every_pair_has_them_from_the_other_side_of_the_table() {
    // The agents in the other order: the same regions are then read through the transposed view.
    let mut found = Vec::new();
    for mut case in cases().into_iter().filter(|case| !case.regions.uncertain) {
        case.scenario.agents.reverse();
        with_table(&case.scenario, |motions, ecm| {
            let regions: Vec<_> = ecm.pair(motions, 1, 0).expect("the table of the fleet").collect();
            found.extend(problems(&regions, &case.regions).into_iter().map(|p| format!("{}: {p}", case.name)));
        });
    }
    assert_none(&found);
}

#[test]
fn fleets_have_the_reference_regions_and_no_others() {
    let mut found = Vec::new();
    for fleet in fleets() {
        let place = |id| fleet.scenario.agents.iter().position(|agent| agent.id == id).expect("an id of the fleet");
        with_table(&fleet.scenario, |motions, ecm| {
            let mut expected = 0;
            for (i, j, regions) in &fleet.pairs {
                let got: Vec<_> = ecm.pair(motions, place(*i), place(*j)).expect("the table of the fleet").collect();
                expected += got.len();
                if !regions.uncertain {
                    found.extend(problems(&got, regions).into_iter().map(|p| format!("{i} sees {j}: {p}")));
                }
            }
            // Both directions of every pair are listed, so that nothing else may be in the table.
            assert_eq!(
                ecm.regions(motions).expect("the table of the fleet").count(),
                expected,
                "regions of pairs that are not listed"
            );
        });
    }
    assert_none(&found);
}

#[test]
fn uncertain_pairs_are_covered_and_not_exceeded() {
    let mut seen = 0;
    for case in cases().iter().filter(|case| case.regions.uncertain) {
        seen += 1;
        let [ego, other] = [0, 1].map(|k| Disc::of_agent(&case.scenario.agents[k]));
        let pair = Pair::new(&ego, &other);
        with_table(&case.scenario, |motions, ecm| {
            let regions: Vec<_> = ecm.pair(motions, 0, 1).expect("the table of the fleet").collect();
            for (time, section) in case.regions.components.iter().flat_map(|component| &component.sections) {
                for &[lo, hi] in section {
                    for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                        let length = lo + part * (hi - lo);
                        let s = motions[1].length_at(*time);
                        let covered = regions.iter().any(|region| region.contains(*time, length));
                        // The ends of a reference section are rounded.
                        assert!(
                            covered || pair.clearance(s, length) > -TOLERANCE,
                            "{}: ({time}, {length}) is not covered",
                            case.name
                        );
                    }
                }
            }
            for region in &regions {
                let time = region.time();
                for k in 0..=16 {
                    let t = time.lo + (time.hi - time.lo) * f64::from(k) / 16.0;
                    for slice in region.slice_at(t) {
                        let clearance = pair.clearance(motions[1].length_at(t), slice.middle());
                        assert!(clearance <= UNCERTAIN, "{}: {clearance:e} clear at {t}", case.name);
                    }
                }
            }
        });
    }
    assert_eq!(seen, 4);
}

#[test]
fn both_views_agree_with_the_definition() {
    const STEPS: u32 = if cfg!(optimized) { 40 } else { 12 };
    for case in cases() {
        let agents = &case.scenario.agents;
        let discs = [0, 1].map(|k| Disc::of_agent(&agents[k]));
        let travels = [0, 1].map(|k| Travel::new(&Drive::of_agent(&agents[k]), discs[k].length(), agents[k].t_start));
        with_table(&case.scenario, |motions, ecm| {
            for (ego, other) in [(0, 1), (1, 0)] {
                let pair = Pair::new(&discs[ego], &discs[other]);
                let regions: Vec<_> = ecm.pair(motions, ego, other).expect("the table of the fleet").collect();
                let (start, end) = travels[other].time();
                for k in 0..=STEPS {
                    let time = start + (end - start) * f64::from(k) / f64::from(STEPS);
                    let s = travels[other].length_at(time);
                    for m in 0..=STEPS {
                        let whole = motions[ego].path().length();
                        let length = (whole * f64::from(m) / f64::from(STEPS)).min(whole);
                        let clearance = pair.clearance(s, length);
                        let holding = regions.iter().filter(|region| region.contains(time, length)).count();
                        let right = clearance.abs() < UNCERTAIN || holding == usize::from(clearance < 0.0);
                        assert!(right, "{}: ({time}, {length}) is in {holding}, {clearance:e} clear", case.name);
                    }
                }
            }
        });
    }
}

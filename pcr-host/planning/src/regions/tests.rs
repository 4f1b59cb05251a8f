//! Regions and conflicts of outlines, compared with polygons at many times and lengths.

use crate::check::CheckReport;
use crate::fleet::HostScalar;
use crate::outline_judge::{Course, FORK, HEXAGON, Outline, Point, TRUCK, agent, line, read, within};
use crate::regions::{RegionEntry, RegionOptions, RegionsReport};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::plane_geometry::distance;
use pcr_formats::scenario::Scenario;
use pcr_formats::splitmix64::SplitMix64;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// Two agents, in all ways in which they are described here.
struct Case {
    scenario: Scenario,
    outlines: [Outline; 2],
    courses: [Course; 2],
}

impl Case {
    fn new(outlines: [Outline; 2], courses: [Course; 2]) -> Self {
        let agents = [0, 1].map(|k| courses[k].agent(k as u64 + 1, &outlines[k]));
        Self { scenario: read(&agents), outlines, courses }
    }

    fn random(dice: &mut SplitMix64) -> Self {
        let outlines = [Outline::random(dice), Outline::polygon(&TRUCK)];
        let courses = [Course::random(dice, 1.5), Course::random(dice, 1.5)];
        Self::new(outlines, courses)
    }

    /// The two at lengths, smaller by a distance.
    fn apart(&self, lengths: [f64; 2], smaller: f64) -> f64 {
        let [a, b] = [0, 1].map(|k| self.outlines[k].smaller(smaller).at(self.courses[k].at(lengths[k])));
        a.apart(&b)
    }

    /// Compares regions and conflicts with the outlines; numbers of the format, and where agents are because of them, differ by up
    /// to `digits` \[m\]. Returns how many points were in contact, and how many were not.
    fn compare<S: HostScalar>(&self, digits: f64) -> [usize; 2] {
        let request = RegionOptions { slices: Some(9), ..RegionOptions::default() };
        let answer = RegionsReport::compute::<S>(&self.scenario, request).unwrap();
        assert!(answer.bodies.is_empty(), "{}: {:?}", S::NAME, answer.bodies);
        let mut counts = [0; 2];
        for own in [0, 1] {
            let regions: Vec<&RegionEntry> =
                answer.regions.iter().filter(|region| region.i == own as u64 + 1).collect();
            self.compare_slices::<S>(own, &regions, digits, &mut counts);
            let other = &self.courses[1 - own];
            for (t, l) in self.grid(own, 40) {
                let there = |region: &&RegionEntry| {
                    (region.open_start || t >= region.t[0])
                        && (region.open_end || t <= region.t[1])
                        && within([region.l[0] - digits, region.l[1] + digits], l)
                };
                let lengths = if own == 0 { [l, other.after(t)] } else { [other.after(t), l] };
                assert!(
                    regions.iter().any(there) || self.apart(lengths, digits) > 0.0,
                    "{}: agent {own} t {t} l {l}: no region",
                    S::NAME
                );
            }
        }
        self.compare_conflicts::<S>(digits);
        counts
    }

    /// Times of the other and lengths of the own agent, evenly spaced.
    fn grid(&self, own: usize, steps: u32) -> impl Iterator<Item = (f64, f64)> {
        let (end, length) = (self.courses[1 - own].duration(), self.courses[own].length());
        let at = move |k: u32, all: f64| all * f64::from(k) / f64::from(steps);
        (0..=steps).flat_map(move |k| (0..=steps).map(move |l| (at(k, end), at(l, length))))
    }

    fn compare_slices<S: HostScalar>(
        &self,
        own: usize,
        regions: &[&RegionEntry],
        digits: f64,
        counts: &mut [usize; 2],
    ) {
        let length = self.courses[own].length();
        for region in regions {
            for slice in region.slices.iter().flatten() {
                let there = self.courses[1 - own].after(slice.t);
                let lengths = |l: f64| if own == 0 { [l, there] } else { [there, l] };
                // Both ends of the intervals and their middles are in contact.
                for [lo, hi] in &slice.l {
                    for l in [*lo, 0.5 * (lo + hi), *hi] {
                        let apart = self.apart(lengths(l), 0.0);
                        assert!(apart <= digits, "{}: agent {own} t {} l {l}: {apart}", S::NAME, slice.t);
                    }
                }
                for k in 0..=60 {
                    let l = length * f64::from(k) / 60.0;
                    let covered = slice.l.iter().any(|[lo, hi]| within([lo - digits, hi + digits], l));
                    // What no other region may hold is in this one.
                    let alone =
                        regions.iter().all(|other| other == region || !within(other.t, slice.t) || !within(other.l, l));
                    let apart = self.apart(lengths(l), digits);
                    assert!(covered || apart > 0.0 || !alone, "{}: agent {own} t {} l {l}: lost", S::NAME, slice.t);
                    counts[usize::from(apart > 0.0)] += 1;
                }
            }
        }
    }

    fn compare_conflicts<S: HostScalar>(&self, digits: f64) {
        const STEPS: u32 = 500;
        let verdict = CheckReport::compute::<S>(&self.scenario, true).unwrap();
        assert!(verdict.bodies.is_empty());
        let [closest] = verdict.closest.as_deref().unwrap() else { panic!("one pair") };
        let end = self.courses[0].duration().max(self.courses[1].duration());
        let mut least = f64::INFINITY;
        for k in 0..=STEPS {
            let t = end * f64::from(k) / f64::from(STEPS);
            let lengths = [0, 1].map(|k| self.courses[k].after(t));
            let is_there = verdict.conflicts.iter().any(|conflict| within(conflict.t, t));
            let apart = self.apart(lengths, 0.0);
            assert!(is_there || self.apart(lengths, digits) > 0.0, "{}: t {t}: no conflict", S::NAME);
            assert!(!is_there || apart <= digits, "{}: t {t}: a conflict at {apart}", S::NAME);
            least = least.min(apart);
        }
        // Between two steps the corners of both go some way.
        let way = [0, 1].map(|k| {
            let reach = self.outlines[k].corners.iter().map(|corner| corner[0].hypot(corner[1])).fold(0.0, f64::max);
            1.0 + reach * self.courses[k].legs.iter().map(|leg| leg[1].abs()).fold(0.0, f64::max)
        });
        let step = 0.5 * (way[0] + way[1]) * end / f64::from(STEPS);
        let clearance = closest.clearance;
        assert!(clearance <= least + digits, "{}: {clearance} {least}", S::NAME);
        assert!(least <= 0.0 || clearance >= least - step - digits, "{}: {clearance} {least}", S::NAME);
        let [a, b] = [0, 1].map(|k| self.courses[k].at(self.courses[k].after(closest.t)));
        let separation = distance([a[0], a[1]], [b[0], b[1]]);
        assert!((closest.separation - separation).abs() <= 2.0 * digits || self.outlines[0].is_disc(), "{}", S::NAME);
    }
}

/// How far an answer in a format may be from the outlines of the scenario \[m\].
struct Digits;

impl Digits {
    fn of<S: HostScalar>() -> f64 {
        match S::NAME {
            "f64" => 1e-9,
            "f32" | "micro" => 2e-4,
            "q20" => 1e-3,
            "q16" => 1e-2,
            _ => 0.1,
        }
    }
}

#[test]
fn trucks_pass_with_a_millimetre_between_them() {
    fn pass<S: HostScalar>() {
        // In `q12` a last digit is a quarter of a millimetre.
        let free = if S::NAME == Q12::NAME { 0.82 } else { 0.801 };
        for (apart, is_free) in [(free, true), (0.799, false)] {
            let truck = Outline::polygon(&TRUCK);
            let agents =
                [agent(1, &truck, [0.0, 0.0, 0.0], &[line(6.0)]), agent(2, &truck, [6.0, apart, PI], &[line(6.0)])];
            let scenario = read(&agents);
            let answer = RegionsReport::compute::<S>(&scenario, RegionOptions::default()).unwrap();
            assert!(answer.bodies.is_empty() && answer.regions.is_empty() == is_free, "{} {apart}", S::NAME);
            let verdict = CheckReport::compute::<S>(&scenario, true).unwrap();
            assert_eq!(verdict.conflicts.is_empty(), is_free, "{} {apart}", S::NAME);
            let clearance = verdict.closest.unwrap()[0].clearance;
            assert!(
                (clearance - (apart - 0.8)).abs() <= if S::NAME == Q12::NAME { 5e-3 } else { 9e-4 },
                "{} {clearance}",
                S::NAME
            );
        }
    }
    pass::<f64>();
    pass::<f32>();
    pass::<Q20>();
    pass::<Q16>();
    pass::<Q12>();
}

#[test]
fn regions_and_conflicts_are_those_of_the_polygons() {
    fn all<S: HostScalar>() {
        const PAIRS: u64 = 24;
        let (mut dice, mut met) = (SplitMix64(56), 0);
        for _ in 0..PAIRS {
            let [inside, _] = Case::random(&mut dice).compare::<S>(Digits::of::<S>());
            met += usize::from(inside > 0);
        }
        assert!(met > 6, "{}: {met}", S::NAME);
    }
    all::<f64>();
    all::<f32>();
    all::<Q20>();
    all::<Q16>();
    all::<Q12>();
}

#[test]
fn a_fork_that_turns_about_a_point_in_a_truck() {
    // It drives once around the reference point of the truck, which stands.
    let stands = Course { start: [0.0; 3], legs: Vec::new() };
    let round = Course { start: [0.0, -0.9, 0.0], legs: vec![[0.9 * TAU, 1.0 / 0.9]] };
    let case = Case::new([&FORK, &TRUCK].map(|corners| Outline::polygon(corners)), [round, stands]);
    let [inside, outside] = case.compare::<f64>(1e-9);
    assert!(inside > 0 && outside > 0, "{inside} {outside}");
}

#[test]
fn margins_are_around_the_outline() {
    let truck = Outline::polygon(&TRUCK);
    let mut agents = [agent(1, &truck, [0.0, 0.0, 0.0], &[line(6.0)]), agent(2, &truck, [6.0, 1.0, PI], &[line(6.0)])];
    for (margin, overlap) in [(0.099, false), (0.101, true)] {
        agents.iter_mut().for_each(|agent| agent["margin"] = json!(margin));
        let answer = RegionsReport::compute::<f64>(&read(&agents), RegionOptions::default()).unwrap();
        assert!(answer.regions.is_empty() && answer.margin_regions.unwrap().is_empty() != overlap, "{margin}");
    }
}

#[test]
fn agents_of_several_bodies_and_with_turns_are_listed() {
    let truck = Outline::polygon(&TRUCK);
    let concave = [[-0.6, -0.4], [0.6, -0.4], [0.2, 0.0], [0.6, 0.4], [-0.6, 0.4]];
    let round: Vec<Point> = (0..17).map(|k| TAU * f64::from(k) / 17.0).map(|at| [at.cos(), at.sin()]).collect();
    let mut loaded = agent(4, &truck, [0.0, 6.0, 0.0], &[line(2.0), line(2.0)]);
    loaded["loads"] = json!([{ "segments": [2, 2], "radius": 0.9 }]);
    let turn = json!({ "kind": "arc", "radius": 1e-9, "sweep": 1.0 });
    let agents = [
        agent(1, &Outline::polygon(&concave), [0.0; 3], &[line(4.0)]),
        agent(2, &Outline::polygon(&round), [0.0, 3.0, 0.0], &[line(4.0)]),
        loaded,
        agent(5, &truck, [0.0, 9.0, 0.0], &[line(1.0), turn, line(1.0)]),
        // Across all lanes.
        agent(6, &truck, [2.0, -3.0, 0.5 * PI], &[line(15.0)]),
        agent(7, &Outline { corners: vec![[0.0; 2]], radius: 0.4 }, [3.0, -3.0, 0.5 * PI], &[line(15.0)]),
        agent(8, &Outline::polygon(&HEXAGON), [1.0, -3.0, 0.5 * PI], &[]),
    ];
    let answer = RegionsReport::compute::<f64>(&read(&agents), RegionOptions::default()).unwrap();
    let listed: Vec<u64> = answer.bodies.iter().map(|bodies| bodies.id).collect();
    assert_eq!(listed, [1, 2, 4, 4, 5]);
    let pair = |i: u64, j: u64| answer.regions.iter().find(|region| [region.i, region.j] == [i, j]);
    assert!([1, 2, 4, 5].iter().all(|&lane| pair(lane, 6).is_some() && pair(6, lane).is_some()));
    assert!([1, 2, 4].iter().all(|&lane| pair(lane, 7).is_some()));
    // They pass a lane apart: 1 m less 0.4 m each, and 0.4 m and half of the width of the hexagon.
    assert!(pair(6, 7).is_none() && pair(6, 8).is_none() && pair(7, 8).is_none());
    // Also with a certificate.
    let certified = RegionOptions { certificate: true, ..RegionOptions::default() };
    let answer = RegionsReport::compute::<f64>(&read(&agents), certified).unwrap();
    let listed: Vec<u64> = answer.bodies.iter().map(|bodies| bodies.id).collect();
    assert_eq!(listed, [1, 2, 4, 4, 5]);
}

#[test]
fn a_hundred_rectangles_have_few_pieces() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/table6-100.json");
    let mut scenario: Value = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
    let corner = |[ahead, left]: [f64; 2]| json!({ "ahead": ahead, "left": left });
    let polygon = [[-0.6, -0.2], [0.6, -0.2], [0.6, 0.2], [-0.6, 0.2]].map(corner);
    for agent in scenario["agents"].as_array_mut().unwrap() {
        agent.as_object_mut().unwrap().remove("radius");
        agent["footprint"] = json!({ "polygon": polygon });
    }
    let answer =
        RegionsReport::compute::<f64>(&Scenario::from_value(&scenario).unwrap(), RegionOptions::default()).unwrap();
    assert!(answer.bodies.is_empty());
    let pieces: usize = answer.regions.iter().map(|region| region.pieces.len()).sum();
    assert_eq!((answer.regions.len(), pieces), (4328, 14102));
}

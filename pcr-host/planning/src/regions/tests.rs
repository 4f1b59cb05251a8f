//! Regions and conflicts of outlines, compared with polygons at many times and lengths.

use crate::check::CheckReport;
use crate::fleet::HostScalar;
use crate::regions::{RegionEntry, RegionOptions, RegionsReport};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::plane_geometry::distance;
use pcr_formats::scenario::Scenario;
use pcr_formats::splitmix64::SplitMix64;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

type Point = [f64; 2];

const TRUCK: [Point; 4] = [[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]];
/// Its reference point is outside of it.
const FORK: [Point; 4] = [[0.2, -0.3], [1.1, -0.3], [1.1, 0.25], [0.2, 0.25]];
const TRIANGLE: [Point; 3] = [[-0.4, -0.5], [0.9, 0.1], [-0.5, 0.4]];
const HEXAGON: [Point; 6] = [[0.5, 0.0], [0.25, 0.4], [-0.25, 0.4], [-0.5, 0.0], [-0.25, -0.4], [0.25, -0.4]];

/// An outline: the points within a radius of a convex polygon. A disc has one corner.
#[derive(Clone, Debug)]
struct Outline {
    corners: Vec<Point>,
    radius: f64,
}

impl Outline {
    fn polygon(corners: &[Point]) -> Self {
        Self { corners: corners.to_vec(), radius: 0.0 }
    }

    fn is_disc(&self) -> bool {
        self.corners.len() == 1
    }

    /// The same, smaller all around: towards a point in the middle, each side comes nearer by that at least.
    fn smaller(&self, by: f64) -> Self {
        if self.is_disc() {
            return Self { radius: self.radius - by, ..self.clone() };
        }
        let count = self.corners.len() as f64;
        let middle = [0, 1].map(|axis| self.corners.iter().map(|corner| corner[axis]).sum::<f64>() / count);
        let inner = sides(&self.corners).map(|ends| from_line(middle, ends)).fold(f64::INFINITY, f64::min);
        let share = 1.0 - by / inner;
        let corners = self.corners.iter().map(|corner| [0, 1].map(|k| middle[k] + share * (corner[k] - middle[k])));
        Self { corners: corners.collect(), ..self.clone() }
    }

    fn at(&self, [x, y, heading]: [f64; 3]) -> Self {
        let (sin, cos) = heading.sin_cos();
        let corners =
            self.corners.iter().map(|[ahead, left]| [x + ahead * cos - left * sin, y + ahead * sin + left * cos]);
        Self { corners: corners.collect(), ..self.clone() }
    }

    /// Distance of two outlines, not above 0 where they overlap.
    fn apart(&self, other: &Self) -> f64 {
        let crossing = sides(&self.corners).any(|own| sides(&other.corners).any(|their| cross(own, their)));
        let inside = holds(&self.corners, other.corners[0]) || holds(&other.corners, self.corners[0]);
        let from = |own: &Self, other: &Self| {
            let all = own.corners.iter().flat_map(|p| sides(&other.corners).map(|side| from_side(*p, side)));
            all.fold(f64::INFINITY, f64::min)
        };
        let between = if crossing || inside { 0.0 } else { from(self, other).min(from(other, self)) };
        between - self.radius - other.radius
    }
}

fn sides(corners: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| [*a, *b])
}

fn area(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn from_line(p: Point, [a, b]: [Point; 2]) -> f64 {
    area(a, b, p).abs() / distance(a, b)
}

fn from_side(p: Point, [a, b]: [Point; 2]) -> f64 {
    let along = |from: Point, to: Point| (p[0] - from[0]) * (to[0] - from[0]) + (p[1] - from[1]) * (to[1] - from[1]);
    if a == b || along(a, b) <= 0.0 || along(b, a) <= 0.0 {
        distance(p, a).min(distance(p, b))
    } else {
        from_line(p, [a, b])
    }
}

fn holds(corners: &[Point], p: Point) -> bool {
    corners.len() > 2
        && (sides(corners).all(|[a, b]| area(a, b, p) >= 0.0) || sides(corners).all(|[a, b]| area(a, b, p) <= 0.0))
}

fn cross([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    area(a, b, c) * area(a, b, d) < 0.0 && area(c, d, a) * area(c, d, b) < 0.0
}

fn line(length: f64) -> Value {
    json!({ "kind": "line", "length": length })
}

fn agent(id: u64, outline: &Outline, start: [f64; 3], path: &[Value]) -> Value {
    let mut agent = json!({ "id": id, "v_max": 1.0, "a_max": 0.5, "path": path,
        "start": { "x": start[0], "y": start[1], "heading": start[2] } });
    if outline.is_disc() {
        agent["radius"] = json!(outline.radius);
    } else {
        let corners = outline.corners.iter().map(|[ahead, left]| json!({ "ahead": ahead, "left": left }));
        agent["footprint"] = json!({ "polygon": corners.collect::<Vec<_>>() });
    }
    agent
}

fn read(agents: &[Value]) -> Scenario {
    Scenario::from_value(&json!({ "agents": agents })).unwrap()
}

/// Where an agent is after a length, and its length after a time, by formulas of this test.
struct Course {
    start: [f64; 3],
    /// Length, and curvature.
    legs: Vec<[f64; 2]>,
}

impl Course {
    fn length(&self) -> f64 {
        self.legs.iter().map(|leg| leg[0]).sum()
    }

    fn at(&self, length: f64) -> [f64; 3] {
        let ([mut x, mut y, mut heading], mut left) = (self.start, length);
        for &[leg, curvature] in &self.legs {
            let own = left.clamp(0.0, leg);
            let turned = heading + curvature * own;
            if curvature == 0.0 {
                (x, y) = (x + own * heading.cos(), y + own * heading.sin());
            } else {
                x += (turned.sin() - heading.sin()) / curvature;
                y -= (turned.cos() - heading.cos()) / curvature;
            }
            (heading, left) = (turned, left - own);
        }
        [x, y, heading]
    }

    /// From rest to rest at up to 1 m/s and 0.5 m/s².
    fn duration(&self) -> f64 {
        let length = self.length();
        if length >= 2.0 { length + 2.0 } else { 2.0 * (2.0 * length).sqrt() }
    }

    fn after(&self, time: f64) -> f64 {
        let (length, end) = (self.length(), self.duration());
        let ramp = |elapsed: f64| 0.25 * elapsed * elapsed;
        let up = (0.5 * end).min(2.0);
        match time.clamp(0.0, end) {
            t if t < up => ramp(t),
            t if t < end - up => ramp(up) + (t - up),
            t => length - ramp(end - t),
        }
    }
}

fn within([lo, hi]: [f64; 2], x: f64) -> bool {
    lo <= x && x <= hi
}

/// Two agents, in all ways in which they are described here.
struct Case {
    scenario: Scenario,
    outlines: [Outline; 2],
    courses: [Course; 2],
}

impl Case {
    fn new(outlines: [Outline; 2], courses: [Course; 2]) -> Self {
        let agents = [0, 1].map(|k| {
            let path = courses[k].legs.iter().map(|&[length, curvature]| match curvature {
                0.0 => line(length),
                _ => json!({ "kind": "arc", "radius": 1.0 / curvature.abs(), "sweep": length * curvature }),
            });
            agent(k as u64 + 1, &outlines[k], courses[k].start, &path.collect::<Vec<_>>())
        });
        Self { scenario: read(&agents), outlines, courses }
    }

    fn random(dice: &mut SplitMix64) -> Self {
        let mut outline = || match dice.below(5) {
            0 => Outline::polygon(&TRUCK),
            1 => Outline::polygon(&FORK),
            2 => Outline::polygon(&TRIANGLE),
            3 => Outline::polygon(&HEXAGON),
            _ => Outline { corners: vec![[0.0; 2]], radius: 0.3 },
        };
        let outlines = [outline(), Outline::polygon(&TRUCK)];
        let mut course = || {
            let count = 1 + dice.below(3);
            let legs = (0..count).map(|_| match dice.below(2) {
                0 => [dice.uniform(0.5, 3.0), 0.0],
                _ => {
                    let radius = dice.uniform(0.3, 2.0);
                    [radius * dice.uniform(0.3, 2.5), if dice.below(2) == 0 { 1.0 / radius } else { -1.0 / radius }]
                }
            });
            let legs = legs.collect();
            Course { start: [dice.uniform(-1.5, 1.5), dice.uniform(-1.5, 1.5), dice.uniform(-PI, PI)], legs }
        };
        let courses = [course(), course()];
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
        assert!(answer.footprints.is_empty(), "{}: {:?}", S::NAME, answer.footprints);
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
        assert!(verdict.footprints.is_empty());
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
            assert!(answer.footprints.is_empty() && answer.regions.is_empty() == is_free, "{} {apart}", S::NAME);
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
fn what_cannot_be_computed_as_it_is_has_a_cover() {
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
    let covered: Vec<u64> = answer.footprints.iter().map(|cover| cover.id).collect();
    assert_eq!(covered, [1, 2, 4, 4, 5]);
    let pair = |i: u64, j: u64| answer.regions.iter().find(|region| [region.i, region.j] == [i, j]);
    assert!([1, 2, 4, 5].iter().all(|&lane| pair(lane, 6).is_some() && pair(6, lane).is_some()));
    assert!([1, 2, 4].iter().all(|&lane| pair(lane, 7).is_some()));
    // They pass a lane apart: 1 m less 0.4 m each, and 0.4 m and half of the width of the hexagon.
    assert!(pair(6, 7).is_none() && pair(6, 8).is_none() && pair(7, 8).is_none());
    let certified = RegionOptions { certificate: true, ..RegionOptions::default() };
    let answer = RegionsReport::compute::<f64>(&read(&agents), certified).unwrap();
    let covered: Vec<u64> = answer.footprints.iter().map(|cover| cover.id).collect();
    assert_eq!(covered, [1, 2, 4, 4, 5, 6, 8]);
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
    assert!(answer.footprints.is_empty());
    let pieces: usize = answer.regions.iter().map(|region| region.pieces.len()).sum();
    assert_eq!((answer.regions.len(), pieces), (4328, 14102));
}

//! Tests of regions of outlines against an independent distance ([`oracle`]).

extern crate std;

mod in_time;
mod steady;

use super::distance::tests::{Random, oracle};
use super::events::Carriers;
use crate::outline::placed::Carried;
use crate::outline::{Outline, OutlineRef};
use crate::piece_store::{Piece, PieceStore};
use crate::scalar::Scalar;
use crate::{
    Curve, Ecm, EcmEntry, Interval, InvalidInput, Motion, Path, Point, Pose, Profile, Radians, RegionRef, Segment,
    TurnSide, Vector, excess,
};
use core::f64::consts::{FRAC_PI_2, PI, TAU};
use std::vec::Vec;

fn standing(x: f64, y: f64, heading: f64) -> Segment<f64> {
    Segment::standing(Pose { position: Point::new(x, y), heading: Radians(heading) }).unwrap()
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-11, "{found} {expected}");
    }
}

/// A rectangle of 1.2 m x 0.8 m turns about its centre beside a wall that comes nearer.
#[test]
fn a_rectangle_that_turns_beside_a_wall_has_pinches() {
    let first = standing(0.0, -1.0, 0.0).then_arc(1.0, TurnSide::Left, TAU).unwrap();
    let second = standing(0.0, 1.5, -FRAC_PI_2).then_line(1.2).unwrap();
    let own = Outline::<f64, 4>::rectangle(0.6, 0.6, 1.4, -0.6, 0.0).unwrap();
    let wall = Outline::<f64, 4>::rectangle(0.1, 0.1, 2.0, 2.0, 0.0).unwrap();
    let (radius, slack) = (0.05, 1e-13);
    let carriers = Carriers {
        first: Carried::new(&first, own.as_outline()),
        second: Carried::new(&second, wall.as_outline()),
        radius,
        slack,
    };
    let slices = [
        (
            0.7,
            &[
                0.534961326318396,
                1.43062612017626,
                1.71096653341353,
                2.6066313272714,
                3.67655397990819,
                4.57221877376606,
                4.85255918700332,
                5.74822398086119,
            ][..],
        ),
        (0.8, &[0.279494746222193, 2.8620979073676, 3.42108739981199, 6.00369056095739]),
        (0.9, &[0.0858968327951782, 3.05569582079461, 3.22748948638497, 6.19728847438441]),
        (1.0, &[0.0, TAU]),
        (0.6, &[]),
    ];
    for (at, expected) in slices {
        let slice = carriers.slice_of_first(at).unwrap();
        let ends: Vec<f64> = slice.as_slice().iter().flat_map(|part| [part.lo, part.hi]).collect();
        close(&ends, expected);
    }
    let events = carriers.events().unwrap();
    for event in [0.0, 0.628889744907202, 0.75, 0.95, 1.2] {
        assert!(
            events.as_slice().iter().any(|found| (found - event).abs() < 1e-11),
            "{event}: {:?}",
            events.as_slice()
        );
    }
    let mut pieces = PieceStore::new([Piece::EMPTY; 16]);
    carriers.find([0; 2], &mut pieces).unwrap();
    let found: Vec<_> = pieces.behind(0).iter().map(|piece| (piece.rank(), piece.second)).collect();
    let expected = [
        ([0, 4], 0.628889744907202, 0.75),
        ([1, 4], 0.628889744907202, 0.75),
        ([2, 4], 0.628889744907202, 0.75),
        ([3, 4], 0.628889744907202, 0.75),
        ([0, 2], 0.75, 0.95),
        ([1, 2], 0.75, 0.95),
        ([0, 1], 0.95, 1.2),
    ];
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (rank, lo, hi) in expected {
        assert!(
            found
                .iter()
                .any(|(of, second)| *of == rank && (second.lo - lo).abs() < 1e-11 && (second.hi - hi).abs() < 1e-11),
            "{found:?}"
        );
    }
    pieces.form_regions(|_| {});
    let all = pieces.take_region().unwrap();
    assert_eq!(crate::piece_store::PieceList::new(pieces.slots(), all).count(), 7, "one region");
}

#[test]
fn a_rectangle_on_a_line_beside_a_wall_covers_one_interval() {
    let first = standing(0.0, 0.0, PI / 6.0).then_line(4.0).unwrap();
    let second = standing(0.0, 1.5, -FRAC_PI_2).then_line(1.2).unwrap();
    // Its heading stays that of the x-axis while it moves at 30 degrees: a body turned by -30 degrees.
    let (cos, sin) = (0.75_f64.sqrt(), -0.5);
    let corners = [(-0.6, -0.4), (0.6, -0.4), (0.6, 0.4), (-0.6, 0.4)];
    let corners = corners.map(|(x, y)| Vector { x: x * cos - y * sin, y: x * sin + y * cos });
    let own = Outline::<f64, 4>::polygon(corners, 0.0).unwrap();
    let wall = Outline::<f64, 4>::rectangle(0.1, 0.1, 2.0, 2.0, 0.0).unwrap();
    let carriers = Carriers {
        first: Carried::new(&first, own.as_outline()),
        second: Carried::new(&second, wall.as_outline()),
        radius: 0.05,
        slack: 1e-13,
    };
    for (at, lo, hi) in [(0.2, 1.5, 3.05995642670502), (0.7, 0.5, 2.7)] {
        let slice = carriers.slice_of_first(at).unwrap();
        close(&slice.as_slice().iter().flat_map(|part| [part.lo, part.hi]).collect::<Vec<_>>(), &[lo, hi]);
    }
}

/// A segment: radius of an arc or lever of a turn in place, negative to the right, and length \[m\].
#[derive(Clone, Copy, Debug)]
enum Step {
    Line(f64),
    Arc(f64, f64),
    /// An arc on which the body keeps its heading.
    Steady(f64, f64),
    Pivot(f64, f64),
}

/// A pair of motions in the format `S`, made of numbers in `f64`.
struct Case {
    segments: [Vec<Step>; 2],
    /// For each segment, by how much the direction of travel turns before it while the body does not; for the first one, the angle from the
    /// body to the direction of travel. None for bodies that look ahead.
    kinks: [Vec<f64>; 2],
    /// Start and heading.
    poses: [[f64; 3]; 2],
    outlines: [Outline<f64, 16>; 2],
}

impl Case {
    fn random(random: &mut Random, segments: usize) -> Self {
        let grid = random.below(3) == 0;
        let on_grid = |x: f64| if grid { (8.0 * x).round() / 8.0 } else { x };
        let radii = [on_grid(random.within(0.0, 0.4)), on_grid(random.within(0.05, 0.4))];
        let outlines = radii.map(|radius| {
            let sharp = random.below(3) == 0;
            random.outline(if sharp { 0.0 } else { radius })
        });
        let poses = [(); 2].map(|()| {
            let heading = if grid { FRAC_PI_2 * random.below(4) as f64 } else { random.within(-3.0, 3.0) };
            [on_grid(random.within(-1.5, 1.5)), on_grid(random.within(-1.5, 1.5)), heading]
        });
        let parts = [(); 2].map(|()| {
            (0..segments)
                .map(|_| {
                    if random.below(3) == 0 {
                        Step::Line(0.1 + on_grid(random.within(0.1, 2.0)))
                    } else {
                        let radius = 0.125 + on_grid(random.within(0.0, 1.5) * random.unit());
                        let sweep = match random.below(6) {
                            0 => TAU,
                            1 if grid => FRAC_PI_2,
                            _ => {
                                let most = if random.below(3) == 0 { TAU } else { 2.0 };
                                random.within(0.1, most)
                            }
                        };
                        Step::Arc(if random.below(2) == 0 { radius } else { -radius }, radius * sweep)
                    }
                })
                .collect()
        });
        Self { segments: parts, kinks: [Vec::new(), Vec::new()], poses, outlines }
    }

    /// The same with turns in place instead of about half of the segments, and with a disc now and then. Some turns are by
    /// quarters, some by a full turn.
    fn with_pivots(mut self, random: &mut Random) -> Self {
        for step in self.segments.iter_mut().flatten() {
            if random.below(2) == 0 {
                let lever = [1.0, 0.25, random.within(0.25, 2.0)][random.below(3)];
                let sweep = [TAU, FRAC_PI_2, PI, random.within(0.1, 2.0), random.within(0.1, TAU)][random.below(5)];
                *step = Step::Pivot(if random.below(2) == 0 { lever } else { -lever }, lever * sweep);
            }
        }
        for outline in &mut self.outlines {
            if random.below(6) == 0 {
                *outline = Outline::disc(0.125 * (1 + random.below(4)) as f64).unwrap();
            }
        }
        self
    }

    /// The same with cusps and bodies that look sideways.
    fn with_gears(mut self, random: &mut Random) -> Self {
        self.kinks = self.segments.each_ref().map(|segments| {
            segments.iter().map(|_| [0.0, PI, PI, FRAC_PI_2, random.within(-3.0, 3.0)][random.below(5)]).collect()
        });
        self
    }

    /// For each segment by how much the direction of travel turns before it, and the angle from it to the body, both in the format.
    fn gears<S: Number>(&self, k: usize) -> Vec<[S; 2]> {
        let kinks = self.kinks[k].iter().enumerate();
        let gears = kinks.scan(S::ZERO, |facing, (place, &by)| {
            let by = S::of(by);
            *facing = *facing - by;
            Some([if place == 0 { S::ZERO } else { by }, *facing])
        });
        gears.collect()
    }

    fn paths<S: Number>(&self) -> [Path<S, 4>; 2] {
        [0, 1].map(|k| {
            let [x, y, heading] = self.poses[k].map(S::of);
            let path = Path::starting_at(Pose { position: Point::new(x, y), heading: S::angle(heading) }).unwrap();
            let side = |bend: f64| if bend < 0.0 { TurnSide::Right } else { TurnSide::Left };
            let gears = self.gears::<S>(k).into_iter().map(Some).chain(core::iter::repeat(None));
            self.segments[k].iter().zip(gears).fold(path, |path, (step, gear)| {
                let path = match gear {
                    Some([by, facing]) => path.turn(S::angle(by)).unwrap().facing(S::angle(facing)).unwrap(),
                    None => path,
                };
                match *step {
                    Step::Line(length) => path.line(S::of(length)),
                    Step::Arc(radius, length) => path.arc(S::of(radius.abs()), side(radius), S::of(length)),
                    Step::Steady(radius, length) => path.steady_arc(S::of(radius.abs()), side(radius), S::of(length)),
                    Step::Pivot(lever, length) => path.pivot(S::of(lever.abs()), S::of(length / lever)),
                }
                .unwrap()
            })
        })
    }

    fn outlines<S: Number>(&self) -> [Outline<S, 16>; 2] {
        self.outlines.each_ref().map(|outline| {
            let outline = outline.as_outline();
            let corners =
                outline.corners().iter().map(|corner| Vector { x: S::of(corner.at().x), y: S::of(corner.at().y) });
            if outline.corners().is_empty() {
                return Outline::disc(S::of(outline.radius())).unwrap();
            }
            Outline::polygon(corners, S::of(outline.radius())).unwrap()
        })
    }
}

/// A number format with conversions from and to `f64`.
trait Number: Scalar {
    fn of(number: f64) -> Self;
    fn float(self) -> f64;
    fn angle(number: Self) -> Self::Angle;
}

impl Number for f64 {
    fn of(number: f64) -> Self {
        number
    }
    fn float(self) -> f64 {
        self
    }
    fn angle(number: Self) -> Radians<f64> {
        Radians(number)
    }
}

impl Number for f32 {
    fn of(number: f64) -> Self {
        number as f32
    }
    fn float(self) -> f64 {
        f64::from(self)
    }
    fn angle(number: Self) -> Radians<f32> {
        Radians(number)
    }
}

#[cfg(feature = "micromath")]
impl Number for crate::scalar::Micro {
    fn of(number: f64) -> Self {
        Self(number as f32)
    }
    fn float(self) -> f64 {
        f64::from(self.0)
    }
    fn angle(number: Self) -> Radians<Self> {
        Radians(number)
    }
}

/// The exact corners in `f64` of an outline at a length of a path whose numbers are those of another format.
struct Exact {
    pose: [f64; 3],
    segments: Vec<Step>,
    /// As [`Case::gears`].
    gears: Vec<[f64; 2]>,
    corners: Vec<[f64; 2]>,
    radius: f64,
    length: f64,
}

impl Exact {
    fn of<S: Number>(case: &Case, k: usize, path: &Path<S, 4>, outline: OutlineRef<'_, S>) -> Self {
        let heading = S::of(case.poses[k][2]).float();
        let gears = case.gears::<S>(k).into_iter().map(|gear| gear.map(S::float)).collect();
        let path = path.as_path();
        let start = path.segments()[0].point_at(S::ZERO);
        let segments = path.segments().iter().map(|segment| {
            let (length, left) = (segment.length().float(), |turn| if turn == TurnSide::Left { 1.0 } else { -1.0 });
            match segment.curve() {
                Curve::Line => Step::Line(length),
                Curve::Arc { radius, turn } if segment.is_steady() => Step::Steady(left(turn) * radius.float(), length),
                Curve::Arc { radius, turn } => Step::Arc(left(turn) * radius.float(), length),
                Curve::Pivot { lever, turn } => Step::Pivot(left(turn) * lever.float(), length),
            }
        });
        let corners = outline.corners().iter().map(|corner| [corner.at().x.float(), corner.at().y.float()]);
        let corners: Vec<_> = if outline.corners().is_empty() { Vec::from([[0.0; 2]]) } else { corners.collect() };
        let pose = [start.x.float(), start.y.float(), heading];
        Self {
            pose,
            segments: segments.collect(),
            gears,
            corners,
            radius: outline.radius().float(),
            length: path.length().float(),
        }
    }

    fn at(&self, length: f64) -> Vec<[f64; 2]> {
        let ([mut x, mut y, mut heading], mut rest, mut body) = (self.pose, length, 0.0);
        for (place, &step) in self.segments.iter().enumerate() {
            if let Some([by, facing]) = self.gears.get(place) {
                (heading, body) = (heading + by, *facing);
            }
            let (Step::Line(length) | Step::Arc(_, length) | Step::Steady(_, length) | Step::Pivot(_, length)) = step;
            let way = rest.min(length);
            match step {
                Step::Line(_) => (x, y) = (x + way * heading.cos(), y + way * heading.sin()),
                Step::Arc(radius, _) | Step::Steady(radius, _) => {
                    let next = heading + way / radius;
                    (x, y) = (x + radius * (next.sin() - heading.sin()), y - radius * (next.cos() - heading.cos()));
                    if let Step::Steady(..) = step {
                        body -= next - heading;
                    }
                    heading = next;
                }
                Step::Pivot(lever, _) => heading += way / lever,
            }
            rest -= way;
            if rest <= 0.0 {
                break;
            }
        }
        let (sin, cos) = (heading + body).sin_cos();
        self.corners.iter().map(|[a, b]| [x + a * cos - b * sin, y + a * sin + b * cos]).collect()
    }
}

/// Counts of what was compared, so that a test that compares nothing fails.
#[derive(Default, Debug)]
struct Tally {
    pairs: u32,
    regions: u32,
    points: u32,
    inside: u32,
    intervals: usize,
    refused: u32,
}

/// Compares the regions of a case with the oracle, at random points and beside the ends of slices.
fn compare<S: Number>(case: &Case, random: &mut Random, tally: &mut Tally, seed: u64) {
    let (paths, outlines) = (case.paths::<S>(), case.outlines::<S>());
    let profiles = paths
        .each_ref()
        .map(|path| Profile::<S, 1>::from_pieces(S::of(1.0), [(path.as_path().length(), S::ZERO)]).unwrap());
    let motion = |k: usize| {
        let path: &Path<S, 4> = &paths[k];
        Motion::with_outline(path.as_path(), profiles[k].as_profile(), &outlines[k], S::ZERO)
    };
    let (Ok(first), Ok(second)) = (motion(0), motion(1)) else {
        tally.refused += 1;
        return;
    };
    let fleet = [first, second];
    let exact = [0, 1].map(|k| Exact::of(case, k, &paths[k], outlines[k].as_outline()));
    let radius = exact[0].radius + exact[1].radius;
    let eps = excess(&fleet[0], &fleet[1]).float();
    let ecm = Ecm::build([EcmEntry::EMPTY; 64], [Piece::EMPTY; 1024], &fleet).unwrap();
    let regions: Vec<RegionRef<'_, S>> = ecm.pair(&fleet, 0, 1).unwrap().collect();
    tally.pairs += 1;
    tally.regions += regions.len() as u32;
    let [l, s] = exact.each_ref().map(|exact| exact.length);
    let mut check = |a: f64, b: f64| {
        let (a, b) = (S::of(a.clamp(0.0, l)), S::of(b.clamp(0.0, s)));
        let f = oracle(&exact[0].at(a.float()), &exact[1].at(b.float()));
        // The oracle itself rounds.
        let fine = 1e-14;
        let holds = regions.iter().filter(|region| region.covers(a, b)).count();
        let back = regions.iter().filter(|region| (*region).clone().swapped().covers(b, a)).count();
        let message = || {
            std::format!(
                "seed {seed}: f - R = {:e}, eps {eps:e}, at {a:?} {b:?}, {:?} {:?}",
                f - radius,
                case.poses,
                case.segments
            )
        };
        if f < radius - fine {
            assert!(holds > 0, "lost: {}", message());
            assert!(back > 0, "lost in the other direction: {}", message());
            tally.inside += 1;
        }
        if f > radius + eps + fine {
            assert!(holds == 0, "invented: {}", message());
            assert!(back == 0, "invented in the other direction: {}", message());
        }
        tally.points += 1;
    };
    for _ in 0..24 {
        check(random.within(0.0, l), random.within(0.0, s));
    }
    let mut ends = Vec::new();
    for region in &regions {
        for _ in 0..3 {
            let range = region.other_length();
            let b = random.within(range.lo.float(), range.hi.float());
            let slice: Vec<Interval<S>> = region.slice_at(S::of(b)).collect();
            tally.intervals = tally.intervals.max(slice.len());
            for part in slice {
                ends.extend([(part.lo.float(), b), (part.hi.float(), b)]);
            }
            ends.push((random.within(region.length().lo.float(), region.length().hi.float()), b));
        }
        let (first, second) = (region.length(), region.other_length());
        for corner in [first.lo, first.hi] {
            ends.extend([(corner.float(), second.lo.float()), (corner.float(), second.hi.float())]);
        }
    }
    for (a, b) in ends {
        for by in [0.0, 1e-6, -1e-6, 1e-3, -1e-3] {
            check(a + by, b);
            check(a, b + by);
        }
    }
}

fn campaign<S: Number>(seeds: core::ops::Range<u64>, segments: usize) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let mut random = Random::of(seed);
        let case = Case::random(&mut random, segments);
        compare::<S>(&case, &mut random, &mut tally, seed);
    }
    tally
}

#[test]
fn regions_of_single_segments_hold_what_the_oracle_says() {
    let tally = campaign::<f64>(0..600, 1);
    assert!(tally.pairs == 600 && tally.inside > 3_000, "{tally:?}");
}

#[test]
fn regions_of_paths_hold_what_the_oracle_says() {
    let tally = campaign::<f64>(10_000..10_300, 4);
    assert!(tally.pairs == 300 && tally.inside > 5_000, "{tally:?}");
}

#[test]
fn regions_in_single_precision_hold_what_the_oracle_says() {
    for segments in [1, 4] {
        let tally = campaign::<f32>(20_000..20_500, segments);
        assert!(tally.pairs > 450 && tally.inside > 2_000, "{tally:?}");
    }
}

/// Turns in place alone and between other segments.
#[test]
fn regions_of_turns_in_place_hold_what_the_oracle_says() {
    fn campaign<S: Number>(seeds: core::ops::Range<u64>) -> Tally {
        let mut tally = Tally::default();
        for seed in seeds {
            let mut random = Random::of(seed);
            let segments = if seed % 2 == 0 { 1 } else { 4 };
            let case = Case::random(&mut random, segments).with_pivots(&mut Random::of(!seed));
            compare::<S>(&case, &mut random, &mut tally, seed);
        }
        tally
    }
    let tally = campaign::<f64>(22_000..22_400);
    assert!(tally.pairs == 400 && tally.inside > 5_000 && tally.intervals > 2, "{tally:?}");
    let tally = campaign::<f32>(23_000..23_400);
    assert!(tally.pairs > 350 && tally.inside > 5_000 && tally.intervals > 2, "{tally:?}");
    #[cfg(feature = "micromath")]
    {
        let tally = campaign::<crate::scalar::Micro>(24_000..24_200);
        assert!(tally.pairs > 150 && tally.inside > 2_000, "{tally:?}");
    }
}

/// Bodies in reverse gear, with cusps, and sideways.
#[test]
fn regions_of_bodies_that_look_elsewhere_hold_what_the_oracle_says() {
    fn campaign<S: Number>(seeds: core::ops::Range<u64>) -> Tally {
        let mut tally = Tally::default();
        for seed in seeds {
            let mut random = Random::of(seed);
            let case = Case::random(&mut random, if seed % 2 == 0 { 1 } else { 4 }).with_gears(&mut random);
            let case = if seed % 4 < 2 { case } else { case.with_pivots(&mut random) };
            compare::<S>(&case, &mut random, &mut tally, seed);
        }
        tally
    }
    let tally = campaign::<f64>(25_000..25_300);
    assert!(tally.pairs == 300 && tally.inside > 4_000, "{tally:?}");
    let tally = campaign::<f32>(26_000..26_300);
    assert!(tally.pairs > 270 && tally.inside > 4_000, "{tally:?}");
}

/// A body whose heading jumps would sweep an area in no time; one that changes gear does not.
#[test]
fn a_heading_that_jumps_is_refused() {
    let start = || {
        let pose = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.4) };
        Path::<f64, 3>::starting_at(pose).unwrap()
    };
    let outline = Outline::<f64, 4>::rectangle(0.6, 0.4, 0.3, 0.2, 0.0).unwrap();
    let made = |path: Result<Path<f64, 3>, InvalidInput>| {
        let path = path.unwrap();
        let profile = Profile::<f64, 1>::from_pieces(1.0, [(path.as_path().length(), 0.0)]).unwrap();
        Motion::with_outline(path.as_path(), profile.as_profile(), &outline, 0.0).map(|motion| motion.extent())
    };
    let line = || start().line(1.0).unwrap();
    assert!(made(line().line(1.0)).is_ok());
    assert!(made(line().reverse().unwrap().line(2.0)).is_ok());
    assert!(made(line().pivot(1.0, PI).unwrap().line(2.0)).is_ok());
    assert!(made(line().turn(Radians(0.3)).unwrap().facing(Radians(-0.3)).unwrap().line(2.0)).is_ok());
    assert!(made(start().facing(Radians(2.0)).unwrap().arc(1.0, TurnSide::Right, 2.0).unwrap().line(2.0)).is_ok());
    let steady = |turn| line().steady_arc(1.0, turn, 2.0).unwrap();
    assert!(made(steady(TurnSide::Right).line(2.0)).is_ok());
    assert!(made(steady(TurnSide::Left).facing(Radians(-2.0)).unwrap().arc(1.0, TurnSide::Left, 2.0)).is_ok());
    assert!(made(steady(TurnSide::Left).reverse().unwrap().steady_arc(1.0, TurnSide::Left, 2.0)).is_ok());
    for jump in [
        line().turn(Radians(PI)).unwrap().line(1.0),
        line().turn(Radians(0.3)).unwrap().line(1.0),
        line().turn(Radians(0.3)),
        steady(TurnSide::Left).facing(Radians(0.0)).unwrap().line(1.0),
        steady(TurnSide::Left).turn(Radians(0.3)).unwrap().line(1.0),
        line().facing(Radians(PI)).unwrap().line(1.0),
        line().reverse().unwrap().line(1.0).unwrap().facing(Radians(0.0)).unwrap().line(1.0),
    ] {
        assert_eq!(made(jump).err(), Some(InvalidInput::TurnInPlace));
    }
    let short = line().pivot(1e-14, PI).unwrap().line(2.0);
    assert_eq!(made(short).err(), Some(InvalidInput::Lever));
    assert_eq!(start().facing(Radians(f64::NAN)).err(), Some(InvalidInput::NonFinite("angle of the body")));
}

/// The components of a set of points of a grid, connected along its lines: the deepest point of each, with its depth.
fn components(count: usize, depth: impl Fn(usize, usize) -> f64) -> Vec<(f64, usize, usize)> {
    let depths: Vec<f64> = (0..count * count).map(|k| depth(k / count, k % count)).collect();
    let (mut seen, mut found, mut open) = (std::vec![false; count * count], Vec::new(), Vec::new());
    for start in 0..count * count {
        if seen[start] || depths[start] < 0.0 {
            continue;
        }
        let mut deepest = start;
        seen[start] = true;
        open.push(start);
        while let Some(k) = open.pop() {
            if depths[k] > depths[deepest] {
                deepest = k;
            }
            let (i, j) = (k / count, k % count);
            for (i, j) in [(i + 1, j), (i.wrapping_sub(1), j), (i, j + 1), (i, j.wrapping_sub(1))] {
                if i < count && j < count && !seen[i * count + j] && depths[i * count + j] >= 0.0 {
                    seen[i * count + j] = true;
                    open.push(i * count + j);
                }
            }
        }
        found.push((depths[deepest], deepest / count, deepest % count));
    }
    found
}

/// Fills the region of each component of a grid: it has to be a region of its own. A gap or a neck that is thinner than the grid needs a
/// finer one.
#[test]
fn regions_are_the_components_of_a_flood_fill() {
    let (mut compared, mut several, mut finer) = (0, 0, 0);
    for seed in 50_000..50_480_u64 {
        let mut random = Random::of(seed);
        let case = Case::random(&mut random, 1);
        let case = match seed {
            ..50_240 => case,
            50_240..50_360 => case.with_pivots(&mut random),
            _ => case.with_steady(&mut random),
        };
        let (paths, outlines) = (case.paths::<f64>(), case.outlines::<f64>());
        let profiles =
            paths.each_ref().map(|path| Profile::<f64, 1>::from_pieces(1.0, [(path.as_path().length(), 0.0)]).unwrap());
        let fleet = [0, 1].map(|k| {
            let path: &Path<f64, 4> = &paths[k];
            Motion::with_outline(path.as_path(), profiles[k].as_profile(), &outlines[k], 0.0).unwrap()
        });
        let exact = [0, 1].map(|k| Exact::of(&case, k, &paths[k], outlines[k].as_outline()));
        let radius = exact[0].radius + exact[1].radius;
        if radius == 0.0 {
            // The oracle does not tell how deep polygons overlap.
            continue;
        }
        let [l, s] = exact.each_ref().map(|exact| exact.length);
        let ecm = Ecm::build([EcmEntry::EMPTY; 64], [Piece::EMPTY; 256], &fleet).unwrap();
        let regions: Vec<_> = ecm.pair(&fleet, 0, 1).unwrap().collect();
        let agrees = |count: usize| {
            let at = |k: usize, length: f64| length * k as f64 / (count - 1) as f64;
            let bodies = [0, 1].map(|k| (0..count).map(|i| exact[k].at(at(i, [l, s][k]))).collect::<Vec<_>>());
            // What is hardly covered may be seen or not.
            let found = components(count, |i, j| radius - oracle(&bodies[0][i], &bodies[1][j]));
            let deep = found.iter().filter(|(depth, ..)| *depth > 1e-9);
            let of = |i, j| regions.iter().position(|region| region.covers(at(i, l), at(j, s)));
            let mut owners: Vec<_> = deep.map(|&(_, i, j)| of(i, j).expect("a deep point is in a region")).collect();
            let all = owners.len();
            owners.sort_unstable();
            owners.dedup();
            // Each component has a region of its own, and each region that is wider than the grid has a component.
            let wide = |region: &&RegionRef<'_, f64>| {
                let (first, second) = (region.length(), region.other_length());
                first.length() > 4.0 * l / count as f64 && second.length() > 4.0 * s / count as f64
            };
            owners.len() == all && regions.iter().filter(wide).count() <= all
        };
        compared += 1;
        several += u32::from(regions.len() > 1);
        if !agrees(64) {
            finer += 1;
            assert!(agrees(256) || agrees(1024), "seed {seed}: {:?} {:?}", case.poses, case.segments);
        }
    }
    assert!(compared > 360 && several > 30 && finer < 80, "{compared} {several} {finer}");
}

/// Two outlines that turn about one centre, which is a corner of the first one, or lies on its edge or inside of it; on a grid.
fn about_one_centre(random: &mut Random) -> Case {
    let mut eighths = |lo: usize, hi: usize| 0.125 * (lo + random.below(hi - lo)) as f64;
    let radii = [eighths(1, 9), eighths(1, 13)];
    let [behind, right, rounding] = [eighths(1, 8), eighths(1, 5), eighths(0, 3)];
    let places = [(0.0, 0.0), (eighths(1, 8), 0.0), (eighths(1, 8), eighths(1, 4))];
    let (ahead, over) = places[(8.0 * eighths(0, 3)) as usize];
    let first = Outline::rectangle(ahead, behind, radii[0] + over, right, rounding).unwrap();
    let second = Outline::rectangle(eighths(1, 6), eighths(1, 6), eighths(1, 4), eighths(1, 4), eighths(0, 2)).unwrap();
    let headings = [0, 1].map(|_| FRAC_PI_2 * (8.0 * eighths(0, 4)));
    let poses = [0, 1].map(|k| [radii[k] * headings[k].sin(), -radii[k] * headings[k].cos(), headings[k]]);
    let segments = radii.map(|radius| {
        let sweep = [FRAC_PI_2, PI, TAU, 1.0][random.below(4)];
        Vec::from([Step::Arc(radius, radius * sweep)])
    });
    Case { segments, kinks: [Vec::new(), Vec::new()], poses, outlines: [first, second] }
}

#[test]
fn pivots_on_corners_and_edges_and_concentric_arcs_lose_nothing() {
    let mut tally = Tally::default();
    for seed in 60_000..60_400_u64 {
        let mut random = Random::of(seed);
        let case = about_one_centre(&mut random);
        compare::<f64>(&case, &mut random, &mut tally, seed);
        compare::<f32>(&case, &mut random, &mut tally, seed);
    }
    assert!(tally.pairs > 600 && tally.inside > 5_000, "{tally:?}");
}

/// Two squares that turn about one corner: the second covers all of the first at a place at which a contact lies exactly at the end of the
/// segment. Who takes it for the begin of a covered part by its sign loses all.
#[test]
fn a_contact_at_the_end_of_a_segment_leaves_what_is_covered_covered() {
    let square = |x: f64, y: f64| {
        let side = 0.6;
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(a, b)| Vector { x: x + a, y: y + b });
        Outline::<f64, 4>::polygon(corners, 0.125).unwrap()
    };
    for turns in [FRAC_PI_2, PI, 1.25 * PI] {
        let first = standing(0.0, -0.5, 0.0).then_arc(0.5, TurnSide::Left, 0.5 * turns).unwrap();
        let second = standing(0.0, -0.25, 0.0).then_arc(0.25, TurnSide::Left, 0.25 * turns).unwrap();
        let (own, other) = (square(0.0, 0.5), square(-0.3, 0.25));
        let carriers = Carriers {
            first: Carried::new(&first, own.as_outline()),
            second: Carried::new(&second, other.as_outline()),
            radius: 0.25,
            slack: 1e-13,
        };
        for k in 0..=16 {
            let at = second.length() * f64::from(k) / 16.0;
            let slice = carriers.slice_of_first(at).unwrap();
            // Both always contain the centre.
            assert_eq!(slice.as_slice(), [Interval::new(0.0, first.length())], "{turns} {k}");
        }
    }
}

/// Two squares about one corner, with the numbers for which classifying contacts by their sign loses a collision 0.25 m deep.
#[test]
#[expect(clippy::excessive_precision, reason = "the numbers as they were found")]
fn squares_at_a_common_corner_are_covered_throughout() {
    let c = [0.35355339059327384, 0.85355339059327373];
    let about = |corners: [[f64; 2]; 4], radius: f64| {
        let corners = corners.map(|[x, y]| Vector { x: x - c[0], y: y - c[1] + radius });
        Outline::<f64, 4>::polygon(corners, 0.125).unwrap()
    };
    let own = about(
        [
            [0.35355339059327373, 0.42928932188134483],
            [-0.070710678118654363, 0.85355339059327395],
            [-0.35355339059327373, 0.57071067811865517],
            [0.070710678118654363, 0.1464466094067261],
        ],
        0.5,
    );
    let other = about(
        [
            [0.40355339059327366, 0.55355339059327346],
            [0.40355339059327411, 1.1535533905932738],
            [-0.19644660940672609, 1.1535533905932738],
            [-0.19644660940672631, 0.55355339059327391],
        ],
        0.25,
    );
    let first = standing(c[0], c[1] - 0.5, 0.0).then_arc(0.5, TurnSide::Left, 1.9634954084936207).unwrap();
    let second = standing(c[0], c[1] - 0.25, 0.0).then_arc(0.25, TurnSide::Left, 0.5).unwrap();
    let carriers = Carriers {
        first: Carried::new(&first, own.as_outline()),
        second: Carried::new(&second, other.as_outline()),
        radius: 0.25,
        slack: 1e-13,
    };
    let slice = carriers.slice_of_first(core::f64::consts::FRAC_PI_8).unwrap();
    assert_eq!(slice.as_slice(), [Interval::new(0.0, first.length())]);
}

/// A disc on a full circle touches the lane of a square exactly where the circle begins and ends. A first version took all of the circle as one piece.
#[test]
fn a_circle_that_touches_a_lane_at_both_ends_leaves_it_between() {
    let case = Case {
        segments: [
            Vec::from([Step::Line(1.25), Step::Line(2.0), Step::Arc(-1.0, TAU)]),
            Vec::from([Step::Arc(-0.5, FRAC_PI_2), Step::Arc(0.75, 1.1780972450961724), Step::Arc(-2.0, 2.0 * TAU)]),
        ],
        kinks: [Vec::new(), Vec::new()],
        poses: [[-1.5, -1.25, PI], [-1.25, -1.25, -FRAC_PI_2]],
        outlines: [Outline::rectangle(0.5, 0.5, 0.5, 0.5, 0.0).unwrap(), Outline::disc(0.25).unwrap()],
    };
    let (paths, outlines) = (case.paths::<f64>(), case.outlines::<f64>());
    let profiles =
        paths.each_ref().map(|path| Profile::<f64, 1>::from_pieces(1.0, [(path.as_path().length(), 0.0)]).unwrap());
    let fleet = [0, 1].map(|k| {
        let path: &Path<f64, 4> = &paths[k];
        Motion::with_outline(path.as_path(), profiles[k].as_profile(), &outlines[k], 0.0).unwrap()
    });
    let exact = [0, 1].map(|k| Exact::of(&case, k, &paths[k], outlines[k].as_outline()));
    let eps = excess(&fleet[0], &fleet[1]);
    let ecm = Ecm::build([EcmEntry::EMPTY; 64], [Piece::EMPTY; 256], &fleet).unwrap();
    let mut seen = 0;
    for region in ecm.pair(&fleet, 0, 1).unwrap() {
        // On a line the distance is a convex function of the length.
        for piece in region.pieces().filter(|piece| piece.segments[0] < 2) {
            for k in 0..=64 {
                let Interval { lo, hi } = piece.other_length;
                let other = exact[1].at((lo + (hi - lo) * f64::from(k) / 64.0).clamp(lo, hi));
                let apart = |length: f64| oracle(&exact[0].at(length), &other);
                let (mut lo, mut hi) = (piece.length.lo, piece.length.hi);
                for _ in 0..100 {
                    let [a, b] = [lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0];
                    if apart(a) < apart(b) { hi = b } else { lo = a }
                }
                assert!(apart(lo).min(apart(hi)) < 0.25 + eps, "{piece:?} {k}: {:e}", apart(lo) - 0.25);
                seen += 1;
            }
        }
    }
    assert!(seen > 4 * 64, "{seen}");
}

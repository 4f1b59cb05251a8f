//! What is free is free: places, durations and delays at the ends of what is forbidden.

use pcr_core::scalar::Micro;
use pcr_core::{
    Encounter, Interval, InvalidInput, Limits, Motion, Path, Point, Pose, Profile, Radians, Scalar, TurnSide,
    earliest_departure, earliest_start, least_duration, safe_intervals,
};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::generators::Dice;
use std::f64::consts::{FRAC_PI_2, PI};

fn at<S: HostScalar>(x: f64, y: f64, heading: f64) -> Pose<S> {
    Pose { position: Point::new(S::from_f64(x), S::from_f64(y)), heading: S::angle(heading).expect("an angle") }
}

fn unit_speed<S: HostScalar>(length: S) -> Profile<S, 1> {
    Profile::from_pieces(S::from_f64(1.0), [(length, S::ZERO)]).expect("small")
}

/// A path of five lines and arcs, and another agent that passes over each of its joints and its end.
fn joints<S: HostScalar>(cases: u64) {
    for seed in 0..cases {
        let dice = &mut Dice::seeded(seed);
        let mut path = Path::<S, 5>::starting_at(at(dice.range(-3.0, 3.0), dice.range(-3.0, 3.0), dice.range(-PI, PI)));
        for _ in 0..5 {
            let (length, bends) = (S::from_f64(dice.range(0.3, 2.0)), dice.chance(0.4));
            path = path.and_then(|path| {
                if bends { path.arc(S::from_f64(1.0), pcr_core::TurnSide::Left, length) } else { path.line(length) }
            });
        }
        let path = path.expect("small");
        let profile = Profile::<S, 3>::rest_to_rest(
            path.as_path().length(),
            Limits { speed: S::from_f64(1.0), acceleration: S::from_f64(1.0) },
        );
        let profile = profile.expect("small");
        let ego = Motion::new(path.as_path(), profile.as_profile(), S::from_f64(0.2), S::ZERO).expect("small");
        let ends = path.as_path().segments().iter().map(|segment| segment.from()).chain([path.as_path().length()]);
        for length in ends {
            let point = path.as_path().point_at(length);
            let heading = dice.range(-PI, PI);
            let [x, y] = [point.x.to_f64() - 2.0 * heading.cos(), point.y.to_f64() - 2.0 * heading.sin()];
            let over = Path::<S, 1>::starting_at(at(x, y, heading))
                .and_then(|path| path.line(S::from_f64(4.0)))
                .expect("small");
            let speed = unit_speed(S::from_f64(4.0));
            let other = Motion::new(over.as_path(), speed.as_profile(), S::from_f64(0.2), S::ZERO).expect("small");
            let fleet = [ego, other];
            let during = Interval::new(S::ZERO, S::from_f64(10.0));
            // At the place itself, and at what rounding makes of it.
            let slip = S::slack(path.as_path().length()).half();
            for place in [length - slip, length, length + slip] {
                let part = Interval::new(place, place);
                let blocked: Vec<_> = Encounter::new(&fleet[0], &fleet[1]).blocked(part, during).collect();
                let near = |a: S, b: f64| (a.to_f64() - b).abs() < 0.05;
                assert!(
                    blocked.len() == 1 && near(blocked[0].lo, 1.6) && near(blocked[0].hi, 2.4),
                    "seed {seed}: {length:?} {blocked:?}"
                );
                let safe: Vec<_> = safe_intervals(&fleet, 0, part, during).expect("agent 0").collect();
                assert_eq!(safe.len(), 2, "seed {seed}: {safe:?}");
                let ecm = build_ecm(&fleet).expect("two agents");
                let mut regions = ecm.pair(&fleet, 0, 1).expect("the table of the fleet");
                assert!(regions.any(|region| region.blocked(part, during).next().is_some()), "seed {seed}: {length:?}");
            }
        }
    }
}

#[test]
fn every_joint_and_the_end_of_a_path_is_blocked_by_who_passes_over_it() {
    let cases = if cfg!(optimized) { 300 } else { 60 };
    joints::<f64>(cases);
    joints::<f32>(cases);
    joints::<Micro>(cases);
    joints::<Q12>(cases);
    joints::<Q16>(cases);
    joints::<Q20>(cases);
}

/// Two lines that cross in their middles; the ego's profile is stretched.
struct Crossing {
    lengths: [f64; 2],
    radius: f64,
    start: f64,
    headings: [f64; 2],
}

impl Crossing {
    fn paths<S: HostScalar>(&self) -> [Path<S, 1>; 2] {
        [0, 1].map(|k| {
            let (half, heading) = (0.5 * self.lengths[k], self.headings[k]);
            let start = at(-half * heading.cos(), -half * heading.sin(), heading);
            Path::starting_at(start).and_then(|path| path.line(S::from_f64(self.lengths[k]))).expect("in range")
        })
    }

    /// The least duration from one on; nothing is met then.
    fn least<S: HostScalar>(&self, from: f64) -> Option<(f64, Option<[f64; 2]>)> {
        let paths = self.paths::<S>();
        let profiles = [0, 1].map(|k| unit_speed(S::from_f64(self.lengths[k])));
        let radius = S::from_f64(self.radius);
        let starts = [S::ZERO, S::from_f64(self.start)];
        let motion = |k: usize| Motion::new(paths[k].as_path(), profiles[k].as_profile(), radius, starts[k]).ok();
        let fleet = [motion(0)?, motion(1)?];
        let ecm = build_ecm(&fleet).expect("two agents");
        let row = || ecm.row(&fleet, 0).expect("the table of the fleet");
        let forbidden = row().next().and_then(|region| region.forbidden_durations::<1>().expect("room"));
        let least = least_duration::<S, 1>(row(), S::from_f64(from)).expect("room")?;
        let stretched = Profile::<S, 1>::stretched(fleet[0].profile(), least).expect("a duration");
        let slower = fleet[0].with_profile(stretched.as_profile(), fleet[0].time().lo).expect("a motion");
        let pair = Encounter::new(&slower, &fleet[1]);
        let deep = pair.conflicts(pair.time()).find(|conflict| !conflict.touching);
        assert_eq!(deep, None, "{} in {least:?} s: {forbidden:?}", S::NAME);
        Some((least.to_f64(), forbidden.map(|forbidden| [forbidden.lo.to_f64(), forbidden.hi.to_f64()])))
    }
}

/// Found by an audit: the product of two times is beyond the format, its quotient is not.
#[test]
fn durations_are_forbidden_as_far_as_the_format_goes() {
    let crossing = Crossing { lengths: [40.0; 2], radius: 0.25, start: 40.0, headings: [0.0, FRAC_PI_2] };
    let (exact, forbidden) = crossing.least::<f64>(120.0).expect("a duration");
    let [lo, hi] = forbidden.expect("a conflict");
    let right = (lo - 116.911).abs() < 1e-3 && (hi - 123.239).abs() < 1e-3 && (exact - hi).abs() < 1e-6;
    assert!(right, "{lo} to {hi}, {exact}");
    for found in [
        crossing.least::<Q20>(120.0),
        crossing.least::<Q16>(120.0),
        crossing.least::<f32>(120.0),
        crossing.least::<Micro>(120.0),
    ] {
        let (least, forbidden) = found.expect("a duration");
        let [lo, hi] = forbidden.expect("a conflict");
        assert!((lo - 116.911).abs() < 1e-1 && (hi - 123.239).abs() < 1e-1 && (least - exact).abs() < 1e-1, "{least}");
    }
    let crossing = Crossing { lengths: [150.0; 2], radius: 0.25, start: 200.0, headings: [0.0, FRAC_PI_2] };
    let exact = crossing.least::<f64>(550.0).expect("a duration").0;
    assert!((crossing.least::<Q16>(550.0).expect("a duration").0 - exact).abs() < 0.1 && exact > 551.0, "{exact}");
}

#[test]
fn least_durations_meet_nobody_up_to_the_limits_of_times() {
    fn all<S: HostScalar>(cases: u64) {
        let (limit, mut found) = (S::LIMIT.to_f64(), 0);
        for seed in 0..cases {
            let dice = &mut Dice::seeded(seed);
            let scale = 10.0_f64.powf(dice.range(1.0, (0.2 * limit).log10().min(4.0)));
            let lengths = [dice.range(0.2, 1.0) * scale, dice.range(0.2, 1.0) * scale];
            let headings = [dice.range(-PI, PI), dice.range(-PI, PI)];
            let crossing =
                Crossing { lengths, radius: dice.range(0.1, 0.04 * scale), start: dice.range(0.0, scale), headings };
            found += u64::from(crossing.least::<S>(lengths[0] * dice.range(0.8, 3.0)).is_some());
        }
        assert!(found * 2 > cases, "{found} of {cases} in {}", S::NAME);
    }
    let cases = if cfg!(optimized) { 400 } else { 60 };
    all::<f64>(cases);
    all::<f32>(cases);
    all::<Q12>(cases);
    all::<Q16>(cases);
    all::<Q20>(cases);
}

/// Nearly head-on the largest delay is in the corner of what the ranges of the region allow: |s - l| <= R / sin(θ / 2).
#[test]
fn the_corner_of_a_region_is_forbidden() {
    let angle = 1e-5_f64;
    let crossing = Crossing { lengths: [2.4e5; 2], radius: 0.5, start: 0.0, headings: [0.0, PI - angle] };
    let paths = crossing.paths::<f64>();
    let profile = unit_speed(2.4e5);
    let fleet =
        paths.each_ref().map(|path| Motion::new(path.as_path(), profile.as_profile(), 0.5, 0.0).expect("small"));
    let ecm = build_ecm(&fleet).expect("two agents");
    let region = ecm.row(&fleet, 0).expect("the table of the fleet").next().expect("a crossing");
    let forbidden = region.forbidden_delays();
    let exact = 1.0 / (0.5 * angle).sin();
    assert!(exact < forbidden.hi + 1e-5 && -exact > forbidden.lo - 1e-5, "{exact}: {forbidden:?}");
    assert!(forbidden.hi < exact + 1e-3 && forbidden.lo > -exact - 1e-3, "{exact}: {forbidden:?}");
}

/// After many turns a heading is rounded by more than a direction: what is missing is passed on along the path, and has to
/// reach the parts of a segment as well.
fn after_many_turns<S: HostScalar<Angle = Radians<S>>>(heading: f64, missing: f64, bends: bool) {
    let (length, bend) = (S::from_f64(90.0), S::from_f64(100.0));
    let start = Pose { position: Point::new(S::ZERO, S::ZERO), heading: Radians(S::from_f64(heading)) };
    let path = Path::<S, 1>::starting_at(start).and_then(|path| path.turn(Radians(S::from_f64(missing))));
    let path = path.and_then(|path| if bends { path.arc(bend, TurnSide::Left, length) } else { path.line(length) });
    let path = path.expect("in range");
    let end = path.as_path().point_at(length);
    let (sin, cos) = (heading + missing + if bends { 0.9 } else { 0.0 }).sin_cos();
    // Aside by less than R, and by more if the heading were the rounded one.
    let aside = 1.0 - 30.0 * missing;
    let stands = Path::<S, 1>::starting_at(at(end.x.to_f64() - aside * sin, end.y.to_f64() + aside * cos, 0.0));
    let (stands, speed, still) = (stands.expect("in range"), unit_speed(length), Profile::<S, 1>::standing());
    let radius = S::from_f64(0.5);
    let fleet = [
        Motion::new(path.as_path(), speed.as_profile(), radius, S::ZERO).expect("in range"),
        Motion::new(stands.as_path(), still.as_profile(), radius, S::ZERO).expect("in range"),
    ];
    let ecm = build_ecm(&fleet).expect("two agents");
    let during = Interval::new(S::ZERO, length);
    for from in [0.0, 10.0, 45.0] {
        let part = Interval::new(S::from_f64(from), length);
        assert_eq!(Encounter::new(&fleet[0], &fleet[1]).blocked(part, during).collect::<Vec<_>>(), [during], "{from}");
        assert_eq!(safe_intervals(&fleet, 0, part, during).expect("agent 0").collect::<Vec<_>>(), [], "{from}");
        let mut regions = ecm.row(&fleet, 0).expect("the table of the fleet");
        assert!(regions.any(|region| region.blocked(part, during).eq([during])), "{from}");
    }
}

#[test]
fn parts_of_a_path_are_blocked_as_the_whole_after_many_turns() {
    for bends in [false, true] {
        after_many_turns::<f64>(f64::from(1 << 23), 0.9e-9, bends);
        after_many_turns::<f32>(1000.0, 3e-5, bends);
    }
}

/// The box of a part of an arc is that of the arc, and not of the turn in place that follows.
fn part_before_a_turn<S: HostScalar>(left: bool) {
    let (side, turn) = if left { (1.0, TurnSide::Left) } else { (-1.0, TurnSide::Right) };
    let length = S::from_f64(0.75 * PI);
    let path = Path::<S, 1>::starting_at(at(0.0, 0.0, 0.0)).and_then(|path| path.arc(S::from_f64(1.0), turn, length));
    let path = path.and_then(|path| path.turn(S::angle(-side * FRAC_PI_2).expect("an angle"))).expect("small");
    let stands = Path::<S, 1>::starting_at(at(1.3, side, 0.0)).expect("small");
    let (speed, still) = (unit_speed(path.as_path().length()), Profile::<S, 1>::standing());
    let radius = S::from_f64(0.25);
    let ego = Motion::new(path.as_path(), speed.as_profile(), radius, S::ZERO).expect("small");
    let other = Motion::new(stands.as_path(), still.as_profile(), radius, S::ZERO).expect("small");
    let during = Interval::new(S::ZERO, S::from_f64(5.0));
    let fleet = [ego, other];
    for from in [0.0, 0.1, 0.5] {
        let part = Interval::new(S::from_f64(from), path.as_path().length());
        let blocked: Vec<_> = Encounter::new(&fleet[0], &fleet[1]).blocked(part, during).collect();
        assert_eq!(blocked, [during], "{from} in {}", S::NAME);
    }
}

#[test]
fn parts_of_arcs_before_a_turn_in_place_are_blocked_as_the_whole() {
    for left in [false, true] {
        part_before_a_turn::<f64>(left);
        part_before_a_turn::<f32>(left);
        part_before_a_turn::<Micro>(left);
        part_before_a_turn::<Q12>(left);
        part_before_a_turn::<Q16>(left);
        part_before_a_turn::<Q20>(left);
    }
}

/// A crossing that the ego passes so early that only durations beyond the format lead into the other's way.
#[test]
fn no_duration_is_forbidden_if_all_of_them_are_beyond_the_format() {
    fn forbidden<S: HostScalar>() -> Option<Interval<S>> {
        let paths = [(at(0.0, 0.0, 0.0), 100.0), (at(2.0, -2.0, FRAC_PI_2), 4.0)].map(|(start, length)| {
            Path::<S, 1>::starting_at(start).and_then(|path| path.line(S::from_f64(length))).expect("in range")
        });
        let profiles = [100.0, 4.0].map(|length| unit_speed(S::from_f64(length)));
        let starts = [0.0, 120.0].map(S::from_f64);
        let motion = |k: usize| {
            Motion::new(paths[k].as_path(), profiles[k].as_profile(), S::from_f64(0.25), starts[k]).expect("in range")
        };
        let fleet = [motion(0), motion(1)];
        let ecm = build_ecm(&fleet).expect("two agents");
        let region = ecm.row(&fleet, 0).expect("the table of the fleet").next().expect("a crossing");
        region.forbidden_durations::<1>().expect("room")
    }
    assert_eq!(forbidden::<Q16>(), None);
    let exact = forbidden::<f64>().expect("durations");
    assert!((exact.lo - 4876.0).abs() < 40.0 && exact.lo < exact.hi, "{exact:?}");
}

/// Another one that passes at a distance of R, or a last digit less, blocks the place.
fn grazed<S: HostScalar>(cases: u64) {
    for seed in 0..cases {
        let dice = &mut Dice::seeded(seed);
        let place = Path::<S, 1>::starting_at(at(dice.range(-9.0, 9.0), dice.range(-9.0, 9.0), 0.0)).expect("small");
        let point = place.as_path().point_at(S::ZERO);
        let radii = [S::from_f64(dice.range(0.1, 2.0)), S::from_f64(dice.range(0.1, 2.0))];
        let reach = radii[0].to_f64() + radii[1].to_f64();
        let heading = dice.range(-PI, PI);
        let (sin, cos) = heading.sin_cos();
        let aside = reach * (1.0 - 2.0 * S::slack(S::from_f64(0.1)).to_f64());
        let [x, y] = [point.x.to_f64() - 5.0 * cos - aside * sin, point.y.to_f64() - 5.0 * sin + aside * cos];
        let way =
            Path::<S, 1>::starting_at(at(x, y, heading)).and_then(|path| path.line(S::from_f64(10.0))).expect("small");
        let speed = unit_speed(S::from_f64(10.0));
        let stands =
            Motion::new(place.as_path(), Profile::<S, 1>::standing().as_profile(), radii[0], S::ZERO).map(|_| ());
        assert_eq!(stands, Ok(()));
        let standing = Profile::<S, 1>::standing();
        let ego = Motion::new(place.as_path(), standing.as_profile(), radii[0], S::ZERO).expect("small");
        let other = Motion::new(way.as_path(), speed.as_profile(), radii[1], S::ZERO).expect("small");
        let blocked = Encounter::new(&ego, &other)
            .blocked(Interval::new(S::ZERO, S::ZERO), Interval::new(S::ZERO, S::from_f64(10.0)))
            .next();
        // As near as the numbers of the path tell: the start and the direction are rounded.
        let segment = &way.as_path().segments()[0];
        let (from, to) = (segment.point_at(S::ZERO), segment.point_at(segment.length()));
        let [dx, dy] = [to.x.to_f64() - from.x.to_f64(), to.y.to_f64() - from.y.to_f64()];
        let [px, py] = [point.x.to_f64() - from.x.to_f64(), point.y.to_f64() - from.y.to_f64()];
        let distance = (dx * py - dy * px).abs() / dx.hypot(dy);
        assert!(blocked.is_some() || distance > reach, "seed {seed}: {} below {reach}", reach - distance);
    }
}

#[test]
fn a_place_that_is_grazed_is_blocked() {
    let cases = if cfg!(optimized) { 20_000 } else { 2_000 };
    grazed::<f64>(cases);
    grazed::<f32>(cases);
    grazed::<Micro>(cases);
    grazed::<Q12>(cases);
    grazed::<Q16>(cases);
    grazed::<Q20>(cases);
}

/// What the format does not hold is nothing to begin a search from.
#[test]
fn searches_from_beyond_the_format_find_nothing() {
    let crossing = Crossing { lengths: [4.0; 2], radius: 0.25, start: 0.0, headings: [0.0, FRAC_PI_2] };
    let paths = crossing.paths::<f64>();
    let profile = unit_speed(4.0);
    let motion = |k: usize| Motion::new(paths[k].as_path(), profile.as_profile(), 0.25, 0.0).expect("small");
    let fleet = [motion(0), motion(1)];
    let ecm = build_ecm(&fleet).expect("two agents");
    let row = || ecm.row(&fleet, 0).expect("the table of the fleet");
    for from in [f64::NAN, f64::INFINITY, 2.0 * f64::LIMIT] {
        assert_eq!((earliest_start(row(), from), earliest_departure(row(), 1.0, from)), (None, None));
        let refused = least_duration::<f64, 1>(row(), from);
        assert!(
            matches!(refused, Err(InvalidInput::NonFinite("duration") | InvalidInput::OutOfRange("duration"))),
            "{refused:?}"
        );
    }
    assert_eq!(least_duration::<f64, 1>(row(), 0.0), Err(InvalidInput::NonPositive("duration")));
    // A wait beyond the end of the path is one at the end; one at no length is none.
    assert_eq!(earliest_departure(row(), 5.0, 0.0), earliest_departure(row(), 4.0, 0.0));
    assert!(earliest_departure(row(), 4.0, 0.0).is_some());
    assert_eq!([f64::NAN, f64::INFINITY].map(|length| earliest_departure(row(), length, 0.0)), [None; 2]);
}

/// A ramp of 15,000 s at one last digit of acceleration, and somebody who goes beside it at its mean speed: where the ramp is slowest they
/// overlap by 0.4 m. By the acceleration, rounded to the format, the ramp was straighter, and nobody met.
#[test]
fn a_slow_ramp_in_fixed_point_is_no_line() {
    let n = <Q12 as HostScalar>::from_f64;
    let path = |x: f64, length: f64| {
        let pose = Pose {
            position: Point::new(n(x), <Q12 as Scalar>::ZERO),
            heading: <Q12 as HostScalar>::angle(0.0).expect("an angle"),
        };
        Path::<Q12, 1>::starting_at(pose).and_then(|path| path.line(n(length))).expect("within the format")
    };
    let lead = [(13732.92041015625, 0.0), (15001.5, 0.000244140625), (2000.0, 0.0)].map(|(t, a)| (n(t), n(a)));
    let lead = Profile::<Q12, 3>::from_pieces(n(0.5), lead).expect("within the format");
    let beside = [(15000.490234375, 0.0), (3200.0, 0.0)].map(|(t, a)| (n(t), n(a)));
    let beside = Profile::<Q12, 2>::from_pieces(n(2.331298828125), beside).expect("within the format");
    for closer in [0.0, 0.05] {
        let paths = [
            path(10.0, lead.as_profile().length().to_f64()),
            path(8.980011224746704 + closer, beside.as_profile().length().to_f64()),
        ];
        let one = Motion::new(paths[0].as_path(), lead.as_profile(), n(0.5), <Q12 as Scalar>::ZERO).expect("a motion");
        let other =
            Motion::new(paths[1].as_path(), beside.as_profile(), n(0.5), n(13733.42529296875)).expect("a motion");
        let pair = Encounter::new(&one, &other);
        let deepest =
            pair.conflicts(pair.time()).map(|conflict| conflict.deepest.separation.to_f64()).fold(9.0, f64::min);
        assert!((deepest - (0.6 - closer)).abs() < 0.04, "{deepest}");
        assert!((pair.closest(pair.time()).separation.to_f64() - (0.6 - closer)).abs() < 0.04);
    }
}

/// Stretched to 2,400 s, a ramp has less than half a last digit of acceleration. It was a line then.
#[test]
fn a_motion_that_is_stretched_is_not_straightened() {
    fn meets<S: HostScalar>() {
        let n = S::from_f64;
        let limits = Limits { speed: n(1.0), acceleration: n(0.5) };
        let quick = Profile::<S, 3>::rest_to_rest(n(4.0), limits).expect("small");
        let slow = Profile::<S, 3>::stretched(quick.as_profile(), n(2400.0)).expect("small");
        let along = Path::<S, 1>::starting_at(at(0.0, 0.0, 0.0)).and_then(|path| path.line(n(4.0))).expect("small");
        let ego = Motion::new(along.as_path(), slow.as_profile(), n(0.2), S::ZERO).expect("small");
        // Half of the ramp, after which a quarter of its way is behind.
        for time in [200.0, 400.0, 600.0] {
            let exact = (time / 800.0_f64).powi(2);
            assert!((ego.length_at(n(time)).to_f64() - exact).abs() < 1e-3, "{time}");
            assert!((slow.as_profile().speed_at(n(time)).to_f64() - time / 320_000.0).abs() < 1e-3, "{time}");
        }
        let (speed, radius) = (0.002, 0.4);
        for tenth in -6..=6 {
            let x = 0.25 + 0.1 * f64::from(tenth);
            let across =
                Path::<S, 1>::starting_at(at(x, -1.0, FRAC_PI_2)).and_then(|path| path.line(n(2.0))).expect("small");
            let profile = Profile::<S, 1>::from_pieces(n(speed), [(n(1000.0), S::ZERO)]).expect("small");
            let length = profile.as_profile().length().to_f64();
            let across = if (length - 2.0).abs() < 1e-9 {
                across
            } else {
                Path::<S, 1>::starting_at(at(x, -1.0, FRAC_PI_2)).and_then(|path| path.line(n(length))).expect("small")
            };
            let other = Motion::new(across.as_path(), profile.as_profile(), n(0.2), n(-100.0)).expect("small");
            let least = (0..8000).map(|k| n(0.1 * f64::from(k))).map(|time| {
                let [a, b] = [ego.position_at(time), other.position_at(time)];
                (a.x.to_f64() - b.x.to_f64()).hypot(a.y.to_f64() - b.y.to_f64())
            });
            let (least, pair) = (least.fold(9.0, f64::min), Encounter::new(&ego, &other));
            let (margin, found) = (0.002, pair.contacts(pair.time()).next().is_some());
            if (least - radius).abs() > margin + pair.tolerance().to_f64() {
                assert_eq!(found, least < radius, "{}, {x}: {least}", S::NAME);
            }
        }
    }
    meets::<f64>();
    meets::<f32>();
    meets::<Q16>();
    meets::<Q12>();
}

//! What the constructors refuse, and that nothing gets past them that could panic later.

use pcr_core::{
    Interval, Invalid, Limits, Motion, Path, PathRef, Phase, Point, Pose, Profile, ProfileRef, Segment, Turn,
};
use pcr_host::fleet::{Format, build_ecm};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, RngSeed, TestRunner};
use std::cell::Cell;

/// Numbers that are no numbers, or hardly.
const GARBAGE: [f64; 22] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    f64::MIN_POSITIVE,
    5e-324,
    -5e-324,
    f64::MAX,
    f64::MIN,
    1e300,
    1e-300,
    1e12,
    -1e12,
    1e6,
    1.1e12,
    1e-12,
    f64::EPSILON,
    std::f64::consts::PI,
    1.0,
    -1.0,
    0.5,
];

fn at<S: Format>(x: f64, y: f64, heading: f64) -> Pose<S> {
    Pose { position: Point::new(S::from_f64(x), S::from_f64(y)), heading: S::angle(heading) }
}

fn origin<S: Format>() -> Segment<S> {
    Segment::standing(at(0.0, 0.0, 0.0)).expect("a finite pose")
}

/// A value, and how a constructor refuses it.
type Refusal = (f64, fn(&'static str) -> Invalid);

/// Values that are refused wherever a number of any sign is taken, and how.
fn refused_anywhere<S: Format>() -> Vec<Refusal> {
    let beyond = S::LIMIT.to_f64() * 1.01;
    vec![
        (f64::NAN, Invalid::NonFinite as fn(_) -> _),
        (f64::INFINITY, Invalid::NonFinite),
        (f64::NEG_INFINITY, Invalid::NonFinite),
        (beyond, Invalid::OutOfRange),
        (-beyond, Invalid::OutOfRange),
    ]
}

fn refused_unless_positive<S: Format>() -> Vec<Refusal> {
    let mut values = refused_anywhere::<S>();
    values.extend([
        (0.0, Invalid::NonPositive as fn(_) -> _),
        (-0.0, Invalid::NonPositive),
        (-1.0, Invalid::NonPositive),
        (-1e-30, Invalid::NonPositive),
    ]);
    values
}

fn refused_if_negative<S: Format>() -> Vec<Refusal> {
    let mut values = refused_anywhere::<S>();
    values.extend([(-1.0, Invalid::Negative as fn(_) -> _), (-1e-30, Invalid::Negative)]);
    values
}

fn each<S: Format, T>(values: Vec<Refusal>, what: &'static str, make: impl Fn(S) -> Result<T, Invalid>) {
    for (value, error) in values {
        assert_eq!(make(S::from_f64(value)).err(), Some(error(what)), "{value} as {what}");
    }
}

fn poses<S: Format>() {
    each::<S, _>(refused_anywhere::<S>(), "x", |x| {
        Segment::standing(Pose { position: Point::new(x, S::ZERO), ..at(0.0, 0.0, 0.0) })
    });
    each::<S, _>(refused_anywhere::<S>(), "y", |y| {
        Segment::standing(Pose { position: Point::new(S::ZERO, y), ..at(0.0, 0.0, 0.0) })
    });
    for heading in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(Path::<S, 1>::starting_at(at(0.0, 0.0, heading)).err(), Some(Invalid::NonFinite("heading")));
    }
}

fn segments<S: Format>() {
    let one = S::from_f64(1.0);
    each::<S, _>(refused_if_negative::<S>(), "length", |length| origin().then_line(length));
    each::<S, _>(refused_if_negative::<S>(), "length", |length| origin().then_arc(one, Turn::Left, length));
    each::<S, _>(refused_unless_positive::<S>(), "radius", |radius| origin().then_arc(radius, Turn::Right, one));
    let below = S::from_f64(0.9 * S::LEAST.to_f64());
    if below < S::LEAST {
        assert_eq!(origin().then_arc(below, Turn::Left, S::ZERO).err(), Some(Invalid::TooSmall("radius")));
    }
    assert!(origin().then_arc(S::LEAST, Turn::Left, S::ZERO).is_ok());
    // Lengths are not multiplied with one another.
    assert!(origin().then_line(S::from_f64(f64::MIN_POSITIVE)).is_ok());
    for sweep in [6.284, 7.0, 100.0] {
        let long = origin().then_arc(one, Turn::Left, S::from_f64(sweep));
        assert_eq!(long.err(), Some(Invalid::SweepOverOneTurn), "{sweep} rad");
    }
    // A path that leaves the range, in space or in length.
    let far = S::from_f64(0.6 * S::LIMIT.to_f64());
    let east = Path::<S, 4>::starting_at(at(0.0, 0.0, 0.0)).expect("a finite pose");
    assert_eq!(east.clone().line(far).and_then(|path| path.line(far)).err(), Some(Invalid::OutOfRange("x")));
    let north = Path::<S, 4>::starting_at(at(0.0, 0.0, std::f64::consts::FRAC_PI_2)).expect("a finite pose");
    assert_eq!(north.line(far).and_then(|path| path.line(far)).err(), Some(Invalid::OutOfRange("y")));
    let back = Path::<S, 4>::starting_at(at(-0.6 * S::LIMIT.to_f64(), 0.0, 0.0)).expect("a finite pose");
    assert_eq!(back.line(far).and_then(|path| path.line(far)).err(), Some(Invalid::OutOfRange("length of the path")));
}

fn capacities<S: Format>() {
    let one = S::from_f64(1.0);
    let full = Path::<S, 2>::starting_at(at(0.0, 0.0, 0.0)).and_then(|path| path.line(one)?.arc(one, Turn::Left, one));
    let full = full.expect("two segments");
    assert_eq!(full.clone().line(one).err(), Some(Invalid::Full("segment")));
    assert!(full.line(S::ZERO).is_ok(), "a length of 0 needs no room");
    let pieces = [(one, S::ZERO); 3];
    assert_eq!(Profile::<S, 2>::from_pieces(one, pieces).err(), Some(Invalid::Full("phase")));
    assert!(Profile::<S, 3>::from_pieces(one, pieces).is_ok());
}

fn chains<S: Format>() {
    let one = S::from_f64(1.0);
    let first = origin::<S>().then_line(one).expect("a line");
    let second = first.then_arc(one, Turn::Left, one).expect("an arc");
    assert_eq!(PathRef::<S>::new(&[]).err(), Some(Invalid::Disconnected("path")));
    assert_eq!(PathRef::new(&[second]).err(), Some(Invalid::Disconnected("path")), "does not begin at length 0");
    assert_eq!(PathRef::new(&[first, first]).err(), Some(Invalid::Disconnected("segment")));
    assert!(PathRef::new(&[first, second]).is_ok());
    let turned = Segment::standing(at::<S>(0.0, 0.0, 1.0)).and_then(|turned| turned.then_line(one)).expect("a line");
    assert_eq!(PathRef::new(&[turned, second]).err(), Some(Invalid::Disconnected("segment")));

    let start = Phase::starting_at(S::ZERO, one, one).expect("a phase");
    let next = start.then(one, S::ZERO).expect("a phase");
    assert_eq!(ProfileRef::new(&[next]).err(), Some(Invalid::Disconnected("phase")));
    assert_eq!(ProfileRef::new(&[start, start]).err(), Some(Invalid::Disconnected("phase")));
    assert!(ProfileRef::new(&[start, next]).is_ok());
    assert!(ProfileRef::<S>::new(&[]).is_ok(), "an agent that stands");
}

fn profiles<S: Format>() {
    let one = S::from_f64(1.0);
    let limits = Limits { speed: one, acceleration: one };
    each::<S, _>(refused_if_negative::<S>(), "length", |length| Profile::rest_to_rest(length, limits));
    each::<S, _>(refused_unless_positive::<S>(), "largest speed", |speed| {
        Profile::rest_to_rest(one, Limits { speed, ..limits })
    });
    each::<S, _>(refused_unless_positive::<S>(), "largest acceleration", |acceleration| {
        Profile::rest_to_rest(one, Limits { acceleration, ..limits })
    });
    each::<S, _>(refused_if_negative::<S>(), "initial speed", |speed| Phase::starting_at(speed, one, S::ZERO));
    each::<S, _>(refused_if_negative::<S>(), "duration", |duration| Phase::starting_at(one, duration, S::ZERO));
    each::<S, _>(refused_anywhere::<S>(), "acceleration", |acceleration| Phase::starting_at(one, one, acceleration));
    // To a speed below 0.
    let two = S::from_f64(2.0);
    assert_eq!(Phase::starting_at(one, two, -one).err(), Some(Invalid::Negative("speed")));
    // To a speed, a time, a length beyond the range.
    let large = S::from_f64(0.9 * S::LIMIT.to_f64());
    assert_eq!(Phase::starting_at(one, large, two).err(), Some(Invalid::OutOfRange("speed")));
    assert_eq!(Phase::starting_at(two, large, S::ZERO).err(), Some(Invalid::OutOfRange("length of the profile")));
    let wait = Phase::starting_at(S::ZERO, large, S::ZERO).expect("a long wait");
    assert_eq!(wait.then(large, S::ZERO).err(), Some(Invalid::OutOfRange("duration of the profile")));
    let crawl = Limits { speed: S::from_f64(1e-3), acceleration: one };
    assert_eq!(Profile::rest_to_rest(large, crawl).err(), Some(Invalid::OutOfRange("duration of the profile")));
}

fn motions<S: Format>() {
    let one = S::from_f64(1.0);
    let path = Path::<S, 1>::starting_at(at(0.0, 0.0, 0.0)).and_then(|path| path.line(one)).expect("a path");
    let profile = Profile::rest_to_rest(one, Limits { speed: one, acceleration: one }).expect("a profile");
    let make = |radius, start| Motion::new(path.as_path(), profile.as_profile(), radius, start);
    each::<S, _>(refused_unless_positive::<S>(), "radius", |radius| make(radius, S::ZERO));
    each::<S, _>(refused_anywhere::<S>(), "start time", |start| make(one, start));
    assert_eq!(make(one, S::LIMIT).err(), Some(Invalid::OutOfRange("end time")));
    let motion = make(one, S::ZERO).expect("a motion");
    each::<S, _>(refused_anywhere::<S>(), "delay", |delay| motion.delayed(delay));
    assert_eq!(motion.delayed(S::LIMIT).err(), Some(Invalid::OutOfRange("end time")));
    for length in [0.0, 0.5, 0.999, 1.001, 2.0] {
        let limits = Limits { speed: one, acceleration: one };
        let other = Profile::rest_to_rest(S::from_f64(length), limits).expect("a profile");
        let outcome = Motion::new(path.as_path(), other.as_profile(), one, S::ZERO);
        assert_eq!(outcome.err(), Some(Invalid::LengthMismatch), "{length} m on 1 m");
    }
}

/// Whatever the constructors accept can be put to any use. More than one case in twenty has a region.
fn harmless<S: Format>() {
    let cases = if cfg!(optimized) { 40_000 } else { 4_000 };
    let mut runner = TestRunner::new(Config {
        cases,
        failure_persistence: None,
        // Every number begins a generator of its own, which takes ChaCha longer than what is tested.
        rng_algorithm: RngAlgorithm::XorShift,
        rng_seed: RngSeed::Fixed(40),
        ..Config::default()
    });
    let met = Cell::new(0);
    let outcome = runner.run(&prop::collection::vec(garbage(), 40), |numbers| {
        met.set(met.get() + u32::from(survives::<S>(&numbers)));
        Ok(())
    });
    outcome.unwrap_or_else(|failed| panic!("{failed}"));
    assert!(20 * met.get() > cases, "{} of {cases} have a region", met.get());
}

/// Whether two motions that are made of these numbers have a region.
fn survives<S: Format>(numbers: &[f64]) -> bool {
    let mut next = numbers.iter().copied().cycle();
    let mut number = || S::from_f64(next.next().unwrap_or_default());
    let mut motion_parts = || {
        let (x, y, heading) = (number(), number(), number().to_f64());
        let mut last = Segment::standing(Pose { position: Point::new(x, y), heading: S::angle(heading) }).ok()?;
        let mut segments = vec![];
        for _ in 0..3 {
            let arc = last.then_arc(number(), if number() > S::ZERO { Turn::Left } else { Turn::Right }, number());
            if let Some(next) = arc.or_else(|_| last.then_line(number())).ok().filter(|next| next.length() > S::ZERO) {
                segments.push(next);
                last = next;
            }
        }
        if segments.is_empty() {
            segments.push(last);
        }
        let length = PathRef::new(&segments).ok()?.length();
        let profile = Profile::rest_to_rest(length, Limits { speed: number(), acceleration: number() });
        let profile = profile.or_else(|_| {
            let one = S::from_f64(1.0);
            Profile::rest_to_rest(length, Limits { speed: one, acceleration: one })
        });
        Some((segments, profile.ok()?, number(), number()))
    };
    let parts: Vec<_> = (0..2).filter_map(|_| motion_parts()).collect();
    let motions: Vec<_> = parts
        .iter()
        .filter_map(|(segments, profile, radius, start)| {
            let path = PathRef::new(segments).ok()?;
            let one = S::from_f64(1.0);
            Motion::new(path, profile.as_profile(), *radius, *start)
                .or_else(|_| Motion::new(path, profile.as_profile(), one, S::ZERO))
                .ok()
        })
        .collect();
    let Ok(ecm) = build_ecm(&motions) else { return false };
    for region in ecm.regions(&motions) {
        let finite =
            |interval: Interval<S>| interval.lo.is_finite() && interval.hi.is_finite() && interval.lo <= interval.hi;
        assert!(finite(region.time()) && finite(region.length()) && finite(region.other_length()));
        for &time in numbers {
            for interval in region.slice_at(S::from_f64(time)) {
                assert!(finite(interval));
            }
            region.contains(S::from_f64(time), S::from_f64(numbers[0]));
        }
    }
    !ecm.is_empty()
}

fn garbage() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => (0..GARBAGE.len()).prop_map(|k| GARBAGE[k]),
        2 => any::<f64>(),
        5 => -10.0..10.0_f64,
        2 => (-12.0..12.0_f64).prop_map(|power| 10.0_f64.powf(power)),
    ]
}

macro_rules! in_format {
    ($module:ident, $format:ident) => {
        mod $module {
            use super::*;

            #[test]
            fn poses_are_finite_and_in_range() {
                poses::<$format>();
            }

            #[test]
            fn segments_have_lengths_and_radii_in_range() {
                segments::<$format>();
            }

            #[test]
            fn capacities_are_kept() {
                capacities::<$format>();
            }

            #[test]
            fn chains_are_connected() {
                chains::<$format>();
            }

            #[test]
            fn profiles_have_limits_and_phases_in_range() {
                profiles::<$format>();
            }

            #[test]
            fn motions_have_radii_and_times_in_range() {
                motions::<$format>();
            }

            #[test]
            fn whatever_is_accepted_does_no_harm() {
                harmless::<$format>();
            }
        }
    };
}

in_format!(in_f64, f64);
in_format!(in_f32, f32);

//! What the constructors refuse. That nothing gets past them that could do harm later is in `limits.rs`.

use pcr_core::{
    BrakingModel, Encounter, InvalidInput, Limits, Motion, Path, PathRef, Phase, Point, Pose, Profile, ProfileRef,
    Radians, Segment, TurnSide,
};
use pcr_formats::scenario::{LENGTH_TOLERANCE, Scenario};
use pcr_planning::fleet::{Fleet, HostScalar};

fn at<S: HostScalar>(x: f64, y: f64, heading: f64) -> Pose<S> {
    Pose { position: Point::new(S::from_f64(x), S::from_f64(y)), heading: S::angle(heading).expect("an angle") }
}

fn origin<S: HostScalar>() -> Segment<S> {
    Segment::standing(at(0.0, 0.0, 0.0)).expect("a finite pose")
}

/// A value, and how a constructor refuses it.
type Refusal = (f64, fn(&'static str) -> InvalidInput);

/// Values that are refused wherever a number of any sign is taken, and how.
fn refused_anywhere<S: HostScalar>() -> Vec<Refusal> {
    let beyond = S::LIMIT.to_f64() * 1.01;
    vec![
        (f64::NAN, InvalidInput::NonFinite as fn(_) -> _),
        (f64::INFINITY, InvalidInput::NonFinite),
        (f64::NEG_INFINITY, InvalidInput::NonFinite),
        (beyond, InvalidInput::OutOfRange),
        (-beyond, InvalidInput::OutOfRange),
    ]
}

fn refused_unless_positive<S: HostScalar>() -> Vec<Refusal> {
    let mut values = refused_anywhere::<S>();
    values.extend([
        (0.0, InvalidInput::NonPositive as fn(_) -> _),
        (-0.0, InvalidInput::NonPositive),
        (-1.0, InvalidInput::NonPositive),
        (-1e-30, InvalidInput::NonPositive),
    ]);
    values
}

fn refused_if_negative<S: HostScalar>() -> Vec<Refusal> {
    let mut values = refused_anywhere::<S>();
    values.extend([(-1.0, InvalidInput::Negative as fn(_) -> _), (-1e-30, InvalidInput::Negative)]);
    values
}

fn each<S: HostScalar, T>(values: Vec<Refusal>, what: &'static str, make: impl Fn(S) -> Result<T, InvalidInput>) {
    for (value, error) in values {
        assert_eq!(make(S::from_f64(value)).err(), Some(error(what)), "{value} as {what}");
    }
}

fn poses<S: HostScalar<Angle = Radians<S>>>() {
    each::<S, _>(refused_anywhere::<S>(), "x", |x| {
        Segment::standing(Pose { position: Point::new(x, S::ZERO), ..at(0.0, 0.0, 0.0) })
    });
    each::<S, _>(refused_anywhere::<S>(), "y", |y| {
        Segment::standing(Pose { position: Point::new(S::ZERO, y), ..at(0.0, 0.0, 0.0) })
    });
    for heading in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let pose = Pose { heading: Radians(S::from_f64(heading)), ..at(0.0, 0.0, 0.0) };
        assert_eq!(Path::<S, 1>::starting_at(pose).err(), Some(InvalidInput::NonFinite("heading")));
    }
}

fn segments<S: HostScalar>() {
    let one = S::from_f64(1.0);
    each::<S, _>(refused_if_negative::<S>(), "length", |length| origin().then_line(length));
    each::<S, _>(refused_if_negative::<S>(), "length", |length| origin().then_arc(one, TurnSide::Left, length));
    each::<S, _>(refused_unless_positive::<S>(), "radius", |radius| origin().then_arc(radius, TurnSide::Right, one));
    let below = S::from_f64(0.9 * S::LEAST.to_f64());
    if below < S::LEAST {
        assert_eq!(origin().then_arc(below, TurnSide::Left, S::ZERO).err(), Some(InvalidInput::TooSmall("radius")));
    }
    assert!(origin().then_arc(S::LEAST, TurnSide::Left, S::ZERO).is_ok());
    // Lengths are not multiplied with one another.
    assert!(origin().then_line(S::from_f64(f64::MIN_POSITIVE)).is_ok());
    for sweep in [6.284, 7.0, 100.0] {
        let long = origin().then_arc(one, TurnSide::Left, S::from_f64(sweep));
        assert_eq!(long.err(), Some(InvalidInput::SweepOverOneTurn), "{sweep} rad");
    }
    // A path that leaves the range, in space or in length.
    let far = S::from_f64(0.6 * S::LIMIT.to_f64());
    let east = Path::<S, 4>::starting_at(at(0.0, 0.0, 0.0)).expect("a finite pose");
    assert_eq!(east.clone().line(far).and_then(|path| path.line(far)).err(), Some(InvalidInput::OutOfRange("x")));
    let north = Path::<S, 4>::starting_at(at(0.0, 0.0, std::f64::consts::FRAC_PI_2)).expect("a finite pose");
    assert_eq!(north.line(far).and_then(|path| path.line(far)).err(), Some(InvalidInput::OutOfRange("y")));
    let back = Path::<S, 4>::starting_at(at(-0.6 * S::LIMIT.to_f64(), 0.0, 0.0)).expect("a finite pose");
    assert_eq!(
        back.line(far).and_then(|path| path.line(far)).err(),
        Some(InvalidInput::OutOfRange("length of the path"))
    );
}

fn capacities<S: HostScalar>() {
    let one = S::from_f64(1.0);
    let full =
        Path::<S, 2>::starting_at(at(0.0, 0.0, 0.0)).and_then(|path| path.line(one)?.arc(one, TurnSide::Left, one));
    let full = full.expect("two segments");
    assert_eq!(full.clone().line(one).err(), Some(InvalidInput::Full("segment")));
    assert!(full.line(S::ZERO).is_ok(), "a length of 0 needs no room");
    let pieces = [(one, S::ZERO); 3];
    assert_eq!(Profile::<S, 2>::from_pieces(one, pieces).err(), Some(InvalidInput::Full("phase")));
    assert!(Profile::<S, 3>::from_pieces(one, pieces).is_ok());
}

fn chains<S: HostScalar>() {
    let one = S::from_f64(1.0);
    let first = origin::<S>().then_line(one).expect("a line");
    let second = first.then_arc(one, TurnSide::Left, one).expect("an arc");
    assert_eq!(PathRef::<S>::new(&[]).err(), Some(InvalidInput::Disconnected("path")));
    assert_eq!(PathRef::new(&[second]).err(), Some(InvalidInput::Disconnected("path")), "does not begin at length 0");
    assert_eq!(PathRef::new(&[first, first]).err(), Some(InvalidInput::Disconnected("segment")));
    assert!(PathRef::new(&[first, second]).is_ok());
    // One begins where the other ends, or after as long a way; not both.
    let after = |x: f64, y: f64, length: f64| {
        let start = Segment::standing(at::<S>(x, y, 0.0)).and_then(|start| start.then_line(S::from_f64(length)));
        start.and_then(|line| line.then_line(one)).expect("a line")
    };
    assert!(PathRef::new(&[first, after(0.0, 0.0, 1.0)]).is_ok());
    for next in [after(-1.0, 0.0, 2.0), after(0.0, 5.0, 1.0)] {
        assert_eq!(PathRef::new(&[first, next]).err(), Some(InvalidInput::Disconnected("segment")));
    }
    let turned = Segment::standing(at::<S>(0.0, 0.0, 1.0)).and_then(|turned| turned.then_line(one)).expect("a line");
    assert_eq!(PathRef::new(&[turned, second]).err(), Some(InvalidInput::Disconnected("segment")));

    let start = Phase::starting_at(S::ZERO, one, one).expect("a phase");
    let next = start.then(one, S::ZERO).expect("a phase");
    assert_eq!(ProfileRef::new(&[next]).err(), Some(InvalidInput::Disconnected("phase")));
    assert_eq!(ProfileRef::new(&[start, start]).err(), Some(InvalidInput::Disconnected("phase")));
    assert!(ProfileRef::new(&[start, next]).is_ok());
    assert!(ProfileRef::<S>::new(&[]).is_ok(), "an agent that stands");
}

fn profiles<S: HostScalar>() {
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
    assert_eq!(Phase::starting_at(one, two, -one).err(), Some(InvalidInput::Negative("speed")));
    // To a speed, a time, a length beyond the range.
    let large = S::from_f64(0.9 * S::LIMIT.to_f64());
    assert_eq!(Phase::starting_at(one, large, two).err(), Some(InvalidInput::OutOfRange("speed")));
    assert_eq!(Phase::starting_at(two, large, S::ZERO).err(), Some(InvalidInput::OutOfRange("length of the profile")));
    let wait = Phase::starting_at(S::ZERO, large, S::ZERO).expect("a long wait");
    assert_eq!(wait.then(large, S::ZERO).err(), Some(InvalidInput::OutOfRange("duration of the profile")));
    let crawl = Limits { speed: S::from_f64(1e-3), acceleration: one };
    assert_eq!(Profile::rest_to_rest(large, crawl).err(), Some(InvalidInput::OutOfRange("duration of the profile")));
    let profile = Profile::rest_to_rest(one, limits).expect("a profile");
    each::<S, _>(refused_unless_positive::<S>(), "duration", |duration| {
        Profile::<S, 3>::stretched(profile.as_profile(), duration)
    });
    each::<S, _>(refused_unless_positive::<S>(), "deceleration", |deceleration| BrakingModel::new(deceleration, one));
    each::<S, _>(refused_if_negative::<S>(), "reaction time", |reaction| BrakingModel::new(one, reaction));
}

fn motions<S: HostScalar>() {
    let one = S::from_f64(1.0);
    let path = Path::<S, 1>::starting_at(at(0.0, 0.0, 0.0)).and_then(|path| path.line(one)).expect("a path");
    let profile = Profile::rest_to_rest(one, Limits { speed: one, acceleration: one }).expect("a profile");
    let make = |radius, start| Motion::new(path.as_path(), profile.as_profile(), radius, start);
    each::<S, _>(refused_unless_positive::<S>(), "radius", |radius| make(radius, S::ZERO));
    each::<S, _>(refused_anywhere::<S>(), "start time", |start| make(one, start));
    assert_eq!(make(one, S::LIMIT).err(), Some(InvalidInput::OutOfRange("end time")));
    let motion = make(one, S::ZERO).expect("a motion");
    each::<S, _>(refused_if_negative::<S>(), "margin", |margin| motion.with_margin(margin));
    assert_eq!(motion.with_margin(S::LIMIT).err(), Some(InvalidInput::OutOfRange("radius with its margin")));
    let inflated = motion.with_margin(one).expect("a margin").inflated();
    assert_eq!((inflated.radius(), inflated.margin()), (motion.radius() + one, S::ZERO));
    assert_eq!(inflated.extent(), motion.extent() + (one + one));
    // For plans it is larger by its margin and the tolerance of contacts.
    let planned = motion.with_margin(one).and_then(Motion::for_plan).expect("a margin");
    let tolerance = Encounter::new(&motion, &motion).tolerance();
    assert_eq!((planned.radius(), planned.margin()), (one + (one + tolerance), S::ZERO));
    each::<S, _>(refused_if_negative::<S>(), "lateness", |lateness| motion.with_lateness(lateness));
    each::<S, _>(refused_anywhere::<S>(), "delay", |delay| motion.delayed(delay));
    assert_eq!(motion.delayed(S::LIMIT).err(), Some(InvalidInput::OutOfRange("end time")));
    for length in [0.0, 0.5, 0.999, 1.001, 2.0] {
        let limits = Limits { speed: one, acceleration: one };
        let other = Profile::rest_to_rest(S::from_f64(length), limits).expect("a profile");
        let outcome = Motion::new(path.as_path(), other.as_profile(), one, S::ZERO);
        let refused = outcome.err();
        let Some(InvalidInput::LengthMismatch { path: 1000, profile }) = refused else {
            panic!("{length} m on 1 m: {refused:?}")
        };
        // Rounded down, and before that to the format.
        assert!((f64::from(profile) - 1000.0 * length).abs() <= 1.1, "{length} m: {profile} mm");
    }
}

/// A profile of 8 m, and a few digits more or less, on a path of so many metres: what a file is read with is what the library takes.
fn files_and_motions_take_the_same<S: HostScalar>() {
    let (length, speed) = (8.0, 0.5);
    let path = Path::<S, 1>::starting_at(at(0.0, 0.0, 0.0)).and_then(|path| path.line(S::from_f64(length)));
    let path = path.expect("a line");
    let motion = |travelled: f64| {
        let profile = Profile::<S, 1>::from_pieces(S::from_f64(speed), [(S::from_f64(travelled / speed), S::ZERO)]);
        Motion::new(path.as_path(), profile.expect("a piece").as_profile(), S::from_f64(0.25), S::ZERO).map(drop)
    };
    let read = |travelled: f64| {
        Scenario::from_value(&serde_json::json!({ "agents": [{
            "id": 1, "radius": 0.25, "start": { "x": 0, "y": 0, "heading": 0 }, "path": [{ "kind": "line", "length": length }],
            "profile": { "v0": speed, "pieces": [{ "duration": travelled / speed, "accel": 0 }] },
        }] }))
    };
    // The number itself, the next one beyond it, and the same inwards.
    let most = length * (1.0 + LENGTH_TOLERANCE);
    let least = length * (1.0 - LENGTH_TOLERANCE);
    for (travelled, fits) in [
        (length, true),
        (most, true),
        (most.next_up().next_up(), false),
        (least, true),
        (least.next_down().next_down(), false),
        (length * (1.0 + 0.5 * LENGTH_TOLERANCE), true),
        (length * (1.0 + 1.5 * LENGTH_TOLERANCE), false),
        (length * (1.0 - 1.5 * LENGTH_TOLERANCE), false),
    ] {
        let scenario = read(travelled);
        assert_eq!(scenario.is_ok(), fits, "a file, {travelled} m");
        let refused = |outcome: Result<(), InvalidInput>| matches!(outcome, Err(InvalidInput::LengthMismatch { .. }));
        if let Ok(scenario) = scenario {
            assert!(Fleet::<S>::new(&scenario).is_ok(), "scaled, {travelled} m");
            assert_eq!(motion(travelled), Ok(()), "{travelled} m");
        } else if S::from_f64(1.0 + f64::EPSILON).to_f64() > 1.0 {
            // Others round more than that.
            assert!(refused(motion(travelled)), "{travelled} m");
        }
        let rounded = S::slack(S::from_f64(length + 0.5)).to_f64();
        let beyond = length + 2.0 * rounded.max(length * LENGTH_TOLERANCE);
        assert!(refused(motion(beyond)) && refused(motion(2.0 * length - beyond)), "{beyond} m");
    }
}

macro_rules! in_format {
    ($module:ident, $format:ident) => {
        mod $module {
            use super::*;

            #[test]
            fn files_and_motions_take_the_same_profiles() {
                files_and_motions_take_the_same::<$format>();
            }

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
        }
    };
}

in_format!(in_f64, f64);
in_format!(in_f32, f32);

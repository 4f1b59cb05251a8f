//! At the limits of every format: whatever the constructors accept can be put to any use, with overflow checks, and nothing that
//! is there is denied.

use pcr_core::scalar::Micro;
use pcr_core::{Encounter, Interval, InvalidInput, Limits, Motion, Path, Point, Pose, Profile, excess};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::{LENGTH_TOLERANCE, Scenario};
use pcr_planning::fleet::{Fleet, HostScalar};
use pcr_tests::limits::{GARBAGE, NUMBERS, number, survives};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, RngSeed, TestRunner};
use std::cell::Cell;

/// Parts of the limit of a format: the limit itself, a last digit less and more, and others.
const PARTS: [f64; 10] = [1.0, -1.0, 0.999_999_996, -0.999_999_996, 1.000_000_004, 0.5, -0.5, 0.7, 1.5, 7.5];

fn garbage<S: HostScalar>() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => (0..GARBAGE.len()).prop_map(|k| GARBAGE[k]),
        2 => any::<f64>(),
        6 => -10.0..10.0_f64,
        3 => (-12.0..12.0_f64).prop_map(|power| 10.0_f64.powf(power)),
        2 => (0..PARTS.len()).prop_map(|k| number::<S>(PARTS[k], true)),
        3 => (-1.0..1.0_f64).prop_map(|part| number::<S>(part, true)),
        1 => (-8.0..0.0_f64).prop_map(|power| number::<S>(10.0_f64.powf(power), true)),
    ]
}

/// More than one case in twenty has a region.
fn harmless<S: HostScalar>() {
    let cases = if cfg!(optimized) { 4_000 } else { 300 };
    let mut runner = TestRunner::new(Config {
        cases,
        failure_persistence: None,
        // Every number begins a generator of its own, which takes ChaCha longer than what is tested.
        rng_algorithm: RngAlgorithm::XorShift,
        rng_seed: RngSeed::Fixed(40),
        ..Config::default()
    });
    let met = Cell::new(0);
    let outcome = runner.run(&prop::collection::vec(garbage::<S>(), NUMBERS), |numbers| {
        met.set(met.get() + u32::from(survives::<S>(&numbers)));
        Ok(())
    });
    outcome.unwrap_or_else(|failed| panic!("{failed}"));
    assert!(20 * met.get() > cases, "{} of {cases} have a region", met.get());
}

/// A line of this length from x = `x` to the east, at one speed.
fn driven<S: HostScalar>(x: S, length: S, speed: S) -> Option<(Path<S, 1>, Profile<S, 1>)> {
    let start = Pose { position: Point::new(x, S::ZERO), heading: S::angle(0.0).expect("an angle") };
    let path = Path::starting_at(start).and_then(|path| path.line(length)).ok()?;
    let profile = Profile::from_pieces(speed, [(length.quotient(speed), S::ZERO)]).ok()?;
    Some((path, profile))
}

/// Speeds, starts and places up to the limit: an encounter of an agent with its copy has a tolerance, and is in contact at all
/// times.
fn encounters<S: HostScalar>() {
    let part = |part: f64| S::from_f64(part * S::LIMIT.to_f64());
    let speeds = [S::from_f64(1e-2), S::from_f64(1.0), part(1e-4), part(0.01), part(0.5), S::LIMIT];
    let places = [(S::ZERO, S::from_f64(1.0)), (-S::LIMIT, part(0.9)), (part(0.5), part(0.499)), (-S::LIMIT, S::LIMIT)];
    let mut motions = 0;
    for (speed, (x, length)) in speeds.into_iter().flat_map(|speed| places.map(|place| (speed, place))) {
        let Some((path, profile)) = driven(x, length, speed) else { continue };
        let latest = S::LIMIT - profile.as_profile().duration();
        for start in [-S::LIMIT, part(-0.3), S::ZERO, part(0.4).min(latest), latest] {
            for radius in [S::from_f64(0.5), S::LIMIT] {
                let motion = Motion::new(path.as_path(), profile.as_profile(), radius, start);
                let Ok(motion) = motion else { continue };
                motions += 1;
                let pair = Encounter::new(&motion, &motion);
                assert!(pair.tolerance() > S::ZERO);
                let all = Interval::new(-S::LIMIT, S::LIMIT);
                assert_eq!(pair.contacts(all).next(), Some(all), "{motion:?}");
                // An interval that goes beyond is cut, and one that is no number is not empty.
                let beyond = Interval::new(S::from_f64(-7.5 * S::LIMIT.to_f64()), S::from_f64(7.5 * S::LIMIT.to_f64()));
                assert_eq!(pair.contacts(beyond).next(), Some(all));
                let at = Interval::new(path.as_path().length(), path.as_path().length());
                let blocked = pair.blocked(at, beyond).last().expect("it stays there");
                assert_eq!(blocked.hi, beyond.hi, "for good");
            }
        }
    }
    assert!(motions >= 30, "{motions}");
}

/// The tolerance is what it is said to be: 16 slacks of the extent and both ways since the time 0, and four times what the path,
/// the gap of the profile and the last digits of times add.
fn tolerances<S: HostScalar>() {
    let one = S::from_f64(1.0);
    for (length, start) in [(10.0, 0.0), (100.0, 50.0), (30.0, -90.0)] {
        let (path, profile) = driven(S::ZERO, S::from_f64(length), one).expect("small");
        let motion = Motion::new(path.as_path(), profile.as_profile(), one, S::from_f64(start)).expect("small");
        let latest = motion.time().lo.abs().max(motion.time().hi.abs());
        let quadruple = |x: S| x.double().double();
        let slack = S::slack(motion.extent() + latest + latest);
        let rest = S::drift(0, motion.extent()) + S::lag(one, profile.as_profile().duration());
        let leap = S::slack(S::ZERO).half().half();
        let pad = slack + (rest + leap).double();
        let least = S::tolerance(motion.extent()).max(quadruple(pad));
        let found = Encounter::new(&motion, &motion).tolerance();
        assert!((found - least).abs() <= S::slack(S::ZERO).double(), "{found:?} and {least:?}");
        assert!(found >= quadruple(slack) - S::slack(S::ZERO));
    }
}

/// A profile that is longer or shorter than the path by so many last digits: what it is off counts for the bound of regions.
fn gaps_count<S: HostScalar>() {
    let (path, profile) = driven(S::ZERO, S::from_f64(10.0), S::from_f64(1.0)).expect("small");
    let exact = Motion::new(path.as_path(), profile.as_profile(), S::from_f64(0.5), S::ZERO).expect("small");
    let slack = S::slack(exact.extent()).max(S::from_f64(10.0 * LENGTH_TOLERANCE));
    let (mut accepted, mut refused) = (0, 0);
    for k in -40..=40 {
        let by = S::from_f64(f64::from(k) / 16.0 * slack.to_f64());
        let length = S::from_f64(10.0) + by;
        let (_, other) = driven(S::ZERO, length, S::from_f64(1.0)).expect("small");
        let gap = (other.as_profile().length() - path.as_path().length()).abs();
        match Motion::new(path.as_path(), other.as_profile(), S::from_f64(0.5), S::ZERO) {
            Ok(motion) => {
                accepted += 1;
                let more = excess(&motion, &exact) - excess(&exact, &exact);
                assert!(gap <= slack && more + S::slack(gap) >= gap, "{k}: {gap:?} m, {more:?} m more");
            }
            Err(refusal) => {
                refused += 1;
                assert!(matches!(refusal, InvalidInput::LengthMismatch { .. }) && gap > slack, "{k}: {gap:?} m");
            }
        }
    }
    assert!(accepted > 20 && refused > 20, "{accepted} accepted, {refused} refused");
}

/// Phases that take less than a last digit of time leave their lengths to their neighbours: nobody jumps.
fn nobody_jumps<S: HostScalar>() {
    let mut short = 0;
    for k in 1..400 {
        // A cruise of less than a last digit of time, at a high speed; and of more.
        let limits = Limits { speed: S::from_f64(20.0), acceleration: S::from_f64(10.0) };
        let length = S::from_f64(40.0 + f64::from(k) * 1e-6);
        let profile = Profile::<S, 3>::rest_to_rest(length, limits).expect("small");
        short += usize::from(profile.as_profile().phases().len() < 3);
        connected(&profile);
        for part in [0.5, 0.7, 0.9, 3.0] {
            let duration = S::from_f64(part * profile.as_profile().duration().to_f64());
            connected(&Profile::<S, 3>::stretched(profile.as_profile(), duration).expect("small"));
        }
    }
    assert!(S::slack(S::ZERO) == S::ZERO || short > 0, "no phase takes no time");
}

fn connected<S: HostScalar, const N: usize>(profile: &Profile<S, N>) {
    let (phases, mut end) = (profile.as_profile().phases(), (S::ZERO, S::ZERO));
    for phase in phases {
        assert!((phase.time().lo, phase.length().lo) == end && phase.time().lo < phase.time().hi, "{phases:?}");
        end = (phase.time().hi, phase.length().hi);
    }
}

macro_rules! in_format {
    ($module:ident, $format:ident) => {
        mod $module {
            use super::*;

            #[test]
            fn whatever_is_accepted_does_no_harm() {
                harmless::<$format>();
            }

            #[test]
            fn who_is_there_is_met_up_to_the_limits() {
                encounters::<$format>();
            }

            #[test]
            fn the_tolerance_of_contacts_is_as_documented() {
                tolerances::<$format>();
            }

            #[test]
            fn what_a_profile_is_too_long_or_too_short_counts() {
                gaps_count::<$format>();
            }

            #[test]
            fn phases_without_time_are_no_jumps() {
                nobody_jumps::<$format>();
            }
        }
    };
}

in_format!(in_f64, f64);
in_format!(in_f32, f32);
in_format!(in_micro, Micro);
in_format!(in_q12, Q12);
in_format!(in_q16, Q16);
in_format!(in_q20, Q20);

/// Found by an audit: speeds and times of which the product is beyond the format.
#[test]
fn discs_that_drive_through_each_other_late_are_in_conflict() {
    fn depth<S: HostScalar>(text: &str) -> f64 {
        let fleet = Fleet::<S>::new(&Scenario::from_json(text).expect("a scenario")).expect("a fleet");
        let motions = fleet.motions();
        let pair = Encounter::new(&motions[0], &motions[1]);
        let depths = pair.conflicts(pair.time()).map(|conflict| conflict.depth.to_f64());
        assert!(pair.tolerance() > S::ZERO);
        depths.fold(0.0, f64::max)
    }
    let near = |depth: f64, exact: f64, tolerance: f64| assert!((depth - exact).abs() <= tolerance, "{depth} m");
    near(depth::<Q20>(include_str!("../data/cases/overflow-q20.json")), 0.1, 1e-3);
    near(depth::<Q16>(include_str!("../data/cases/overflow-q16.json")), 0.1, 1e-3);
    near(depth::<Q12>(include_str!("../data/cases/overflow-q12.json")), 1.0, 5e-2);
}

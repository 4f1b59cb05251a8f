//! Where an agent is at a time, against the bounds of docs/theory/errors.md: how far it is from where its phases say, and, in fixed point, how
//! far these are from the limits, or the durations and accelerations, that constructors were given.

use pcr_core::scalar::Micro;
use pcr_core::{Limits, Motion, PathRef, Point, Pose, Profile, ProfileRef, Segment};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::exact::{DoubleDouble, Travel};
use pcr_tests::generators::Dice;

const SAMPLES: u32 = 64;

/// What a length at a time is rounded by, in last digits: half of one and 4 · 2⁻³⁰ of the length.
fn query(length: f64, digit: f64) -> f64 {
    0.5 + 4.0 * length / digit / 1_073_741_824.0
}

/// The largest difference between a profile and a law of motion, as a part of its bound, both in last digits.
fn worst<S: HostScalar>(profile: ProfileRef<'_, S>, law: impl Fn(f64) -> f64, bound: f64, digit: f64) -> f64 {
    let duration = profile.duration().to_f64();
    let off = |k: u32| {
        let time = S::from_f64(duration * f64::from(k) / f64::from(SAMPLES));
        (profile.length_at(time).to_f64() - law(time.to_f64())).abs() / digit
    };
    (0..=SAMPLES).map(off).fold(0.0, f64::max) / bound
}

/// Length at a time from rest to rest at the largest speed `v` and acceleration `a`.
fn trapezoid(length: f64, v: f64, a: f64) -> impl Fn(f64) -> f64 {
    let peak = v.min((length * a).sqrt());
    let (ramp, duration) = (peak / a, length / peak + peak / a);
    move |time: f64| {
        let time = time.clamp(0.0, duration);
        if time < ramp {
            0.5 * a * time * time
        } else if time > duration - ramp {
            length - 0.5 * a * (duration - time) * (duration - time)
        } else {
            0.5 * peak * ramp + peak * (time - ramp)
        }
    }
}

fn rest_to_rest<S: HostScalar>(digit: f64) {
    let mut most = 0.0_f64;
    for seed in 0..4_000 {
        let mut dice = Dice::seeded(seed);
        let most_length = 0.5 * S::LIMIT.to_f64();
        let [length, v, a] =
            [dice.magnitude(0.1, most_length), dice.magnitude(0.05, 20.0), dice.magnitude(0.02, 4.0)].map(S::from_f64);
        // What lasts too long is refused.
        let Ok(profile) = Profile::rest_to_rest(length, Limits { speed: v, acceleration: a }) else { continue };
        let [length, v, a] = [length, v, a].map(S::to_f64);
        let peak = v.min((length * a).sqrt());
        let ramp = if peak < v { peak / a } else { 0.0 };
        let bound = 2.5 + 1.5 * (peak + ramp) + query(length, digit);
        let part = worst(profile.as_profile(), trapezoid(length, v, a), bound, digit);
        assert!(part <= 1.0, "{}, seed {seed}: {part} of {bound} digits", S::NAME);
        most = most.max(part);
    }
    println!("{}: {most} of the bound", S::NAME);
    assert!(most > 0.2, "{}: too good to be measured: {most}", S::NAME);
}

fn chains<S: HostScalar>(digit: f64) {
    let mut most = 0.0_f64;
    for seed in 0..4_000 {
        let mut dice = Dice::seeded(seed);
        let first = S::from_f64(dice.range(0.0, 2.0)).to_f64();
        let (mut speed, mut length, mut time) = (first, 0.0, 0.0);
        // Begin, length and speed there, acceleration.
        let mut law = Vec::new();
        let mut pieces = Vec::new();
        // Errors of speed and of length so far, in last digits.
        let (mut of_speed, mut of_length, mut bound) = (0.0, 0.0, 0.0_f64);
        for _ in 0..1 + dice.below(6) {
            let duration = S::from_f64(dice.magnitude(0.1, 8.0)).to_f64();
            let least = (-0.9 * speed / duration).max(-2.0);
            let acceleration = S::from_f64(dice.range(least, 1.0)).to_f64();
            pieces.push((S::from_f64(duration), S::from_f64(acceleration)));
            law.push((time, length, speed, acceleration));
            of_length += (of_speed + 0.25) * duration + 0.5;
            of_speed += 0.5;
            bound = bound.max(of_length + 0.25 * of_speed * duration);
            (time, length) = (time + duration, length + (speed + 0.5 * acceleration * duration) * duration);
            speed += acceleration * duration;
        }
        let at = |t: f64| {
            let (from, before, speed, a) = law[law.partition_point(|&(from, ..)| from <= t).max(1) - 1];
            before + (speed + 0.5 * a * (t - from)) * (t - from)
        };
        let profile = Profile::<S, 6>::from_pieces(S::from_f64(first), pieces).unwrap();
        let bound = bound + query(length, digit);
        let part = worst(profile.as_profile(), at, bound, digit);
        assert!(part <= 1.0, "{}, seed {seed}: {part} of {bound} digits", S::NAME);
        most = most.max(part);
    }
    println!("{}: {most} of the bound", S::NAME);
    assert!(most > 0.2, "{}: too good to be measured: {most}", S::NAME);
}

#[test]
fn profiles_from_rest_to_rest_are_those_of_their_limits() {
    rest_to_rest::<Q20>(Q20::LAST_DIGIT.to_f64());
    rest_to_rest::<Q16>(Q16::LAST_DIGIT.to_f64());
    rest_to_rest::<Q12>(Q12::LAST_DIGIT.to_f64());
}

#[test]
fn chains_of_phases_are_those_of_their_accelerations() {
    chains::<Q20>(Q20::LAST_DIGIT.to_f64());
    chains::<Q16>(Q16::LAST_DIGIT.to_f64());
    chains::<Q12>(Q12::LAST_DIGIT.to_f64());
}

/// The largest error of a length at a time, as a part of its bound.
fn travelled<S: HostScalar>(digit: f64) {
    let mut most = 0.0_f64;
    for seed in 0..2_000 {
        let mut dice = Dice::seeded(seed);
        let length = S::from_f64(dice.magnitude(0.1, 100.0));
        let limits = Limits {
            speed: S::from_f64(dice.magnitude(0.05, 20.0)),
            acceleration: S::from_f64(dice.magnitude(0.02, 4.0)),
        };
        let origin = Pose { position: Point::new(S::ZERO, S::ZERO), heading: S::angle(0.0).expect("an angle") };
        let line = [Segment::standing(origin).unwrap().then_line(length).unwrap()];
        let start = S::from_f64(dice.range(-20.0, 20.0));
        let Ok(profile) = Profile::rest_to_rest(length, limits) else { continue };
        let path = PathRef::new(&line).unwrap();
        let Ok(motion) = Motion::new(path, profile.as_profile(), S::from_f64(0.5), start) else { continue };
        let travel = Travel::new(&motion, DoubleDouble::from(length.to_f64()));
        let (top, duration) = (profile.as_profile().top_speed().to_f64(), profile.as_profile().duration().to_f64());
        let (length, u) = (length.to_f64(), 0.5 * S::EPSILON);
        let bound =
            if S::EPSILON == 0.0 { query(length, digit) * digit } else { u * (8.0 * top * duration + 19.0 * length) };
        for k in 0..=SAMPLES {
            let time = S::from_f64(start.to_f64() + duration * f64::from(k) / f64::from(SAMPLES));
            let exact = travel.length_at(DoubleDouble::from(time.to_f64()));
            let part = (DoubleDouble::from(motion.length_at(time).to_f64()) - exact).abs().to_f64() / bound;
            assert!(part <= 1.0, "{}, seed {seed}: {part} of {bound} m", S::NAME);
            most = most.max(part);
        }
    }
    println!("{}: {most} of the bound", S::NAME);
    assert!(most > 0.01, "{}: too good to be measured: {most}", S::NAME);
}

#[test]
fn lengths_at_a_time_are_those_of_the_phases() {
    travelled::<f64>(0.0);
    travelled::<f32>(0.0);
    travelled::<Micro>(0.0);
    travelled::<Q20>(Q20::LAST_DIGIT.to_f64());
    travelled::<Q16>(Q16::LAST_DIGIT.to_f64());
    travelled::<Q12>(Q12::LAST_DIGIT.to_f64());
}

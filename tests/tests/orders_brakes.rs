//! Stopping distances against exact fractions, over all numbers of each format.

use pcr_core::{BrakingModel, InvalidInput, Limits, Scalar};
use pcr_fixed::{Q, Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::generators::Dice;

#[test]
fn brakes_are_enough() {
    let limits = Limits { speed: 2.0, acceleration: 0.7 };
    let brakes = BrakingModel::new(limits.acceleration, 0.2).expect("brakes");
    for k in 0..2000 {
        let way = f64::from(k) * 1e-3;
        let speed = brakes.speed(way);
        assert!(brakes.distance(speed) <= way + 1e-12 && brakes.distance(speed + 1e-6) >= way, "{way} {speed}");
    }
    assert_eq!((brakes.speed(0.0), brakes.speed(-1.0), brakes.distance(0.0)), (0.0, 0.0, 0.0));
    stopping_ways_are_no_shorter_than_exact::<f32>();
    stopping_ways_are_no_shorter_than_exact::<Q12>();
    stopping_ways_are_no_shorter_than_exact::<Q16>();
    stopping_ways_are_no_shorter_than_exact::<Q20>();
}

/// Of formats that are coarser than f64: rounding never takes away from a way, or adds to a speed.
fn stopping_ways_are_no_shorter_than_exact<S: HostScalar>() {
    let digit = S::slack(S::from_f64(8.0)).to_f64();
    for (deceleration, reaction) in [(0.7, 0.2), (2.3, 0.0), (0.11, 1.3)] {
        let [a, r] = [deceleration, reaction].map(|number| S::from_f64(number));
        let brakes = BrakingModel::new(a, r).expect("brakes");
        let [a, r] = [a, r].map(S::to_f64);
        for k in 1..400 {
            let number = S::from_f64(f64::from(k) * 0.005);
            let (exact, v) = (number.to_f64(), number.to_f64());
            let way = brakes.distance(number).to_f64();
            let least = v * r + v * v / (2.0 * a);
            assert!(least <= way && way <= least + 20.0 * digit, "{v} m/s: {way} m for {least} m");
            let speed = brakes.speed(number).to_f64();
            let most = ((a * r).powi(2) + 2.0 * a * exact).sqrt() - a * r;
            assert!(speed <= most && most <= speed + 20.0 * digit, "{exact} m: {speed} m/s for {most} m/s");
        }
    }
}

/// Brakes and a number with magnitudes of all sizes, below so many bits.
fn drawn(dice: &mut Dice) -> [i32; 3] {
    [28, 24, 28].map(|most| dice.range(0.0, f64::from(most)).exp2() as i32)
}

/// A distance is at least the exact one, and not much more; a speed needs no more than its distance.
fn exact<const F: u32>() {
    let mut dice = Dice::seeded(u64::from(F));
    let limit = i128::from(Q::<F>::LIMIT.to_bits());
    let cases = (0..200_000).map(|_| drawn(&mut dice));
    let known = [[631_112, 102_892, 6_536_561], [1, 0, 1 << 28], [1 << 28, 1 << F, 1 << 28], [1, 1 << 24, 1]];
    for bits in known.into_iter().chain(cases) {
        let [deceleration, reaction, number] = bits.map(Q::<F>::from_bits);
        let Ok(brakes) = BrakingModel::new(deceleration, reaction) else { continue };
        let [a, tau, _] = bits.map(i128::from);
        // Times 2 a 2^F, everything is an integer.
        let whole = 2 * (a << F);
        let exact = |speed: i128| 2 * a * speed * tau + ((speed * speed) << F);
        let speed = i128::from(bits[2]);
        let way = i128::from(brakes.distance(number).to_bits());
        assert!(way * whole >= exact(speed) || way >= limit, "{bits:?}: {way} digits");
        let slack = i128::from(Q::<F>::slack(Q::from_bits((way + speed) as i32)).to_bits());
        assert!((way - slack - 8 - 1) * whole <= exact(speed), "{bits:?}: {way} digits are too many");
        let speed = i128::from(brakes.speed(number).to_bits());
        assert!(exact(speed) <= i128::from(bits[2]) * whole, "{bits:?}: {speed} digits of speed");
    }
}

#[test]
fn stopping_distances_of_fixed_point_are_no_shorter_than_exact_fractions() {
    exact::<12>();
    exact::<16>();
    exact::<20>();
    exact::<22>();
}

#[test]
fn stopping_distances_of_f32_are_no_shorter_than_exact() {
    let mut dice = Dice::seeded(3);
    let size = |dice: &mut Dice, most: f64| dice.range(-10.0, most).exp2() as f32;
    for _ in 0..200_000 {
        let (a, tau, v) = (size(&mut dice, 16.0), size(&mut dice, 4.0), size(&mut dice, 19.0));
        let Ok(brakes) = BrakingModel::new(a, tau) else { continue };
        let [wide_a, wide_tau, wide_v] = [a, tau, v].map(f64::from);
        let exact = wide_v * wide_tau + wide_v * wide_v / (2.0 * wide_a);
        let way = f64::from(brakes.distance(v));
        assert!(exact <= way && way <= (exact + wide_v) * (1.0 + 1e-4), "{a} {tau} {v}: {way} for {exact}");
    }
}

#[test]
fn speeds_beyond_the_limit_are_taken_as_the_limit() -> Result<(), InvalidInput> {
    let brakes = BrakingModel::new(Q16::from_bits(1 << 16), Q16::from_bits(1 << 16))?;
    let most = brakes.distance(Q16::LIMIT);
    assert!(most > Q16::LIMIT);
    for bits in [1 << 29, 1 << 30, i32::MAX] {
        assert_eq!(brakes.distance(Q16::from_bits(bits)), most);
    }
    assert_eq!(brakes.distance(Q16::from_bits(i32::MIN)), Q16::ZERO);
    let brakes = BrakingModel::new(1.0, 1.0)?;
    assert_eq!([f64::INFINITY, f64::NAN].map(|speed| brakes.distance(speed)), [brakes.distance(f64::LIMIT); 2]);
    Ok(())
}

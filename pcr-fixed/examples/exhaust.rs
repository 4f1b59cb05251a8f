//! Compares the sine, cosine and arctangent of every possible input with those of `f64`, for the bounds of
//! docs/theory/errors.md:
//!
//! ```text
//! cargo run --profile checked -p pcr-fixed --example exhaust -- [turns-sine] [f32-arctangent] [f32-sine]
//! ```
//!
//! Prints the largest errors. The exit status is 1 if one exceeds its bound, or if a bound is much too large. Takes a
//! minute on one core.

use pcr_core::Radians;
use pcr_core::scalar::Angle;
use pcr_fixed::{Q16, Sine, Turns};
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::process::ExitCode;
use std::sync::LazyLock;

/// Unit roundoff of `f32`.
const U: f64 = 0.5 * f32::EPSILON as f64;

/// The largest value of each figure.
type Worst = [f64; 3];

/// A run over all inputs.
struct Run {
    /// Name in the ledger.
    name: &'static str,
    /// What the figures are, with their units.
    figures: [&'static str; 3],
    /// Bounds of the figures.
    bounds: Worst,
    /// The inputs, by number.
    inputs: Range<u32>,
    /// Computes the figures of one input.
    at: fn(u32) -> Worst,
}

/// All runs.
const RUNS: [Run; 3] = [
    Run {
        name: "turns-sine",
        figures: ["sine [2^-30]", "cosine [2^-30]", "both as a vector [2^-30]"],
        bounds: [1.18, 1.12, 1.51],
        // A quarter turn around 0: the other quarters follow by swaps and signs.
        inputs: 0..1 << 30,
        at: turns_sine,
    },
    Run {
        name: "f32-arctangent",
        figures: ["atan2(t, 1), relative [u]", "atan2(1, t), relative [u]", "atan2(t, -1), relative [u]"],
        bounds: [3.5, 2.2, 1.65],
        inputs: (1e-6_f32).to_bits()..1.0_f32.to_bits() + 1,
        at: arctangent,
    },
    Run {
        name: "f32-sine",
        figures: ["sine or cosine [u]", "both as a vector [u]", "sine, as a part of an angle up to pi [u]"],
        bounds: [1.57, 1.79, 1.8],
        inputs: (1e-9_f32).to_bits()..1024.0_f32.to_bits() + 1,
        at: float_sine,
    },
];

fn turns_sine(number: u32) -> Worst {
    let bits = number as i32 - (1 << 29);
    let (sin, cos) = Angle::<Q16>::sin_cos(Turns::from_bits(bits));
    let exact = ANGLES.of(bits);
    let off = |found: Sine, exact: f64| (found.to_f64() - exact).abs() * f64::from(1 << 30);
    let (sin, cos) = (off(sin, exact.0), off(cos, exact.1));
    [sin, cos, length(sin, cos)]
}

fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

static ANGLES: LazyLock<Angles> = LazyLock::new(Angles::new);

/// Sines and cosines of angles within an eighth of a turn around 0, as those of a sum of two angles from tables: faster than one by one, and
/// within 4 · 2⁻⁵³, as the errors of a table entry, of its argument, of a product and of a sum are at most 2⁻⁵³ each, and the bounds here
/// are multiples of 2⁻³⁰.
struct Angles {
    /// Of the multiples of 2⁻³² turns that are less than 2⁻¹⁷ turns.
    fine: Vec<(f64, f64)>,
    /// Of the multiples of 2⁻¹⁷ turns, from an eighth of a turn below 0 on.
    coarse: Vec<(f64, f64)>,
}

impl Angles {
    const FINE: u32 = 15;

    fn new() -> Self {
        let of = |bits: i32| (f64::from(bits) * (TAU / 4_294_967_296.0)).sin_cos();
        let fine = (0..1 << Self::FINE).map(of).collect();
        Self { fine, coarse: (-(1 << 14)..1 << 14).map(|bits| of(bits << Self::FINE)).collect() }
    }

    fn of(&self, bits: i32) -> (f64, f64) {
        let (fine, coarse) = (bits & ((1 << Self::FINE) - 1), (bits >> Self::FINE) + (1 << 14));
        let ((sin, cos), (s, c)) = (self.coarse[coarse as usize], self.fine[fine as usize]);
        (sin * c + cos * s, cos * c - sin * s)
    }
}

fn arctangent(bits: u32) -> Worst {
    let t = f32::from_bits(bits);
    let off = |y: f32, x: f32| {
        let exact = f64::from(y).atan2(f64::from(x));
        (f64::from(<Radians<f32> as Angle<f32>>::atan2(y, x).0) - exact).abs() / (exact * U)
    };
    [off(t, 1.0), off(1.0, t), off(t, -1.0)]
}

fn float_sine(bits: u32) -> Worst {
    let x = f32::from_bits(bits);
    let found = |x| <Radians<f32> as Angle<f32>>::sin_cos(Radians(x));
    let (sin, cos) = found(x);
    assert_eq!(found(-x), (-sin, cos), "of {x} and its negative");
    let x = f64::from(x);
    let exact = x.sin_cos();
    let off = |found: f32, exact: f64| (f64::from(found) - exact).abs() / U;
    let (sin, cos) = (off(sin, exact.0), off(cos, exact.1));
    [sin.max(cos), length(sin, cos), if x <= PI { sin / x } else { 0.0 }]
}

impl Run {
    /// The largest figures, computed on all processors.
    fn worst(&self) -> Worst {
        let threads = std::thread::available_parallelism().map_or(1, |count| count.get() as u32);
        std::thread::scope(|scope| {
            let workers = (0..threads).map(|k| {
                scope.spawn(move || {
                    let inputs = self.inputs.clone().skip(k as usize).step_by(threads as usize);
                    inputs.map(self.at).fold([0.0; 3], larger)
                })
            });
            let workers: Vec<_> = workers.collect();
            workers.into_iter().map(|worker| worker.join().expect("no input panics")).fold([0.0; 3], larger)
        })
    }
}

/// NaN exceeds every bound.
fn larger(a: Worst, b: Worst) -> Worst {
    [0, 1, 2].map(|k| {
        if a[k] >= b[k] {
            a[k]
        } else if b[k].is_nan() {
            f64::INFINITY
        } else {
            b[k]
        }
    })
}

/// Whether all figures are within their bounds, and no bound is much too large.
fn within(worst: Worst, bounds: Worst) -> bool {
    worst.iter().zip(bounds).all(|(worst, bound)| 0.95 * bound < *worst && *worst <= bound)
}

fn main() -> ExitCode {
    let asked: Vec<_> = std::env::args().skip(1).collect();
    let mut held = true;
    for run in RUNS.iter().filter(|run| asked.is_empty() || asked.iter().any(|name| name == run.name)) {
        let worst = run.worst();
        for ((figure, worst), bound) in run.figures.iter().zip(worst).zip(run.bounds) {
            println!("{}: {figure} {worst:.4}, bound {bound}", run.name);
        }
        held &= within(worst, run.bounds);
    }
    if held && asked.iter().all(|name| RUNS.iter().any(|run| run.name == name)) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

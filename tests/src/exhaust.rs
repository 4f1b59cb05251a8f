//! Sines, cosines and arctangents of every input there is, against those of `f64`, for the bounds of docs/errors.md.

use pcr_core::Radians;
use pcr_core::scalar::Angle;
use pcr_fixed::{Q16, Sine, Turns};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Unit roundoff of `f32`.
const U: f64 = 0.5 * f32::EPSILON as f64;

/// The largest of each figure.
pub type Worst = [f64; 3];

/// A run over all inputs: name, unit of the figures, what they are, their bounds, and the inputs, by number.
pub struct Run {
    /// Its name in the ledger.
    pub name: &'static str,
    /// What the figures are, with their unit.
    pub figures: [&'static str; 3],
    /// What they may be.
    pub bounds: Worst,
    /// The numbers of the inputs.
    pub inputs: Range<u32>,
    /// The figures of one input.
    pub at: fn(u32) -> Worst,
}

/// All of them.
pub const RUNS: [Run; 3] = [
    Run {
        name: "turns-sine",
        figures: ["sine [2^-30]", "cosine [2^-30]", "both as a vector [2^-30]"],
        bounds: [1.18, 1.12, 1.51],
        // A quarter turn about 0: the others are its swaps and signs.
        inputs: 0..1 << 30,
        at: turns_sine,
    },
    Run {
        name: "f32-arctangent",
        figures: ["atan2(t, 1), relative [u]", "atan2(1, t), relative [u]", "atan2(t, -1), relative [u]"],
        bounds: [3.5, 2.2, 1.7],
        inputs: (1e-6_f32).to_bits()..1.0_f32.to_bits() + 1,
        at: arctangent,
    },
    Run {
        name: "f32-sine",
        figures: ["sine or cosine [u]", "both as a vector [u]", "sine, as a part of an angle up to pi [u]"],
        bounds: [1.57, 1.79, 1.8],
        // The angle is taken off an odd function and an even one.
        inputs: (1e-9_f32).to_bits()..1024.0_f32.to_bits() + 1,
        at: float_sine,
    },
];

fn turns_sine(number: u32) -> Worst {
    let bits = number as i32 - (1 << 29);
    let (sin, cos) = Angle::<Q16>::sin_cos(Turns::from_bits(bits));
    let exact = (f64::from(bits) * (TAU / 4_294_967_296.0)).sin_cos();
    let off = |found: Sine, exact: f64| (found.to_f64() - exact).abs() * f64::from(1 << 30);
    let (sin, cos) = (off(sin, exact.0), off(cos, exact.1));
    [sin, cos, sin.hypot(cos)]
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
    let (sin, cos) = <Radians<f32> as Angle<f32>>::sin_cos(Radians(x));
    let x = f64::from(x);
    let exact = x.sin_cos();
    let off = |found: f32, exact: f64| (f64::from(found) - exact).abs() / U;
    let (sin, cos) = (off(sin, exact.0), off(cos, exact.1));
    [sin.max(cos), sin.hypot(cos), if x <= PI { sin / x } else { 0.0 }]
}

impl Run {
    /// The largest figures of every `stride`-th input, on all processors.
    pub fn worst(&self, stride: u32) -> Worst {
        let threads = std::thread::available_parallelism().map_or(1, |count| count.get() as u32);
        std::thread::scope(|scope| {
            let workers = (0..threads).map(|k| {
                scope.spawn(move || {
                    let inputs = self.inputs.clone().skip((k * stride) as usize).step_by((threads * stride) as usize);
                    inputs.map(self.at).fold([0.0; 3], larger)
                })
            });
            let workers: Vec<_> = workers.collect();
            workers.into_iter().map(|worker| worker.join().expect("no input panics")).fold([0.0; 3], larger)
        })
    }
}

fn larger(a: Worst, b: Worst) -> Worst {
    [0, 1, 2].map(|k| a[k].max(b[k]))
}

/// What every number may be is a number of the format, and no bound is idle.
pub fn within(worst: Worst, bounds: Worst) -> bool {
    worst.iter().zip(bounds).all(|(worst, bound)| 0.95 * bound < *worst && *worst <= bound)
}

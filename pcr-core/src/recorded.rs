//! Records the kernels as scripts for Gappa, with a number type that writes down the operations done with it. `proofs/`
//! proves bounds about exactly the lines that are written here. If a kernel changes, it is no longer the one that was
//! proved, and the test fails.
//!
//! A line is an operation and its exact twin, in capitals: `t3 rnd= t1 * c; T3 = T1 * C;`. Inputs have names; an input
//! with a twin is not exact.

extern crate std;

use crate::pair::disc_on_segment::CarrierCoordinates;
use crate::scalar::{AccelerationRamp, Angle, AngleSector, Scalar, Unit, Wide};
use crate::segment::{Curve, Segment, TurnSide};
use crate::{Point, Pose};
use core::ops::{Add, Neg, Sub};
use std::cell::RefCell;
use std::string::{String, ToString};
use std::vec::Vec;
use std::{eprintln, format, fs, path::Path};

/// A value, which decides branches, and the index of its name.
#[derive(Clone, Copy, Debug, Default)]
struct TracedScalar(f64, usize);

/// Names of numbers and of their exact twins, and the lines so far. The first name is that of 0.
#[derive(Default)]
struct GappaTape {
    names: Vec<[String; 2]>,
    lines: Vec<String>,
}

std::thread_local! { static TAPE: RefCell<GappaTape> = RefCell::default(); }

fn on_tape<T>(act: impl FnOnce(&mut GappaTape) -> T) -> T {
    TAPE.with(|tape| act(&mut tape.borrow_mut()))
}

impl GappaTape {
    fn name(&mut self, rounded: &str, exact: &str) -> usize {
        self.names.push([rounded.to_string(), exact.to_string()]);
        self.names.len() - 1
    }
    /// Removes all lines, so that numbers which are passed to a kernel count as its inputs.
    fn clear(&mut self) {
        self.names.clear();
        self.lines.clear();
        self.name("0", "0");
    }
}

/// An exact input with this value.
fn input(name: &str, value: f64) -> TracedScalar {
    TracedScalar(value, on_tape(|tape| tape.name(name, name)))
}

/// A rounded input.
fn rounded(name: &str, value: f64) -> TracedScalar {
    TracedScalar(value, on_tape(|tape| tape.name(name, &name.to_uppercase())))
}

/// An operation: its result, and its text with `{0}` and `{1}` in place of the operands.
fn operation(value: f64, text: &str, of: &[TracedScalar], rounds: bool) -> TracedScalar {
    on_tape(|tape| {
        let written = |twin: usize| {
            let numbered = of.iter().enumerate();
            numbered.fold(text.to_string(), |text, (k, n)| text.replace(&format!("{{{k}}}"), &tape.names[n.1][twin]))
        };
        let (lower, upper) = (written(0), written(1));
        let place = tape.lines.len() + 1;
        let equals = if rounds { "rnd=" } else { "=" };
        tape.lines.push(format!("t{place} {equals} {lower}; T{place} = {upper};"));
        TracedScalar(value, tape.name(&format!("t{place}"), &format!("T{place}")))
    })
}

/// For operations that no recorded kernel uses.
fn left_out() -> ! {
    panic!("not recorded")
}

impl PartialEq for TracedScalar {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}
impl PartialOrd for TracedScalar {
    /// Comparisons that decide branches are recorded, because they are part of the proof.
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        let order = self.0.partial_cmp(&other.0);
        on_tape(|tape| {
            let line = format!("# {} is {order:?} to {}", tape.names[self.1][0], tape.names[other.1][0]);
            tape.lines.push(line);
        });
        order
    }
}
impl Add for TracedScalar {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        operation(self.0 + rhs.0, "{0} + {1}", &[self, rhs], true)
    }
}
impl Sub for TracedScalar {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        operation(self.0 - rhs.0, "{0} - {1}", &[self, rhs], true)
    }
}
impl Neg for TracedScalar {
    type Output = Self;
    fn neg(self) -> Self {
        operation(-self.0, "- {0}", &[self], false)
    }
}

/// The function bodies of `float.rs`.
impl Scalar for TracedScalar {
    type Wide = TracedScalar;
    type Unit = TracedScalar;
    type Angle = TracedScalar;
    const ZERO: Self = TracedScalar(0.0, 0);
    const LIMIT: Self = TracedScalar(1e12, 0);
    const LEAST: Self = TracedScalar(1e-75, 0);
    fn is_finite(self) -> bool {
        true
    }
    fn digest(self) -> u32 {
        0
    }
    fn millimetres(self) -> u32 {
        0
    }
    fn portion(self, _: Self, _: Self) -> Self {
        left_out()
    }
    fn times(self, rhs: Self) -> TracedScalar {
        operation(self.0 * rhs.0, "{0} * {1}", &[self, rhs], true)
    }
    fn scale(self, by: TracedScalar) -> Self {
        Scalar::times(self, by)
    }
    fn half(self) -> Self {
        operation(0.5 * self.0, "0.5 * {0}", &[self], false)
    }
    fn double(self) -> Self {
        operation(2.0 * self.0, "2 * {0}", &[self], false)
    }
    fn abs(self) -> Self {
        operation(self.0.abs(), "|{0}|", &[self], false)
    }
    fn quotient(self, _: Self) -> Self {
        left_out()
    }
    fn quotient_unit(self, _: TracedScalar) -> Option<Self> {
        left_out()
    }
    fn unit_vector(_: Self, _: Self, _: Self) -> [TracedScalar; 2] {
        left_out()
    }
    fn difference(a: Self, b: Self, squares: TracedScalar) -> Self {
        let sum = a + b;
        operation(squares.0 / sum.0, "{0} / {1}", &[squares, sum], true)
    }
    fn quadratic_roots(_: Self, _: TracedScalar, _: TracedScalar) -> Option<[Self; 2]> {
        left_out()
    }
    fn half_tangent_roots(
        _: impl Iterator<Item = [TracedScalar; 4]>,
        _: AngleSector<TracedScalar>,
        _: impl FnMut(TracedScalar),
    ) {
        left_out()
    }
    fn ramp_length(ramp: AccelerationRamp<Self>, elapsed: Self) -> Self {
        Scalar::times(ramp.slow + Scalar::times(Scalar::half(ramp.acceleration), elapsed), elapsed)
    }
    fn ramp_time(_: AccelerationRamp<Self>, _: Self) -> Self {
        left_out()
    }
    // Used by constructors, not by a kernel.
    fn slack(_: Self) -> Self {
        <Self as Scalar>::ZERO
    }
    fn rounding(_: Self) -> Self {
        <Self as Scalar>::ZERO
    }
}
impl Wide<TracedScalar> for TracedScalar {
    const ZERO: Self = TracedScalar(0.0, 0);
    fn sqrt(self) -> TracedScalar {
        operation(libm::sqrt(self.0), "sqrt({0})", &[self], true)
    }
    fn narrow(self) -> TracedScalar {
        self
    }
    fn half(self) -> Self {
        Scalar::half(self)
    }
}
impl Unit for TracedScalar {
    const ZERO: Self = TracedScalar(0.0, 0);
    const ONE: Self = TracedScalar(1.0, 0);
    const COARSE: Self = TracedScalar(0.0, 0);
    fn times(self, rhs: Self) -> Self {
        Scalar::times(self, rhs)
    }
}
impl Angle<TracedScalar> for TracedScalar {
    const ZERO: Self = TracedScalar(0.0, 0);
    fn is_finite(self) -> bool {
        true
    }
    fn digest(self) -> u32 {
        Scalar::digest(self)
    }
    fn subtended(length: TracedScalar, radius: TracedScalar) -> Self {
        operation(length.0 / radius.0, "{0} / {1}", &[length, radius], true)
    }
    fn half_subtended(length: TracedScalar, radius: TracedScalar) -> Self {
        Scalar::half(Self::subtended(length, radius))
    }
    fn sin_cos(self) -> (TracedScalar, TracedScalar) {
        (rounded("s", libm::sin(self.0)), rounded("c", libm::cos(self.0)))
    }
    fn atan2(y: TracedScalar, x: TracedScalar) -> Self {
        rounded("angle", libm::atan2(y.0, x.0))
    }
    fn arc_length(self, radius: TracedScalar) -> TracedScalar {
        Scalar::times(self, radius)
    }
    fn circumference(radius: TracedScalar) -> TracedScalar {
        rounded("circumference", core::f64::consts::TAU * radius.0)
    }
}

/// An arc of a few metres whose start, direction and radius are inputs.
fn arc() -> Segment<TracedScalar> {
    on_tape(GappaTape::clear);
    let zero = <TracedScalar as Scalar>::ZERO;
    let start = Segment::standing(Pose { position: Point::new(zero, zero), heading: zero }).expect("a pose");
    let mut arc = start.then_arc(input("radius", 3.0), TurnSide::Left, input("length", 2.0)).expect("an arc");
    on_tape(GappaTape::clear);
    arc.start = Point::new(input("sx", 0.25), input("sy", 0.5));
    (arc.direction.cos, arc.direction.sin) = (rounded("c", 0.8), rounded("s", 0.6));
    arc.curve = Curve::Arc { radius: input("radius", 3.0), turn: TurnSide::Left };
    arc
}

/// The lines of the tape between two indices; some numbers are renamed.
fn lines(from: usize, to: usize, inputs: &[(usize, &str)]) -> String {
    let mut text = on_tape(|tape| tape.lines[from..to].join("\n")) + "\n";
    for (place, name) in inputs {
        for old in [format!("t{place}"), format!("T{place}")] {
            // Replaces whole words only.
            let words = text.split_inclusive(|c: char| !c.is_alphanumeric()).map(|word| {
                let end = word.trim_end_matches(|c: char| !c.is_alphanumeric());
                if end == old { word.replace(&old, name) } else { word.to_string() }
            });
            text = words.collect();
        }
    }
    text
}

fn length() -> usize {
    on_tape(|tape| tape.lines.len())
}

/// Compares a recording with the file in `proofs/recorded`. `PCR_RECORD=1` writes the file.
fn assert_recorded(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../proofs/recorded").join(format!("{name}.g"));
    if std::env::var_os("PCR_RECORD").is_some() {
        eprintln!("written: {}", path.display());
        fs::write(&path, text).expect("a writable file");
    }
    let proved = fs::read_to_string(&path).expect("a recorded kernel");
    assert!(proved == text, "{name} is not the kernel that proofs/ is about; it is now\n{text}");
}

/// Index of the line of the tape that computes this number.
fn place(of: TracedScalar) -> usize {
    on_tape(|tape| tape.names[of.1][0].trim_start_matches('t').parse().expect("a number that was computed"))
}

#[test]
fn the_kernels_are_those_that_were_proved() {
    let arc = arc();
    let point = Point::new(input("px", 1.0), input("py", 1.5));
    let footprint = CarrierCoordinates::of(point, &arc);
    let all = length();
    // The local coordinates end where `y` is computed.
    let from_start = point - arc.start;
    let [_, y] = [from_start.along(arc.direction), from_start.across(arc.direction)];
    let local = place(y) - all;
    let x = 5;
    assert_recorded("local", &lines(0, local, &[]));
    assert_recorded("offset", &lines(local, all, &[(x, "x"), (local, "y")]));
    let offset = place(footprint.offset);
    assert_eq!(offset, all);

    let (before, footprint_y) = (length(), y.0);
    let radius = input("r", 1.75);
    footprint.reach(&arc, radius);
    // The lines after the last root compute angles.
    let roots = on_tape(|tape| tape.lines.iter().rposition(|line| line.contains("sqrt")).expect("a root")) + 1;
    let distance = on_tape(|tape| tape.lines.iter().position(|line| line.contains("sqrt")).expect("a root")) + 1;
    assert_recorded("reach", &lines(before, roots, &[(offset, "n"), (distance, "d")]));

    on_tape(GappaTape::clear);
    let ramp = AccelerationRamp {
        slow: input("v", 1.1),
        fast: input("w", 2.0),
        acceleration: input("a", 0.3),
        duration: input("t", 2.0),
        length: input("l", 3.0),
    };
    let way = TracedScalar::ramp_length(ramp, input("e", 1.25));
    assert_recorded("ramp", &lines(0, length(), &[]));

    // Checks that the bodies of `float.rs` above are still the same: the same operations give the same bits.
    let floats = AccelerationRamp { slow: 1.1, fast: 2.0, acceleration: 0.3, duration: 2.0, length: 3.0 };
    assert_eq!(way.0.to_bits(), f64::ramp_length(floats, 1.25).to_bits());
    let below: f64 = 3.1 - footprint_y;
    assert_eq!(
        f64::difference(3.1, below, 0.7).to_bits(),
        TracedScalar::difference(TracedScalar(3.1, 0), TracedScalar(below, 0), TracedScalar(0.7, 0)).0.to_bits()
    );
}

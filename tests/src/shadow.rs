//! The shadow scalar: a number of a format that decides every branch, beside an enclosure of what it would be without rounding.
//!
//! The generic kernels of the library run on it as they are. Each operation rounds as the format does and encloses the exact
//! result in a number of 106 bits with a bound on its error; comparisons look at the format's own value. How far the two are apart is
//! then what rounding has done along the very branches that were taken. A root of a quadratic is told as it is: it is to be
//! held against the geometry that it stands for, at which it is exact input ([`Number::exact`]). One that is real by its doubt
//! alone is marked: its exact value may be anything ([`Number::is_doubted`]).

mod enclosure;
mod formats;

pub use enclosure::Enclosure;
use pcr_core::Scalar;
use pcr_core::scalar::{AccelerationRamp, Angle, AngleSector, Unit, Wide};
use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Neg, Sub};

/// A format whose values can be read as `f64`, exactly.
pub trait Shadowed: Copy + Debug + Default + PartialEq + 'static {
    /// Its numbers.
    type S: Scalar;
    /// The value of a number.
    fn number(value: Self::S) -> f64;
    /// The exact value of an angle \[rad\].
    fn angle(value: <Self::S as Scalar>::Angle) -> Enclosure;
}

macro_rules! shadow {
    ($name:ident, $of:ty, $what:literal) => {
        #[doc = $what]
        #[derive(Clone, Copy, Debug)]
        pub struct $name<X: Shadowed> {
            /// The format's own.
            pub value: $of,
            /// What it would be without rounding.
            pub exact: Enclosure,
        }

        impl<X: Shadowed> PartialEq for $name<X> {
            fn eq(&self, other: &Self) -> bool {
                self.partial_cmp(other) == Some(Ordering::Equal)
            }
        }
        impl<X: Shadowed> PartialOrd for $name<X> {
            fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
                self.value.partial_cmp(&other.value)
            }
        }
        impl<X: Shadowed> Add for $name<X> {
            type Output = Self;
            fn add(self, rhs: Self) -> Self {
                Self { value: self.value + rhs.value, exact: self.exact + rhs.exact }
            }
        }
        impl<X: Shadowed> Sub for $name<X> {
            type Output = Self;
            fn sub(self, rhs: Self) -> Self {
                Self { value: self.value - rhs.value, exact: self.exact - rhs.exact }
            }
        }
        impl<X: Shadowed> Neg for $name<X> {
            type Output = Self;
            fn neg(self) -> Self {
                Self { value: -self.value, exact: -self.exact }
            }
        }
    };
}

shadow!(Number, X::S, "A length, with its shadow.");
shadow!(Product, <X::S as Scalar>::Wide, "A product of lengths, with its shadow.");
shadow!(Sine, <X::S as Scalar>::Unit, "A sine or cosine, with its shadow.");
shadow!(Turned, <X::S as Scalar>::Angle, "An angle, with its shadow.");

impl<X: Shadowed> Number<X> {
    /// A number of the format as exact input.
    pub fn exact(value: X::S) -> Self {
        Self { value, exact: Enclosure::at(X::number(value)) }
    }

    /// Whether it comes from a root that only a doubt has made real.
    pub fn is_doubted(self) -> bool {
        self.error() == f64::INFINITY
    }

    /// How far the value is from the exact one, at most.
    pub fn error(self) -> f64 {
        self.exact.farthest(X::number(self.value))
    }
}

impl<X: Shadowed> Turned<X> {
    /// An angle of the format as exact input.
    pub fn exact(value: <X::S as Scalar>::Angle) -> Self {
        Self { value, exact: X::angle(value) }
    }
}

impl<X: Shadowed> Default for Number<X> {
    fn default() -> Self {
        Self::ZERO
    }
}

type N<X> = Number<X>;

impl<X: Shadowed> Scalar for Number<X> {
    type Wide = Product<X>;
    type Unit = Sine<X>;
    type Angle = Turned<X>;

    const ZERO: Self = Self { value: X::S::ZERO, exact: Enclosure::at(0.0) };
    const LIMIT: Self = Self { value: X::S::LIMIT, exact: Enclosure::ALL };
    const LEAST: Self = Self { value: X::S::LEAST, exact: Enclosure::ALL };

    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
    fn digest(self) -> u32 {
        self.value.digest()
    }
    fn millimetres(self) -> u32 {
        self.value.millimetres()
    }
    fn times(self, rhs: Self) -> Product<X> {
        Product { value: self.value.times(rhs.value), exact: self.exact * rhs.exact }
    }
    fn scale(self, by: Sine<X>) -> Self {
        Self { value: self.value.scale(by.value), exact: self.exact * by.exact }
    }
    fn combine(a: Self, u: Sine<X>, b: Self, v: Sine<X>) -> Self {
        let value = X::S::combine(a.value, u.value, b.value, v.value);
        Self { value, exact: a.exact * u.exact + b.exact * v.exact }
    }
    fn half(self) -> Self {
        Self { value: self.value.half(), exact: self.exact * Enclosure::at(0.5) }
    }
    fn sum(self, rhs: Self) -> (Self, Self) {
        let (value, rest) = self.value.sum(rhs.value);
        (Self { value, exact: self.exact + rhs.exact }, Self { value: rest, exact: Enclosure::at(0.0) })
    }
    fn advance(self, rest: Self, length: Self, by: Sine<X>) -> (Self, Self) {
        let (value, left) = self.value.advance(rest.value, length.value, by.value);
        let exact = self.exact + rest.exact + length.exact * by.exact;
        (Self { value, exact }, Self { value: left, exact: Enclosure::at(0.0) })
    }
    fn sum_up(self, rhs: Self) -> Self {
        Self { value: self.value.sum_up(rhs.value), exact: self.exact + rhs.exact }
    }
    fn quotient(self, divisor: Self) -> Self {
        Self { value: self.value.quotient(divisor.value), exact: self.exact / divisor.exact }
    }
    fn portion(self, part: Self, whole: Self) -> Self {
        Self { value: self.value.portion(part.value, whole.value), exact: self.exact * part.exact / whole.exact }
    }
    fn quotient_unit(self, divisor: Sine<X>) -> Option<Self> {
        let value = self.value.quotient_unit(divisor.value)?;
        Some(Self { value, exact: self.exact / divisor.exact })
    }
    fn unit_vector(x: Self, y: Self, norm: Self) -> [Sine<X>; 2] {
        let [cos, sin] = X::S::unit_vector(x.value, y.value, norm.value);
        let norm = (x.exact * x.exact + y.exact * y.exact).sqrt();
        [Sine { value: cos, exact: x.exact / norm }, Sine { value: sin, exact: y.exact / norm }]
    }
    fn difference(a: Self, b: Self, squares: Product<X>) -> Self {
        let value = X::S::difference(a.value, b.value, squares.value);
        Self { value, exact: squares.exact / (a.exact + b.exact) }
    }
    fn quadratic_roots(b: Self, g: Product<X>, doubt: Product<X>) -> Option<[Self; 2]> {
        let roots = X::S::quadratic_roots(b.value, g.value, doubt.value)?;
        let real = X::S::quadratic_roots(b.value, g.value, Wide::ZERO).is_some();
        Some(roots.map(|value| if real { Self::exact(value) } else { Self { value, exact: Enclosure::ALL } }))
    }
    fn half_tangent_roots(
        equations: impl Iterator<Item = [Product<X>; 4]>,
        sector: AngleSector<Sine<X>>,
        mut found: impl FnMut(Turned<X>),
    ) {
        let [from, middle] = [sector.from, sector.middle].map(|direction| direction.map(|sine| sine.value));
        let sector = AngleSector { from, middle, least: sector.least.value };
        for [a, b, g, doubt] in equations.map(|equation| equation.map(|coefficient| coefficient.value)) {
            let mut real = 0;
            X::S::half_tangent_roots([[a, b, g, Wide::ZERO]].into_iter(), AngleSector::all(sector.from), |_| real += 1);
            X::S::half_tangent_roots([[a, b, g, doubt]].into_iter(), sector, |value| {
                found(if real > 0 { Turned::exact(value) } else { Turned { value, exact: Enclosure::ALL } });
            });
        }
    }
    fn chord(radius: Self, half: Turned<X>, right: bool, direction: [Sine<X>; 2]) -> [Self; 2] {
        let values = X::S::chord(radius.value, half.value, right, direction.map(|sine| sine.value));
        let (sin, cos) = half.exact.sin_cos();
        let chord = radius.exact * Enclosure::at(2.0) * sin;
        let (along, across) = (chord * cos, if right { -(chord * sin) } else { chord * sin });
        let [c, s] = direction.map(|sine| sine.exact);
        let exact = [along * c - across * s, along * s + across * c];
        [Self { value: values[0], exact: exact[0] }, Self { value: values[1], exact: exact[1] }]
    }
    fn ramp_length(ramp: AccelerationRamp<Self>, elapsed: Self) -> Self {
        Self::exact(X::S::ramp_length(plain(ramp), elapsed.value))
    }
    fn ramp_time(ramp: AccelerationRamp<Self>, length: Self) -> Self {
        Self::exact(X::S::ramp_time(plain(ramp), length.value))
    }
    fn ramp_bulge(ramp: AccelerationRamp<Self>, duration: Self) -> Self {
        Self::exact(X::S::ramp_bulge(plain(ramp), duration.value))
    }
    fn ramps_alike(one: AccelerationRamp<Self>, other: AccelerationRamp<Self>) -> bool {
        X::S::ramps_alike(plain(one), plain(other))
    }
    fn slack(extent: Self) -> Self {
        Self::exact(X::S::slack(extent.value))
    }
    fn rounding(of: Self) -> Self {
        Self::exact(X::S::rounding(of.value))
    }
    fn drift(arcs: usize, extent: Self) -> Self {
        Self::exact(X::S::drift(arcs, extent.value))
    }
    fn lag(speed: Self, time: Self) -> Self {
        Self::exact(X::S::lag(speed.value, time.value))
    }
}

fn plain<X: Shadowed>(ramp: AccelerationRamp<N<X>>) -> AccelerationRamp<X::S> {
    let AccelerationRamp { slow, fast, acceleration, duration, length } = ramp;
    let [slow, fast, acceleration] = [slow, fast, acceleration].map(|number| number.value);
    AccelerationRamp { slow, fast, acceleration, duration: duration.value, length: length.value }
}

impl<X: Shadowed> Wide<N<X>> for Product<X> {
    const ZERO: Self = Self { value: <<X::S as Scalar>::Wide as Wide<X::S>>::ZERO, exact: Enclosure::at(0.0) };
    fn sqrt(self) -> N<X> {
        Number { value: self.value.sqrt(), exact: self.exact.sqrt() }
    }
    fn narrow(self) -> N<X> {
        Number { value: self.value.narrow(), exact: self.exact }
    }
    fn half(self) -> Self {
        Self { value: self.value.half(), exact: self.exact * Enclosure::at(0.5) }
    }
}

impl<X: Shadowed> Unit for Sine<X> {
    const ZERO: Self = Self { value: <X::S as Scalar>::Unit::ZERO, exact: Enclosure::at(0.0) };
    const ONE: Self = Self { value: <X::S as Scalar>::Unit::ONE, exact: Enclosure::at(1.0) };
    const COARSE: Self = Self { value: <X::S as Scalar>::Unit::COARSE, exact: Enclosure::ALL };
    fn times(self, rhs: Self) -> Self {
        Self { value: self.value.times(rhs.value), exact: self.exact * rhs.exact }
    }
    fn combine(a: Self, u: Self, b: Self, v: Self) -> Self {
        let value = Unit::combine(a.value, u.value, b.value, v.value);
        Self { value, exact: a.exact * u.exact + b.exact * v.exact }
    }
}

impl<X: Shadowed> Angle<N<X>> for Turned<X> {
    const ZERO: Self = Self { value: <X::S as Scalar>::Angle::ZERO, exact: Enclosure::at(0.0) };
    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
    fn digest(self) -> u32 {
        Angle::<X::S>::digest(self.value)
    }
    fn subtended(length: N<X>, radius: N<X>) -> Self {
        let value = Angle::<X::S>::subtended(length.value, radius.value);
        Self { value, exact: length.exact / radius.exact }
    }
    fn half_subtended(length: N<X>, radius: N<X>) -> Self {
        let value = Angle::<X::S>::half_subtended(length.value, radius.value);
        Self { value, exact: length.exact / (radius.exact * Enclosure::at(2.0)) }
    }
    fn subtended_rest(self, length: N<X>, radius: N<X>) -> Self {
        Self { value: self.value.subtended_rest(length.value, radius.value), exact: Enclosure::at(0.0) }
    }
    fn sum(self, rhs: Self) -> (Self, Self) {
        let (value, rest) = Angle::<X::S>::sum(self.value, rhs.value);
        (Self { value, exact: self.exact + rhs.exact }, Self { value: rest, exact: Enclosure::at(0.0) })
    }
    fn sin_cos(self) -> (Sine<X>, Sine<X>) {
        let (sin, cos) = self.value.sin_cos();
        let exact = self.exact.sin_cos();
        (Sine { value: sin, exact: exact.0 }, Sine { value: cos, exact: exact.1 })
    }
    fn atan2(y: N<X>, x: N<X>) -> Self {
        let value = <X::S as Scalar>::Angle::atan2(y.value, x.value);
        Self { value, exact: y.exact.atan2(x.exact, X::angle(value).to_f64()) }
    }
    fn arc_length(self, radius: N<X>) -> N<X> {
        Number { value: self.value.arc_length(radius.value), exact: self.exact * radius.exact }
    }
    fn circumference(radius: N<X>) -> N<X> {
        let value = <X::S as Scalar>::Angle::circumference(radius.value);
        Number { value, exact: Enclosure::TURN * radius.exact }
    }
}

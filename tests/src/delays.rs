//! Unsafe delays of straight edges by their definition, with 106 bits: no closed form of an end is used here.
//!
//! With a delay δ both vehicles are on their edges from max(0, δ) to min(T₁, T₂ + δ), their distance is that of a point moving
//! evenly, and its minimum f(δ) over that time is had by a projection. f is convex (a minimum over one variable of a convex function of
//! two), so that the unsafe delays are one interval, and three values of f tell that nothing is outside of one that was found.

pub mod published;

use pcr_certify::double_double::DoubleDouble;
use pcr_formats::import::{Layout, LayoutEdge};

/// Where an edge begins and ends.
pub fn ends_of(layout: &Layout, edge: &LayoutEdge) -> [[f64; 2]; 2] {
    edge.ends.map(|node| layout.nodes[node].point)
}

/// What is wrong with an interval of delays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DelayFault {
    /// There is none, and the vehicles come this near \[m\].
    Missing {
        /// The least distance of their reference points \[m\].
        apart: f64,
    },
    /// Its ends are none \[s\].
    NoInterval([f64; 2]),
    /// Both are never under way in the middle of it, or just inside of an end \[s\].
    NobodyThere([f64; 2]),
    /// There are contacts beyond an end.
    Beyond {
        /// The end \[s\].
        end: f64,
        /// The distance just beyond \[m\].
        apart: f64,
    },
    /// An end is too far out.
    TooWide {
        /// The end \[s\].
        end: f64,
        /// The distance just inside \[m\].
        apart: f64,
    },
}

/// A straight edge with 106 bits.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    start: [DoubleDouble; 2],
    end: [DoubleDouble; 2],
    /// \[m/s\]
    velocity: [DoubleDouble; 2],
    /// \[s\]
    duration: DoubleDouble,
}

fn less([a, b]: [DoubleDouble; 2], [c, d]: [DoubleDouble; 2]) -> [DoubleDouble; 2] {
    [a - c, b - d]
}

fn dot([a, b]: [DoubleDouble; 2], [c, d]: [DoubleDouble; 2]) -> DoubleDouble {
    a * c + b * d
}

fn by([a, b]: [DoubleDouble; 2], factor: DoubleDouble) -> [DoubleDouble; 2] {
    [a * factor, b * factor]
}

fn cross([a, b]: [DoubleDouble; 2], [c, d]: [DoubleDouble; 2]) -> DoubleDouble {
    a * d - b * c
}

fn larger(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    if a < b { b } else { a }
}

fn smaller(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    if b < a { b } else { a }
}

impl Exact {
    /// From one point to another at a speed.
    pub fn new(from: [f64; 2], to: [f64; 2], speed: f64) -> Self {
        let (start, end) = (from.map(DoubleDouble::from), to.map(DoubleDouble::from));
        let way = less(end, start);
        let length = dot(way, way).sqrt();
        let speed = DoubleDouble::from(speed);
        let still = length == DoubleDouble::ZERO;
        let velocity = if still { [DoubleDouble::ZERO; 2] } else { by(way, speed / length) };
        Self { start, end, velocity, duration: if still { DoubleDouble::ZERO } else { length / speed } }
    }

    /// How long it takes \[s\].
    pub fn duration(&self) -> f64 {
        self.duration.to_f64()
    }

    /// The square of the least distance if the other one sets off later by `delay`, while both are under way; `None` where they never are.
    pub fn nearest(&self, other: &Self, delay: DoubleDouble) -> Option<DoubleDouble> {
        let (from, to) = (larger(DoubleDouble::ZERO, delay), smaller(self.duration, other.duration + delay));
        if to < from {
            return None;
        }
        let passing = less(self.velocity, other.velocity);
        let at_zero = less(self.start, less(other.start, by(other.velocity, delay)));
        let square = dot(passing, passing);
        let time = if square == DoubleDouble::ZERO { from } else { (-dot(at_zero, passing) / square).clamp(from, to) };
        let apart = less(at_zero, by(passing, -time));
        Some(dot(apart, apart))
    }

    /// The square of the distance of the two edges: that of the vehicles at the best of all delays.
    pub fn apart(&self, other: &Self) -> DoubleDouble {
        let side = |of: &Self, point: [DoubleDouble; 2]| cross(less(of.end, of.start), less(point, of.start));
        let split = |of: &Self, by: &Self| {
            let [a, b] = [side(by, of.start), side(by, of.end)];
            (a < DoubleDouble::ZERO && DoubleDouble::ZERO < b) || (b < DoubleDouble::ZERO && DoubleDouble::ZERO < a)
        };
        if split(self, other) && split(other, self) {
            return DoubleDouble::ZERO;
        }
        let ends = [(self, other.start), (self, other.end), (other, self.start), (other, self.end)];
        let all = ends.map(|(edge, point)| edge.apart_from(point));
        all.into_iter().reduce(smaller).unwrap_or(DoubleDouble::ZERO)
    }

    /// The square of the distance of a point.
    fn apart_from(&self, point: [DoubleDouble; 2]) -> DoubleDouble {
        let (way, to) = (less(self.end, self.start), less(point, self.start));
        let square = dot(way, way);
        let one = DoubleDouble::from(1.0);
        let share =
            if square == DoubleDouble::ZERO { one } else { (dot(to, way) / square).clamp(DoubleDouble::ZERO, one) };
        let apart = less(to, by(way, share));
        dot(apart, apart)
    }

    /// The square of the distance of a point from where the vehicle is at a time.
    pub fn apart_from_at(&self, point: [f64; 2], time: f64) -> DoubleDouble {
        let time = DoubleDouble::from(time).clamp(DoubleDouble::ZERO, self.duration);
        let apart = less(less(point.map(DoubleDouble::from), self.start), by(self.velocity, time));
        dot(apart, apart)
    }

    /// What is wrong with an interval of delays that was found for this edge and another one: a contact outside of it, or an end
    /// that is further out than the excess allows (of lengths, and of times).
    pub fn judge(&self, other: &Self, reach: f64, found: Option<[f64; 2]>, excess: [f64; 2]) -> Result<(), DelayFault> {
        let square = |reach: DoubleDouble| reach * reach;
        let (reach, wide) = (DoubleDouble::from(reach), DoubleDouble::from(reach) + DoubleDouble::from(excess[0]));
        let Some([lo, hi]) = found else {
            return match self.apart(other) {
                apart if apart > square(reach) => Ok(()),
                apart => Err(DelayFault::Missing { apart: apart.sqrt().to_f64() }),
            };
        };
        if lo.is_nan() || hi.is_nan() || lo > hi {
            return Err(DelayFault::NoInterval([lo, hi]));
        }
        // Rounding may lead to where nobody is.
        let there = |delay: f64| DoubleDouble::from(delay).clamp(-other.duration, self.duration);
        let middle = there(0.5 * (lo + hi));
        let inside = self.nearest(other, middle).ok_or(DelayFault::NobodyThere([lo, hi]))?;
        for (end, beyond, inward) in [(lo, lo.next_down(), excess[1]), (hi, hi.next_up(), -excess[1])] {
            // Beyond the end nobody is there any more, or they are apart and the farther the more: f is convex.
            if let Some(apart) = self.nearest(other, DoubleDouble::from(beyond))
                && (apart <= square(reach) || apart <= inside)
            {
                return Err(DelayFault::Beyond { end, apart: apart.sqrt().to_f64() });
            }
            let half = 0.5 * (hi - lo);
            let inner = there(end + inward.clamp(-half, half));
            let within = self.nearest(other, inner).ok_or(DelayFault::NobodyThere([lo, hi]))?;
            if within > square(wide) {
                return Err(DelayFault::TooWide { end, apart: within.sqrt().to_f64() });
            }
        }
        Ok(())
    }
}

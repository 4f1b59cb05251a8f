//! From the numbers of a path to its segments in the plane, with 106 bits.

use crate::ball::Ball;
use crate::cell::Placed;
use crate::data::{Angle, Path, Segment};
use crate::plane::{Carrier, Vector};
use crate::twofold::Twofold;

type Number = Ball<Twofold>;

/// No number of a path is larger.
const MOST: f64 = 1e15;

/// A segment in the plane, and its lengths along the path.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// In the plane.
    pub placed: Placed,
    /// Exact length of the path before it \[m\].
    pub before: Twofold,
    from: f64,
    to: f64,
}

impl Stretch {
    /// The length along the segment at a length along the path. An end is one if it is the same number as that of the segment.
    pub fn along(&self, length: f64) -> Twofold {
        if length == self.from {
            Twofold::ZERO
        } else if length == self.to {
            self.placed.length
        } else {
            (Twofold::from(length) - Twofold::from(self.from)).clamp(Twofold::ZERO, self.placed.length)
        }
    }

    /// Whether a length along the path is on the segment.
    pub fn holds(&self, length: f64) -> bool {
        self.from <= length && length <= self.to
    }

    /// Which way an arc turns, of a line nothing.
    pub fn turns_left(&self) -> Option<bool> {
        match self.placed.exact {
            Carrier::Line { .. } => None,
            Carrier::Circle { left, .. } => Some(left),
        }
    }

    /// The parts of the segment between lengths along the path.
    pub fn range(&self, lengths: [f64; 2]) -> [Twofold; 2] {
        lengths.map(|length| self.along(length))
    }

    /// The length along the path at a length along the segment, rounded.
    pub fn on_path(&self, length: Twofold) -> f64 {
        (Twofold::from(self.from) + length).to_f64().clamp(self.from, self.to)
    }
}

/// Sine and cosine of an angle.
fn sine_and_cosine(angle: Angle) -> [Number; 2] {
    match angle {
        Angle::Radians(angle) => sines(Twofold::from(angle), 0.0),
        // The product is right within 2^-102 of itself, the constant within 2^-108.
        Angle::Turns(turns) => {
            let rest = turns - turns.round();
            let angle = Twofold::TURN * rest;
            sines(angle, 1e-30)
        }
    }
}

/// Those of an angle that is off by so much: up to a thousand turns they are as right as those of smaller ones.
fn sines(angle: Twofold, off: f64) -> [Number; 2] {
    let (sin, cos) = angle.sin_cos();
    let err = if angle.to_f64().abs() < 6000.0 { off + 8e-31 } else { f64::INFINITY };
    [sin, cos].map(|mid| Ball { mid, err })
}

fn fits(value: f64, name: &str) -> Result<(), String> {
    if value.abs() <= MOST { Ok(()) } else { Err(format!("{name} {value} is out of range")) }
}

/// The segments of a path.
///
/// # Errors
/// What is wrong with it.
pub fn stretches(path: &Path) -> Result<Vec<Stretch>, String> {
    let [x, y] = path.start;
    fits(x, "x")?;
    fits(y, "y")?;
    let (Angle::Radians(heading) | Angle::Turns(heading)) = path.heading;
    if heading.abs() > 6000.0 || heading.is_nan() {
        return Err(format!("heading {heading} is out of range"));
    }
    let zero = Ball::from(0.0);
    let mut direction = Vector { x: Ball::from(1.0), y: zero }.turned(sine_and_cosine(path.heading));
    let mut at = Vector { x: Ball::from(x), y: Ball::from(y) };
    let mut before = Twofold::ZERO;
    let (mut stretches, mut sum) = (Vec::with_capacity(path.segments.len()), 0.0);
    for (place, segment) in path.segments.iter().enumerate() {
        let wrong = |problem: String| format!("segment {place}: {problem}");
        checked(segment, sum).map_err(wrong)?;
        direction = segment.turns.iter().fold(direction, |direction, &by| direction.turned(sine_and_cosine(by)));
        let carrier = match segment.radius {
            None => Carrier::Line { start: at, along: direction },
            Some(bend) => {
                let (left, radius) = (bend > 0.0, Ball::from(bend.abs()));
                let to_centre = if left { direction.left() } else { direction.left().times(Ball::from(-1.0)) };
                let start = to_centre.times(Ball::from(-1.0));
                Carrier::Circle { centre: at + to_centre.times(radius), radius, start, left }
            }
        };
        let length = Twofold::from(segment.length);
        let placed = Placed::new(carrier, length);
        (at, direction) = (carrier.point(Ball::from(segment.length)), carrier.direction(Ball::from(segment.length)));
        for (end, exact) in [(segment.from, before), (segment.to, before + length)] {
            let off = (Twofold::from(end) - exact).abs().to_f64();
            if off > path.rounding {
                return Err(wrong(format!("its lengths along the path are off by {off:e} m")));
            }
        }
        stretches.push(Stretch { placed, before, from: segment.from, to: segment.to });
        (before, sum) = (before + length, segment.to);
    }
    if stretches.is_empty() { Err("no segments".into()) } else { Ok(stretches) }
}

fn checked(segment: &Segment, sum: f64) -> Result<(), String> {
    fits(segment.length, "length")?;
    fits(segment.radius.unwrap_or(1.0), "radius")?;
    if segment.length < 0.0 || segment.radius == Some(0.0) {
        return Err("a length below 0 or a radius of 0".into());
    }
    // A full turn rounded to the last digit of a format may be more: 13 digits for a radius of 2.
    if segment.radius.is_some_and(|radius| segment.length > 7.0 * radius.abs()) {
        return Err("more than one turn".into());
    }
    if segment.from != sum || segment.to < segment.from {
        return Err("it does not begin where the one before ends".into());
    }
    Ok(())
}

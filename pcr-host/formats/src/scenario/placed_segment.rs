//! Lines and arcs anywhere in the plane, with turns in place between them.

use super::PathSegment;

/// Largest angle between two pieces that is passed without stopping \[rad\]: what joints of maps are off by.
pub const KINK: f64 = 0.01;

/// A segment where the file has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedSegment {
    /// Start \[m\].
    pub start: [f64; 2],
    /// Direction there \[rad\].
    pub heading: f64,
    /// Its shape.
    pub shape: PathSegment,
}

impl PlacedSegment {
    /// The line between two points \[m\].
    pub fn line(from: [f64; 2], to: [f64; 2]) -> Self {
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        Self { start: from, heading: y.atan2(x), shape: PathSegment::Line { length: x.hypot(y) } }
    }

    /// Direction at its end \[rad\].
    pub fn heading_at_end(&self) -> f64 {
        match self.shape {
            PathSegment::Line { .. } => self.heading,
            PathSegment::Facing { before, after } => self.heading + (before - after),
            shape => self.heading + shape.sweep(),
        }
    }

    /// End \[m\].
    pub fn end(&self) -> [f64; 2] {
        let (chord, direction) = match self.shape {
            PathSegment::Line { length } => (length, self.heading),
            PathSegment::Turn { .. } | PathSegment::Kink { .. } | PathSegment::Facing { .. } => return self.start,
            PathSegment::Arc { radius, sweep, .. } => {
                (2.0 * radius * (sweep.abs() / 2.0).sin(), self.heading + sweep / 2.0)
            }
        };
        [self.start[0] + chord * direction.cos(), self.start[1] + chord * direction.sin()]
    }

    /// The part between two lengths along it \[m\]. Turns and kinks are not cut.
    #[must_use]
    pub fn part(&self, from: f64, to: f64) -> Self {
        if matches!(self.shape, PathSegment::Turn { .. } | PathSegment::Kink { .. }) {
            return *self;
        }
        let whole = self.shape.length();
        let cut = |length: f64| {
            let share = if whole > 0.0 { length / whole } else { 0.0 };
            match self.shape {
                PathSegment::Line { length } => PathSegment::Line { length: length * share },
                PathSegment::Arc { radius, sweep, steady } => PathSegment::Arc { radius, sweep: sweep * share, steady },
                _ => PathSegment::Line { length: 0.0 },
            }
        };
        let before = Self { shape: cut(from), ..*self };
        Self { start: before.end(), heading: before.heading_at_end(), shape: cut(to - from) }
    }

    /// Radius \[m\], if it is an arc.
    pub(crate) fn radius(&self) -> Option<f64> {
        match self.shape {
            PathSegment::Arc { radius, .. } => Some(radius),
            _ => None,
        }
    }

    /// The same, travelled the other way.
    pub fn reversed(&self) -> Self {
        let shape = match self.shape {
            PathSegment::Line { .. } => self.shape,
            PathSegment::Facing { before, after } => PathSegment::Facing { before: after, after: before },
            PathSegment::Arc { radius, sweep, steady } => PathSegment::Arc { radius, sweep: -sweep, steady },
            PathSegment::Turn { sweep } => PathSegment::Turn { sweep: -sweep },
            PathSegment::Kink { sweep } => PathSegment::Kink { sweep: -sweep },
        };
        Self { start: self.end(), heading: self.heading_at_end() + std::f64::consts::PI, shape }
    }
}

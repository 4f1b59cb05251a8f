//! Positions on a path, as the integral of the unit vector of the heading.

use crate::disc::{Disc, Leg};

/// Complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Complex(f64, f64);

impl Complex {
    fn turned(angle: f64) -> Self {
        Self(angle.cos(), angle.sin())
    }

    fn times(self, by: Self) -> Self {
        Self(self.0 * by.0 - self.1 * by.1, self.0 * by.1 + self.1 * by.0)
    }

    fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }

    fn scaled(self, by: f64) -> Self {
        Self(self.0 * by, self.1 * by)
    }
}

/// A path that can be evaluated.
#[derive(Clone, Debug)]
pub struct Route {
    pieces: Vec<Piece>,
    start: Complex,
    length: f64,
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    from: f64,
    length: f64,
    start: Complex,
    heading: Complex,
    curvature: f64,
}

impl Piece {
    fn at(&self, u: f64) -> Complex {
        self.start.plus(self.heading.times(mean_turn(self.curvature * u).scaled(u)))
    }
}

/// Mean of `exp(i x)` between 0 and `x`, `(exp(i x) - 1) / (i x)`: by its power series where that quotient cancels.
fn mean_turn(x: f64) -> Complex {
    /// The series is used up to this argument \[rad\]; its last term is then below 1e-19.
    const SMALL: f64 = 0.7;
    const TERMS: i32 = 16;
    if x.abs() > SMALL {
        return Complex(x.sin() / x, (1.0 - x.cos()) / x);
    }
    // 1 + (ix/2) (1 + (ix/3) (1 + ...))
    let mut sum = Complex(1.0, 0.0);
    for k in (2..=TERMS).rev() {
        sum = Complex(1.0, 0.0).plus(Complex(0.0, x / f64::from(k)).times(sum));
    }
    sum
}

impl Route {
    /// The route of a disc.
    pub fn new(disc: &Disc) -> Self {
        let [x, y, mut heading] = disc.start;
        let start = Complex(x, y);
        let (mut at, mut from, mut pieces) = (start, 0.0, Vec::new());
        for leg in disc.legs.iter().filter(|leg| leg.length() > 0.0) {
            let curvature = match *leg {
                Leg::Line(_) => 0.0,
                Leg::Left { radius, .. } => 1.0 / radius,
                Leg::Right { radius, .. } => -1.0 / radius,
            };
            let piece = Piece { from, length: leg.length(), start: at, heading: Complex::turned(heading), curvature };
            at = piece.at(leg.length());
            heading += leg.sweep();
            from += leg.length();
            pieces.push(piece);
        }
        Self { pieces, start, length: from }
    }

    /// Total length \[m\].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Position \[m\] at a travelled length \[m\], limited to the route.
    pub fn at(&self, length: f64) -> (f64, f64) {
        let piece = self.pieces.iter().rev().find(|piece| piece.from <= length).or(self.pieces.first());
        let point = piece.map_or(self.start, |piece| piece.at((length - piece.from).clamp(0.0, piece.length)));
        (point.0, point.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn both_forms_of_the_mean_turn_agree_where_they_meet() {
        let (below, above) = (mean_turn(0.7), mean_turn(0.7 + 1e-15));
        assert!((below.0 - above.0).abs() < 1e-14 && (below.1 - above.1).abs() < 1e-14);
    }

    #[test]
    fn a_quarter_turn_and_a_line_end_where_they_should() {
        let legs = vec![Leg::arc(2.0, FRAC_PI_2), Leg::Line(3.0), Leg::arc(1.0, -PI)];
        let route = Route::new(&Disc { radius: 1.0, start: [1.0, 0.0, 0.0], legs });
        for (length, x, y) in [(0.0, 1.0, 0.0), (PI, 3.0, 2.0), (PI + 3.0, 3.0, 5.0), (2.0 * PI + 3.0, 5.0, 5.0)] {
            let (px, py) = route.at(length);
            assert!((px - x).abs() < 1e-14 && (py - y).abs() < 1e-14, "at {length}: ({px}, {py})");
        }
    }
}

//! Positions on a path of lines and arcs, from the numbers that its constructors were given.
//!
//! A point is evaluated in `f64` first. That decides all but what is close to contact; the rest is decided with 106 bits.

use super::DoubleDouble;
use crate::disc::{Disc, Leg};
use pcr_planning::fleet::HostScalar;

/// Abscissa and ordinate \[m\].
pub type Place = [DoubleDouble; 2];

/// A path.
#[derive(Clone, Debug)]
pub struct Route {
    pieces: Vec<Piece>,
    start: Place,
    length: DoubleDouble,
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    from: DoubleDouble,
    length: DoubleDouble,
    start: Place,
    /// Cosine and sine of the heading at the start.
    heading: Place,
    /// Signed radius, left positive; `None` for a line.
    bend: Option<f64>,
}

fn turned([x, y]: Place, [cos, sin]: Place) -> Place {
    [x * cos - y * sin, x * sin + y * cos]
}

impl Piece {
    /// The integral of the unit vector of the heading over the first `u` metres: `2ϱ sin(h) e(h)`, `h = u / 2ϱ`.
    fn at(&self, u: DoubleDouble) -> Place {
        let way = match self.bend {
            None => [u, DoubleDouble::ZERO],
            Some(bend) => {
                let (sin, cos) = (u / DoubleDouble::from(bend)).half().sin_cos();
                let chord = sin * (2.0 * bend);
                [chord * cos, chord * sin]
            }
        };
        let [x, y] = turned(way, self.heading);
        [self.start[0] + x, self.start[1] + y]
    }

    fn near(&self, u: f64) -> [f64; 2] {
        let [x, y] = match self.bend {
            None => [u, 0.0],
            Some(bend) => {
                let (sin, cos) = (0.5 * u / bend).sin_cos();
                let chord = 2.0 * bend * sin;
                [chord * cos, chord * sin]
            }
        };
        let [cos, sin] = self.heading.map(DoubleDouble::to_f64);
        let [x0, y0] = self.start.map(DoubleDouble::to_f64);
        [x0 + x * cos - y * sin, y0 + x * sin + y * cos]
    }
}

impl Route {
    /// The path of a disc whose numbers are numbers of the format, as [`Disc::rounded`] makes them.
    pub fn new<S: HostScalar>(disc: &Disc) -> Self {
        let [x, y, heading] = disc.start;
        let start = [x, y].map(DoubleDouble::from);
        let mut angle = DoubleDouble::from(S::radians(S::angle(heading).expect("an angle")));
        let (mut at, mut from, mut pieces) = (start, DoubleDouble::ZERO, Vec::with_capacity(disc.legs.len()));
        for leg in disc.legs.iter().filter(|leg| leg.length() > 0.0) {
            let length = DoubleDouble::from(leg.length());
            let bend = match *leg {
                Leg::Line(_) => None,
                Leg::Left { radius, .. } => Some(radius),
                Leg::Right { radius, .. } => Some(-radius),
            };
            let (sin, cos) = angle.sin_cos();
            let piece = Piece { from, length, start: at, heading: [cos, sin], bend };
            at = piece.at(length);
            if let Some(bend) = bend {
                angle = angle + length / DoubleDouble::from(bend);
            }
            from = from + length;
            pieces.push(piece);
        }
        Self { pieces, start, length: from }
    }

    /// Total length \[m\].
    pub fn length(&self) -> DoubleDouble {
        self.length
    }

    fn locate(&self, length: DoubleDouble) -> Option<(&Piece, DoubleDouble)> {
        let after = self.pieces.partition_point(|piece| piece.from <= length);
        let piece = self.pieces.get(after.saturating_sub(1))?;
        Some((piece, (length - piece.from).clamp(DoubleDouble::ZERO, piece.length)))
    }

    /// Position at a travelled length \[m\], limited to the path.
    pub fn at(&self, length: DoubleDouble) -> Place {
        self.locate(length).map_or(self.start, |(piece, u)| piece.at(u))
    }

    /// Distance of a point from the leg of this index, legs of length 0 not counted \[m\].
    pub fn distance(&self, leg: usize, from: Place) -> DoubleDouble {
        let norm = |[x, y]: Place| (x * x + y * y).sqrt();
        let apart = |p: Place| norm([from[0] - p[0], from[1] - p[1]]);
        let Some(piece) = self.pieces.get(leg) else {
            return apart(self.start);
        };
        let [cos, sin] = piece.heading;
        let [x, y] = turned([from[0] - piece.start[0], from[1] - piece.start[1]], [cos, -sin]);
        let ends = [piece.at(DoubleDouble::ZERO), piece.at(piece.length)].map(apart);
        let nearer = if ends[0] < ends[1] { ends[0] } else { ends[1] };
        // A foot misplaced by rounding beside an end is off by the square of that.
        match piece.bend {
            None if x > DoubleDouble::ZERO && x < piece.length => y.abs(),
            Some(bend) => {
                let (side, radius) = (bend.signum(), DoubleDouble::from(bend.abs()));
                let below = radius - y * side;
                let foot = x.to_f64().atan2(below.to_f64()).rem_euclid(std::f64::consts::TAU) * bend.abs();
                if foot <= piece.length.to_f64() { (norm([x, below]) - radius).abs() } else { nearer }
            }
            None => nearer,
        }
    }

    /// A position in `f64`: off by some 2^-53 of the coordinates and of the length of one leg.
    pub fn near(&self, length: DoubleDouble) -> [f64; 2] {
        self.locate(length).map_or(self.start.map(DoubleDouble::to_f64), |(piece, u)| piece.near(u.to_f64()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::{Dice, pair};
    use crate::oracle;

    #[test]
    fn it_agrees_with_the_integral_of_the_heading() {
        for seed in 0..2000 {
            let (disc, _) = pair(&mut Dice::seeded(seed));
            let (route, other) = (Route::new::<f64>(&disc), oracle::Route::new(&disc));
            let scale = 1.0 + disc.start[0].abs() + disc.start[1].abs() + disc.length();
            for k in 0..=20 {
                let length = disc.length() * f64::from(k) / 20.0;
                let (exact, near, sum) = (route.at(length.into()), route.near(length.into()), other.at(length));
                let [x, y] = exact.map(DoubleDouble::to_f64);
                assert!((x - near[0]).hypot(y - near[1]) < 4e-15 * scale, "seed {seed}: {exact:?} {near:?}");
                assert!((x - sum.0).hypot(y - sum.1) < 4e-14 * scale, "seed {seed}: {exact:?} {sum:?}");
            }
        }
    }

    #[test]
    fn a_triangle_of_arcs_closes_to_thirty_digits() {
        // Three thirds of a circle, cut anywhere: back at the start but for what 2π was rounded to.
        let (third, radius) = (std::f64::consts::TAU / 3.0, 1.5);
        let length = radius * third;
        let legs = [0.1, 0.7, 1.9, 2.4].map(|part| Leg::Left { radius, length: part * length });
        let total: f64 = legs.iter().map(|leg| leg.length()).sum();
        let one = Leg::Left { radius, length: total };
        let [cut, whole] = [legs.to_vec(), vec![one]].map(|legs| {
            let disc = Disc { radius: 0.1, start: [3.0, -2.0, 1.0], legs };
            let route = Route::new::<f64>(&disc);
            (route.at(route.length()), route.length())
        });
        let beyond = (cut.1 - whole.1).to_f64();
        for k in [0, 1] {
            let apart = (cut.0[k] - whole.0[k]).abs().to_f64();
            assert!(apart <= beyond.abs() + 1e-30, "{apart:e}, lengths differ by {beyond:e}");
        }
    }
}

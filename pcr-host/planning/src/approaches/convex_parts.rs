//! Bodies as convex parts, and how far two of them are apart.
//!
//! For convex bodies with support functions g and h, the signed distance s = max over all directions q of −(g(q) + h(−q)) is their distance, or
//! below 0 how far they overlap. If no point of a body moves farther than d, its support function changes by d at most, and so does s. The
//! signed distance of bodies of several parts is the least of any two of them, of which the same holds.

use pcr_formats::footprint::Footprint;

/// A convex polygon with rounded corners.
#[derive(Clone, Debug)]
struct ConvexPart {
    /// Counter-clockwise, ahead and left of the reference point \[m\]; one for a disc.
    corners: Vec<[f64; 2]>,
    /// Radius by which they are rounded \[m\].
    radius: f64,
}

/// A body.
#[derive(Clone, Debug)]
pub(super) struct ConvexParts {
    parts: Vec<ConvexPart>,
    /// Radius of the disc around the reference point that holds it \[m\].
    pub(super) reach: f64,
}

impl ConvexParts {
    pub(super) fn new(footprint: &Footprint) -> Self {
        let part = |part: Footprint| ConvexPart { corners: part.polygon().to_vec(), radius: part.growth() };
        Self { parts: footprint.parts().map(part).collect(), reach: footprint.circumscribed_radius() }
    }

    pub(super) fn disc(radius: f64) -> Self {
        Self { parts: vec![ConvexPart { corners: vec![[0.0; 2]], radius }], reach: radius }
    }

    /// The body at a place, with a heading.
    pub(super) fn at(&self, [x, y]: [f64; 2], heading: f64) -> Self {
        let (sin, cos) = heading.sin_cos();
        let place = |[ahead, left]: &[f64; 2]| [x + ahead * cos - left * sin, y + ahead * sin + left * cos];
        let part =
            |part: &ConvexPart| ConvexPart { corners: part.corners.iter().map(place).collect(), radius: part.radius };
        Self { parts: self.parts.iter().map(part).collect(), reach: self.reach }
    }

    /// The signed distance of two bodies \[m\].
    pub(super) fn signed_distance(&self, other: &Self) -> f64 {
        let pairs = self.parts.iter().flat_map(|own| other.parts.iter().map(move |their| own.signed_distance(their)));
        pairs.fold(f64::INFINITY, f64::min)
    }
}

impl ConvexPart {
    fn signed_distance(&self, other: &Self) -> f64 {
        // The direction in which polygons overlap least is across a side; of those that do not overlap, a side or two corners are nearest.
        let beside = self.beside(other).max(other.beside(self));
        let between = if beside <= 0.0 { beside } else { self.to_sides(other).min(other.to_sides(self)) };
        between - self.radius - other.radius
    }

    fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        self.corners.iter().zip(self.corners.iter().cycle().skip(1)).map(|(a, b)| [*a, *b])
    }

    /// How far the other one is beyond a side of this one, at most; two points are apart by their distance.
    fn beside(&self, other: &Self) -> f64 {
        let mut most = f64::NEG_INFINITY;
        for [a, b] in self.sides() {
            let [x, y] = [b[0] - a[0], b[1] - a[1]];
            let length = x.hypot(y);
            if length > 0.0 {
                let out = [y / length, -x / length];
                let across = |p: &[f64; 2]| out[0] * (p[0] - a[0]) + out[1] * (p[1] - a[1]);
                most = most.max(other.corners.iter().map(across).fold(f64::INFINITY, f64::min));
            }
        }
        let are_points = self.corners.len() == 1 && other.corners.len() == 1;
        if are_points { self.to_sides(other) } else { most }
    }

    /// The distance of the corners of this one to the sides of the other.
    fn to_sides(&self, other: &Self) -> f64 {
        let mut least = f64::INFINITY;
        for p in &self.corners {
            for [a, b] in other.sides() {
                let (way, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
                let square = way[0] * way[0] + way[1] * way[1];
                let part = (to[0] * way[0] + to[1] * way[1]) / square;
                // Of a point alone there is no part of the way.
                let part = if square > 0.0 { part.clamp(0.0, 1.0) } else { 0.0 };
                least = least.min((to[0] - part * way[0]).hypot(to[1] - part * way[1]));
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::splitmix64::SplitMix64;
    use std::f64::consts::TAU;

    fn support(body: &ConvexPart, q: [f64; 2]) -> f64 {
        let along = |p: &[f64; 2]| q[0] * p[0] + q[1] * p[1];
        body.corners.iter().map(along).fold(f64::NEG_INFINITY, f64::max) + body.radius
    }

    #[test]
    fn the_signed_distance_is_that_of_the_support_functions() {
        let polygon = |points: &[[f64; 2]]| ConvexParts::new(&Footprint::new(points.to_vec()).unwrap());
        let bodies = [
            ConvexParts::disc(0.3),
            polygon(&[[0.8, 0.3], [-0.4, 0.3], [-0.4, -0.3], [0.8, -0.3]]),
            polygon(&[[0.5, 0.0], [-0.2, 0.4], [-0.3, -0.4]]),
        ];
        let mut random = SplitMix64(3);
        let mut overlaps = 0;
        for k in 0..3000 {
            let mut place =
                |body: &ConvexParts| body.at([0, 1].map(|_| 2.0 * random.unit() - 1.0), TAU * random.unit());
            let (a, b) = (place(&bodies[k % 3]), place(&bodies[k / 3 % 3]));
            let exact = a.signed_distance(&b);
            let directions = (0..3600).map(|step| (f64::from(step) * TAU / 3600.0).sin_cos());
            let apart = directions.map(|(y, x)| -support(&a.parts[0], [x, y]) - support(&b.parts[0], [-x, -y]));
            let sampled = apart.fold(f64::NEG_INFINITY, f64::max);
            assert!(sampled <= exact + 1e-12 && exact - sampled < 4e-3, "{exact} {sampled}");
            overlaps += usize::from(exact < 0.0);
        }
        assert!((500..2500).contains(&overlaps), "{overlaps}");
    }
}

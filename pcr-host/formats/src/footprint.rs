//! Outlines of vehicles that are polygons, with or without an equal distance all around them. A concave one is cut into convex parts.

mod convex_parts;
mod simple_polygon;

use crate::plane_geometry::{drop_needless, from_segment, hull};
use convex_parts::convex_parts;
use serde::de::{Deserializer, Error};
use serde::ser::{SerializeStruct, Serializer};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Corners of a polygon at most.
const CORNERS: usize = 256;

/// Rounding of coordinates, relative.
const ROUNDING: f64 = 1e-12;

/// The points within a distance of a simple polygon, in the frame of the vehicle: the reference point, which travels the path, is the
/// origin, and its heading is ahead.
#[derive(Clone, Debug, PartialEq)]
pub struct Footprint {
    polygon: Vec<[f64; 2]>,
    growth: f64,
    parts: Vec<Vec<[f64; 2]>>,
}

/// Why a polygon is no footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FootprintError {
    /// It has so many corners: fewer than three, or too many.
    CornerCount(usize),
    /// All corners are at fewer than three places.
    NoArea,
    /// Two sides touch or cross, each from a corner to a corner, from 1.
    SidesMeet([[usize; 2]; 2]),
    /// Its sides are so near to one another that it is not cut into convex parts.
    NoParts,
}

impl fmt::Display for FootprintError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CornerCount(count) => write!(f, "{count} corners; allowed are 3 to {CORNERS}"),
            Self::NoArea => f.write_str("it has no area: its corners are at fewer than three places"),
            Self::SidesMeet([[a, b], [c, d]]) => write!(
                f,
                "the side from corner {a} to {b} touches or crosses that from {c} to {d}; allowed is a simple polygon with an area"
            ),
            Self::NoParts => f.write_str("its sides are too near to one another to cut it into convex parts"),
        }
    }
}

impl std::error::Error for FootprintError {}

impl Footprint {
    /// Returns the footprint with these corners, ahead and left of the reference point \[m\], in either direction of rotation.
    ///
    /// # Errors
    /// What is wrong: fewer than three corners or more than 256, sides that touch or cross, or no area.
    pub fn new(polygon: Vec<[f64; 2]>) -> Result<Self, FootprintError> {
        if !(3..=CORNERS).contains(&polygon.len()) {
            return Err(FootprintError::CornerCount(polygon.len()));
        }
        if let Some(fault) = simple_polygon::fault(&polygon) {
            return Err(fault);
        }
        let hull = hull(polygon.clone());
        // A simple polygon whose corners all lie on its convex hull has them in the same order.
        let is_convex = polygon.iter().all(|&corner| depth(&hull, corner) <= rounding(&hull));
        let parts = convex_parts(if is_convex { &hull } else { &polygon });
        let parts = parts.ok_or(FootprintError::NoParts)?;
        Ok(Self { polygon, growth: 0.0, parts })
    }

    /// Returns the corners, ahead and left of the reference point \[m\].
    pub fn polygon(&self) -> &[[f64; 2]] {
        &self.polygon
    }

    /// Returns convex footprints of at most 16 corners whose union is this one: one of them for a convex footprint of so few corners.
    pub fn parts(&self) -> impl Iterator<Item = Self> + '_ {
        let part = |corners: &Vec<[f64; 2]>| Self {
            polygon: corners.clone(),
            growth: self.growth,
            parts: vec![corners.clone()],
        };
        self.parts.iter().map(part)
    }

    /// Returns the same outline, larger by a distance from 0 all around \[m\].
    #[must_use]
    pub fn inflated(&self, by: f64) -> Self {
        Self { growth: self.growth + by, ..self.clone() }
    }

    /// Returns how much larger than the polygon the outline is all around \[m\].
    pub fn growth(&self) -> f64 {
        self.growth
    }

    /// Whether the outline is exactly the same when the vehicle is turned by half a turn about its reference point. A polygon with
    /// needless corners on one side only counts as another one.
    pub(crate) fn is_same_backward(&self) -> bool {
        let corners = &self.polygon;
        let opposite = corners.iter().cycle().skip(corners.len() / 2);
        corners.len().is_multiple_of(2) && corners.iter().zip(opposite).all(|(a, b)| *a == b.map(|x| -x))
    }

    /// Returns the outline turned by half a turn about its reference point: that of a vehicle that drives backward.
    #[must_use]
    pub fn backward(&self) -> Self {
        let turned = |corners: &Vec<[f64; 2]>| corners.iter().map(|corner| corner.map(|x| -x)).collect();
        Self { polygon: turned(&self.polygon), growth: self.growth, parts: self.parts.iter().map(turned).collect() }
    }

    /// Returns the outline turned about its reference point by an angle \[rad\], to the left if positive.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let turned =
            |corners: &Vec<[f64; 2]>| corners.iter().map(|[x, y]| [x * cos - y * sin, x * sin + y * cos]).collect();
        Self { polygon: turned(&self.polygon), growth: self.growth, parts: self.parts.iter().map(turned).collect() }
    }

    /// Returns the convex hull of the outline and the same turned by half a turn, which holds the vehicle whether it drives ahead or
    /// backward; nothing if it would have too many corners.
    pub fn either_way(&self) -> Option<Self> {
        let both = self.polygon.iter().chain(&self.backward().polygon).copied().collect();
        Self::new(hull(both)).ok().map(|outline| outline.inflated(self.growth))
    }

    /// Returns the corners without those that are no farther than `near` \[m\] from the line between their neighbours, counter-clockwise,
    /// without growth; `None` if the polygon is not convex. [`Footprint::beyond`] tells how far the polygon reaches out of what is left.
    pub fn convex(&self, near: f64) -> Option<Vec<[f64; 2]>> {
        let mut corners = hull(self.polygon.clone());
        if self.polygon.iter().any(|&corner| depth(&corners, corner) > rounding(&corners)) {
            return None;
        }
        drop_needless(&mut corners, near);
        Some(corners)
    }

    /// Returns how far the polygon, without growth, reaches out of a convex one at most \[m\]; 0 if it does not.
    pub fn beyond(&self, convex: &[[f64; 2]]) -> f64 {
        self.polygon.iter().map(|&corner| -depth(convex, corner)).fold(0.0, f64::max)
    }

    /// Returns the radius of the disc around the reference point that is in the outline \[m\]; below 0 where that point is outside of it.
    pub fn inner_radius(&self) -> f64 {
        depth(&self.polygon, [0.0; 2]) + self.growth
    }

    /// Returns the radius of the disc around the reference point that contains the outline \[m\], rounded up.
    pub fn circumscribed_radius(&self) -> f64 {
        let farthest = self.polygon.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
        ((farthest + self.growth) * (1.0 + 4.0 * f64::EPSILON)).next_up()
    }
}

/// A corner in files.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Corner {
    ahead: f64,
    left: f64,
}

/// As in scenario files.
impl<'de> Deserialize<'de> for Footprint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct FootprintRecord {
            polygon: Vec<Corner>,
            #[serde(default)]
            growth: f64,
        }
        let FootprintRecord { polygon, growth } = FootprintRecord::deserialize(deserializer)?;
        if !(growth >= 0.0 && growth.is_finite()) {
            return Err(D::Error::custom(format!("footprint: growth: {growth} is out of range; allowed is 0 or more")));
        }
        let outline = Self::new(polygon.iter().map(|corner| [corner.ahead, corner.left]).collect());
        let outline = outline.map_err(|why| D::Error::custom(format!("footprint: {why}")))?;
        Ok(Self { growth, ..outline })
    }
}

/// As in scenario files.
impl Serialize for Footprint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let corners: Vec<Corner> = self.polygon.iter().map(|&[ahead, left]| Corner { ahead, left }).collect();
        let mut fields = serializer.serialize_struct("Footprint", 2)?;
        fields.serialize_field("polygon", &corners)?;
        if self.growth > 0.0 {
            fields.serialize_field("growth", &self.growth)?;
        }
        fields.end()
    }
}

/// What of these corners is rounding and nothing else \[m\].
fn rounding(corners: &[[f64; 2]]) -> f64 {
    ROUNDING * corners.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// Distance of a point from the sides of a polygon, negative outside.
fn depth(polygon: &[[f64; 2]], point: [f64; 2]) -> f64 {
    let (mut nearest, mut inside) = (f64::INFINITY, false);
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        nearest = nearest.min(from_segment(point, [*a, *b]));
        let [side, away] = [b, &point].map(|end| [end[0] - a[0], end[1] - a[1]]);
        // Whether a ray to the right crosses the side.
        inside ^= (a[1] > point[1]) != (b[1] > point[1]) && away[0] < side[0] * away[1] / side[1];
    }
    if inside { nearest } else { -nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks many points in and around a polygon: those inside are in a convex part, and no other ones are.
    fn check(footprint: &Footprint) {
        let corner = |pick: fn(f64, f64) -> f64, start: f64| {
            [0, 1].map(|axis| footprint.polygon().iter().map(|point| point[axis]).fold(start, pick))
        };
        let [lo, hi] = [corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY)];
        let parts: Vec<Footprint> = footprint.parts().collect();
        for part in &parts {
            assert!(part.polygon().len() <= 16 && part.convex(0.0).is_some());
        }
        let mut inside = 0;
        for column in -10..=70 {
            for row in -10..=70 {
                let at =
                    [(0, column), (1, row)].map(|(axis, k)| lo[axis] + (hi[axis] - lo[axis]) * f64::from(k) / 60.0);
                let depths = parts.iter().map(|part| depth(part.polygon(), at));
                let (whole, part) = (depth(footprint.polygon(), at), depths.fold(f64::NEG_INFINITY, f64::max));
                inside += i32::from(whole > 0.0);
                assert!(whole < 1e-12 || part >= -1e-12, "{at:?}");
                assert!(part < 1e-12 || whole >= -1e-12, "{at:?}");
            }
        }
        assert!(inside > 500);
    }

    #[test]
    fn a_rectangle_is_its_only_part() {
        let rectangle = vec![[-0.4, -0.4], [0.8, -0.4], [0.8, 0.4], [-0.4, 0.4]];
        let footprint = Footprint::new(rectangle.clone()).unwrap();
        assert_eq!(footprint.parts().map(|part| part.polygon().to_vec()).collect::<Vec<_>>(), [rectangle]);
        assert!(!footprint.is_same_backward());
        let radius = 0.8_f64.hypot(0.4);
        assert!((radius..radius + 1e-14).contains(&footprint.circumscribed_radius()));
        let centred = |half: [f64; 2]| {
            [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(|sides| [0, 1].map(|k| half[k] * f64::from(sides[k])))
        };
        let mut corners = centred([0.6, 0.2]).to_vec();
        assert!(Footprint::new(corners.clone()).unwrap().is_same_backward());
        // A triangle has no corners opposite to its own, and a rounding in one corner is another outline.
        assert!(!Footprint::new(corners[..3].to_vec()).unwrap().is_same_backward());
        corners[0][0] = corners[0][0].next_up();
        assert!(!Footprint::new(corners).unwrap().is_same_backward());
    }

    #[test]
    fn parts_are_together_the_outline() {
        let fork =
            vec![[0.0, -0.5], [1.5, -0.5], [1.5, -0.3], [0.3, -0.3], [0.3, 0.3], [1.5, 0.3], [1.5, 0.5], [0.0, 0.5]];
        let triangle = vec![[1.0, 0.0], [-0.5, 0.6], [-0.5, -0.6]];
        let star = (0..40).map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 40.0).sin_cos();
            let radius = if k % 2 == 0 { 1.0 } else { 0.55 };
            [radius * cos, radius * sin]
        });
        let round = (0..100).map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 100.0).sin_cos();
            [cos, 0.7 * sin]
        });
        let spiral = vec![
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 1.0],
            [3.0, 1.0],
            [3.0, 3.0],
            [1.0, 3.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.5],
            [0.5, 1.5],
            [0.5, 3.5],
            [3.5, 3.5],
            [3.5, 0.5],
            [0.0, 0.5],
        ];
        for (polygon, most) in [(fork, 3), (triangle, 1), (star.collect(), 40), (round.collect(), 7), (spiral, 14)] {
            for corners in [polygon.clone(), polygon.into_iter().rev().collect()] {
                let footprint = Footprint::new(corners).unwrap();
                assert!(footprint.parts().count() <= most, "{}", footprint.parts().count());
                check(&footprint);
                check(&footprint.backward());
            }
        }
    }

    #[test]
    fn a_convex_polygon_keeps_the_corners_that_it_needs() {
        let needless = vec![
            [0.5, -0.4],
            [0.8, -0.4],
            [0.8, 0.4],
            [0.8, 0.4],
            [0.8, 0.4],
            [-0.4, 0.4],
            [-0.4, 0.1],
            [-0.4, -0.4],
            [0.5, -0.4],
        ];
        let rectangle = [[-0.4, -0.4], [0.8, -0.4], [0.8, 0.4], [-0.4, 0.4]];
        for polygon in [needless.clone(), needless.into_iter().rev().collect()] {
            let footprint = Footprint::new(polygon).unwrap();
            assert_eq!(footprint.convex(1e-15).unwrap(), rectangle);
            assert_eq!(footprint.beyond(&rectangle), 0.0);
        }
        // Middles of the sides of a rectangle that is turned are on them but for rounding, on either side.
        for k in 1..90 {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            let sides = rectangle.iter().zip(rectangle.iter().cycle().skip(1));
            let points = sides.flat_map(|(a, b)| [*a, [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]]);
            let turned: Vec<[f64; 2]> = points.map(|[x, y]| [x * cos - y * sin, x * sin + y * cos]).collect();
            let footprint = Footprint::new(turned).unwrap();
            let corners = footprint.convex(2e-15).unwrap();
            assert_eq!(corners.len(), 4, "{k}");
            assert!((0.0..=2e-15).contains(&footprint.beyond(&corners)), "{k}");
        }
        // What is left out within an allowance sticks out by no more than is told; a smaller one keeps it.
        let blunt = vec![[-0.4, -0.4], [0.8, -0.4], [0.801, 0.0], [0.8, 0.4], [-0.4, 0.4]];
        let footprint = Footprint::new(blunt.clone()).unwrap();
        let corners = footprint.convex(2e-3).unwrap();
        assert_eq!(corners.len(), 4);
        assert!((footprint.beyond(&corners) - 1e-3).abs() < 1e-9);
        assert_eq!(footprint.convex(1e-4).unwrap(), blunt);
    }

    #[test]
    fn a_concave_polygon_is_told() {
        let notched = vec![[-0.4, -0.4], [0.8, -0.4], [0.8 - 1e-9, 0.0], [0.8, 0.4], [-0.4, 0.4]];
        assert_eq!(Footprint::new(notched).unwrap().convex(1e-3), None);
        let fork =
            vec![[0.0, -0.5], [1.5, -0.5], [1.5, -0.3], [0.3, -0.3], [0.3, 0.3], [1.5, 0.3], [1.5, 0.5], [0.0, 0.5]];
        assert_eq!(Footprint::new(fork).unwrap().convex(1e-15), None);
    }

    #[test]
    fn what_is_refused() {
        assert!(Footprint::new(vec![[0.0, 0.0], [1.0, 0.0]]).unwrap_err().to_string().contains("corners"));
        assert!(Footprint::new(vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]).unwrap_err().to_string().contains("touches"));
        // A fork that is a line there and back has no area.
        let fork = [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.2], [1.5, 0.2], [0.5, 0.2], [0.5, 0.3], [-0.5, 0.3]];
        assert!(Footprint::new(fork.to_vec()).unwrap_err().to_string().contains("from corner 2 to 3"));
        let [a, b] = [9e9, 9_000_000_000.000_004];
        assert!(Footprint::new(vec![[a, a], [b, a], [b, b], [a, b]]).unwrap_err().to_string().contains("no area"));
    }
}

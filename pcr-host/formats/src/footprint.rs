//! Footprints that are polygons, covered by discs that move with them.
//!
//! The box around the polygon is cut into cells of equal size. The part of the polygon in a cell is covered by the disc
//! around its box. The cells become smaller until no disc reaches further out of the polygon than allowed, the
//! *overhang*: a disc of radius r whose centre is at the depth d inside the polygon reaches at most r - d out of it.

mod simple_polygon;

use crate::plane_geometry::{distance, from_segment, hull};
use serde::Serialize;

/// Discs of a cover at most.
const MOST: usize = 64;

/// Corners of a polygon at most.
const CORNERS: usize = 256;

/// Overhang that is allowed if nothing is said: this share of the shorter side of the box around the polygon.
const OVERHANG: f64 = 0.125;

/// Cells in each direction that are looked at, at most: more than can be used.
const CELLS: f64 = 1e3;

/// From one size of cells to the next.
const SMALLER: f64 = 0.9;

/// Rounding of a radius, relative.
const ROUNDING: f64 = 1e-12;

/// A disc of a cover, in the frame of the vehicle: the reference point travels the path, its heading is ahead.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CoverDisc {
    /// Distance of the centre ahead of the reference point, in its heading \[m\].
    pub ahead: f64,
    /// Distance to its left \[m\].
    pub left: f64,
    /// \[m\]
    pub radius: f64,
}

/// A polygon and its cover.
#[derive(Clone, Debug, PartialEq)]
pub struct Footprint {
    polygon: Vec<[f64; 2]>,
    allowed: Option<f64>,
    growth: f64,
    discs: Vec<CoverDisc>,
    overhang: f64,
}

impl Footprint {
    /// The footprint with these corners (ahead and left of the reference point \[m\]), with an overhang of the cover up to
    /// `allowed` \[m\]; if there is none, an eighth of the shorter side of its box, or more if that needs more than 64 discs.
    ///
    /// # Errors
    /// What is wrong: fewer than three corners or more than 256, sides that touch or cross, no area, or more than 64 discs would be
    /// needed.
    pub fn new(polygon: Vec<[f64; 2]>, allowed: Option<f64>) -> Result<Self, String> {
        if !(3..=CORNERS).contains(&polygon.len()) {
            return Err(format!("{} corners; allowed are 3 to {CORNERS}", polygon.len()));
        }
        if let Some(fault) = simple_polygon::fault(&polygon) {
            return Err(fault);
        }
        let [lo, hi] = bounds(&polygon);
        let side = (hi[0] - lo[0]).min(hi[1] - lo[1]);
        let limit = allowed.unwrap_or(OVERHANG * side);
        let mut cell = side;
        // One that is much longer than wide has larger cells.
        while cover(&polygon, cell).len() > MOST {
            cell /= SMALLER;
        }
        let mut best: Option<(Vec<CoverDisc>, f64)> = None;
        loop {
            let discs = cover(&polygon, cell);
            if discs.len() > MOST || cell < side / CELLS {
                break;
            }
            let overhang = overhang(&polygon, &discs);
            if best.as_ref().is_none_or(|(_, least)| overhang < *least) {
                best = Some((discs, overhang));
            }
            if overhang <= limit {
                break;
            }
            cell *= SMALLER;
        }
        match best.filter(|(_, overhang)| allowed.is_none() || *overhang <= limit) {
            Some((discs, overhang)) => Ok(Self { polygon, allowed, growth: 0.0, discs, overhang }),
            None => Err(format!("an overhang of {limit} m needs more than {MOST} discs; allow more")),
        }
    }

    /// Corners, ahead and left of the reference point \[m\].
    pub fn polygon(&self) -> &[[f64; 2]] {
        &self.polygon
    }

    /// The overhang that is allowed \[m\], where it is given.
    pub fn allowed(&self) -> Option<f64> {
        self.allowed
    }

    /// The discs: every point of the polygon is in one of them.
    pub fn discs(&self) -> &[CoverDisc] {
        &self.discs
    }

    /// No point of a disc is farther than this from the outline \[m\].
    pub fn overhang(&self) -> f64 {
        self.overhang
    }

    /// The same outline, larger by a distance from 0 all around \[m\].
    #[must_use]
    pub fn inflated(&self, by: f64) -> Self {
        let discs = self.discs.iter().map(|disc| CoverDisc { radius: disc.radius + by, ..*disc });
        Self { growth: self.growth + by, discs: discs.collect(), ..self.clone() }
    }

    /// How much larger than the polygon the outline is all around \[m\].
    pub fn growth(&self) -> f64 {
        self.growth
    }

    /// Whether the outline is exactly the same when the vehicle is turned by half a turn about its reference point. A polygon with
    /// needless corners on one side only counts as another one.
    pub fn is_same_backward(&self) -> bool {
        let corners = &self.polygon;
        let opposite = corners.iter().cycle().skip(corners.len() / 2);
        corners.len().is_multiple_of(2) && corners.iter().zip(opposite).all(|(a, b)| *a == b.map(|x| -x))
    }

    /// The outline turned by half a turn about its reference point: that of a vehicle that drives backward.
    #[must_use]
    pub fn backward(&self) -> Self {
        let polygon = self.polygon.iter().map(|corner| corner.map(|x| -x)).collect();
        let discs = self.discs.iter().map(|disc| CoverDisc { ahead: -disc.ahead, left: -disc.left, ..*disc }).collect();
        Self { polygon, discs, ..self.clone() }
    }

    /// The convex hull of the outline and the same turned by half a turn, which holds the vehicle whether it drives ahead or backward;
    /// nothing if it would have too many corners or discs.
    pub fn either_way(&self) -> Option<Self> {
        let both = self.polygon.iter().chain(&self.backward().polygon).copied().collect();
        // No disc may reach farther out than those of the outline are allowed to.
        Self::new(hull(both), self.allowed).ok().map(|outline| outline.inflated(self.growth))
    }

    /// The corners without those that are no farther than `near` \[m\] from the line between their neighbours, counter-clockwise,
    /// without growth; `None` if the polygon is not convex. [`Footprint::beyond`] tells how far the polygon reaches out of what is left.
    pub fn convex(&self, near: f64) -> Option<Vec<[f64; 2]>> {
        let mut corners = hull(self.polygon.clone());
        let rounding = ROUNDING * corners.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        // A simple polygon whose corners all lie on its convex hull has them in the same order.
        if self.polygon.iter().any(|&corner| depth(&corners, corner) > rounding) {
            return None;
        }
        while corners.len() > 3 {
            let count = corners.len();
            let off = |k: usize| from_segment(corners[k], [corners[(k + count - 1) % count], corners[(k + 1) % count]]);
            let least = (0..count).min_by(|&a, &b| off(a).total_cmp(&off(b))).filter(|&k| off(k) <= near);
            let Some(needless) = least else { break };
            corners.remove(needless);
        }
        Some(corners)
    }

    /// How far the polygon, without growth, reaches out of a convex one at most \[m\]; 0 if it does not.
    pub fn beyond(&self, convex: &[[f64; 2]]) -> f64 {
        self.polygon.iter().map(|&corner| -depth(convex, corner)).fold(0.0, f64::max)
    }

    /// Radius of the disc around the reference point that is in the outline \[m\]; below 0 where that point is outside of it.
    pub fn inner_radius(&self) -> f64 {
        depth(&self.polygon, [0.0; 2]) + self.growth
    }

    /// Radius of the disc around the reference point that holds all discs \[m\].
    pub fn circumscribed_radius(&self) -> f64 {
        self.discs.iter().map(|disc| disc.ahead.hypot(disc.left) + disc.radius).fold(0.0, f64::max)
    }
}

/// Corners of the box around some points.
fn bounds(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let corner = |pick: fn(f64, f64) -> f64, start: f64| {
        [0, 1].map(|axis| points.iter().map(|point| point[axis]).fold(start, pick))
    };
    [corner(f64::min, f64::INFINITY), corner(f64::max, f64::NEG_INFINITY)]
}

/// How far discs reach out of the polygon \[m\].
fn overhang(polygon: &[[f64; 2]], discs: &[CoverDisc]) -> f64 {
    discs.iter().map(|disc| disc.radius - depth(polygon, [disc.ahead, disc.left])).fold(0.0, f64::max)
}

/// Discs around the parts of the polygon in cells of at most this size.
fn cover(polygon: &[[f64; 2]], cell: f64) -> Vec<CoverDisc> {
    let [lo, hi] = bounds(polygon);
    let size = [0, 1].map(|axis| hi[axis] - lo[axis]);
    let cells = size.map(|size| (size / cell).ceil().clamp(1.0, CELLS) as usize);
    let mut discs = Vec::new();
    for column in 0..cells[0] {
        for row in 0..cells[1] {
            let mut part = polygon.to_vec();
            for (axis, place) in [(0, column), (1, row)] {
                let border = |k: usize| lo[axis] + size[axis] * (k as f64 / cells[axis] as f64);
                part = clip(&part, axis, border(place), 1.0);
                part = clip(&part, axis, border(place + 1), -1.0);
            }
            discs.extend(around(&part));
            if discs.len() > MOST {
                return discs;
            }
        }
    }
    discs
}

/// The part of a polygon on one side of a line along an axis (Sutherland and Hodgman): where `side` times (coordinate less
/// `border`) is not negative.
fn clip(polygon: &[[f64; 2]], axis: usize, border: f64, side: f64) -> Vec<[f64; 2]> {
    let mut part = Vec::new();
    let after = polygon.iter().cycle().skip(1);
    for (from, to) in polygon.iter().zip(after) {
        let [a, b] = [from, to].map(|point| side * (point[axis] - border));
        if a >= 0.0 {
            part.push(*from);
        }
        if (a < 0.0) != (b < 0.0) {
            let mut at = [0, 1].map(|k| from[k] + (to[k] - from[k]) * (a / (a - b)));
            at[axis] = border;
            part.push(at);
        }
    }
    part
}

/// The disc around the box of some points that holds them; none where they have no extent.
fn around(points: &[[f64; 2]]) -> Option<CoverDisc> {
    let [lo, hi] = bounds(points);
    let centre = [0, 1].map(|axis| 0.5 * (lo[axis] + hi[axis]));
    let radius = points.iter().map(|point| distance(*point, centre)).fold(0.0, f64::max);
    let radius = radius + ROUNDING * (radius + centre[0].abs() + centre[1].abs());
    // A cell that the outline only touches is covered by its neighbour.
    (lo[0] < hi[0] && lo[1] < hi[1]).then_some(CoverDisc { ahead: centre[0], left: centre[1], radius })
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

    fn covered(footprint: &Footprint, point: [f64; 2]) -> bool {
        footprint.discs().iter().any(|disc| distance(point, [disc.ahead, disc.left]) <= disc.radius)
    }

    /// Many points in and around a polygon: those inside are covered, those that are covered are near it.
    fn check(footprint: &Footprint) {
        let [lo, hi] = bounds(footprint.polygon());
        let mut inside = 0;
        for column in -40..=240 {
            for row in -40..=240 {
                let at =
                    [(0, column), (1, row)].map(|(axis, k)| lo[axis] + (hi[axis] - lo[axis]) * f64::from(k) / 200.0);
                let depth = depth(footprint.polygon(), at);
                inside += i32::from(depth > 0.0);
                assert!(depth < 0.0 || covered(footprint, at), "{at:?}");
                assert!(!covered(footprint, at) || -depth <= footprint.overhang() + 1e-9, "{at:?} {depth}");
            }
        }
        assert!(inside > 1000);
    }

    #[test]
    fn a_rectangle_is_covered_by_squares() {
        let rectangle = vec![[-0.4, -0.4], [0.8, -0.4], [0.8, 0.4], [-0.4, 0.4]];
        let footprint = Footprint::new(rectangle, None).unwrap();
        assert_eq!(footprint.discs().len(), 6);
        // The corner of a square of 0.4 m less half its side.
        assert!((footprint.overhang() - (0.08_f64.sqrt() - 0.2)).abs() < 1e-9);
        assert!(!footprint.is_same_backward());
        let centred = |half: [f64; 2]| {
            [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(|sides| [0, 1].map(|k| half[k] * f64::from(sides[k])))
        };
        let mut corners = centred([0.6, 0.2]).to_vec();
        assert!(Footprint::new(corners.clone(), None).unwrap().is_same_backward());
        // A triangle has no corners opposite to its own, and a rounding in one corner is another outline.
        assert!(!Footprint::new(corners[..3].to_vec(), None).unwrap().is_same_backward());
        corners[0][0] = corners[0][0].next_up();
        assert!(!Footprint::new(corners, None).unwrap().is_same_backward());
        check(&footprint);
    }

    #[test]
    fn any_polygon_is_covered_with_the_overhang_that_is_allowed() {
        let fork =
            vec![[0.0, -0.5], [1.5, -0.5], [1.5, -0.3], [0.3, -0.3], [0.3, 0.3], [1.5, 0.3], [1.5, 0.5], [0.0, 0.5]];
        let triangle = vec![[1.0, 0.0], [-0.5, 0.6], [-0.5, -0.6]];
        for polygon in [fork, triangle] {
            for allowed in [0.1, 0.2] {
                let footprint = Footprint::new(polygon.clone(), Some(allowed)).unwrap();
                assert!(footprint.overhang() <= allowed);
                check(&footprint);
            }
        }
    }

    #[test]
    fn a_thin_outline_overhangs_by_more() {
        let thin = vec![[-1.0, -0.05], [1.0, -0.05], [1.0, 0.05], [-1.0, 0.05]];
        assert!(Footprint::new(thin.clone(), Some(0.012_5)).unwrap_err().contains("allow more"));
        let footprint = Footprint::new(thin, None).unwrap();
        assert!((0.012_5..0.03).contains(&footprint.overhang()), "{}", footprint.overhang());
        check(&footprint);
        let longer = vec![[-3.5, -0.05], [3.5, -0.05], [3.5, 0.05], [-3.5, 0.05]];
        for allowed in [None, Some(10.0)] {
            check(&Footprint::new(longer.clone(), allowed).unwrap());
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
            let footprint = Footprint::new(polygon, None).unwrap();
            assert_eq!(footprint.convex(1e-15).unwrap(), rectangle);
            assert_eq!(footprint.beyond(&rectangle), 0.0);
        }
        // Middles of the sides of a rectangle that is turned are on them but for rounding, on either side.
        for k in 1..90 {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            let sides = rectangle.iter().zip(rectangle.iter().cycle().skip(1));
            let points = sides.flat_map(|(a, b)| [*a, [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]]);
            let turned: Vec<[f64; 2]> = points.map(|[x, y]| [x * cos - y * sin, x * sin + y * cos]).collect();
            let footprint = Footprint::new(turned, None).unwrap();
            let corners = footprint.convex(2e-15).unwrap();
            assert_eq!(corners.len(), 4, "{k}");
            assert!((0.0..=2e-15).contains(&footprint.beyond(&corners)), "{k}");
        }
        // What is left out within an allowance sticks out by no more than is told; a smaller one keeps it.
        let blunt = vec![[-0.4, -0.4], [0.8, -0.4], [0.801, 0.0], [0.8, 0.4], [-0.4, 0.4]];
        let footprint = Footprint::new(blunt.clone(), None).unwrap();
        let corners = footprint.convex(2e-3).unwrap();
        assert_eq!(corners.len(), 4);
        assert!((footprint.beyond(&corners) - 1e-3).abs() < 1e-9);
        assert_eq!(footprint.convex(1e-4).unwrap(), blunt);
    }

    #[test]
    fn a_concave_polygon_is_told() {
        let notched = vec![[-0.4, -0.4], [0.8, -0.4], [0.8 - 1e-9, 0.0], [0.8, 0.4], [-0.4, 0.4]];
        assert_eq!(Footprint::new(notched, None).unwrap().convex(1e-3), None);
        let fork =
            vec![[0.0, -0.5], [1.5, -0.5], [1.5, -0.3], [0.3, -0.3], [0.3, 0.3], [1.5, 0.3], [1.5, 0.5], [0.0, 0.5]];
        assert_eq!(Footprint::new(fork, None).unwrap().convex(1e-15), None);
    }

    #[test]
    fn what_is_refused() {
        assert!(Footprint::new(vec![[0.0, 0.0], [1.0, 0.0]], None).unwrap_err().contains("corners"));
        assert!(Footprint::new(vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], None).unwrap_err().contains("touches"));
        // A fork that is a line there and back would be left out of the discs.
        let fork = [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.2], [1.5, 0.2], [0.5, 0.2], [0.5, 0.3], [-0.5, 0.3]];
        assert!(Footprint::new(fork.to_vec(), None).unwrap_err().contains("from corner 2 to 3"));
        // Cells cannot become smaller than the rounding of the corners.
        let [a, b] = [9e9, 9_000_000_000.000_004];
        assert!(Footprint::new(vec![[a, a], [b, a], [b, b], [a, b]], Some(1e-9)).unwrap_err().contains("no area"));
        let [a, b] = [1e9, 1e9 + 8.0];
        assert!(Footprint::new(vec![[a, a], [b, a], [b, b], [a, b]], Some(1e-9)).unwrap_err().contains("64 discs"));
        let square = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert!(Footprint::new(square, Some(1e-6)).unwrap_err().contains("64 discs"));
    }
}

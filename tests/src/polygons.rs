//! Convex polygons: where they are, and how far apart.

/// Abscissa and ordinate.
pub type Point = [f64; 2];

/// Its corners, to the left about.
pub type Polygon = Vec<Point>;

/// The polygon of a vehicle, whose corners are ahead and left of it, at a point in a heading.
pub fn placed(polygon: &[Point], [x, y]: Point, heading: f64) -> Polygon {
    let (sin, cos) = heading.sin_cos();
    polygon.iter().map(|[ahead, left]| [x + ahead * cos - left * sin, y + ahead * sin + left * cos]).collect()
}

fn from_side(p: Point, a: Point, b: Point) -> f64 {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let share = (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (a[0] + share * dx - p[0]).hypot(a[1] + share * dy - p[1])
}

/// A convex polygon that is smaller by a distance all around, at least.
pub fn smaller(polygon: &[Point], by: f64) -> Polygon {
    let middle = [0, 1].map(|axis| polygon.iter().map(|corner| corner[axis]).sum::<f64>() / polygon.len() as f64);
    let inner = sides(&polygon.to_vec()).map(|(a, b)| from_side(middle, a, b)).fold(f64::INFINITY, f64::min);
    polygon.iter().map(|corner| [0, 1].map(|k| corner[k] + (middle[k] - corner[k]) * (by / inner))).collect()
}

fn sides(polygon: &Polygon) -> impl Iterator<Item = (Point, Point)> {
    polygon.iter().copied().zip(polygon.iter().copied().cycle().skip(1))
}

/// Whether a convex polygon, its corners to the left about, holds a point.
fn holds(polygon: &Polygon, p: Point) -> bool {
    sides(polygon).all(|(a, b)| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0.0)
}

/// Distance of two convex polygons: 0 where they overlap. Two that cross without a corner inside have sides that cross.
pub fn apart(a: &Polygon, b: &Polygon) -> f64 {
    let cross = |(p, q): (Point, Point), (r, s): (Point, Point)| {
        let side = |a: Point, b: Point, c: Point| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        side(p, q, r) * side(p, q, s) < 0.0 && side(r, s, p) * side(r, s, q) < 0.0
    };
    let inside = a.iter().any(|p| holds(b, *p)) || b.iter().any(|p| holds(a, *p));
    if inside || sides(a).any(|own| sides(b).any(|other| cross(own, other))) {
        return 0.0;
    }
    let corners = |own: &Polygon, other: &Polygon| {
        let distances = own.iter().flat_map(|p| sides(other).map(|(a, b)| from_side(*p, a, b)).collect::<Vec<_>>());
        distances.fold(f64::INFINITY, f64::min)
    };
    corners(a, b).min(corners(b, a))
}

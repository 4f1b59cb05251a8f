//! Converts NURBS curves to chains of rational Bézier curves, by their polar form.
//!
//! On a span [a, b] of the knots, the control points of the Bézier curve are the values of the polar form at (a, ...,
//! a, b, ..., b); de Boor's recursion evaluates it with one argument for each of its levels. Points are homogeneous,
//! (wx, wy, w) with w > 0, so that rational curves need no special case.

use super::ImportError;

/// Largest degree that is read: more is a damaged file.
pub(super) const MOST_DEGREE: usize = 16;

/// Most control points of a curve that are read.
pub(super) const MOST_POINTS: usize = 10_000;

/// Gap between two curves that is rounding and nothing else, as a part of the largest coordinate.
const CLOSED: f64 = 1e-9;

/// A rational Bézier curve by its homogeneous control points: one more than its degree, with positive weights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RationalBezier(pub(super) Vec<[f64; 3]>);

fn mix(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t)
}

impl RationalBezier {
    /// The curve with these points and weights 1.
    pub(super) fn new(points: &[[f64; 2]]) -> Self {
        Self(points.iter().map(|[x, y]| [*x, *y, 1.0]).collect())
    }

    /// Control points in the plane: the curve lies in their hull.
    pub(super) fn points(&self) -> impl DoubleEndedIterator<Item = [f64; 2]> + Clone {
        self.0.iter().map(|[x, y, w]| [x / w, y / w])
    }

    /// Length of the control polygon \[m\]: the curve is not longer, as it crosses no line more often.
    pub(super) fn polygon(&self) -> f64 {
        self.points().zip(self.points().skip(1)).map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1])).sum()
    }

    /// First and last point.
    pub(super) fn ends(&self) -> [[f64; 2]; 2] {
        let first = self.points().next().unwrap_or_default();
        [first, self.points().next_back().unwrap_or(first)]
    }

    /// Directions of travel at both ends \[rad\], where there are any: towards the first control point that is elsewhere.
    pub(super) fn headings(&self) -> Option<[f64; 2]> {
        let [first, last] = self.ends();
        let after = self.points().find(|point| *point != first)?;
        let before = self.points().rev().find(|point| *point != last)?;
        let heading = |from: [f64; 2], to: [f64; 2]| (to[1] - from[1]).atan2(to[0] - from[0]);
        Some([heading(first, after), heading(before, last)])
    }

    /// The point at a parameter from 0 to 1.
    pub(super) fn at(&self, t: f64) -> [f64; 2] {
        let mut level = self.0.clone();
        while level.len() > 1 {
            level = level.windows(2).map(|pair| mix(pair[0], pair[1], t)).collect();
        }
        level.first().map_or([0.0; 2], |[x, y, w]| [x / w, y / w])
    }

    /// Both parts at a parameter from 0 to 1 (de Casteljau).
    pub(super) fn split(&self, t: f64) -> [Self; 2] {
        let (mut before, mut after) = (Vec::new(), Vec::new());
        let mut level = self.0.clone();
        while let (Some(first), Some(last)) = (level.first(), level.last()) {
            before.push(*first);
            after.push(*last);
            level = level.windows(2).map(|pair| mix(pair[0], pair[1], t)).collect();
        }
        after.reverse();
        [Self(before), Self(after)]
    }
}

/// A NURBS curve as a file gives it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Nurbs {
    pub(super) degree: usize,
    /// As many as control points and the degree together, and one more; clamped and uniform if empty.
    pub(super) knots: Vec<f64>,
    /// Position and weight.
    pub(super) points: Vec<([f64; 2], f64)>,
}

impl Nurbs {
    /// The curve as Bézier curves, one a span of the knots.
    pub(super) fn beziers(&self) -> Result<Vec<RationalBezier>, ImportError> {
        let (degree, count) = (self.degree, self.points.len());
        let refused = |problem: String| Err(ImportError::new(problem));
        if !(1..=MOST_DEGREE).contains(&degree) {
            return refused(format!("degree {degree}; allowed is 1 to {MOST_DEGREE}"));
        }
        if count <= degree || count > MOST_POINTS {
            let least = degree + 1;
            return refused(format!("{count} control points; degree {degree} takes {least} to {MOST_POINTS}"));
        }
        if let Some((_, weight)) = self.points.iter().find(|(_, weight)| !(1e-6..=1e6).contains(weight)) {
            return refused(format!("a control point of weight {weight}; allowed is 1e-6 to 1e6"));
        }
        let knots = if self.knots.is_empty() { uniform(degree, count) } else { self.knots.clone() };
        if knots.len() != count + degree + 1 {
            let expected = count + degree + 1;
            return refused(format!("{} knots; {count} points of degree {degree} take {expected}", knots.len()));
        }
        if knots.windows(2).any(|pair| !(pair[1] >= pair[0] && pair[1].is_finite())) {
            return refused("the knots do not increase".into());
        }
        let homogeneous: Vec<[f64; 3]> = self.points.iter().map(|([x, y], w)| [x * w, y * w, *w]).collect();
        let spans = (degree..count).filter(|&k| knots[k + 1] > knots[k]);
        let beziers: Vec<RationalBezier> = spans.map(|k| span(&knots, &homogeneous, degree, k)).collect();
        if beziers.is_empty() {
            return refused("all its knots are the same".into());
        }
        match widest_jump(&beziers) {
            jump if jump > 0.0 => refused(format!("it jumps by {jump:.3e} m, at a knot that is there too often")),
            _ => Ok(beziers),
        }
    }
}

/// How far the curves are apart where one ends and the next one begins \[m\]: more than rounding only where a knot between them is
/// there more often than the degree.
fn widest_jump(beziers: &[RationalBezier]) -> f64 {
    let extent = beziers.iter().flat_map(RationalBezier::points).flatten().fold(1.0, |most: f64, x| most.max(x.abs()));
    let apart = |pair: &[RationalBezier]| {
        let [before, after] = pair else { return 0.0 };
        let (end, begin) = (before.ends()[1], after.ends()[0]);
        (end[0] - begin[0]).hypot(end[1] - begin[1])
    };
    let widest = beziers.windows(2).map(apart).fold(0.0, f64::max);
    if widest > CLOSED * extent { widest } else { 0.0 }
}

/// Knots from 0 to 1 that are clamped at both ends and evenly spaced between.
fn uniform(degree: usize, count: usize) -> Vec<f64> {
    let spans = count - degree;
    (0..=count + degree).map(|k| (k.clamp(degree, count) - degree) as f64 / spans as f64).collect()
}

/// The Bézier curve between knots `k` and `k + 1`.
fn span(knots: &[f64], points: &[[f64; 3]], degree: usize, k: usize) -> RationalBezier {
    let (a, b) = (knots[k], knots[k + 1]);
    let control = |last: usize| {
        let mut level: Vec<[f64; 3]> = points[k - degree..=k].to_vec();
        for round in 1..=degree {
            let argument = if round <= degree - last { a } else { b };
            for j in (round..=degree).rev() {
                let (from, to) = (knots[k - degree + j], knots[k + 1 + j - round]);
                level[j] = mix(level[j - 1], level[j], (argument - from) / (to - from));
            }
        }
        level[degree]
    };
    RationalBezier((0..=degree).map(control).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12
    }

    /// The Cox-de Boor formula, as textbooks have it.
    fn basis(knots: &[f64], k: usize, degree: usize, u: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[k] <= u && u < knots[k + 1]));
        }
        let part = |numerator: f64, width: f64, k: usize| match width > 0.0 {
            true => numerator / width * basis(knots, k, degree - 1, u),
            false => 0.0,
        };
        part(u - knots[k], knots[k + degree] - knots[k], k)
            + part(knots[k + degree + 1] - u, knots[k + degree + 1] - knots[k + 1], k + 1)
    }

    #[test]
    fn knots_that_are_not_given_are_clamped_and_even() {
        assert_eq!(uniform(2, 5), [0.0, 0.0, 0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0, 1.0, 1.0]);
        assert_eq!(uniform(1, 2), [0.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn spans_are_the_textbook_curve() {
        let points = [[0.0, 0.0], [1.0, 3.0], [2.5, -1.0], [4.0, 0.5], [5.0, 4.0], [7.0, 3.0]];
        let weights = [1.0, 0.5, 2.0, 1.0, 3.0, 1.0];
        for (degree, knots) in [
            (2, vec![0.0, 0.0, 0.0, 0.2, 0.2, 0.7, 1.0, 1.0, 1.0]),
            (3, vec![0.0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.8, 0.9, 1.0, 1.0]),
            (5, vec![0.0; 6].into_iter().chain(vec![1.0; 6]).collect()),
            (1, Vec::new()),
        ] {
            let nurbs = Nurbs { degree, knots, points: points.into_iter().zip(weights).collect() };
            let beziers = nurbs.beziers().unwrap();
            let knots = if nurbs.knots.is_empty() { uniform(degree, 6) } else { nurbs.knots.clone() };
            let spans = (degree..6).filter(|&k| knots[k + 1] > knots[k]);
            for (bezier, k) in beziers.iter().zip(spans) {
                for step in 0..10 {
                    let t = f64::from(step) / 10.0;
                    let u = knots[k] + (knots[k + 1] - knots[k]) * t;
                    let weighted = |f: &dyn Fn(usize) -> f64| {
                        (0..6).map(|j| weights[j] * basis(&knots, j, degree, u) * f(j)).sum::<f64>()
                    };
                    let w = weighted(&|_| 1.0);
                    let expected = [weighted(&|j| points[j][0]) / w, weighted(&|j| points[j][1]) / w];
                    assert!(close(bezier.at(t), expected), "degree {degree}: {:?} {expected:?}", bezier.at(t));
                    let [before, after] = bezier.split(0.3);
                    let halves = if t < 0.3 { before.at(t / 0.3) } else { after.at((t - 0.3) / 0.7) };
                    assert!(close(halves, expected));
                }
            }
        }
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let points: Vec<_> = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(|point| (point, 1.0)).into();
        let message = |degree, knots: &[f64], points: &[([f64; 2], f64)]| {
            Nurbs { degree, knots: knots.into(), points: points.into() }.beziers().unwrap_err().to_string()
        };
        assert_eq!(message(0, &[], &points), "degree 0; allowed is 1 to 16");
        assert_eq!(message(3, &[], &points), "3 control points; degree 3 takes 4 to 10000");
        assert_eq!(message(2, &[0.0; 5], &points), "5 knots; 3 points of degree 2 take 6");
        assert_eq!(message(2, &[0.0; 6], &points), "all its knots are the same");
        assert_eq!(message(2, &[0.0, 0.0, 1.0, 0.5, 1.0, 1.0], &points), "the knots do not increase");
        // A knot in the middle as often as the ends: two lines.
        let torn: Vec<_> = [[0.0, 0.0], [1.0, 0.0], [1.0, 8.0], [2.0, 8.0]].map(|point| (point, 1.0)).into();
        let knots = [0.0, 0.0, 0.5, 0.5, 1.0, 1.0];
        assert_eq!(message(1, &knots, &torn), "it jumps by 8.000e0 m, at a knot that is there too often");
        let closed: Vec<_> = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 8.0]].map(|point| (point, 1.0)).into();
        assert_eq!(Nurbs { degree: 1, knots: knots.into(), points: closed }.beziers().unwrap().len(), 2);
        assert_eq!(message(2, &[], &[([0.0; 2], 0.0); 3]), "a control point of weight 0; allowed is 1e-6 to 1e6");
    }
}

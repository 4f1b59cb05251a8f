//! Polynomials by their Bernstein coefficients, between the least and the largest of which all values lie.

use super::nurbs::RationalBezier;

/// The coefficients of `a + factor · b`, of the same degree.
pub(super) fn sum(a: &[f64], b: &[f64], factor: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
}

/// Those of the product.
pub(super) fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let (n, m) = (a.len().saturating_sub(1), b.len().saturating_sub(1));
    let [of_a, of_b, of_both] = [n, m, n + m].map(binomials);
    let coefficient = |sum: usize| {
        let terms = (sum.saturating_sub(m)..=sum.min(n)).map(|i| of_a[i] * a[i] * of_b[sum - i] * b[sum - i]);
        terms.sum::<f64>() / of_both[sum]
    };
    (0..=n + m).map(coefficient).collect()
}

/// Those of the derivative.
pub(super) fn derivative(a: &[f64]) -> Vec<f64> {
    let degree = a.len().saturating_sub(1) as f64;
    a.windows(2).map(|pair| degree * (pair[1] - pair[0])).collect()
}

/// The row of Pascal's triangle.
fn binomials(degree: usize) -> Vec<f64> {
    let mut row = vec![1.0];
    for k in 0..degree {
        row.push(row[k] * (degree - k) as f64 / (k + 1) as f64);
    }
    row
}

/// Homogeneous coordinates x, y and w of a curve, in the frame of a pose.
pub(super) fn framed(curve: &RationalBezier, at: [f64; 2], heading: f64) -> [Vec<f64>; 3] {
    let (sin, cos) = heading.sin_cos();
    let point = |[x, y, w]: &[f64; 3]| {
        let (x, y) = (x - at[0] * w, y - at[1] * w);
        [x * cos + y * sin, y * cos - x * sin, *w]
    };
    [0, 1, 2].map(|axis| curve.0.iter().map(|control| point(control)[axis]).collect())
}

/// w² g and w² of a curve, with g = k (x² + y²) / 2 - y in the plane: 0 on the circle of signed curvature k that touches the first axis at
/// the origin.
pub(super) fn circle([x, y, w]: &[Vec<f64>; 3], curvature: f64) -> [Vec<f64>; 2] {
    let squares = sum(&product(x, x), &product(y, y), 1.0);
    let half: Vec<f64> = squares.iter().map(|square| 0.5 * curvature * square).collect();
    [sum(&half, &product(y, w), -1.0), product(w, w)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(a: &[f64], t: f64) -> f64 {
        let mut level = a.to_vec();
        while level.len() > 1 {
            level = level.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) * t).collect();
        }
        level[0]
    }

    #[test]
    fn values_are_those_of_the_polynomials() {
        let (a, b) = ([1.0, -2.0, 0.5, 3.0], [0.5, 2.0, -1.0]);
        for t in [0.0, 0.1, 0.5, 0.77, 1.0] {
            let (own, their) = (value(&a, t), value(&b, t));
            assert!((value(&product(&a, &b), t) - own * their).abs() < 1e-12);
            assert!((value(&sum(&a, &a, -3.0), t) + 2.0 * own).abs() < 1e-12);
            let near = (value(&a, t + 1e-6) - value(&a, t - 1e-6)) / 2e-6;
            assert!((value(&derivative(&a), t) - near).abs() < 1e-6);
        }
    }

    #[test]
    fn it_is_0_on_the_circle() {
        // A quarter of the circle of radius 2 that begins at the origin.
        let weight = std::f64::consts::FRAC_1_SQRT_2;
        let quarter = RationalBezier(vec![[1.0, 1.0, 1.0], [3.0 * weight, weight, weight], [3.0, 3.0, 1.0]]);
        let points = framed(&quarter, [1.0, 1.0], 0.0);
        let [g, squares] = circle(&points, 0.5);
        assert!(g.iter().all(|g| g.abs() < 1e-15) && squares.iter().all(|w| *w > 0.4), "{g:?} {squares:?}");
        assert!(circle(&points, -0.5)[0].iter().any(|g| g.abs() > 0.1));
    }
}

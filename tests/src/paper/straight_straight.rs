//! Section 3.3.1: the ego on the x-axis, the other on a line through the origin; Eq. (8)-(17).

use super::{Pcr, Range, Vec2};

/// Eq. (8), residual \[m²\]: `(x - p₁x)² + (y - p₁y)² - r̂₁²`, 0 on the contour of the grown agent at `centre`.
pub fn eq_08(point: Vec2, centre: Vec2, r: f64) -> f64 {
    (point[0] - centre[0]).powi(2) + (point[1] - centre[1]).powi(2) - r * r
}

/// Eq. (9), parametric half: `p₁ = (υ₁ t cos θ, υ₁ t sin θ)`. Its other half, `p₁y = tan θ · p₁x`, is undefined at
/// `θ = ± π/2`.
pub fn eq_09(pcr: &Pcr, t: f64) -> Vec2 {
    let travelled = pcr.v * t;
    [travelled * pcr.theta.cos(), travelled * pcr.theta.sin()]
}

/// Eq. (11), residual \[m\]: `p₂y`, 0 on ρ₂.
pub fn eq_11(point: Vec2) -> f64 {
    point[1]
}

/// Eq. (12): `p₂x = p₁x ∓ √(r̂₁² - p₁y²)`, the intersections of ρ₂ and the contour; `None` if there are none.
pub fn eq_12(centre: Vec2, r: f64) -> Option<[Vec2; 2]> {
    let radicand = r * r - centre[1] * centre[1];
    (radicand >= 0.0).then(|| [[centre[0] - radicand.sqrt(), 0.0], [centre[0] + radicand.sqrt(), 0.0]])
}

/// Eq. (13): `[λ⁻, λ⁺] = [p₂x⁻, p₂x⁺]`, the collision length on a straight ρ₂.
pub fn eq_13(centre: Vec2, r: f64) -> Option<Range> {
    eq_12(centre, r).map(|[lower, upper]| [lower[0], upper[0]])
}

/// Eq. (14), residual \[m²\]: `(1 + tan² θ) p₁x² - 2 p₂x p₁x + p₂x² - r̂₁²`, 0 where the other agent at `p₁x` touches
/// the ego at `p₂x`.
pub fn eq_14(pcr: &Pcr, p2x: f64, p1x: f64) -> f64 {
    (1.0 + pcr.theta.tan().powi(2)) * p1x * p1x - 2.0 * p2x * p1x + p2x * p2x - pcr.r * pcr.r
}

/// The discriminant of Eq. (14) as the text below it prints it \[m²\]: `p₂x² - (1 + tan² θ)(p₂x² - r̂₁²)`.
pub fn eq_14_discriminant(pcr: &Pcr, p2x: f64) -> f64 {
    p2x * p2x - (1.0 + pcr.theta.tan().powi(2)) * (p2x * p2x - pcr.r * pcr.r)
}

/// Length range of SS.
pub mod eq_15 {
    use super::{Pcr, Range};

    /// `[-r̂₁ / sin θ, r̂₁ / sin θ]`: its ends are exchanged where `sin θ < 0`.
    pub fn as_printed(pcr: &Pcr) -> Range {
        [-pcr.r / pcr.theta.sin(), pcr.r / pcr.theta.sin()]
    }

    /// `± r̂₁ / |sin θ|`.
    pub fn corrected(pcr: &Pcr) -> Range {
        let l = pcr.r / pcr.theta.sin().abs();
        [-l, l]
    }
}

/// Eq. (16), the condition below it: whether the radicand of Eq. (12) is not negative at `t`.
pub fn eq_16(pcr: &Pcr, t: f64) -> bool {
    let [_, y] = pcr.position(t);
    pcr.r * pcr.r - y * y >= 0.0
}

/// Time range of SS.
pub mod eq_17 {
    use super::{Pcr, Range};

    /// `[-r̂₁ / (υ₁ sin θ), r̂₁ / (υ₁ sin θ)]`: its ends are exchanged where `sin θ < 0`.
    pub fn as_printed(pcr: &Pcr) -> Range {
        [-pcr.r / (pcr.v * pcr.theta.sin()), pcr.r / (pcr.v * pcr.theta.sin())]
    }

    /// `± r̂₁ / (υ₁ |sin θ|)`.
    pub fn corrected(pcr: &Pcr) -> Range {
        let t = pcr.r / (pcr.v * pcr.theta.sin().abs());
        [-t, t]
    }
}

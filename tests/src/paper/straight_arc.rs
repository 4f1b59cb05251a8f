//! Section 3.3.2: the ego on the x-axis, the other on a circle through the origin; Eq. (18)-(23).

use super::{Arc, Pcr, Range, Vec2};
use std::f64::consts::FRAC_PI_2;

/// Eq. (18), residual \[m²\]: `(p₁x - c₁x)² + (p₁y - c₁y)² - ς₁²`, 0 on the circle of ρ₁.
pub fn eq_18(point: Vec2, centre: Vec2, arc: Arc) -> f64 {
    (point[0] - centre[0]).powi(2) + (point[1] - centre[1]).powi(2) - arc.radius * arc.radius
}

/// Eq. (19), the centre of ρ₁: `c₁ = ς₁ (cos(θ ± π/2), sin(θ ± π/2))`, + counter-clockwise, - clockwise.
/// (The text after it says "direction of circular path ρ₂": it is ρ₁.)
pub fn eq_19(theta: f64, arc: Arc) -> Vec2 {
    let angle = theta + arc.dir * FRAC_PI_2;
    [arc.radius * angle.cos(), arc.radius * angle.sin()]
}

/// Eq. (20), the position on ρ₁ at `φ₁ = ω₁ t`, `ω₁ = υ₁ / ς₁`:
/// `p₁ = [1 - cos φ₁, dir sin φ₁; -dir sin φ₁, 1 - cos φ₁] c₁`.
pub fn eq_20(pcr: &Pcr, arc: Arc, t: f64) -> Vec2 {
    let [cx, cy] = eq_19(pcr.theta, arc);
    let (sin, cos) = (pcr.v / arc.radius * t).sin_cos();
    [(1.0 - cos) * cx + arc.dir * sin * cy, -arc.dir * sin * cx + (1.0 - cos) * cy]
}

/// Eq. (21), residual \[m²\] of ρ₁⁺ (`side = 1`) or ρ₁⁻ (`side = -1`): `(x - c₁x)² + (y - c₁y)² - (ς₁ ± r̂₁)²`. Of
/// ρ₁⁻ there is only the far side where `r̂₁ > ς₁`.
pub fn eq_21(point: Vec2, centre: Vec2, arc: Arc, r: f64, side: f64) -> f64 {
    (point[0] - centre[0]).powi(2) + (point[1] - centre[1]).powi(2) - (arc.radius + side * r).powi(2)
}

/// `√((ς₁ + side r̂₁)² - c₁y²)`: half the chord of ρ₁^± on the x-axis; NaN if there is none.
fn half_chord(pcr: &Pcr, arc: Arc, side: f64) -> f64 {
    let [_, cy] = eq_19(pcr.theta, arc);
    ((arc.radius + side * pcr.r).powi(2) - cy * cy).sqrt()
}

/// Length range of SA.
pub mod eq_22 {
    use super::{Arc, Pcr, Range, eq_19, half_chord};

    /// `c₁x ≥ 0`: `[√((ς₁ + r̂₁)² - c₁y²) - |c₁x|, -√((ς₁ - r̂₁)² - c₁y²) + |c₁x|]`;
    /// `c₁x < 0`: `[-√((ς₁ - r̂₁)² - c₁y²) + |c₁x|, √((ς₁ + r̂₁)² - c₁y²) - |c₁x|]`.
    /// One end of each has the wrong sign.
    pub fn as_printed(pcr: &Pcr, arc: Arc) -> Range {
        let [cx, _] = eq_19(pcr.theta, arc);
        let (outer, inner) = (half_chord(pcr, arc, 1.0), half_chord(pcr, arc, -1.0));
        if cx >= 0.0 { [outer - cx.abs(), -inner + cx.abs()] } else { [-inner + cx.abs(), outer - cx.abs()] }
    }

    /// `c₁x - g √((ς₁ ± r̂₁)² - c₁y²)` with `g = sgn c₁x`; `c₁x ± √((ς₁ + r̂₁)² - c₁y²)` where ρ₁⁻ does not cut the
    /// x-axis, or only with its far side: the two crossings of the line and the circle have one region.
    pub fn corrected(pcr: &Pcr, arc: Arc) -> Range {
        let [cx, _] = eq_19(pcr.theta, arc);
        let (outer, inner) = (half_chord(pcr, arc, 1.0), half_chord(pcr, arc, -1.0));
        if inner.is_nan() || pcr.r >= arc.radius {
            [cx - outer, cx + outer]
        } else if cx >= 0.0 {
            [cx - outer, cx - inner]
        } else {
            [cx + inner, cx + outer]
        }
    }
}

/// Time range of SA.
pub mod eq_23 {
    use super::super::EVERYWHERE;
    use super::{Arc, Pcr, Range, eq_19};
    use std::f64::consts::PI;

    /// `[(asin((-r̂₁ - c₁y) / ς₁) - θ_SA) / ω₁, (asin((r̂₁ - c₁y) / ς₁) - θ_SA) / ω₁]` with
    /// `θ_SA = atan(c₁y / (dir c₁x))`. It holds where ρ₁ rises (`sin θ > 0`) and both ends are on that flank.
    pub fn as_printed(pcr: &Pcr, arc: Arc) -> Range {
        let [cx, cy] = eq_19(pcr.theta, arc);
        let theta_sa = (cy / (arc.dir * cx)).atan();
        [-pcr.r, pcr.r].map(|side| (((side - cy) / arc.radius).asin() - theta_sa) / (pcr.v / arc.radius))
    }

    /// With `g = sgn sin θ`, `y = g c₁y` and the sines `a, b = (∓ r̂₁ - y) / ς₁` of the flank on which the other is at
    /// `t = 0`: `τ_a = asin a`, or `-π - asin b` (from the flank before) if `a < -1`; `τ_b = asin b`, or `π - asin a`
    /// (to the flank after) if `b > 1`; `t = (τ - asin(-y / ς₁)) / ω₁`.
    pub fn corrected(pcr: &Pcr, arc: Arc) -> Range {
        let y = pcr.theta.sin().signum() * eq_19(pcr.theta, arc)[1];
        let [a, b] = [-pcr.r, pcr.r].map(|side| (side - y) / arc.radius);
        if a < -1.0 && b > 1.0 {
            return EVERYWHERE;
        }
        let lo = if a < -1.0 { -PI - b.asin() } else { a.asin() };
        let hi = if b > 1.0 { PI - a.asin() } else { b.asin() };
        let at_crossing = (-y / arc.radius).asin();
        [lo, hi].map(|tau| (tau - at_crossing) / (pcr.v / arc.radius))
    }
}

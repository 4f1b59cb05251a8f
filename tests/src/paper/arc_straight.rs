//! Section 3.3.3: the ego on a circle through the origin, the other on a line; Eq. (24)-(33).

use super::{Arc, Pcr, Range, Vec2, norm};

/// Eq. (24), residual \[m²\]: `(p₂x - c₂x)² + (p₂y - c₂y)² - ς₂²`, 0 on the circle of ρ₂.
pub fn eq_24(point: Vec2, arc: Arc) -> f64 {
    let [cx, cy] = eq_25(arc);
    (point[0] - cx).powi(2) + (point[1] - cy).powi(2) - arc.radius * arc.radius
}

/// Eq. (25), the centre of ρ₂: `c₂' = (0, -ς₂)` clockwise, `c₂'' = (0, ς₂)` counter-clockwise.
pub fn eq_25(arc: Arc) -> Vec2 {
    [0.0, arc.dir * arc.radius]
}

/// Eq. (10) on an arc: `ρ₂⁻¹(p)`, the length at a point of the circle on the lap next to the crossing. (Printed is
/// `ρ₂(p_I^±)`, but ρ₂ maps lengths to points.)
pub fn eq_10([x, y]: Vec2, arc: Arc) -> f64 {
    arc.radius * x.atan2(-arc.dir * (y - eq_25(arc)[1]))
}

/// The collision length on an arc.
pub mod eq_26 {
    use super::{Arc, Range, Vec2, eq_28, eq_29};
    use std::f64::consts::PI;

    /// `[ς² (ε - 0.5 φ), ς² (ε + 0.5 φ)]`: an exponent for an index, and (28), (29) as printed.
    pub fn as_printed(p1: Vec2, r: f64, arc: Arc) -> Range {
        let (epsilon, phi) = (eq_29::as_printed(p1, arc), eq_28::as_printed(p1, r, arc));
        [-0.5, 0.5].map(|half| arc.radius.powi(2) * (epsilon + half * phi))
    }

    /// `[ς₂ (ε - φ/2), ς₂ (ε + φ/2)]` with (28) and (29) as printed: what the text before (26) means.
    pub fn with_printed_angles(p1: Vec2, r: f64, arc: Arc) -> Range {
        let (epsilon, phi) = (eq_29::as_printed(p1, arc), eq_28::as_printed(p1, r, arc));
        [-0.5, 0.5].map(|half| arc.radius * (epsilon + half * phi))
    }

    /// `[ς₂ (ε - φ/2), ς₂ (ε + φ/2)]`; a whole lap about the crossing where the disc holds the circle, `None` where it
    /// does not reach it.
    pub fn corrected(p1: Vec2, r: f64, arc: Arc) -> Option<Range> {
        let phi = eq_28::corrected(p1, r, arc)?;
        let epsilon = if phi >= 2.0 * PI { 0.0 } else { eq_29::corrected(p1, arc) };
        Some([-0.5, 0.5].map(|half| arc.radius * (epsilon + half * phi)))
    }
}

/// Eq. (27), residual \[m²\], 0 on the common chord of (8) and (24):
/// `2 p₁x x + 2 (p₁y - c₂y) y - (p₁x² + p₁y² - r̂₁²)`.
pub fn eq_27(point: Vec2, p1: Vec2, r: f64, arc: Arc) -> f64 {
    let [_, cy] = eq_25(arc);
    2.0 * p1[0] * point[0] + 2.0 * (p1[1] - cy) * point[1] - (p1[0] * p1[0] + p1[1] * p1[1] - r * r)
}

/// The angle φ at c₂ between the two intersections.
pub mod eq_28 {
    use super::{Arc, Vec2, eq_25, norm};
    use std::f64::consts::PI;

    /// `2 acos(|2 (p₁y - c₂y) c₂y - (p₁x² + p₁y² - r̂₁²)| / (2 ς₂ √(p₁x² + (p₁y - c₂y)²)))`: the absolute value
    /// takes a chord beyond c₂ for one before it, and gives an angle where there is no chord.
    pub fn as_printed([x, y]: Vec2, r: f64, arc: Arc) -> f64 {
        let [_, cy] = eq_25(arc);
        let distance = norm([x, y - cy]);
        let power = 2.0 * (y - cy) * cy - (x * x + y * y - r * r);
        2.0 * (power.abs() / (2.0 * arc.radius * distance)).acos()
    }

    /// `4 atan2(√((r̂₁ - |D - ς₂|)(r̂₁ + |D - ς₂|)), √((D + ς₂ - r̂₁)(D + ς₂ + r̂₁)))` with `D = |p₁ - c₂|`; 2π where
    /// the disc holds the circle, `None` where it does not reach it.
    pub fn corrected([x, y]: Vec2, r: f64, arc: Arc) -> Option<f64> {
        let [_, cy] = eq_25(arc);
        let distance = norm([x, y - cy]);
        let (offset, diameter) = ((distance - arc.radius).abs(), distance + arc.radius);
        if offset > r {
            None
        } else if diameter <= r {
            Some(2.0 * PI)
        } else {
            let near = ((r - offset) * (r + offset)).sqrt();
            Some(4.0 * near.atan2(((diameter - r) * (diameter + r)).sqrt()))
        }
    }
}

/// The angle ε at c₂ from the crossing to the middle of the chord.
pub mod eq_29 {
    use super::{Arc, Vec2, eq_25};

    /// `atan(p₁x / (p₁y - c₂y))`: the sign is that of `c₂'`, and half of the circle is lost.
    pub fn as_printed([x, y]: Vec2, arc: Arc) -> f64 {
        (x / (y - eq_25(arc)[1])).atan()
    }

    /// `atan2(p₁x, -dir₂ (p₁y - c₂y))`.
    pub fn corrected([x, y]: Vec2, arc: Arc) -> f64 {
        x.atan2(-arc.dir * (y - eq_25(arc)[1]))
    }
}

/// Length range of AS.
pub mod eq_30 {
    use super::super::EVERYWHERE;
    use super::{Arc, Pcr, Range};
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    /// `[ς₂ (θ⁺ - θ_AS), ς₂ (θ_AS - θ⁻)]` in quadrants 1 and 3, `[ς₂ (θ⁻ - θ_AS), ς₂ (θ_AS - θ⁺)]` in 2 and 4, with
    /// `θ^± = acos(ς₂ / (c₂p_H ± r̂₁))`, `θ_AS = π - θ`, and `c₂p_H` the distance of c₂ from ρ₁.
    pub fn as_printed(pcr: &Pcr, arc: Arc) -> Range {
        let distance = arc.radius * pcr.theta.cos().abs();
        let [outer, inner] = [1.0, -1.0].map(|side| (arc.radius / (distance + side * pcr.r)).acos());
        from_angles(pcr, arc, outer, inner, PI - pcr.theta)
    }

    /// As printed with the ratio `(c₂p_H ± r̂₁) / ς₂` the right way round: still wrong in signs and in `θ_AS`.
    pub fn with_ratio_inverted(pcr: &Pcr, arc: Arc) -> Range {
        let distance = arc.radius * pcr.theta.cos().abs();
        let [outer, inner] = [1.0, -1.0].map(|side| ((distance + side * pcr.r) / arc.radius).acos());
        from_angles(pcr, arc, outer, inner, PI - pcr.theta)
    }

    fn from_angles(pcr: &Pcr, arc: Arc, outer: f64, inner: f64, theta_as: f64) -> Range {
        let quadrant = (pcr.theta.rem_euclid(TAU) / FRAC_PI_2).floor() as i64;
        let (first, second) = if quadrant % 2 == 0 { (outer, inner) } else { (inner, outer) };
        [arc.radius * (first - theta_as), arc.radius * (theta_as - second)]
    }

    /// With `k = dir₂ sgn(sin θ) cos θ`, the signed distance of c₂ from ρ₁ in radii, `β₀ = acos k`, `q = r̂₁ / ς₂`:
    /// `l⁺ = ς₂ (β₀ - acos(k + q))`, or `ς₂ (β₀ + acos(k - q))` (beyond the next crossing) if `k + q > 1`;
    /// `l⁻ = ς₂ (β₀ - acos(k - q))`, or `ς₂ (β₀ - 2π + acos(k + q))` if `k - q < -1`.
    pub fn corrected(pcr: &Pcr, arc: Arc) -> Range {
        let k = arc.dir * pcr.theta.sin().signum() * pcr.theta.cos();
        let (angle, q) = (k.acos(), pcr.r / arc.radius);
        if k + q > 1.0 && k - q < -1.0 {
            return EVERYWHERE;
        }
        let hi = if k + q > 1.0 { angle + (k - q).acos() } else { angle - (k + q).acos() };
        let lo = if k - q < -1.0 { angle - TAU + (k + q).acos() } else { angle - (k - q).acos() };
        [arc.radius * lo, arc.radius * hi]
    }
}

/// Eq. (31), residual \[m²\]: `p₁x² + (p₁y - c₂y)² - (ς₂ ± r̂₁)²`, 0 where the circles (8) and (24) touch from outside
/// (`side = 1`) or from inside (`side = -1`, only for `r̂₁ < ς₂` a boundary).
pub fn eq_31(p1: Vec2, r: f64, arc: Arc, side: f64) -> f64 {
    let [_, cy] = eq_25(arc);
    p1[0] * p1[0] + (p1[1] - cy).powi(2) - (arc.radius + side * r).powi(2)
}

/// Eq. (31) with Eq. (9), a quadratic in `t`.
pub mod eq_32 {
    use super::{Arc, Pcr, eq_25};

    /// Residual \[m²\] of `υ₁² (sin² θ + cos² θ) t² - 2 υ₁ sin θ ς₂ t ± 2 ς₂ r̂₁ - r̂₁²`: the middle term is that of
    /// `c₂''`; `side = 1` is the contact from inside.
    pub fn as_printed(pcr: &Pcr, arc: Arc, side: f64, t: f64) -> f64 {
        let (sin, cos) = pcr.theta.sin_cos();
        let square = pcr.v.powi(2) * (sin * sin + cos * cos) * t * t;
        square - 2.0 * pcr.v * sin * arc.radius * t + side * 2.0 * arc.radius * pcr.r - pcr.r.powi(2)
    }

    /// Residual \[m²\] of `υ₁² t² - 2 υ₁ sin θ c₂y t ± 2 ς₂ r̂₁ - r̂₁²`; `side = 1` is the contact from inside.
    pub fn corrected(pcr: &Pcr, arc: Arc, side: f64, t: f64) -> f64 {
        let middle = 2.0 * pcr.v * pcr.theta.sin() * eq_25(arc)[1];
        (pcr.v * t).powi(2) - middle * t + side * 2.0 * arc.radius * pcr.r - pcr.r.powi(2)
    }
}

/// Time range of AS.
pub mod eq_33 {
    use super::{Arc, Pcr, Range, eq_25};

    /// `(α ∓ √(α² - υ₁² β)) / υ₁²` with `α = υ₁ sin θ ς₂` and one of `β = ± 2 ς₂ r̂₁ - r̂₁²` in both roots: from the
    /// first contact to the last of the whole circle (`side = -1`), or between the two contacts from inside (`side = 1`).
    pub fn as_printed(pcr: &Pcr, arc: Arc, side: f64) -> Range {
        let alpha = pcr.v * pcr.theta.sin() * arc.radius;
        roots(pcr, arc, alpha, side)
    }

    /// With `α = υ₁ sin θ c₂y` and `t_in`, `t_out` the roots of the contacts from inside and outside: from the outer
    /// one to the inner one on the way into the circle (`α > 0`), from the inner to the outer one on the way out;
    /// from outer to outer where there is no contact from inside, or `r̂₁ ≥ ς₂`.
    pub fn corrected(pcr: &Pcr, arc: Arc) -> Range {
        let alpha = pcr.v * pcr.theta.sin() * eq_25(arc)[1];
        let (outer, inner) = (roots(pcr, arc, alpha, -1.0), roots(pcr, arc, alpha, 1.0));
        if inner[0].is_nan() || pcr.r >= arc.radius {
            outer
        } else if alpha > 0.0 {
            [outer[0], inner[0]]
        } else {
            [inner[1], outer[1]]
        }
    }

    fn roots(pcr: &Pcr, arc: Arc, alpha: f64, side: f64) -> Range {
        let beta = side * 2.0 * arc.radius * pcr.r - pcr.r.powi(2);
        let q = (alpha * alpha - pcr.v.powi(2) * beta).sqrt();
        [(alpha - q) / pcr.v.powi(2), (alpha + q) / pcr.v.powi(2)]
    }
}

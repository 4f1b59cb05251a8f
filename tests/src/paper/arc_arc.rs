//! Section 3.3.4: both on circles through the origin; Eq. (34)-(37).

use super::arc_straight::eq_25;
use super::straight_arc::eq_19;
use super::{Arc, Pcr, Range, Vec2, norm};

/// The distance of the centres `c₁c₂` \[m\].
pub fn centre_distance(pcr: &Pcr, own: Arc, other: Arc) -> f64 {
    let ([x1, y1], [x2, y2]) = (eq_19(pcr.theta, other), eq_25(own));
    norm([x1 - x2, y1 - y2])
}

/// Length range of AA.
pub mod eq_34 {
    use super::super::EVERYWHERE;
    use super::{Arc, Pcr, Range, centre_distance, eq_19};
    use std::f64::consts::TAU;

    /// `[ς₂ (θ⁺ - θ), ς₂ (θ - θ⁻)]` for `c₁x ≥ 0`, else `[ς₂ (θ⁻ - θ), ς₂ (θ - θ⁺)]`, with
    /// `θ^{±,0} = acos((ς₂² + c₁c₂² - ϱ²) / (2 c₁c₂ ϱ))`, `ϱ = ς₁ ± r̂₁, ς₁`. (Printed is `acos( ) / ( )`, which is
    /// no angle at all.) That is the cosine formula for another corner of the triangle.
    pub fn as_printed(pcr: &Pcr, own: Arc, other: Arc) -> Range {
        signs_as_printed(pcr, own, other, |radius| radius)
    }

    /// As printed with the denominator of the angle at c₂, `2 c₁c₂ ς₂`: one end still has the wrong sign.
    pub fn with_denominator_corrected(pcr: &Pcr, own: Arc, other: Arc) -> Range {
        signs_as_printed(pcr, own, other, |_| own.radius)
    }

    fn signs_as_printed(pcr: &Pcr, own: Arc, other: Arc, adjacent: impl Fn(f64) -> f64) -> Range {
        let centres = centre_distance(pcr, own, other);
        let [outer, crossing, inner] = [1.0, 0.0, -1.0].map(|side| {
            let radius = other.radius + side * pcr.r;
            ((own.radius.powi(2) + centres.powi(2) - radius.powi(2)) / (2.0 * centres * adjacent(radius))).acos()
        });
        let (first, second) = if eq_19(pcr.theta, other)[0] >= 0.0 { (outer, inner) } else { (inner, outer) };
        [own.radius * (first - crossing), own.radius * (crossing - second)]
    }

    /// With `θ^{±,0} = acos((ς₂² + c₁c₂² - ϱ²) / (2 c₁c₂ ς₂))`, undefined where the circles do not meet (or `ϱ ≤ 0`):
    /// `a = θ⁰ - θ⁺`, or `θ⁰ - 2π + θ⁻` without θ⁺; `b = θ⁰ - θ⁻`, or `θ⁰ + θ⁺` without θ⁻;
    /// `[ς₂ a, ς₂ b]` for `c₁x ≥ 0`, else `[-ς₂ b, -ς₂ a]`.
    pub fn corrected(pcr: &Pcr, own: Arc, other: Arc) -> Range {
        let centres = centre_distance(pcr, own, other);
        let angle = |radius: f64| {
            let cos = (own.radius.powi(2) + centres.powi(2) - radius.powi(2)) / (2.0 * centres * own.radius);
            (radius > 0.0 && cos.abs() <= 1.0).then(|| cos.acos())
        };
        let (outer, inner) = (angle(other.radius + pcr.r), angle(other.radius - pcr.r));
        let crossing = angle(other.radius).unwrap_or(f64::NAN);
        let [a, b] = match (outer, inner) {
            (Some(outer), Some(inner)) => [crossing - outer, crossing - inner],
            (Some(outer), None) => [crossing - outer, crossing + outer],
            (None, Some(inner)) => [crossing - TAU + inner, crossing - inner],
            (None, None) => return EVERYWHERE,
        };
        if eq_19(pcr.theta, other)[0] >= 0.0 {
            [own.radius * a, own.radius * b]
        } else {
            [-own.radius * b, -own.radius * a]
        }
    }
}

/// Eq. (35), residual \[m²\]: `c₁x p₁x + (c₁y - c₂y) p₁y ∓ ς₂ r̂₁ - 0.5 r̂₁²`, 0 where the circles touch from outside
/// (`side = 1`) or from inside (`side = -1`).
pub fn eq_35(pcr: &Pcr, own: Arc, other: Arc, side: f64, p1: Vec2) -> f64 {
    let ([c1x, c1y], [_, c2y]) = (eq_19(pcr.theta, other), eq_25(own));
    c1x * p1[0] + (c1y - c2y) * p1[1] - (side * own.radius * pcr.r + 0.5 * pcr.r.powi(2))
}

/// Eq. (36), residual \[m²\]: `dir c₁x c₂y sin φ₁ + (c₁y c₂y - ς₁²) cos φ₁ ∓ ς₂ r̂₁ - 0.5 r̂₁² - c₁y c₂y + ς₁²`.
/// (Printed is `dir(p₁)` for `dir(ρ₁)`, here and in (37).)
pub fn eq_36(pcr: &Pcr, own: Arc, other: Arc, side: f64, phi: f64) -> f64 {
    let ([c1x, c1y], [_, c2y]) = (eq_19(pcr.theta, other), eq_25(own));
    let beta = c1y * c2y - other.radius.powi(2);
    let left = other.dir * c1x * c2y * phi.sin() + beta * phi.cos();
    left - (side * own.radius * pcr.r + 0.5 * pcr.r.powi(2) + beta)
}

/// Time range of AA.
pub mod eq_37 {
    use super::super::EVERYWHERE;
    use super::{Arc, Pcr, Range, eq_19, eq_25};
    use std::f64::consts::PI;

    /// α, β and γ∓ of Eq. (37) \[m²\].
    fn coefficients(pcr: &Pcr, own: Arc, other: Arc) -> (f64, f64, [f64; 2]) {
        let ([c1x, c1y], [_, c2y]) = (eq_19(pcr.theta, other), eq_25(own));
        let beta = c1y * c2y - other.radius.powi(2);
        let gamma = [-1.0, 1.0].map(|side| side * own.radius * pcr.r + 0.5 * pcr.r.powi(2) + beta);
        (other.dir * c1x * c2y, beta, gamma)
    }

    /// The arguments `γ∓ / √(α² + β²)` of the arcsines.
    pub fn arguments(pcr: &Pcr, own: Arc, other: Arc) -> [f64; 2] {
        let (alpha, beta, gamma) = coefficients(pcr, own, other);
        gamma.map(|gamma| gamma / alpha.hypot(beta))
    }

    /// α: positive where the other leaves the circle of ρ₂.
    pub fn alpha(pcr: &Pcr, own: Arc, other: Arc) -> f64 {
        coefficients(pcr, own, other).0
    }

    /// `(asin(γ∓ / √(α² + β²)) - θ_AA) / ω₁`, `θ_AA = atan(β / α)`. It holds for `α > 0` and both contacts on the flank
    /// of the crossing. (The name θ_AA is that of another angle in (34).)
    pub fn as_printed(pcr: &Pcr, own: Arc, other: Arc) -> Range {
        let (alpha, beta, _) = coefficients(pcr, own, other);
        let theta_aa = (beta / alpha).atan();
        arguments(pcr, own, other).map(|sine| (sine.asin() - theta_aa) / (pcr.v / other.radius))
    }

    /// With `a, b = γ∓ / √(α² + β²)` and `t₀ = asin(β / √(α² + β²))`: `lo = asin a`, or `-π - asin b` (from the
    /// crossing before) if `a < -1` or `r̂₁ ≥ ς₂`; `hi = asin b`, or `π - asin a` (to the one after) if `b > 1`;
    /// `t = [lo - t₀, hi - t₀] / ω₁` for `α > 0`, `[t₀ - hi, t₀ - lo] / ω₁` for `α < 0`.
    pub fn corrected(pcr: &Pcr, own: Arc, other: Arc) -> Range {
        let (alpha, beta, _) = coefficients(pcr, own, other);
        let [a, b] = arguments(pcr, own, other);
        let (no_inner, no_outer) = (a < -1.0 || pcr.r >= own.radius, b > 1.0);
        if no_inner && no_outer {
            return EVERYWHERE;
        }
        let lo = if no_inner { -PI - b.asin() } else { a.asin() };
        let hi = if no_outer { PI - a.asin() } else { b.asin() };
        let at_crossing = (beta / alpha.hypot(beta)).asin();
        let range =
            if alpha > 0.0 { [lo - at_crossing, hi - at_crossing] } else { [at_crossing - hi, at_crossing - lo] };
        range.map(|angle| angle / (pcr.v / other.radius))
    }
}

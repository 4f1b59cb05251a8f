//! Sections 3.3 and 3.4: from the frame {B} of a crossing to the frame {A} of a path; Eq. (7), (38), (39).

use super::Range;
use pcr_core::Crossing;

/// Eq. (7): `(t, l)` in {A} is `(t, l)` in {B} plus the origin `(T, L)` of {B} in {A}.
pub fn eq_07(point: [f64; 2], origin: [f64; 2]) -> [f64; 2] {
    [point[0] + origin[0], point[1] + origin[1]]
}

/// Eq. (38): whether `(t, l)` lies in the region with this time range and contour. (Printed is `CR_ji` of `λ_ij`; and a
/// region has several intervals at one time where paths come back: `slice` is one of them.)
pub fn eq_38([t, l]: [f64; 2], time: Range, slice: impl Fn(f64) -> Option<Range>) -> bool {
    time[0] <= t && t <= time[1] && slice(t).is_some_and(|[lower, upper]| lower <= l && l <= upper)
}

/// The origin `(T, L)` of {B} in {A}.
pub mod eq_39 {
    use super::Crossing;

    /// `T = λ_j⁻¹(ρ_j⁻¹(p))`, `L = ρ_j⁻¹(p)`: the length along the other's path.
    pub fn as_printed(crossing: &Crossing<f64>) -> [f64; 2] {
        [crossing.time, crossing.other_length]
    }

    /// `T = λ_j⁻¹(ρ_j⁻¹(p))`, `L = ρ_i⁻¹(p)`, as Table I says.
    pub fn corrected(crossing: &Crossing<f64>) -> [f64; 2] {
        [crossing.time, crossing.length]
    }
}

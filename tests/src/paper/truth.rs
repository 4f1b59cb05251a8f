//! What the tests of the paper's errors share: the counterexamples' numbers, and the right value, on which three agree.

use super::{Arc, Pcr, Range, definition, kernels, norm};

/// The documented numbers have three or four decimals.
pub const PRINTED: f64 = 6e-4;

/// Two computations of the right value \[s\] or \[m\].
pub const SAME: f64 = 1e-9;

/// A printed equation is right where it agrees to this \[s\] or \[m\]; no wrong one comes as near by chance in these cases.
pub const RIGHT: f64 = 1e-7;

/// Random cases of each class.
pub const EACH: usize = 25;

/// Whether both ends agree to a tolerance.
pub fn within(a: Range, b: Range, tolerance: f64) -> bool {
    a == b || (a[0] - b[0]).abs() < tolerance && (a[1] - b[1]).abs() < tolerance
}

/// Asserts that both ends agree to a tolerance, or are both NaN or the same infinity.
///
/// # Panics
/// If they do not.
#[track_caller]
pub fn assert_range(found: Range, expected: Range, tolerance: f64) {
    let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan() || (a - b).abs() < tolerance;
    assert!(same(found[0], expected[0]) && same(found[1], expected[1]), "{found:?} is not {expected:?}");
}

/// An arc of this radius \[m\] and turn.
pub fn arc(radius: f64, dir: f64) -> Option<Arc> {
    Some(Arc { radius, dir })
}

/// A case with the numbers that most counterexamples share.
pub fn example(theta: f64, own: Option<Arc>, other: Option<Arc>) -> Pcr {
    Pcr { r: 0.3, v: 0.4, theta, own, other }
}

/// The true time range, on which the corrected form, the definition and the library agree.
///
/// # Panics
/// If one of them does not.
#[track_caller]
pub fn true_time(pcr: &Pcr) -> Range {
    let range = pcr.time_range();
    assert_range(definition::time_range(pcr), range, SAME);
    assert_range(kernels::find(pcr, true, &[]).time, range, SAME);
    range
}

/// The true length range, on which the corrected form, the definition and the library agree.
///
/// # Panics
/// If one of them does not.
#[track_caller]
pub fn true_length(pcr: &Pcr) -> Range {
    let range = pcr.length_range();
    assert_range(definition::length_range(pcr), range, SAME);
    assert_range(kernels::find(pcr, true, &[]).length, range, SAME);
    range
}

/// The true slice, on which the corrected form and the library agree, with contact at its ends.
///
/// # Panics
/// If one of them does not.
#[track_caller]
pub fn true_slice(pcr: &Pcr, t: f64) -> Range {
    let found = kernels::find(pcr, true, &[t]);
    assert_eq!(found.slices[0].len(), 1, "{found:?}");
    let range = pcr.slice(t).expect("a slice");
    assert_range(found.slices[0][0], range, SAME);
    for l in range {
        let [contact, centre] =
            [definition::point(0.0, pcr.own, l), definition::point(pcr.theta, pcr.other, pcr.v * t)];
        assert!((norm([contact[0] - centre[0], contact[1] - centre[1]]) - pcr.r).abs() < SAME);
    }
    range
}

/// ρ₂ of AS and AA.
///
/// # Panics
/// For other types.
pub fn own(pcr: &Pcr) -> Arc {
    pcr.own.expect("an arc")
}

/// ρ₁ of SA and AA.
///
/// # Panics
/// For other types.
pub fn other(pcr: &Pcr) -> Arc {
    pcr.other.expect("an arc")
}

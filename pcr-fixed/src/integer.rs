//! The integer operations that are more than one instruction, each in one place.

/// `√square`, rounded to nearest.
///
/// The root of a number below 2⁶² is below 2³¹; larger ones do not come out of the kernels and saturate.
pub(crate) fn sqrt(square: u64) -> u32 {
    let floor = square.isqrt();
    // (r + 1/2)² = r² + r + 1/4
    let root = if square - floor * floor > floor { floor + 1 } else { floor };
    u32::try_from(root).unwrap_or(u32::MAX)
}

/// `dividend / divisor`, rounded down; saturates, also for a divisor of 0.
///
/// The one division of this crate. It has no instruction on a small processor; those who call it say why they do.
pub(crate) fn divide(dividend: u64, divisor: u32) -> u32 {
    let quotient = dividend.checked_div(u64::from(divisor)).unwrap_or(u64::MAX);
    u32::try_from(quotient).unwrap_or(u32::MAX)
}

/// `a · b / 2^SHIFT`, rounded to nearest, for a result that fits.
pub(crate) fn multiply<const SHIFT: u32>(a: i32, b: i32) -> i32 {
    ((i64::from(a) * i64::from(b) + (1 << (SHIFT - 1))) >> SHIFT) as i32
}

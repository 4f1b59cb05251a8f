//! Integer operations that take more than one instruction.

/// `√square`, rounded to nearest.
///
/// The root of a number below 2⁶² is below 2³¹. Larger numbers do not occur in the kernels; they saturate.
pub(crate) fn sqrt(square: u64) -> u32 {
    let floor = square.isqrt();
    // (r + 1/2)² = r² + r + 1/4
    let root = if square - floor * floor > floor { floor + 1 } else { floor };
    u32::try_from(root).unwrap_or(u32::MAX)
}

/// `dividend / divisor`, rounded down. Saturates, also for a divisor of 0.
///
/// The only division of this crate. Small processors have no instruction for it; the callers say why they need it.
pub(crate) fn divide(dividend: u64, divisor: u32) -> u32 {
    let quotient = dividend.checked_div(u64::from(divisor)).unwrap_or(u64::MAX);
    u32::try_from(quotient).unwrap_or(u32::MAX)
}

/// `a · b / 2^SHIFT`, rounded to nearest. The result must fit.
pub(crate) fn multiply<const SHIFT: u32>(a: i32, b: i32) -> i32 {
    ((i64::from(a) * i64::from(b) + (1 << (SHIFT - 1))) >> SHIFT) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_rounded_to_nearest() {
        for root in [1, 2, 1000, 46_341, (1 << 31) - 1, u64::from(u32::MAX) - 1] {
            // (r - 1/2)² and (r + 1/2)² are r² ∓ r + 1/4.
            let square = root * root;
            let found = [square - root, square - root + 1, square, square + root, square + root + 1].map(sqrt);
            assert_eq!(found.map(u64::from), [root - 1, root, root, root, root + 1]);
        }
        assert_eq!([sqrt(0), sqrt(u64::MAX)], [0, u32::MAX]);
    }

    #[test]
    fn quotients_are_rounded_down_and_saturate() {
        assert_eq!([divide(14, 5), divide(15, 5), divide((1 << 40) - 1, 1 << 20)], [2, 3, (1 << 20) - 1]);
        let largest = u64::from(u32::MAX);
        assert_eq!([divide(7 * largest + 6, 7), divide(7 * largest + 7, 7), divide(u64::MAX, 1)], [u32::MAX; 3]);
        assert_eq!([divide(5, 0), divide(0, 0), divide(0, 5)], [u32::MAX, u32::MAX, 0]);
    }

    #[test]
    fn products_are_rounded_to_nearest_halves_up() {
        assert_eq!([23, 24, 25, -24, -25, 39, 40].map(|a| multiply::<4>(a, 1)), [1, 2, 2, -1, -2, 2, 3]);
        assert_eq!(multiply::<31>(i32::MIN, i32::MAX), -i32::MAX);
        assert_eq!(multiply::<1>(3, -1), -1);
    }
}

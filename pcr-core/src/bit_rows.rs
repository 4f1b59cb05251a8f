//! Rows of bits, one for each of a few neighbours. Tests whose outcome a processor cannot predict are first collected
//! as bits, without a branch, and then evaluated. Also a checksum of numbers.

/// Packs flags into bits; the first flag becomes the lowest bit.
pub(crate) fn row(flags: impl DoubleEndedIterator<Item = bool>) -> u32 {
    flags.rev().fold(0, |row, flag| row << 1 | u32::from(flag))
}

/// Adds a number to a checksum. Each bit of either changes every bit of the result about every other time (Wellons'
/// `triple32`), the last number as well as the first: sums of checksums do not cancel when agents exchange numbers.
// Not inlined: otherwise each number format would have its own copy.
#[inline(never)]
pub(crate) fn digest(sum: u32, number: u32) -> u32 {
    // The constant, because the bijection maps 0 to 0.
    let mut mixed = (sum.rotate_left(5) ^ number).wrapping_add(0x9E37_79B9);
    mixed = (mixed ^ (mixed >> 17)).wrapping_mul(0xED5A_D4BB);
    mixed = (mixed ^ (mixed >> 11)).wrapping_mul(0xAC4C_1B51);
    mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x3184_8BAB);
    mixed ^ (mixed >> 14)
}

/// Indices of the bits that are set, the lowest first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SetBits(pub(crate) u32);

impl Iterator for SetBits {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let place = self.0.trailing_zeros();
        self.0 &= self.0.wrapping_sub(1);
        (place < u32::BITS).then_some(place)
    }
}

/// The runs of consecutive set bits, each as a word with only its bits, the lowest first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BitRuns(pub(crate) u32);

impl BitRuns {
    /// The row without its lowest run: adding the lowest set bit carries through the run.
    pub(crate) fn rest(self) -> u32 {
        self.0 & self.0.wrapping_add(self.0 & self.0.wrapping_neg())
    }
}

impl Iterator for BitRuns {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let rest = self.rest();
        let run = self.0 ^ rest;
        self.0 = rest;
        (run != 0).then_some(run)
    }
}

#[cfg(test)]
mod tests {
    use super::{BitRuns, SetBits, digest, row};

    #[test]
    fn a_bit_of_a_checksum_changes_every_bit_of_the_next_one() {
        const SUMS: u32 = 4096;
        let sums = || (0..SUMS).map(|k| k.wrapping_mul(0x9E37_79B9));
        for bit in 0..32 {
            for (of_sum, of_number) in [(1 << bit, 0), (0, 1 << bit)] {
                for place in 0..32 {
                    let changes = |&sum: &u32| (digest(sum, 1) ^ digest(sum ^ of_sum, 1 ^ of_number)) >> place & 1 == 1;
                    let changed = sums().filter(changes).count() as i32;
                    assert!((changed - SUMS as i32 / 2).abs() < 200, "bit {bit} changes bit {place} {changed} times");
                }
            }
        }
        assert_ne!(digest(0, 0), 0);
    }

    #[test]
    fn the_first_flag_is_the_lowest_bit() {
        assert_eq!(row([true, false, false, true].into_iter()), 0b1001);
        assert_eq!(row([true; 32].into_iter()), u32::MAX);
        assert_eq!(row([].into_iter()), 0);
    }

    #[test]
    fn ones_come_one_by_one_up_to_the_highest_bit() {
        let mut ones = SetBits(0b1000_0000_0000_0000_0000_0000_0000_0101);
        assert_eq!([(); 4].map(|()| ones.next()), [Some(0), Some(2), Some(31), None]);
    }

    #[test]
    fn runs_come_one_by_one_up_to_the_highest_bit() {
        let mut runs = BitRuns(0b1100_0000_0000_0000_0000_0000_0110_1110);
        assert_eq!(runs.next(), Some(0b1110));
        assert_eq!(runs.next(), Some(0b110_0000));
        assert_eq!(runs.next(), Some(0b11 << 30));
        assert_eq!(runs.next(), None);
        assert_eq!((BitRuns(u32::MAX).next(), BitRuns(u32::MAX).rest()), (Some(u32::MAX), 0));
    }
}

//! Rows of bits: which of a few neighbours have something in common. Tests whose outcome is as good as random to a processor
//! are written as bits first, without a branch, and looked at then. And a checksum of numbers by their bits.

/// A row of flags as bits, the first one the lowest.
pub(crate) fn row(flags: impl DoubleEndedIterator<Item = bool>) -> u32 {
    flags.rev().fold(0, |row, flag| row << 1 | u32::from(flag))
}

/// A checksum with one more number in it: a product with an odd constant carries a change upward, the shift down again.
pub(crate) fn digest(sum: u32, number: u32) -> u32 {
    let product = (sum.rotate_left(5) ^ number).wrapping_mul(0x9E37_79B9);
    product ^ (product >> 15)
}

/// The places of the ones in a row, the lowest first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ones(pub(crate) u32);

impl Iterator for Ones {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let place = self.0.trailing_zeros();
        self.0 &= self.0.wrapping_sub(1);
        (place < u32::BITS).then_some(place)
    }
}

/// The runs of a row, each as the bits of it alone, the lowest first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Runs(pub(crate) u32);

impl Runs {
    /// The row without its lowest run: adding the lowest bit carries that away.
    pub(crate) fn rest(self) -> u32 {
        self.0 & self.0.wrapping_add(self.0 & self.0.wrapping_neg())
    }
}

impl Iterator for Runs {
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
    use super::{Ones, Runs, row};

    #[test]
    fn the_first_flag_is_the_lowest_bit() {
        assert_eq!(row([true, false, false, true].into_iter()), 0b1001);
        assert_eq!(row([true; 32].into_iter()), u32::MAX);
        assert_eq!(row([].into_iter()), 0);
    }

    #[test]
    fn ones_come_one_by_one_up_to_the_highest_bit() {
        let mut ones = Ones(0b1000_0000_0000_0000_0000_0000_0000_0101);
        assert_eq!([(); 4].map(|()| ones.next()), [Some(0), Some(2), Some(31), None]);
    }

    #[test]
    fn runs_come_one_by_one_up_to_the_highest_bit() {
        let mut runs = Runs(0b1100_0000_0000_0000_0000_0000_0110_1110);
        assert_eq!(runs.next(), Some(0b1110));
        assert_eq!(runs.next(), Some(0b110_0000));
        assert_eq!(runs.next(), Some(0b11 << 30));
        assert_eq!(runs.next(), None);
        assert_eq!((Runs(u32::MAX).next(), Runs(u32::MAX).rest()), (Some(u32::MAX), 0));
    }
}

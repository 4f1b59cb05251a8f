//! Rows of bits, one for each of a few neighbours. Tests whose outcome a processor cannot predict are first collected
//! as bits, without a branch, and then evaluated. Also a checksum of numbers.

/// Packs flags into bits; the first flag becomes the lowest bit.
pub(crate) fn row(flags: impl DoubleEndedIterator<Item = bool>) -> u32 {
    flags.rev().fold(0, |row, flag| row << 1 | u32::from(flag))
}

/// Adds a number to a checksum: multiplying by an odd constant spreads a change to higher bits, the shift spreads it to
/// lower bits.
pub(crate) fn digest(sum: u32, number: u32) -> u32 {
    let product = (sum.rotate_left(5) ^ number).wrapping_mul(0x9E37_79B9);
    product ^ (product >> 15)
}

/// Indices of the bits that are set, the lowest first.
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

/// The runs of consecutive set bits, each as a word with only its bits, the lowest first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Runs(pub(crate) u32);

impl Runs {
    /// The row without its lowest run: adding the lowest set bit carries through the run.
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

//! The table as text: a line a region, in thousandths for people and in bits for comparison.
//!
//! Written with integers only: the machinery of `core::fmt` would cost more flash than everything else here.

use crate::number::Number;
use heapless::Vec;
use pcr_core::RegionRef;

/// Bytes of the longest line.
const WIDTH: usize = 120;

/// The headings of the columns.
pub const HEADING: &[u8] = b"ego other     from [s]    to [s]  from [m]    to [m]    time, length: bits\n";

/// A line of text.
#[derive(Debug, Default)]
pub struct Line(Vec<u8, WIDTH>);

impl Line {
    /// Its bytes.
    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// Adds text. What does not fit is left out.
    pub fn text(mut self, text: &[u8]) -> Self {
        text.iter().for_each(|&byte| self.push(byte));
        self
    }

    /// Adds a number, right-aligned.
    pub fn integer(self, value: u32, width: usize) -> Self {
        self.digits(value, 0, false, width)
    }

    /// Adds a number of thousandths with three decimals, right-aligned.
    pub fn thousandths(self, value: i32, width: usize) -> Self {
        self.digits(value.unsigned_abs(), 3, value < 0, width)
    }

    /// Adds eight hexadecimal digits.
    pub fn bits(mut self, bits: u32) -> Self {
        for shift in (0..8).rev() {
            let nibble = (bits >> (4 * shift)) as u8 & 0xf;
            self.push(if nibble < 10 { b'0' + nibble } else { b'a' + nibble - 10 });
        }
        self
    }

    fn digits(mut self, value: u32, decimals: usize, negative: bool, width: usize) -> Self {
        let mut reversed: Vec<u8, 13> = Vec::new();
        let mut rest = value;
        // Ten digits, a point and a sign fit.
        let mut add = |byte| {
            let _ = reversed.push(byte);
        };
        for place in 0..10 {
            if rest == 0 && place > decimals {
                break;
            }
            if place == decimals && decimals > 0 {
                add(b'.');
            }
            add(b'0' + (rest % 10) as u8);
            rest /= 10;
        }
        if negative {
            add(b'-');
        }
        for _ in reversed.len()..width {
            self.push(b' ');
        }
        reversed.iter().rev().for_each(|&byte| self.push(byte));
        self
    }

    fn push(&mut self, byte: u8) {
        let _ = self.0.push(byte);
    }
}

/// One region.
pub fn region<S: Number>(region: &RegionRef<'_, S>) -> Line {
    let (time, length) = (region.time(), region.length());
    let ends = [time.lo, time.hi, length.lo, length.hi];
    let line = Line::default().integer(region.ego() as u32, 3).integer(region.other() as u32, 6).text(b"   ");
    let line = ends.iter().fold(line, |line, end| line.thousandths(end.thousandths(), 10));
    let line = ends.iter().fold(line.text(b"   "), |line, end| line.text(b" ").bits(end.bits()));
    line.text(b"\n")
}

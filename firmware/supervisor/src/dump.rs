//! The table as text: one line for each region, in thousandths for people and in bits for comparisons; and the whole
//! table in bits, with its paths and motions, for `pcr certify --table` (docs/theory/certificates.md has the format).
//!
//! It uses integers only: the code of `core::fmt` would take more flash than everything else here.

use crate::frame::CRC;
use crate::number::Number;
use heapless::Vec;
use pcr_core::{
    Branch, Curve, Ecm, EcmEntry, Interval, MismatchError, Motion, Piece, PieceRef, RegionRef, TurnSide, excess,
};

/// Length of the longest line in bytes.
const WIDTH: usize = 120;

/// Headings of the columns.
pub const HEADING: &[u8] = b"ego other     from [s]    to [s]  from [m]    to [m]    time, length: bits\n";

/// A line of text.
#[derive(Debug, Default)]
pub struct Line(Vec<u8, WIDTH>);

impl Line {
    /// The bytes of the line.
    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// Adds text; the part that does not fit is left out.
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

    /// Adds a space and a count.
    fn count(self, count: usize) -> Self {
        self.text(b" ").integer(count as u32, 0)
    }

    /// Adds numbers, each a space and its bits.
    fn numbers<S: Number>(self, numbers: &[S]) -> Self {
        numbers.iter().fold(self, |line, number| line.text(b" ").bits(number.bits()))
    }

    /// Adds both ends of each interval.
    fn ranges<S: Number>(self, ranges: &[Interval<S>]) -> Self {
        ranges.iter().fold(self, |line, range| line.numbers(&[range.lo, range.hi]))
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

/// Writes a whole table in bits, line by line.
///
/// # Errors
/// [`MismatchError`] if it is not the table of the fleet.
pub fn table<S: Number, R: AsRef<[EcmEntry]>, P: AsRef<[Piece<S>]>>(
    fleet: &[Motion<'_, S>],
    table: &Ecm<S, R, P>,
    mut print: impl FnMut(&[u8]),
) -> Result<(), MismatchError> {
    let mut check = CRC.digest();
    let mut send = |line: Line| {
        let line = line.text(b"\n");
        check.update(line.as_bytes());
        print(line.as_bytes());
    };
    send(Line::default().text(b"pcr-table 1 ").text(S::NAME.as_bytes()).count(fleet.len()));
    fleet.iter().for_each(|motion| agent(motion, &mut send));
    // `enumerate` would check its counter for overflow.
    for (i, first) in (0..fleet.len()).zip(fleet) {
        for (j, second) in (0..fleet.len()).zip(fleet).skip(i.saturating_add(1)) {
            let count = table.pair(fleet, i, j)?.fold(0_usize, |count, _| count.saturating_add(1));
            send(Line::default().text(b"pair").count(i).count(j).count(count).numbers(&[excess(first, second)]));
            for region in table.pair(fleet, i, j)? {
                let count = region.pieces().fold(0_usize, |count, _| count.saturating_add(1));
                let lengths = [region.length(), region.other_length()];
                let times = [region.clone().swapped().time(), region.time()];
                send(Line::default().text(b"region").count(count).ranges(&lengths).ranges(&times));
                region.pieces().for_each(|own| send(piece(&own)));
            }
        }
    }
    let end = Line::default().text(b"end ").bits(check.finalize()).text(b"\n");
    print(end.as_bytes());
    Ok(())
}

/// Writes an agent with the lines and arcs of its path, and its phases.
fn agent<S: Number>(motion: &Motion<'_, S>, send: &mut impl FnMut(Line)) {
    let (path, phases) = (motion.path(), motion.profile().phases());
    let (segments, start) = (path.segments(), path.point_at(S::ZERO));
    let line = Line::default().text(b"agent").count(segments.len()).count(phases.len());
    let line = line.numbers(&[motion.radius(), start.x, start.y]).text(b" ");
    let heading = segments.first().map_or(0, |first| S::angle_bits(first.heading_at(S::ZERO)));
    send(line.bits(heading).numbers(&[motion.time().lo, motion.lag(), motion.time_excess()]));
    let ends = segments.iter().skip(1).map(|next| next.from()).chain([path.length()]);
    for (segment, to) in segments.iter().zip(ends) {
        let line = match segment.curve() {
            Curve::Line => Line::default().text(b"line"),
            Curve::Arc { radius, turn: TurnSide::Left } => Line::default().text(b"left").numbers(&[radius]),
            Curve::Arc { radius, turn: TurnSide::Right } => Line::default().text(b"right").numbers(&[radius]),
            // The reader of dumps refuses it: it has discs that go on only.
            Curve::Pivot { lever, .. } => Line::default().text(b"pivot").numbers(&[lever]),
        };
        send(line.numbers(&[segment.length(), segment.from(), to]));
    }
    for phase in phases {
        send(Line::default().text(b"phase").ranges(&[phase.time(), phase.length()]).numbers(&phase.speed()));
    }
}

fn piece<S: Number>(piece: &PieceRef<'_, S>) -> Line {
    let line = piece.segments.iter().fold(Line::default().text(b"piece"), |line, segment| line.count(*segment));
    let share: &[u8] = match piece.share {
        Branch::Only => b" only",
        Branch::Start => b" start",
        Branch::End => b" end",
    };
    line.text(share).ranges(&[piece.length, piece.other_length])
}

//! A table as a microcontroller prints it: lines of words, every number as the bits that it is held in.
//!
//! ```text
//! pcr-table 1 FORMAT AGENTS            f32, micro, q20, q16 or q12
//! agent SEGMENTS PHASES  radius x y heading start lag time-excess
//! line  length from to                 SEGMENTS lines of these three kinds
//! left  radius length from to
//! right radius length from to
//! phase time time length length speed speed
//! pair I J REGIONS  excess             every two agents
//! region PIECES  length length  other other  time time  other's time time
//! piece SEGMENT SEGMENT SHARE  length length  other other     only, start or end
//! end CRC                              CRC-32 of all lines before, ends of lines included
//! ```
//!
//! Counts are decimal, all else is hexadecimal: IEEE 754, two's complement, angles in radians or in parts of 2^32 of a turn. What stands
//! before the first line and behind the last one does not count. A table that is cut, has another line in it or one twice, is an error.

use crate::error::{CertifyError, InputPart};
use crate::raw::{
    RawAgent, RawAngle, RawBranch, RawMotion, RawPair, RawPath, RawPhase, RawPiece, RawRegion, RawSegment, RawTable,
};

/// Version of what is read.
const VERSION: &str = "1";

/// A number format by its name.
#[derive(Clone, Copy, Debug)]
enum DumpFormat {
    Float,
    Fixed(i32),
}

impl DumpFormat {
    fn named(name: &str) -> Result<Self, CertifyError> {
        match name {
            "f32" | "micro" => Ok(Self::Float),
            "q20" => Ok(Self::Fixed(20)),
            "q16" => Ok(Self::Fixed(16)),
            "q12" => Ok(Self::Fixed(12)),
            _ => Err(CertifyError::UnknownFormat(name.to_owned())),
        }
    }

    fn number(self, bits: u32) -> Result<f64, CertifyError> {
        let value = match self {
            Self::Float => f64::from(f32::from_bits(bits)),
            Self::Fixed(digits) => f64::from(bits.cast_signed()) * f64::powi(2.0, -digits),
        };
        if value.is_finite() { Ok(value) } else { Err(CertifyError::NotFinite(bits)) }
    }

    fn angle(self, bits: u32) -> Result<RawAngle, CertifyError> {
        match self {
            Self::Float => self.number(bits).map(RawAngle::Radians),
            Self::Fixed(_) => Ok(RawAngle::Turns(f64::from(bits.cast_signed()) / 4_294_967_296.0)),
        }
    }

    /// What all lengths are multiples of \[m\], if there is such a number.
    fn step(self) -> f64 {
        match self {
            Self::Float => 0.0,
            Self::Fixed(digits) => f64::powi(2.0, -digits),
        }
    }

    /// What a sum of lengths up to this one may be off \[m\].
    fn rounding(self, length: f64) -> f64 {
        match self {
            Self::Float => f64::from(f32::EPSILON) * length,
            Self::Fixed(_) => 0.0,
        }
    }
}

/// CRC-32 of IEEE 802.3, bit by bit.
fn check(sum: u32, bytes: &[u8]) -> u32 {
    bytes.iter().fold(sum, |sum, &byte| {
        let divide = |sum: u32, _| if sum & 1 == 1 { (sum >> 1) ^ 0xedb8_8320 } else { sum >> 1 };
        (0..8).fold(sum ^ u32::from(byte), divide)
    })
}

/// The words of one line.
struct DumpWords<'a> {
    words: std::str::SplitWhitespace<'a>,
    format: DumpFormat,
}

impl<'a> DumpWords<'a> {
    fn word(&mut self) -> Result<&'a str, CertifyError> {
        self.words.next().ok_or(CertifyError::MissingWord)
    }

    fn count(&mut self) -> Result<usize, CertifyError> {
        let word = self.word()?;
        match word.parse::<u16>() {
            Ok(count) => Ok(usize::from(count)),
            Err(_) => Err(CertifyError::NoCount(word.to_owned())),
        }
    }

    fn bits(&mut self) -> Result<u32, CertifyError> {
        let word = self.word()?;
        // A sign would be read, too.
        let hexadecimal = word.len() == 8 && word.bytes().all(|byte| byte.is_ascii_hexdigit());
        let bits = u32::from_str_radix(word, 16).ok().filter(|_| hexadecimal);
        bits.ok_or_else(|| CertifyError::NotHexadecimal(word.to_owned()))
    }

    fn number(&mut self) -> Result<f64, CertifyError> {
        let bits = self.bits()?;
        self.format.number(bits)
    }

    fn range(&mut self) -> Result<[f64; 2], CertifyError> {
        Ok([self.number()?, self.number()?])
    }

    fn end(mut self) -> Result<(), CertifyError> {
        self.words.next().map_or(Ok(()), |word| Err(CertifyError::ExtraWord(word.to_owned())))
    }
}

fn unexpected(found: &str, expected: &'static str) -> CertifyError {
    CertifyError::Unexpected { found: found.to_owned(), expected }
}

/// The lines of a table.
struct DumpLines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    format: DumpFormat,
    /// Line by line.
    sum: u32,
    /// Of the last line, from 1.
    number: usize,
}

impl<'a> DumpLines<'a> {
    /// The first word of the next line, and its words.
    fn next(&mut self) -> Result<(&'a str, DumpWords<'a>), CertifyError> {
        let (place, line) = self.lines.next().ok_or(CertifyError::Cut)?;
        self.number = place + 1;
        let mut words = DumpWords { words: line.split_whitespace(), format: self.format };
        let first = words.word()?;
        if first != "end" {
            self.sum = check(check(self.sum, line.as_bytes()), b"\n");
        }
        Ok((first, words))
    }

    fn expect(&mut self, name: &'static str) -> Result<DumpWords<'a>, CertifyError> {
        let (first, words) = self.next()?;
        if first == name { Ok(words) } else { Err(unexpected(first, name)) }
    }

    fn agent(&mut self, id: u64) -> Result<RawAgent, CertifyError> {
        let mut words = self.expect("agent")?;
        let [segments, phases] = [words.count()?, words.count()?];
        let (radius, start) = (words.number()?, [words.number()?, words.number()?]);
        let heading = words.bits().and_then(|bits| self.format.angle(bits))?;
        let [from, lag, time_excess] = [words.number()?, words.number()?, words.number()?];
        words.end()?;
        let segments = (0..segments).map(|_| self.segment()).collect::<Result<Vec<_>, _>>()?;
        let phases = (0..phases).map(|_| self.phase()).collect::<Result<_, _>>()?;
        let rounding = self.format.rounding(segments.last().map_or(0.0, |last| last.to));
        let path = RawPath { start, heading, segments, rounding, step: self.format.step() };
        Ok(RawAgent { id, radius, path, travel: Some(RawMotion { start: from, phases, lag, time_excess }) })
    }

    fn segment(&mut self) -> Result<RawSegment, CertifyError> {
        let (kind, mut words) = self.next()?;
        let radius = match kind {
            "line" => None,
            "left" => Some(words.number()?),
            "right" => Some(-words.number()?),
            _ => return Err(unexpected(kind, "line, left or right")),
        };
        if radius.is_some_and(|radius| (radius < 0.0) != (kind == "right")) {
            return Err(CertifyError::RadiusNotPositive);
        }
        let [length, from, to] = [words.number()?, words.number()?, words.number()?];
        words.end()?;
        Ok(RawSegment { length, radius, turns: Vec::new(), from, to })
    }

    fn phase(&mut self) -> Result<RawPhase, CertifyError> {
        let mut words = self.expect("phase")?;
        let phase = RawPhase { time: words.range()?, length: words.range()?, speed: words.range()? };
        words.end()?;
        Ok(phase)
    }

    fn pair(&mut self, mut words: DumpWords<'_>) -> Result<RawPair, CertifyError> {
        let agents = [words.count()?, words.count()?];
        let (count, excess) = (words.count()?, words.number()?);
        words.end()?;
        let mut pair = RawPair { agents, excess, regions: Vec::new(), pieces: Vec::new() };
        for region in 0..count {
            let mut words = self.expect("region")?;
            let pieces = words.count()?;
            let lengths = [words.range()?, words.range()?];
            let times = Some([words.range()?, words.range()?]);
            words.end()?;
            pair.regions.push(RawRegion { lengths, times });
            for _ in 0..pieces {
                pair.pieces.push(self.piece(region)?);
            }
        }
        Ok(pair)
    }

    fn piece(&mut self, region: usize) -> Result<RawPiece, CertifyError> {
        let mut words = self.expect("piece")?;
        let segments = [words.count()?, words.count()?];
        let share = match words.word()? {
            "only" => RawBranch::Only,
            "start" => RawBranch::Start,
            "end" => RawBranch::End,
            other => return Err(CertifyError::NoShare(other.to_owned())),
        };
        let lengths = [words.range()?, words.range()?];
        words.end()?;
        Ok(RawPiece { segments, lengths, share, region })
    }

    /// The pairs, up to the end.
    fn pairs(&mut self) -> Result<Vec<RawPair>, CertifyError> {
        let mut pairs = Vec::new();
        loop {
            let (first, mut words) = self.next()?;
            match first {
                "pair" => pairs.push(self.pair(words)?),
                "end" => {
                    let told = words.bits()?;
                    words.end()?;
                    let sum = !self.sum;
                    return if told == sum { Ok(pairs) } else { Err(CertifyError::Checksum { told, sum }) };
                }
                other => return Err(unexpected(other, "pair or end")),
            }
        }
    }
}

/// The table in a text.
///
/// # Errors
/// What is wrong with it, and in which line.
pub fn decode(text: &str) -> Result<RawTable, CertifyError> {
    let is_head = |line: &str| line.split_whitespace().next() == Some("pcr-table");
    match text.lines().filter(|line| is_head(line)).count() {
        0 => return Err(CertifyError::NoTable),
        1 => {}
        count => return Err(CertifyError::Tables(count)),
    }
    let mut lines = DumpLines { lines: text.lines().enumerate(), format: DumpFormat::Float, sum: !0, number: 0 };
    loop {
        let mut ahead = lines.lines.clone();
        if ahead.next().is_some_and(|(_, line)| is_head(line)) {
            break;
        }
        lines.lines = ahead;
    }
    let mut read = || {
        let (_, mut words) = lines.next()?;
        let version = words.word()?;
        if version != VERSION {
            return Err(CertifyError::UnknownVersion(version.to_owned()));
        }
        lines.format = DumpFormat::named(words.word()?)?;
        let count = words.count()?;
        words.end()?;
        let agents = (0..count as u64).map(|id| lines.agent(id)).collect::<Result<_, _>>()?;
        Ok(RawTable { agents, pairs: lines.pairs()?, apart: None })
    };
    let read = read();
    read.map_err(CertifyError::of(InputPart::Line(lines.number)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_check_is_that_of_ieee_802_3() {
        assert_eq!(!check(!0, b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn bits_are_numbers_of_their_format() {
        let number = |name: &str, bits| DumpFormat::named(name).unwrap().number(bits);
        assert_eq!(number("f32", 0xbfc0_0000), Ok(-1.5));
        assert_eq!(number("q16", 0xfffe_8000), Ok(-1.5));
        assert_eq!(number("q20", 0x0018_0000), Ok(1.5));
        assert_eq!(number("q12", 0x8000_0000), Ok(-524_288.0));
        for nothing in [0x7f80_0000, 0xff80_0000, 0x7fc0_0000] {
            assert!(number("micro", nothing).is_err());
        }
        assert_eq!(DumpFormat::Fixed(16).angle(0xc000_0000), Ok(RawAngle::Turns(-0.25)));
        assert!(DumpFormat::named("f64").is_err());
    }
}

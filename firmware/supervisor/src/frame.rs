//! Frames on a serial line: one message each, found again after noise, checked, versioned.
//!
//! ```text
//! 0  COBS( version  who  sequence  place  postcard message ...  CRC-32 )  0
//! ```
//!
//! COBS (Cheshire and Baker 1999) takes the zeros out of a frame, so that a zero begins and ends it: noise before a frame
//! does it no harm, and a receiver is in step after the first zero. Numbers have their low byte first. An answer has who
//! asked, the sequence number of the request, and its place among the answers to it; a request has [`Tag::REQUEST`] for a place. The
//! check has 32 bits because 16 let one damaged frame of 65,536 through. A new version may change everything behind the
//! first byte; within a version, kinds of messages are only ever added.

use crc::{CRC_32_ISO_HDLC, Crc};
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Version of the protocol.
pub const VERSION: u8 = 3;

/// Longest frame before it is encoded: header, message, check.
pub const MAX_PLAIN: usize = 192;
/// Longest frame on the line: one more byte for COBS, and the zeros around it.
pub const MAX_FRAME: usize = MAX_PLAIN + 3;

const HEADER: usize = 7;
const CHECK: usize = 4;
pub(crate) const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

// COBS adds one byte up to this length.
const _: () = assert!(MAX_PLAIN <= 254);

/// Where a message belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tag {
    /// Who asks, or is answered: [`Tag::PLANNER`], or a robot, 1 more than its index. Each counts requests by itself.
    pub who: u16,
    /// Number of the request.
    pub sequence: u16,
    /// Place among the answers to it.
    pub place: u16,
}

impl Tag {
    /// The place of a request.
    pub const REQUEST: u16 = u16::MAX;
    /// Who plans: the one whose requests change the fleet.
    pub const PLANNER: u16 = 0;
}

/// A frame that was received.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame<T> {
    /// Where it belongs.
    pub tag: Tag,
    /// Its check.
    pub check: u32,
    /// What it says.
    pub message: T,
}

/// What is wrong with a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Damage {
    /// It is longer than any message.
    TooLong,
    /// It is shorter than a header and a check.
    TooShort,
    /// A byte of it does not say where the next zero was.
    Stuffing,
    /// The check does not fit the rest.
    Check,
    /// It is of another version, with which the sender may try again.
    Version(u8),
    /// The message is none of this version.
    Message,
}

/// A message as the bytes of a frame. `None` where it is too long.
pub fn encode<T: Serialize>(tag: Tag, message: &T) -> Option<Vec<u8, MAX_FRAME>> {
    encode_version(VERSION, tag, message)
}

/// As [`encode`], with the header of any version: to test that others are refused.
pub fn encode_version<T: Serialize>(version: u8, tag: Tag, message: &T) -> Option<Vec<u8, MAX_FRAME>> {
    let mut plain = [0; MAX_PLAIN];
    let (header, rest) = plain.split_first_chunk_mut::<HEADER>()?;
    let [[a, b], [c, d], [e, f]] = [tag.who, tag.sequence, tag.place].map(u16::to_le_bytes);
    *header = [version, a, b, c, d, e, f];
    let length = postcard::to_slice(message, rest).ok()?.len().checked_add(HEADER)?;
    let check = CRC.checksum(plain.get(..length)?).to_le_bytes();
    plain.get_mut(length..)?.first_chunk_mut::<CHECK>()?.clone_from(&check);
    stuff(plain.get(..length.checked_add(CHECK)?)?)
}

/// COBS: every zero is replaced by the distance to the next one, and so is the end.
fn stuff(plain: &[u8]) -> Option<Vec<u8, MAX_FRAME>> {
    let mut frame = Vec::new();
    frame.push(0).ok()?;
    for run in plain.split(|&byte| byte == 0) {
        frame.push(u8::try_from(run.len()).ok()?.checked_add(1)?).ok()?;
        run.iter().try_for_each(|&byte| frame.push(byte)).ok()?;
    }
    frame.push(0).ok()?;
    Some(frame)
}

/// Which frames a receiver is for. Some lines bring back what one has sent; that is passed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// Those of requests.
    Requests,
    /// Those of answers.
    Answers,
}

/// Collects the bytes of a line into frames.
#[derive(Debug)]
pub struct Receiver {
    reads: Reads,
    bytes: Vec<u8, MAX_PLAIN>,
    /// Bytes until the next stuffed one; 0 is one.
    run: u8,
    damage: Option<Damage>,
    started: bool,
}

impl Receiver {
    /// Nothing received.
    pub const fn new(reads: Reads) -> Self {
        Self { reads, bytes: Vec::new(), run: 0, damage: None, started: false }
    }

    /// Takes a byte; at the end of a frame, the frame, or what is wrong with it.
    pub fn take<T: for<'de> Deserialize<'de>>(&mut self, byte: u8) -> Option<Result<Frame<T>, Damage>> {
        if byte == 0 {
            // Between two zeros there is no frame.
            let frame = if self.started { self.frame().transpose() } else { None };
            *self = Self::new(self.reads);
            return frame;
        }
        match self.run.checked_sub(1) {
            None => {
                // The first run begins the frame, each other one follows a zero.
                if self.started {
                    self.store(0);
                }
                self.run = byte - 1;
            }
            Some(run) => {
                self.run = run;
                self.store(byte);
            }
        }
        self.started = true;
        None
    }

    fn store(&mut self, byte: u8) {
        if self.bytes.push(byte).is_err() {
            self.damage = Some(Damage::TooLong);
        }
    }

    /// The frame, if it is one of those to be read.
    fn frame<T: for<'de> Deserialize<'de>>(&self) -> Result<Option<Frame<T>>, Damage> {
        if let Some(damage) = self.damage {
            return Err(damage);
        }
        if self.run > 0 {
            return Err(Damage::Stuffing);
        }
        let (content, check) = self.bytes.split_last_chunk::<CHECK>().ok_or(Damage::TooShort)?;
        let check = u32::from_le_bytes(*check);
        if CRC.checksum(content) != check {
            return Err(Damage::Check);
        }
        let (&[version, a, b, c, d, e, f], message) = content.split_first_chunk::<HEADER>().ok_or(Damage::TooShort)?;
        if version != VERSION {
            return Err(Damage::Version(version));
        }
        let [who, sequence, place] = [[a, b], [c, d], [e, f]].map(u16::from_le_bytes);
        if (place == Tag::REQUEST) != (self.reads == Reads::Requests) {
            return Ok(None);
        }
        match postcard::take_from_bytes(message) {
            Ok((message, [])) => Ok(Some(Frame { tag: Tag { who, sequence, place }, check, message })),
            _ => Err(Damage::Message),
        }
    }
}

//! Frames on a serial line: each holds one message with a checksum and a version, and can be found again after noise.
//!
//! ```text
//! 0  COBS( version  who  sequence  place  postcard message ...  CRC-32 )  0
//! ```
//!
//! COBS (Cheshire and Baker 1999) removes zeros from a frame, so that a zero can mark its begin and its end. Noise
//! before a frame does no harm, and a receiver is synchronized after the first zero. Numbers are little-endian. An
//! answer contains the asker, the sequence number of the request, and its index among the answers to it; a request has
//! [`Tag::REQUEST`] as index. The check has 32 bits because a check of 16 bits let one damaged frame in 65,536 through.
//! A new version may change everything after the first byte; within a version, kinds of messages are only ever added.

use crc::{CRC_32_ISO_HDLC, Crc};
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Version of the protocol.
pub const VERSION: u8 = 4;

/// Length of the longest frame before encoding: header, message, check.
pub const MAX_PLAIN: usize = 192;
/// Length of the longest frame on the line: one more byte for COBS, and the zeros around it.
pub const MAX_FRAME: usize = MAX_PLAIN + 3;

const HEADER: usize = 7;
const CHECK: usize = 4;
pub(crate) const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

// COBS adds one byte up to this length.
const _: () = assert!(MAX_PLAIN <= 254);

/// Address of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tag {
    /// The client that asks or is answered: [`Tag::PLANNER`], or for a robot its index plus 1. Each client counts its
    /// own requests.
    pub who: u16,
    /// Sequence number of the request.
    pub sequence: u16,
    /// Index among the answers to it.
    pub place: u16,
}

impl Tag {
    /// The index of a request.
    pub const REQUEST: u16 = u16::MAX;
    /// The planner, whose requests change the fleet.
    pub const PLANNER: u16 = 0;

    /// The robot with this index.
    pub(crate) const fn of_robot(agent: u16) -> u16 {
        agent.saturating_add(1)
    }
}

/// A frame that was received.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame<T> {
    /// Address.
    pub tag: Tag,
    /// Check of the frame.
    pub check: u32,
    /// Message.
    pub message: T,
}

/// Why a frame is damaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Damage {
    /// The frame is longer than any message.
    TooLong,
    /// The frame is shorter than a header and a check.
    TooShort,
    /// A byte of the encoding does not point to the next zero.
    Stuffing,
    /// The check does not match the contents.
    Check,
    /// The frame is of this other version; the sender may try again with the receiver's version.
    Version(u8),
    /// The message is invalid in this version.
    Message,
}

/// Encodes a message as a frame. `None` if it is too long.
pub fn encode<T: Serialize>(tag: Tag, message: &T) -> Option<Vec<u8, MAX_FRAME>> {
    encode_version(VERSION, tag, message)
}

/// Like [`encode`], with the header of any version, to test that other versions are refused.
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

/// COBS encoding: every zero, and the end, is replaced by the distance to the next one.
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

/// The kind of frames that a receiver reads. Some lines echo the frames that were sent; those are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reads {
    /// Frames of requests.
    Requests,
    /// Frames of answers.
    Answers,
}

/// Assembles the bytes of a line into frames.
#[derive(Debug)]
pub struct Receiver {
    reads: Reads,
    bytes: Vec<u8, MAX_PLAIN>,
    /// Bytes until the next encoded zero; if it is 0, this byte is one.
    run: u8,
    too_long: bool,
    started: bool,
}

impl Receiver {
    /// A receiver that has received nothing.
    pub const fn new(reads: Reads) -> Self {
        Self { reads, bytes: Vec::new(), run: 0, too_long: false, started: false }
    }

    /// Processes a byte. At the end of a frame it returns the frame, or why it is damaged.
    pub fn take<T: for<'de> Deserialize<'de>>(&mut self, byte: u8) -> Option<Result<Frame<T>, Damage>> {
        if byte == 0 {
            // There is no frame between two consecutive zeros.
            let frame = if self.started { self.frame().transpose() } else { None };
            *self = Self::new(self.reads);
            return frame;
        }
        match self.run.checked_sub(1) {
            None => {
                // The first run begins the frame; every other one follows a zero.
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
            self.too_long = true;
        }
    }

    /// The frame, if it is of the kind that is read.
    fn frame<T: for<'de> Deserialize<'de>>(&self) -> Result<Option<Frame<T>>, Damage> {
        if self.too_long {
            return Err(Damage::TooLong);
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

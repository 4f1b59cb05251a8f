//! Frames on a serial line: one message each, found again after noise, checked, versioned.
//!
//! ```text
//! COBS( version  sequence  postcard message ...  CRC-16/X-25, low byte first )  0
//! ```
//!
//! COBS (Cheshire and Baker 1999) takes the zeros out of a frame, so that a zero ends it and a receiver is in step
//! after the first. An answer has the sequence number of its request. A new version may change everything behind the
//! first byte; within a version, kinds of messages are only ever added.

use crc::{CRC_16_IBM_SDLC, Crc};
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Version of the protocol.
pub const VERSION: u8 = 1;

/// Longest frame before it is encoded: header, message, check.
pub const MAX_PLAIN: usize = 192;
/// Longest frame on the line: one more byte for COBS, and the zero at the end.
pub const MAX_FRAME: usize = MAX_PLAIN + 2;

const HEADER: usize = 2;
const CHECK: usize = 2;
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_SDLC);

// COBS adds one byte up to this length.
const _: () = assert!(MAX_PLAIN <= 254);

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
pub fn encode<T: Serialize>(sequence: u8, message: &T) -> Option<Vec<u8, MAX_FRAME>> {
    encode_version(VERSION, sequence, message)
}

/// As [`encode`], with the header of any version: to test that others are refused.
pub fn encode_version<T: Serialize>(version: u8, sequence: u8, message: &T) -> Option<Vec<u8, MAX_FRAME>> {
    let mut plain = [0; MAX_PLAIN];
    let (header, rest) = plain.split_first_chunk_mut::<HEADER>()?;
    *header = [version, sequence];
    let length = postcard::to_slice(message, rest).ok()?.len().checked_add(HEADER)?;
    let check = CRC.checksum(plain.get(..length)?).to_le_bytes();
    plain.get_mut(length..)?.first_chunk_mut::<CHECK>()?.clone_from(&check);
    stuff(plain.get(..length.checked_add(CHECK)?)?)
}

/// COBS: every zero is replaced by the distance to the next one, and so is the end.
fn stuff(plain: &[u8]) -> Option<Vec<u8, MAX_FRAME>> {
    let mut frame = Vec::new();
    for run in plain.split(|&byte| byte == 0) {
        frame.push(u8::try_from(run.len()).ok()?.checked_add(1)?).ok()?;
        run.iter().try_for_each(|&byte| frame.push(byte)).ok()?;
    }
    frame.push(0).ok()?;
    Some(frame)
}

/// Collects the bytes of a line into frames.
#[derive(Debug, Default)]
pub struct Receiver {
    bytes: Vec<u8, MAX_PLAIN>,
    /// Bytes until the next stuffed one; 0 is one.
    run: u8,
    damage: Option<Damage>,
    started: bool,
}

impl Receiver {
    /// Nothing received.
    pub const fn new() -> Self {
        Self { bytes: Vec::new(), run: 0, damage: None, started: false }
    }

    /// Takes a byte; at the end of a frame, its sequence number and message, or what is wrong with it and, as far as it
    /// can be told, its sequence number.
    pub fn take<T: for<'de> Deserialize<'de>>(&mut self, byte: u8) -> Option<(u8, Result<T, Damage>)> {
        if byte == 0 {
            let sequence = self.bytes.get(1).copied().unwrap_or(0);
            let message = self.message();
            let started = self.started;
            *self = Self::new();
            // Between two zeros there is no frame.
            return started.then_some((sequence, message));
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

    fn message<T: for<'de> Deserialize<'de>>(&self) -> Result<T, Damage> {
        if let Some(damage) = self.damage {
            return Err(damage);
        }
        if self.run > 0 {
            return Err(Damage::Stuffing);
        }
        let (content, check) = self.bytes.split_last_chunk::<CHECK>().ok_or(Damage::TooShort)?;
        if CRC.checksum(content) != u16::from_le_bytes(*check) {
            return Err(Damage::Check);
        }
        let ([version, _], message) = content.split_first_chunk::<HEADER>().ok_or(Damage::TooShort)?;
        if *version != VERSION {
            return Err(Damage::Version(*version));
        }
        match postcard::take_from_bytes(message) {
            Ok((message, [])) => Ok(message),
            _ => Err(Damage::Message),
        }
    }
}

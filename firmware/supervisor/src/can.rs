//! Authority and progress in messages of 8 bytes, for a CAN bus on which the supervisor and all robots are. Orders, which are longer, come over
//! another line or a transport protocol of the bus.
//!
//! Every message may be lost, repeated, late or overtaken by another one: places and authority only grow, and carry the edition of the orders.
//! The bus finds damaged frames itself.
//!
//! ```text
//! identifier, 11 bits     the kind in the upper three, the robot in the lower eight; the bus sends lower numbers first
//! data, lowest byte first  run: u16, number: u16, length: the bits of the number format, 32 bits
//! ```

use crate::message::{Answer, Edition, Refusal, Request};
use crate::number::Number;
use core::fmt;
use heapless::Vec;
use pcr_core::Interval;

/// Messages in one frame of CAN FD.
pub const MESSAGES: usize = 6;
/// Bytes of a message in a frame of CAN FD: its identifier, and eight.
const RECORD: usize = 10;
/// Sizes of a frame of CAN FD with at least one message.
const SIZES: [usize; 6] = [12, 20, 24, 32, 48, 64];

/// A frame of CAN.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Identifier of 11 bits.
    pub id: u16,
    /// All eight bytes are sent.
    pub data: [u8; 8],
}

/// A message about a robot with an index of at most 255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Message<S> {
    /// From the supervisor to the robot: how far it may go, as [`Answer::Go`].
    Go(Length<S>),
    /// From the supervisor to all: the robot has come so far, as [`Answer::Place`].
    Place(Length<S>),
    /// From the supervisor to the robot: its report was about other orders than these. It asks for its orders.
    Edition {
        /// Index of the robot.
        agent: u8,
        /// Edition of the orders.
        edition: Edition,
    },
    /// From the supervisor to the robot: its report was refused.
    Refused {
        /// Index of the robot.
        agent: u8,
        /// The number of the kind of [`Refusal`].
        why: u8,
    },
    /// From the robot to the supervisor: the lower end of its place, as [`Request::Report`].
    Report(Length<S>),
}

/// A length along the path of a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length<S> {
    /// Index of the robot.
    pub agent: u8,
    /// Edition of the orders.
    pub edition: Edition,
    /// Travelled length \[m\].
    pub length: S,
}

/// Why a frame is no message, or a message cannot be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanError {
    /// No message has this identifier.
    Identifier(u16),
    /// The length is not finite, negative, or out of the range of the number format.
    Length,
    /// The frame of CAN FD would be, or is, one of so many bytes, which are not at most six whole messages.
    Size(usize),
    /// Indices of robots are at most 255.
    Agent(u16),
}

impl fmt::Display for CanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Identifier(id) => write!(f, "no message has the identifier {id}"),
            Self::Length => f.write_str("the length is not one that a robot can have travelled"),
            Self::Size(bytes) => write!(f, "{bytes} bytes are not at most six whole messages"),
            Self::Agent(agent) => write!(f, "robot {agent}: indices on the bus are at most 255"),
        }
    }
}

impl core::error::Error for CanError {}

impl<S: Number> Message<S> {
    /// The message with which the supervisor sends an answer to the report of a robot; `None` for answers that are no part of a report.
    ///
    /// # Errors
    /// [`CanError::Agent`].
    pub fn of_answer(robot: u16, answer: &Answer<S>) -> Result<Option<Self>, CanError> {
        let length = |agent, edition, length| Ok::<_, CanError>(Length { agent: index(agent)?, edition, length });
        Ok(Some(match *answer {
            Answer::Go { agent, edition, to } => Self::Go(length(agent, edition, to)?),
            Answer::Place { agent, edition, at } => Self::Place(length(agent, edition, at)?),
            Answer::Refused(Refusal::Edition(edition)) => Self::Edition { agent: index(robot)?, edition },
            Answer::Refused(ref refusal) => {
                // The number of the kind comes first.
                let mut bytes = [u8::MAX; 64];
                let why = postcard::to_slice(refusal, &mut bytes).ok().and_then(|bytes| bytes.first().copied());
                Self::Refused { agent: index(robot)?, why: why.unwrap_or(u8::MAX) }
            }
            _ => return Ok(None),
        }))
    }

    /// The answer that [`Robot::hear`](crate::Robot::hear) takes; `None` for a message that is no news of a place or authority.
    pub fn as_answer(&self) -> Option<Answer<S>> {
        match *self {
            Self::Go(Length { agent, edition, length }) => {
                Some(Answer::Go { agent: agent.into(), edition, to: length })
            }
            Self::Place(Length { agent, edition, length }) => {
                Some(Answer::Place { agent: agent.into(), edition, at: length })
            }
            _ => None,
        }
    }

    /// The request that [`Service::answer`](crate::Service::answer) takes; `None` for a message that no robot sends.
    pub fn as_request(&self) -> Option<Request<S>> {
        match *self {
            Self::Report(Length { agent, edition, length }) => {
                Some(Request::Report { agent: agent.into(), edition, at: Interval::new(length, length) })
            }
            _ => None,
        }
    }

    /// The frame of the message.
    pub fn encode(&self) -> Frame {
        let (kind, agent, edition, bits) = match *self {
            Self::Go(Length { agent, edition, length }) => (0, agent, edition, length.bits()),
            Self::Place(Length { agent, edition, length }) => (1, agent, edition, length.bits()),
            Self::Edition { agent, edition } => (2, agent, edition, 0),
            Self::Refused { agent, why } => (3, agent, Edition::default(), u32::from(why)),
            Self::Report(Length { agent, edition, length }) => (4, agent, edition, length.bits()),
        };
        let [[a, b], [c, d]] = [edition.run, edition.number].map(u16::to_le_bytes);
        let [e, f, g, h] = bits.to_le_bytes();
        Frame { id: kind << 8 | u16::from(agent), data: [a, b, c, d, e, f, g, h] }
    }

    /// The message of a frame.
    ///
    /// # Errors
    /// [`CanError::Identifier`], [`CanError::Length`].
    pub fn decode(frame: &Frame) -> Result<Self, CanError> {
        let [a, b, c, d, e, f, g, h] = frame.data;
        let edition = Edition { run: u16::from_le_bytes([a, b]), number: u16::from_le_bytes([c, d]) };
        let bits = u32::from_le_bytes([e, f, g, h]);
        let [kind, agent] = frame.id.to_be_bytes();
        let length = || {
            let length = S::of_bits(bits);
            let travelled = length.is_finite() && length >= S::ZERO && length <= S::LIMIT;
            if travelled { Ok(Length { agent, edition, length }) } else { Err(CanError::Length) }
        };
        match kind {
            0 => Ok(Self::Go(length()?)),
            1 => Ok(Self::Place(length()?)),
            2 => Ok(Self::Edition { agent, edition }),
            3 => Ok(Self::Refused { agent, why: e }),
            4 => Ok(Self::Report(length()?)),
            _ => Err(CanError::Identifier(frame.id)),
        }
    }
}

/// The data of a frame of CAN FD with these messages, each as its identifier and its eight bytes, and filled up with bytes of 255 to a size
/// that the bus knows. The frame has the identifier of its first message.
///
/// # Errors
/// [`CanError::Size`] for more than [`MESSAGES`].
pub fn pack(frames: &[Frame]) -> Result<Vec<u8, 64>, CanError> {
    let used = frames.len().saturating_mul(RECORD);
    let size = SIZES.into_iter().find(|&size| size >= used).ok_or(CanError::Size(used))?;
    let records = frames.iter().flat_map(|Frame { id, data }| id.to_le_bytes().into_iter().chain(*data));
    // There is room for the largest size.
    Ok(records.chain(core::iter::repeat(u8::MAX)).take(size).collect())
}

/// The messages in the data of a frame of CAN FD.
///
/// # Errors
/// [`CanError::Size`] if it does not end after a message, but for the bytes with which the bus fills it up.
pub fn unpack(data: &[u8]) -> Result<Vec<Frame, MESSAGES>, CanError> {
    let (records, rest) = data.as_chunks::<RECORD>();
    let mut frames = Vec::new();
    let filled = |bytes: &[u8]| bytes.iter().all(|&byte| byte == u8::MAX);
    for (place, &[low, high, a, b, c, d, e, f, g, h]) in records.iter().enumerate() {
        if filled(data.get(place.saturating_mul(RECORD)..).unwrap_or_default()) {
            return Ok(frames);
        }
        let frame = Frame { id: u16::from_le_bytes([low, high]), data: [a, b, c, d, e, f, g, h] };
        frames.push(frame).map_err(|_| CanError::Size(data.len()))?;
    }
    if filled(rest) { Ok(frames) } else { Err(CanError::Size(data.len())) }
}

fn index(agent: u16) -> Result<u8, CanError> {
    u8::try_from(agent).map_err(|_| CanError::Agent(agent))
}

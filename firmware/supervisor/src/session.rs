//! The supervisor on a line that loses, repeats, damages and reorders frames: each request is executed once, and late
//! ones are refused.
//!
//! Requests are numbered: the first after power-up has 1, and 65535 is followed by 2, so that a restart of the
//! supervisor is noticed. The next number is executed; a repetition of the last one gets the same answer; all others
//! are refused ([`Refusal::Sequence`]). Requests of robots are executed whatever their number is, possibly twice, late
//! and in any order ([`Request::is_of_robots`]). A greeting is answered whatever its number is, and uses none up. 0 is
//! the number of a damaged frame.

use crate::agent::{Agent, Step};
use crate::frame::{self, Reads, Receiver, Tag};
use crate::message::{Answer, Refusal, Request};
use crate::number::Number;
use crate::service::{self, Regions, Service};
use crate::table::Table;
use heapless::Vec;

/// The sequence number after this one.
pub const fn after(sequence: u16) -> u16 {
    match sequence.checked_add(1) {
        Some(next) => next,
        None => 2,
    }
}

/// The output of the line; a closure that takes frames can be used.
pub trait Line {
    /// Sends a frame.
    fn send(&mut self, frame: &[u8]);

    /// Called during long computations, like [`Replies::pause`](service::Replies::pause).
    fn pause(&mut self) {}
}

impl<F: FnMut(&[u8])> Line for F {
    fn send(&mut self, frame: &[u8]) {
        self(frame);
    }
}

/// A [`Service`] behind a line, meant to be a `static`.
#[derive(Debug)]
pub struct Session<S: Number, const A: usize, const N: usize, const R: usize, const P: usize, T = Regions<S, R, P>> {
    service: Service<S, A, N, R, P, T>,
    receiver: Receiver,
    /// A list, because an `Option` without a value would not be all zeros.
    last: Vec<Last<S>, 1>,
}

/// The request that was executed last.
#[derive(Debug)]
struct Last<S: Number> {
    sequence: u16,
    /// Check of its frame, which tells a repetition from another request with the same number.
    check: u32,
    /// The answer; `None` if the request changes nothing and is answered again by executing it.
    answer: Option<Answer<S>>,
}

impl<S: Number, const A: usize, const N: usize, const R: usize, const P: usize> Session<S, A, N, R, P> {
    /// A session without agents and orders, and a fleet that can be loaded.
    pub const fn new(built_in: &'static [Agent<S, &'static [Step<S>]>]) -> Self {
        Self::of(Service::new(built_in))
    }
}

impl<S: Number, T, const A: usize, const N: usize, const R: usize, const P: usize> Session<S, A, N, R, P, T> {
    /// A session for this service.
    pub const fn of(service: Service<S, A, N, R, P, T>) -> Self {
        Self { service, receiver: Receiver::new(Reads::Requests), last: Vec::new() }
    }
}

impl<S, T, const A: usize, const N: usize, const R: usize, const P: usize> Session<S, A, N, R, P, T>
where
    S: Number,
    T: Table<S, R, P>,
{
    /// Puts a fleet in the place of the one that can be loaded.
    pub fn build_in(&mut self, fleet: &'static [Agent<S, &'static [Step<S>]>]) {
        self.service.build_in(fleet);
    }

    /// Processes a byte from the line: calls [`Line::send`] for each frame to be sent.
    pub fn take(&mut self, byte: u8, line: &mut impl Line) {
        let Some(received) = self.receiver.take::<Request<S>>(byte) else { return };
        let mut replies = Replies { tag: Tag { who: Tag::PLANNER, sequence: 0, place: 0 }, line, last: None };
        match received {
            Err(damage) => replies.say(&Answer::<S>::Refused(Refusal::Frame(damage))),
            Ok(frame) => {
                (replies.tag.who, replies.tag.sequence) = (frame.tag.who, frame.tag.sequence);
                if frame.tag.who == Tag::PLANNER {
                    self.done(frame.tag.sequence, frame.check, frame.message, replies);
                } else if frame.message.is_of_robots()
                    && frame.message.robot().is_none_or(|agent| Tag::of_robot(agent) == frame.tag.who)
                {
                    let next = self.next();
                    self.service.answer(frame.message, next, replies);
                } else {
                    replies.say(&Answer::<S>::Refused(Refusal::Robot));
                }
            }
        }
    }

    /// Sequence number of the planner's next request.
    fn next(&self) -> u16 {
        self.last.first().map_or(1, |last| after(last.sequence))
    }

    fn done(&mut self, sequence: u16, check: u32, request: Request<S>, mut replies: Replies<'_, S, impl Line>) {
        let next = self.next();
        let answer = match self.last.first() {
            _ if request == Request::Hello => None,
            Some(last) if (last.sequence, last.check) == (sequence, check) => last.answer.clone(),
            _ if sequence == next => None,
            _ => Some(Answer::Refused(Refusal::Sequence { next })),
        };
        if let Some(answer) = answer {
            return replies.say(&answer);
        }
        let (greeting, changes) = (request == Request::Hello, request.changes());
        let mut answer = None;
        let last = changes.then_some(&mut answer);
        self.service.answer(request, next, Replies { tag: replies.tag, line: replies.line, last });
        if !greeting {
            self.last = Vec::from_array([Last { sequence, check, answer }]);
        }
    }
}

/// Sends the answers to a request with their indices.
struct Replies<'a, S: Number, L> {
    tag: Tag,
    line: &'a mut L,
    /// Where the last answer is kept, if it has to be.
    last: Option<&'a mut Option<Answer<S>>>,
}

impl<S: Number, L: Line> Replies<'_, S, L> {
    fn say(&mut self, answer: &Answer<S>) {
        // Every answer is shorter than the longest frame (`tests/wire.rs`); a longer one would be skipped.
        if let Some(bytes) = frame::encode(self.tag, answer) {
            self.line.send(&bytes);
        }
        self.tag.place = self.tag.place.saturating_add(1);
    }
}

impl<S: Number, L: Line> service::Replies<S> for Replies<'_, S, L> {
    fn send(&mut self, answer: Answer<S>) {
        self.say(&answer);
        if let Some(last) = &mut self.last {
            **last = Some(answer);
        }
    }

    fn pause(&mut self) {
        self.line.pause();
    }
}

//! The client end of the line: sends one request at a time, and repeats it until the whole answer has arrived.
//!
//! A client has no clock. Its user sends [`Client::frame`] again when [`Event::Again`] says so, and when nothing has
//! arrived for longer than the supervisor may take.

use crate::frame::{self, Frame, MAX_FRAME, Reads, Receiver, Tag};
use crate::message::{Answer, Refusal, Request};
use crate::number::Number;
use crate::session::after;
use core::cmp::Ordering;
use heapless::Vec;

/// The event caused by a byte from the line.
#[derive(Clone, Debug, PartialEq)]
pub enum Event<S: Number> {
    /// The next answer to the request; more follow. Answers to a [`Request::Report`] are passed on as they arrive, in
    /// any order and possibly repeated.
    Answer(Answer<S>),
    /// The last answer to the request, which is finished.
    Last(Answer<S>),
    /// An answer was lost: send the request again.
    Again,
    /// The data changed while they were sent: ask again. Only robots get this.
    Changed,
    /// The supervisor is at another request: it was restarted, or another client talks to it. The request was not
    /// executed, and the state of the fleet is unknown. Wait until no frame can be on its way any more, send a
    /// greeting, and begin with [`Request::Clear`] or [`Request::Load`].
    OutOfStep,
}

/// A client: the planner or a robot.
#[derive(Debug)]
pub struct Client {
    who: u16,
    receiver: Receiver,
    request: Vec<u8, MAX_FRAME>,
    /// Sequence number of the request.
    sequence: u16,
    greeting: bool,
    /// Number of the next greeting. Greetings are counted separately and use up no sequence number.
    greetings: u16,
    /// Sequence number of the next request that is not a greeting.
    next: u16,
    /// Number of answers to the request that have arrived.
    heard: u16,
    waiting: bool,
}

impl Default for Client {
    fn default() -> Self {
        Self::new()
    }
}

impl Client {
    /// The planner; its first request must be [`Request::Hello`].
    pub const fn new() -> Self {
        Self::of(Tag::PLANNER)
    }

    /// The robot with this index. It may send requests that change no fleet ([`Request::is_of_robots`]), in any order.
    /// It counts from 1, so a robot that was restarted waits until no answer to its requests before that can be on its
    /// way any more.
    pub const fn robot(agent: u16) -> Self {
        Self::of(Tag::of_robot(agent))
    }

    const fn of(who: u16) -> Self {
        let receiver = Receiver::new(Reads::Answers);
        Self {
            who,
            receiver,
            request: Vec::new(),
            sequence: 0,
            greeting: false,
            greetings: 1,
            next: 1,
            heard: 0,
            waiting: false,
        }
    }

    /// Begins a request; send its [`Client::frame`] next. Returns `false`, and begins nothing, if the request is too
    /// long for a frame. To give a request up before its last answer, wait until no frame of it can be on its way, and
    /// send a greeting.
    pub fn ask<S: Number>(&mut self, request: &Request<S>) -> bool {
        let greeting = self.who != Tag::PLANNER || *request == Request::Hello;
        let sequence = if greeting { self.greetings } else { self.next };
        let Some(frame) = frame::encode(Tag { who: self.who, sequence, place: Tag::REQUEST }, request) else {
            return false;
        };
        let number = if greeting { &mut self.greetings } else { &mut self.next };
        *number = after(sequence);
        (self.request, self.sequence, self.greeting) = (frame, sequence, greeting);
        (self.heard, self.waiting) = (0, true);
        true
    }

    /// The sequence number of the next request. If a greeting changes it, the fleet is not what it was: the supervisor
    /// was restarted, or another client has talked to it.
    pub fn next(&self) -> u16 {
        self.next
    }

    /// The bytes of the request, to be sent.
    pub fn frame(&self) -> &[u8] {
        &self.request
    }

    /// Processes a byte from the line.
    pub fn take<S: Number>(&mut self, byte: u8) -> Option<Event<S>> {
        // A damaged frame counts as lost, which is noticed later.
        let Frame { tag, message: answer, .. } = self.receiver.take::<Answer<S>>(byte)?.ok()?;
        let own = tag.who == self.who || matches!(answer, Answer::Refused(Refusal::Frame(_)));
        if !self.waiting || !own {
            return None;
        }
        if matches!(answer, Answer::Refused(Refusal::Frame(_))) {
            return Some(Event::Again);
        }
        let greets = self.who != Tag::PLANNER || matches!(answer, Answer::Hello { .. });
        if tag.sequence != self.sequence || greets != self.greeting {
            return None;
        }
        if matches!(answer, Answer::Refused(Refusal::Sequence { .. })) {
            self.waiting = false;
            return Some(Event::OutOfStep);
        }
        // A place or a release is complete by itself. On a line that loses a quarter of all frames, an answer of five
        // frames would almost never arrive completely.
        if matches!(answer, Answer::Place { .. } | Answer::Go { .. }) {
            self.waiting = answer.goes_on();
            return Some(if self.waiting { Event::Answer(answer) } else { Event::Last(answer) });
        }
        // An answer that was received before, or one behind a lost one.
        match tag.place.cmp(&self.heard) {
            // A list of orders has become shorter meanwhile: the rest of the old list will not arrive.
            Ordering::Less if !answer.goes_on() => {
                self.waiting = false;
                return Some(Event::Changed);
            }
            Ordering::Less => return None,
            Ordering::Greater => return (!answer.goes_on()).then_some(Event::Again),
            Ordering::Equal => {}
        }
        self.heard = self.heard.saturating_add(1);
        self.waiting = answer.goes_on();
        if let Answer::Hello { next, .. } = answer {
            self.next = next;
        }
        Some(if self.waiting { Event::Answer(answer) } else { Event::Last(answer) })
    }
}

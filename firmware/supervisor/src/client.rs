//! The other end of the line: asks one thing at a time, and again until all of the answer is there.
//!
//! It has no clock. Whoever uses it sends [`Client::frame`] again whenever [`Event::Again`] says so, and when nothing has
//! come for longer than the supervisor may take.

use crate::frame::{self, Frame, MAX_FRAME, Reads, Receiver, Tag};
use crate::message::{Answer, Refusal, Request};
use crate::number::Number;
use crate::session::after;
use core::cmp::Ordering;
use heapless::Vec;

/// What a byte from the line comes to.
#[derive(Clone, Debug, PartialEq)]
pub enum Event<S: Number> {
    /// The next answer to the request; more follow. Those to a [`Request::Report`] come as they are heard, in any order, and again.
    Answer(Answer<S>),
    /// The last answer to the request: it is done.
    Last(Answer<S>),
    /// Something was lost: send the request again.
    Again,
    /// What was asked for has changed while it was sent: ask anew. Only robots get that.
    Changed,
    /// The supervisor is at another request: it has started anew, or somebody else talks to it. The request was not done,
    /// and nobody knows its fleet. Wait until nothing can be under way, greet it, and begin with [`Request::Clear`] or
    /// [`Request::Load`].
    OutOfStep,
}

/// One who asks.
#[derive(Debug)]
pub struct Client {
    who: u16,
    receiver: Receiver,
    request: Vec<u8, MAX_FRAME>,
    /// Of the request.
    sequence: u16,
    greeting: bool,
    /// Of the next greeting: they are counted by themselves, and use up no number of a request.
    greetings: u16,
    /// Of the next request that is none.
    next: u16,
    /// How many answers to the request have come.
    heard: u16,
    waiting: bool,
}

impl Default for Client {
    fn default() -> Self {
        Self::new()
    }
}

impl Client {
    /// Who plans, and has asked nothing yet; [`Request::Hello`] comes first.
    pub const fn new() -> Self {
        Self::of(Tag::PLANNER)
    }

    /// A robot of this index. It may ask what changes no fleet ([`Request::is_of_robots`]), in any order.
    pub const fn robot(agent: u16) -> Self {
        Self::of(agent.saturating_add(1))
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

    /// Begins a request, whose [`Client::frame`] is then to be sent. `false`, and nothing begun, where it is too long for a
    /// frame. Whoever gives a request up before its last answer waits until nothing of it can be under way, and greets.
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

    /// The sequence number of the next request. Where a greeting changes it, the fleet is not what it was: the supervisor has
    /// started anew, or somebody else has talked to it.
    pub fn next(&self) -> u16 {
        self.next
    }

    /// The bytes of the request, to be sent.
    pub fn frame(&self) -> &[u8] {
        &self.request
    }

    /// Takes a byte from the line.
    pub fn take<S: Number>(&mut self, byte: u8) -> Option<Event<S>> {
        // What is damaged is missing later on.
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
        // A place or a release is complete by itself. On a line that loses a quarter of all frames, an answer of five of them almost never
        // comes whole.
        if matches!(answer, Answer::Place { .. } | Answer::Go { .. }) {
            self.waiting = answer.goes_on();
            return Some(if self.waiting { Event::Answer(answer) } else { Event::Last(answer) });
        }
        // Again, or behind one that is missing.
        match tag.place.cmp(&self.heard) {
            // A list of orders has become shorter meanwhile: the rest of the old one does not come any more.
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

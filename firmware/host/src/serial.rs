//! Talks to a supervisor and checks what it says against the same computation here.

use crate::passing::Supervisor;
use crate::{BuiltIn, motions, store};
use pcr_core::{Ecm, EcmEntry, Limits, Motion, Piece, earliest_start};
use pcr_supervisor::frame::{self, Damage, Reads, Receiver, Tag, VERSION};
use pcr_supervisor::message::{ConflictRecord, PieceRecord, Reason, Refusal, RegionRecord, text};
use pcr_supervisor::scenario::{AGENTS, PIECES, REGIONS};
use pcr_supervisor::{Agent, Answer, Client, Event, Number, Request, Step};
use std::error::Error;
use std::io::{Read, Write};
use std::marker::PhantomData;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// After how long a request is sent again; that does no harm where the first one is still being answered.
const AGAIN: Duration = Duration::from_secs(20);
/// How often. Only a supervisor that says nothing lets that much time pass.
const PATIENCE: u32 = 90;

/// A supervisor behind a serial line.
struct Link {
    child: Child,
    to: ChildStdin,
    from: mpsc::Receiver<u8>,
    client: Client,
    /// Bytes received.
    bytes: usize,
}

impl Link {
    fn start(command: &[&str]) -> Result<Self, Box<dyn Error>> {
        let (program, arguments) = command.split_first().ok_or("no command")?;
        let mut child = Command::new(program).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let to = child.stdin.take().ok_or("no line to the supervisor")?;
        let mut from = child.stdout.take().ok_or("no line from the supervisor")?;
        let (send, bytes) = mpsc::channel();
        thread::spawn(move || {
            let mut byte = [0];
            while from.read_exact(&mut byte).is_ok() && send.send(byte[0]).is_ok() {}
        });
        Ok(Self { child, to, from: bytes, client: Client::new(), bytes: 0 })
    }

    /// Sends a request.
    fn ask<S: Number>(&mut self, request: &Request<S>) -> Result<(), Box<dyn Error>> {
        if !self.client.ask(request) {
            return Err("a request is too long".into());
        }
        self.repeat()
    }

    /// Sends the request again.
    fn repeat(&mut self) -> Result<(), Box<dyn Error>> {
        self.to.write_all(self.client.frame())?;
        Ok(self.to.flush()?)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
        self.to.write_all(bytes)?;
        Ok(self.to.flush()?)
    }

    /// The next byte; `None` where it takes long.
    fn byte(&mut self) -> Result<Option<u8>, Box<dyn Error>> {
        match self.from.recv_timeout(AGAIN) {
            Ok(byte) => {
                self.bytes += 1;
                Ok(Some(byte))
            }
            Err(RecvTimeoutError::Timeout) => Ok(None),
            Err(RecvTimeoutError::Disconnected) => Err("the supervisor has ended".into()),
        }
    }

    /// The next answer to the last request.
    fn hear<S: Number>(&mut self) -> Result<Answer<S>, Box<dyn Error>> {
        let mut patience = PATIENCE;
        loop {
            let event = match self.byte()? {
                Some(byte) => self.client.take(byte),
                None => Some(Event::Again),
            };
            match event {
                None => {}
                Some(Event::Answer(answer) | Event::Last(answer)) => return Ok(answer),
                Some(Event::Changed | Event::OutOfStep) => return Err("the supervisor has started anew".into()),
                Some(Event::Again) => {
                    patience = patience.checked_sub(1).ok_or("the supervisor does not answer")?;
                    self.repeat()?;
                }
            }
        }
    }

    /// The next answer whatever its request.
    fn overhear<S: Number>(&mut self) -> Result<(u16, Answer<S>), Box<dyn Error>> {
        let mut receiver = Receiver::new(Reads::Answers);
        for _ in 0..PATIENCE {
            while let Some(byte) = self.byte()? {
                if let Some(frame) = receiver.take(byte) {
                    let frame = frame.map_err(|damage| format!("a damaged answer: {damage:?}"))?;
                    return Ok((frame.tag.sequence, frame.message));
                }
            }
        }
        Err("the supervisor does not answer".into())
    }

    /// Sends a request and compares the answer.
    fn expect<S: Number>(&mut self, request: &Request<S>, expected: &Answer<S>) -> Result<(), Box<dyn Error>> {
        self.ask(request)?;
        same(&self.hear()?, expected)
    }
}

/// A supervisor behind a serial line, as robots have it.
pub(crate) struct Remote<S> {
    link: Link,
    /// Greetings of the host's own.
    marks: u16,
    format: PhantomData<S>,
}

impl<S> Remote<S> {
    pub(crate) fn start(command: &[&str]) -> Result<Self, Box<dyn Error>> {
        Ok(Self { link: Link::start(command)?, marks: 0, format: PhantomData })
    }
}

impl<S: Number> Supervisor for Remote<S> {
    /// The answer to a greeting behind the bytes tells that they were read.
    fn exchange(&mut self, bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
        self.marks = self.marks.wrapping_add(1);
        let mark = Tag { who: u16::MAX, sequence: self.marks, place: Tag::REQUEST };
        let greeting = frame::encode(mark, &Request::<S>::Hello).ok_or("a greeting is too long")?;
        // A zero ends whatever was cut off.
        self.link.send(&[bytes, &[0], &greeting].concat())?;
        let (mut said, mut frame, mut receiver) = (Vec::new(), Vec::new(), Receiver::new(Reads::Answers));
        for _ in 0..PATIENCE {
            while let Some(byte) = self.link.byte()? {
                frame.push(byte);
                let Some(answer) = receiver.take::<Answer<S>>(byte) else { continue };
                let tag = answer.map_err(|damage| format!("a damaged answer: {damage:?}"))?.tag;
                if (tag.who, tag.sequence) == (mark.who, mark.sequence) {
                    return Ok(said);
                }
                said.append(&mut frame);
            }
        }
        Err("the supervisor does not answer".into())
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        // It never ends by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn same<T: PartialEq + std::fmt::Debug>(seen: &T, expected: &T) -> Result<(), Box<dyn Error>> {
    if seen == expected { Ok(()) } else { Err(format!("expected {expected:?}, got {seen:?}").into()) }
}

/// Runs the whole conversation.
pub(crate) fn check<S: Number>(agents: BuiltIn<S>, command: &[&str]) -> Result<(), Box<dyn Error>> {
    let mut link = Link::start(command)?;
    greet::<S>(&mut link)?;
    damage::<S>(&mut link)?;
    refusals(&mut link, agents)?;
    exchange(&mut link, agents)?;

    link.expect(&Request::<S>::Clear, &Answer::Done)?;
    for (index, agent) in agents.iter().enumerate() {
        let expected = Answer::Fleet { agents: u16::try_from(index + 1)? };
        link.expect(&Request::Add(sendable(agent)?), &expected)?;
    }
    println!("sent {} agents", agents.len());
    repeated(&mut link, agents)?;
    table(&mut link, agents)?;

    link.expect(&Request::<S>::Load, &Answer::Fleet { agents: u16::try_from(agents.len())? })?;
    table(&mut link, agents)?;
    println!("the fleet that is built in has the same table");
    replan(&mut link, agents)
}

fn sendable<S: Number>(agent: &Agent<S, &'static [Step<S>]>) -> Result<Agent<S>, Box<dyn Error>> {
    let path = agent.path.iter().copied().collect();
    Ok(Agent { radius: agent.radius, start_time: agent.start_time, limits: agent.limits, start: agent.start, path })
}

fn greet<S: Number>(link: &mut Link) -> Result<(), Box<dyn Error>> {
    link.ask(&Request::<S>::Hello)?;
    let Answer::<S>::Hello { format, agents, .. } = link.hear()? else {
        return Err("no greeting".into());
    };
    same(&(&format[..], usize::from(agents)), &(S::NAME.as_bytes(), AGENTS))?;
    println!("a supervisor of {agents} agents in {}", S::NAME);
    Ok(())
}

/// Damaged frames are refused by name, and the next good one is understood.
fn damage<S: Number>(link: &mut Link) -> Result<(), Box<dyn Error>> {
    let tag = Tag { who: Tag::PLANNER, sequence: 7, place: Tag::REQUEST };
    let good = frame::encode(tag, &Request::<S>::Hello).ok_or("a greeting is too long")?;
    let other = frame::encode_version(VERSION + 1, tag, &Request::<S>::Hello).ok_or("a greeting is too long")?;
    let mut flipped = good.clone();
    flipped[good.len() - 3] ^= 0x40;
    let mut long = vec![0x11; 300];
    long.push(0);
    // A bit is turned over; the version is another; a run goes on behind the end; there is no check; it never ends.
    let cases: [(&[u8], Damage); 5] = [
        (&flipped, Damage::Check),
        (&other, Damage::Version(VERSION + 1)),
        (&[3, 7, 0], Damage::Stuffing),
        (&[2, 7, 0], Damage::TooShort),
        (&long, Damage::TooLong),
    ];
    for (bytes, damage) in cases {
        link.send(bytes)?;
        same(&link.overhear::<S>()?, &(0, Answer::Refused(Refusal::Frame(damage))))?;
    }
    // Zeros between frames are nothing.
    link.send(&[0, 0, 0])?;
    greet::<S>(link)?;
    println!("damaged frames are refused, and the line recovers");
    Ok(())
}

/// A request that does not fit is refused with a reason and changes nothing.
fn refusals<S: Number>(link: &mut Link, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>> {
    let agent = sendable(agents.first().ok_or("no agents")?)?;
    let refused = |agent, what, why| Answer::Refused(Refusal::Agent { agent, what: text(what), why });
    link.expect(&Request::<S>::Clear, &Answer::Done)?;
    let flat = Agent { radius: S::ZERO, ..agent.clone() };
    link.expect(&Request::Add(flat), &refused(0, "radius", Reason::NonPositive))?;
    let fast = Limits { speed: -agent.limits.speed, ..agent.limits };
    link.expect(
        &Request::Add(Agent { limits: fast, ..agent.clone() }),
        &refused(0, "largest speed", Reason::NonPositive),
    )?;
    // One that stands takes the least room.
    let agent = Agent { path: [].into_iter().collect(), ..agent };
    let most = u16::try_from(AGENTS)?;
    for agents in 1..=most {
        link.expect(&Request::Add(agent.clone()), &Answer::Fleet { agents })?;
    }
    link.expect(&Request::Add(agent), &refused(most, "agent", Reason::Full))?;
    println!("agents that do not fit are refused by name");
    link.expect(&Request::<S>::Row { ego: 0 }, &Answer::Refused(Refusal::NotComputed))?;
    link.expect(&Request::<S>::Replan { agent: 0 }, &Answer::Refused(Refusal::NotComputed))?;
    link.expect(&Request::<S>::Row { ego: most }, &Answer::Refused(Refusal::NoSuchAgent { agent: most }))?;
    println!("so is what is asked of a table that there is not, and of nobody");
    Ok(())
}

/// A request that is sent again is not done again; one that is late is refused.
fn repeated<S: Number>(link: &mut Link, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>> {
    let late = link.client.frame().to_vec();
    let sequence = link.client.next().wrapping_sub(1);
    let fleet = Answer::<S>::Fleet { agents: u16::try_from(agents.len())? };
    link.send(&late)?;
    same(&link.overhear()?, &(sequence, fleet))?;
    link.ask(&Request::<S>::Compute)?;
    link.hear::<S>()?;
    link.send(&late)?;
    let next = link.client.next();
    same(&link.overhear::<S>()?, &(sequence, Answer::Refused(Refusal::Sequence { next })))?;
    println!("a request that comes twice is done once, and one that comes late is refused");
    Ok(())
}

/// Agents are exchanged and removed until the fleet is another one, and its table is that of the same fleet sent at once.
fn exchange<S: Number>(link: &mut Link, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>> {
    let [first, second, third, ..] = agents else { return Err("too few agents".into()) };
    link.expect(&Request::<S>::Load, &Answer::Fleet { agents: u16::try_from(agents.len())? })?;
    for count in (3..u16::try_from(agents.len())?).rev() {
        link.expect(&Request::<S>::Remove { agent: 1 }, &Answer::Fleet { agents: count })?;
    }
    for (agent, with) in [(1, second), (2, third), (0, first)] {
        link.expect(&Request::Replace { agent, with: sendable(with)? }, &Answer::Fleet { agents: 3 })?;
    }
    link.expect(&Request::Row::<S> { ego: 0 }, &Answer::Refused(Refusal::NotComputed))?;
    table(link, &agents[..3])?;
    println!("agents that were exchanged and removed have the table of those that are there");
    Ok(())
}

/// The table of the fleet that was sent is that of the same fleet here, bit by bit.
fn table<S: Number>(link: &mut Link, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>> {
    let store = store(agents)?;
    let fleet = motions(&store);
    let ecm = Ecm::build([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES], &fleet)?;
    let computed = Answer::Computed { regions: u16::try_from(ecm.len())?, pieces: u16::try_from(ecm.pieces())? };
    link.expect(&Request::<S>::Compute, &computed)?;
    let before = link.bytes;
    let (mut regions, mut pieces) = (0, 0);
    for ego in 0..fleet.len() {
        link.ask(&Request::<S>::Row { ego: u16::try_from(ego)? })?;
        let mut row = 0;
        for region in ecm.row(&fleet, ego)? {
            same(&link.hear()?, &Answer::Region(RegionRecord::of(&region)))?;
            for piece in region.pieces() {
                same(&link.hear()?, &Answer::Piece(PieceRecord::of(&piece)))?;
                pieces += 1;
            }
            row += 1;
        }
        same(&link.hear::<S>()?, &Answer::End { count: row })?;
        regions += usize::from(row);
    }
    same(&regions, &(2 * ecm.len()))?;
    let bytes = link.bytes - before;
    println!("{regions} regions with {pieces} pieces in {bytes} bytes, equal to those computed here bit by bit");
    let conflicts = conflicts(link, &fleet)?;
    println!("{conflicts} pairs that conflict, and where they do first, equal bit by bit");
    Ok(())
}

/// The first conflicts are those of these motions; how many are more than a touch.
fn conflicts<S: Number>(link: &mut Link, fleet: &[Motion<'_, S>]) -> Result<u16, Box<dyn Error>> {
    link.ask(&Request::<S>::Conflicts)?;
    let (mut conflicts, mut touching) = (0, 0);
    for first in 0..fleet.len() {
        for second in first + 1..fleet.len() {
            if let Some(conflict) =
                ConflictRecord::first(fleet, [first, second]).map_err(|refusal| format!("{refusal:?}"))?
            {
                touching += u16::from(conflict.touching);
                conflicts += 1;
                same(&link.hear()?, &Answer::Conflict(conflict))?;
            }
        }
    }
    same(&link.hear::<S>()?, &Answer::End { count: conflicts })?;
    Ok(conflicts - touching)
}

/// Agents are planned again one after the other, on both sides alike; afterwards no two agents overlap, though they may touch.
fn replan<S: Number>(link: &mut Link, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>> {
    let store = store(agents)?;
    let mut fleet = motions(&store);
    let ecm = Ecm::build([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES], &fleet)?;
    let before = conflicts(link, &fleet)?;
    let mut planned = 0;
    for agent in 0..fleet.len() {
        let delay = earliest_start(ecm.row(&fleet, agent)?, S::ZERO);
        let answer = match delay {
            Some(delay) => {
                fleet[agent] = fleet[agent].delayed(delay)?;
                planned += 1;
                Answer::Replanned { agent: u16::try_from(agent)?, time: fleet[agent].time() }
            }
            None => Answer::Refused(Refusal::NoPlan),
        };
        link.expect(&Request::<S>::Replan { agent: u16::try_from(agent)? }, &answer)?;
    }
    let nobody = u16::try_from(fleet.len())?;
    link.expect(&Request::<S>::Replan { agent: nobody }, &Answer::Refused(Refusal::NoSuchAgent { agent: nobody }))?;
    let after = conflicts(link, &fleet)?;
    println!("{planned} agents replanned: {before} pairs that conflict before, {after} after, equal bit by bit");
    if planned == fleet.len() && after == 0 { Ok(()) } else { Err("there are conflicts left".into()) }
}

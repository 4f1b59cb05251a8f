//! Talks to a supervisor and checks what it says against the same computation here.

use crate::{BuiltIn, store};
use pcr_core::{Ecm, Limits, Motion, Piece, Region, earliest_start};
use pcr_supervisor::frame::{self, Damage, Receiver, VERSION};
use pcr_supervisor::message::{ConflictRecord, PieceRecord, Reason, Refusal, RegionRecord, text};
use pcr_supervisor::scenario::{AGENTS, PIECES, REGIONS};
use pcr_supervisor::{Agent, Answer, Number, Request};
use std::error::Error;
use std::io::{Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How long the supervisor may take for an answer. Only a supervisor that says nothing takes that long.
const PATIENCE: Duration = Duration::from_secs(60);

/// A supervisor behind a serial line.
struct Link<S: Number> {
    child: Child,
    to: ChildStdin,
    from: mpsc::Receiver<(u8, Result<Answer<S>, Damage>)>,
    sequence: u8,
    /// Bytes received in frames of regions.
    bytes: mpsc::Receiver<usize>,
}

impl<S: Number + Send> Link<S>
where
    S::Angle: Send,
{
    fn start(command: &[&str]) -> Result<Self, Box<dyn Error>> {
        let (program, arguments) = command.split_first().ok_or("no command")?;
        let mut child = Command::new(program).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let to = child.stdin.take().ok_or("no line to the supervisor")?;
        let mut from = child.stdout.take().ok_or("no line from the supervisor")?;
        let (send, answers) = mpsc::channel();
        let (count, bytes) = mpsc::channel();
        thread::spawn(move || {
            let (mut receiver, mut byte, mut length) = (Receiver::new(), [0], 0);
            while from.read_exact(&mut byte).is_ok() {
                length += 1;
                if let Some(answer) = receiver.take::<Answer<S>>(byte[0]) {
                    if count.send(length).is_err() || send.send(answer).is_err() {
                        return;
                    }
                    length = 0;
                }
            }
        });
        Ok(Self { child, to, from: answers, sequence: 0, bytes })
    }

    /// Sends a request.
    fn ask(&mut self, request: &Request<S>) -> Result<(), Box<dyn Error>> {
        self.sequence = self.sequence.wrapping_add(1);
        let bytes = frame::encode(self.sequence, request).ok_or("a request is too long")?;
        self.send(&bytes)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
        self.to.write_all(bytes)?;
        Ok(self.to.flush()?)
    }

    /// The next answer to the last request.
    fn hear(&mut self) -> Result<Answer<S>, Box<dyn Error>> {
        let (sequence, answer) = self.from.recv_timeout(PATIENCE).map_err(|error| match error {
            RecvTimeoutError::Timeout => "the supervisor does not answer",
            RecvTimeoutError::Disconnected => "the supervisor has ended",
        })?;
        let answer = answer.map_err(|damage| format!("a damaged answer: {damage:?}"))?;
        if sequence != self.sequence {
            return Err(format!("answer {sequence} to request {}: {answer:?}", self.sequence).into());
        }
        Ok(answer)
    }

    /// Sends a request and compares the answer.
    fn expect(&mut self, request: &Request<S>, expected: &Answer<S>) -> Result<(), Box<dyn Error>> {
        self.ask(request)?;
        same(&self.hear()?, expected)
    }
}

impl<S: Number> Drop for Link<S> {
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
pub(crate) fn check<S: Number + Send>(agents: BuiltIn<S>, command: &[&str]) -> Result<(), Box<dyn Error>>
where
    S::Angle: Send,
{
    let mut link = Link::<S>::start(command)?;
    greet(&mut link)?;
    damage(&mut link)?;
    refusals(&mut link, agents)?;

    link.expect(&Request::Clear, &Answer::Done)?;
    for (index, agent) in agents.iter().enumerate() {
        let expected = Answer::Added { agents: u16::try_from(index + 1)? };
        link.expect(&Request::Add(sendable(agent)?), &expected)?;
    }
    println!("sent {} agents", agents.len());
    table(&mut link, agents)?;

    link.expect(&Request::Load, &Answer::Added { agents: u16::try_from(agents.len())? })?;
    table(&mut link, agents)?;
    println!("the fleet that is built in has the same table");
    replan(&mut link, agents)
}

fn sendable<S: Number>(agent: &Agent<S, &'static [pcr_supervisor::Step<S>]>) -> Result<Agent<S>, Box<dyn Error>> {
    let path = agent.path.iter().copied().collect();
    Ok(Agent { radius: agent.radius, start_time: agent.start_time, limits: agent.limits, start: agent.start, path })
}

fn greet<S: Number + Send>(link: &mut Link<S>) -> Result<(), Box<dyn Error>>
where
    S::Angle: Send,
{
    link.ask(&Request::Hello)?;
    let Answer::Hello { format, agents, .. } = link.hear()? else {
        return Err("no greeting".into());
    };
    same(&(&format[..], usize::from(agents)), &(S::NAME.as_bytes(), AGENTS))?;
    println!("a supervisor of {agents} agents in {}", S::NAME);
    Ok(())
}

/// Damaged frames are refused by name, and the next good one is understood.
fn damage<S: Number + Send>(link: &mut Link<S>) -> Result<(), Box<dyn Error>>
where
    S::Angle: Send,
{
    link.sequence = 7;
    let good = frame::encode(7, &Request::<S>::Hello).ok_or("a greeting is too long")?;
    let flipped = |at: usize| {
        let mut bytes = good.clone();
        bytes[at] ^= 0x40;
        bytes
    };
    let mut long = vec![0x11; 300];
    long.push(0);
    // A byte in the middle is turned over; the version is (and the check with it); a run goes on behind the end.
    let other_version = other_version::<S>()?;
    let cases: [(&[u8], Damage); 4] = [
        (&flipped(good.len() - 3), Damage::Check),
        (&other_version, Damage::Version(VERSION + 1)),
        (&[3, 7, 0], Damage::Stuffing),
        (&[2, 7, 0], Damage::TooShort),
    ];
    for (bytes, damage) in cases {
        link.send(bytes)?;
        let (_, answer) = link.from.recv_timeout(PATIENCE)?;
        same(&answer, &Ok(Answer::Refused(Refusal::Frame(damage))))?;
    }
    link.send(&long)?;
    let (_, answer) = link.from.recv_timeout(PATIENCE)?;
    same(&answer, &Ok(Answer::Refused(Refusal::Frame(Damage::TooLong))))?;
    // Zeros between frames are nothing.
    link.send(&[0, 0, 0])?;
    greet(link)?;
    println!("damaged frames are refused, and the line recovers");
    Ok(())
}

/// A greeting of the next version, with a good check.
fn other_version<S: Number>() -> Result<Vec<u8>, Box<dyn Error>> {
    let bytes = frame::encode_version(VERSION + 1, 7, &Request::<S>::Hello).ok_or("a greeting is too long")?;
    Ok(bytes.to_vec())
}

/// What does not fit is refused by name and changes nothing.
fn refusals<S: Number + Send>(link: &mut Link<S>, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>>
where
    S::Angle: Send,
{
    let agent = sendable(agents.first().ok_or("no agents")?)?;
    let refused = |what, why| Answer::Refused(Refusal::Agent { what: text(what), why });
    link.expect(&Request::Clear, &Answer::Done)?;
    let flat = Agent { radius: S::ZERO, ..agent.clone() };
    link.expect(&Request::Add(flat), &refused("radius", Reason::NonPositive))?;
    let fast = Limits { speed: -agent.limits.speed, ..agent.limits };
    link.expect(
        &Request::Add(Agent { limits: fast, ..agent.clone() }),
        &refused("largest speed", Reason::NonPositive),
    )?;
    // One that stands takes the least room.
    let agent = Agent { path: [].into_iter().collect(), ..agent };
    for count in 1..=u16::try_from(AGENTS)? {
        link.expect(&Request::Add(agent.clone()), &Answer::Added { agents: count })?;
    }
    link.expect(&Request::Add(agent), &refused("agent", Reason::Full))?;
    println!("agents that do not fit are refused by name");
    Ok(())
}

/// The table of the fleet that was sent is that of the same fleet here, bit by bit.
fn table<S: Number + Send>(link: &mut Link<S>, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>>
where
    S::Angle: Send,
{
    let store = store(agents)?;
    let fleet = store.motions();
    let ecm = Ecm::build([Region::EMPTY; REGIONS], [Piece::EMPTY; PIECES], &fleet)?;
    let computed = Answer::Computed { regions: u16::try_from(ecm.len())?, pieces: u16::try_from(ecm.pieces())? };
    link.expect(&Request::Compute, &computed)?;
    link.bytes.try_iter().for_each(drop);
    let (mut regions, mut pieces) = (0, 0);
    for ego in 0..fleet.len() {
        link.ask(&Request::Row { ego: u16::try_from(ego)? })?;
        let mut row = 0;
        for region in ecm.row(&fleet, ego)? {
            same(&link.hear()?, &Answer::Region(RegionRecord::of(&region)))?;
            for piece in region.pieces() {
                same(&link.hear()?, &Answer::Piece(PieceRecord::of(&piece)))?;
                pieces += 1;
            }
            row += 1;
        }
        same(&link.hear()?, &Answer::End { count: row })?;
        regions += usize::from(row);
    }
    same(&regions, &(2 * ecm.len()))?;
    let bytes: usize = link.bytes.try_iter().sum();
    println!("{regions} regions with {pieces} pieces in {bytes} bytes, equal to those computed here bit by bit");
    let conflicts = conflicts(link, &fleet)?;
    println!("{conflicts} pairs that conflict, and where they do first, equal bit by bit");
    Ok(())
}

/// The first conflicts are those of these motions; how many are more than a touch.
fn conflicts<S: Number + Send>(link: &mut Link<S>, fleet: &[Motion<'_, S>]) -> Result<u16, Box<dyn Error>>
where
    S::Angle: Send,
{
    link.ask(&Request::Conflicts)?;
    let (mut conflicts, mut touching) = (0, 0);
    for first in 0..fleet.len() {
        for second in first + 1..fleet.len() {
            if let Some(conflict) = ConflictRecord::first(fleet, [first, second]) {
                touching += u16::from(conflict.touching);
                conflicts += 1;
                same(&link.hear()?, &Answer::Conflict(conflict))?;
            }
        }
    }
    same(&link.hear()?, &Answer::End { count: conflicts })?;
    Ok(conflicts - touching)
}

/// Agents are replanned as they are here, one after the other; then nobody meets anybody, but for a touch.
fn replan<S: Number + Send>(link: &mut Link<S>, agents: BuiltIn<S>) -> Result<(), Box<dyn Error>>
where
    S::Angle: Send,
{
    let store = store(agents)?;
    let mut fleet = store.motions();
    let ecm = Ecm::build([Region::EMPTY; REGIONS], [Piece::EMPTY; PIECES], &fleet)?;
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
        link.expect(&Request::Replan { agent: u16::try_from(agent)? }, &answer)?;
    }
    let nobody = u16::try_from(fleet.len())?;
    link.expect(&Request::Replan { agent: nobody }, &Answer::Refused(Refusal::NoSuchAgent))?;
    let after = conflicts(link, &fleet)?;
    println!("{planned} agents replanned: {before} pairs that conflict before, {after} after, equal bit by bit");
    if planned == fleet.len() && after == 0 { Ok(()) } else { Err("there are conflicts left".into()) }
}

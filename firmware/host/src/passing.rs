//! Robots under way on a line that loses, cuts, repeats, delays and reorders frames: whatever is lost, no two discs touch.
//!
//! Each run has a fleet of its own, drawn at random and planned by the supervisor. Every robot is a [`Client`] with a [`Briefing`] and
//! a [`Robot`], as on its own controller; between them and the supervisor is one line with faults in both directions. Robots stop
//! at random, get new paths when they have arrived, and in half of the runs lose their memory on the way (*restarts*). They move
//! freely up to their holds; the true positions are checked five times per control step.

use pcr_core::scalar::Angle;
use pcr_core::{Brakes, Curve, Interval, Limits, Pass, Point, Pose, Turn};
use pcr_supervisor::message::{Edition, Refusal, Terms};
use pcr_supervisor::robot::Unclear;
use pcr_supervisor::{
    Agent, Answer, Briefing, Client, Event, Motions, Number, Request, Robot, Service, Session, Step, Traffic,
};
use std::error::Error;

/// Largest number of robots. The capacities of the supervisor below follow from it.
pub(crate) const ROBOTS: usize = 5;
/// Lines and arcs of a path.
const STEPS: usize = 3;
const SEGMENTS: usize = ROBOTS * STEPS;
/// Capacity of the supervisor for segments, with room for the new path of one robot beside its old one.
pub(crate) const ROOM: usize = SEGMENTS + STEPS;
/// Capacities for regions, pieces and orders.
pub(crate) const REGIONS: usize = 48;
pub(crate) const PIECES: usize = 128;
pub(crate) const ORDERS: usize = 2 * REGIONS;

/// Time between two control steps \[s\].
const STEP: f64 = 0.1;
/// Control steps after which no frame from before a restart can still be on the line: 9 s.
const SILENCE: usize = 90;
/// Control steps after which a run is given up: 600 s.
const CONTROLS: usize = 6000;

/// A number of the format, rounded.
pub(crate) trait Rounded: Number {
    /// From a decimal.
    fn from_f64(value: f64) -> Self;
    /// The exact value.
    fn to_f64(self) -> f64;
}

impl Rounded for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

impl Rounded for pcr_core::scalar::Micro {
    fn from_f64(value: f64) -> Self {
        Self(value as f32)
    }
    fn to_f64(self) -> f64 {
        f64::from(self.0)
    }
}

impl Rounded for pcr_fixed::Q16 {
    fn from_f64(value: f64) -> Self {
        Self::from_f64(value).expect("a small number")
    }
    fn to_f64(self) -> f64 {
        Self::to_f64(self)
    }
}

/// Weyl sequence with the finalizer of SplitMix64.
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        self.below(1 << 20) as f64 / f64::from(1 << 20)
    }

    fn chance(&mut self, of_1000: usize) -> bool {
        self.below(1000) < of_1000
    }
}

/// The other end: bytes go there, and what it has said since comes back.
pub(crate) trait Supervisor {
    /// Sends bytes; what it answers to them and to nothing else.
    fn exchange(&mut self, bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>>;
}

/// Counts over all runs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) runs: usize,
    pub(crate) robots: usize,
    /// Orders by which one waits.
    pub(crate) orders: usize,
    /// Paths that were admitted, and refused.
    pub(crate) admitted: usize,
    pub(crate) refused: usize,
    /// Frames on the line, and how many of them suffered a fault.
    pub(crate) frames: usize,
    pub(crate) faults: usize,
    /// Robots that came to the ends of their paths.
    pub(crate) arrived: usize,
    /// Controllers that forgot everything, and those of them that had to find their places.
    pub(crate) restarts: usize,
    pub(crate) resumed: usize,
    /// Least distance between two discs \[m\].
    pub(crate) gap: f64,
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { runs, robots, orders, admitted, refused, frames, faults, arrived, restarts, resumed, gap } = self;
        writeln!(
            f,
            "{runs} runs, {robots} robots, {arrived} at the ends of their paths; {orders} times to wait for one"
        )?;
        writeln!(
            f,
            "{admitted} paths admitted on the way, {refused} refused; {frames} frames, {faults} of them damaged, lost or late"
        )?;
        writeln!(f, "{restarts} controllers restarted, {resumed} of them on the way")?;
        write!(f, "no two discs touch; the least distance is {:.1} mm", gap * 1e3)
    }
}

/// A supervisor in this process.
type Here<S> = Session<S, ROBOTS, ROOM, REGIONS, PIECES, Traffic<S, ROBOTS, REGIONS, PIECES, ORDERS>>;

pub(crate) fn here<S: Rounded>() -> Here<S> {
    Session::of(Service::with(Traffic::new(), &[]))
}

impl<S: Rounded> Supervisor for Here<S> {
    fn exchange(&mut self, bytes: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut said = Vec::new();
        bytes.iter().for_each(|&byte| self.take(byte, &mut |frame: &[u8]| said.extend_from_slice(frame)));
        Ok(said)
    }
}

/// One direction of the line.
#[derive(Default)]
struct Way {
    arriving: Vec<Vec<u8>>,
    /// Frames that come late: so many steps.
    late: Vec<(usize, Vec<u8>)>,
}

impl Way {
    /// Sends a frame; `bad` of 1000 suffer each kind of fault.
    fn send(&mut self, frame: &[u8], random: &mut Random, bad: usize, tally: &mut Tally) {
        tally.frames += 1;
        let mut frame = frame.to_vec();
        let before = (frame.clone(), self.late.len());
        if random.chance(bad) {
            tally.faults += 1;
            return;
        }
        if random.chance(bad) {
            self.late.push((1 + random.below(40), frame.clone()));
        }
        if random.chance(bad) {
            frame.truncate(random.below(frame.len()));
        }
        if random.chance(bad) && !frame.is_empty() {
            let at = random.below(frame.len());
            frame[at] ^= 1 << random.below(8);
        }
        tally.faults += usize::from((&frame, self.late.len()) != (&before.0, before.1));
        if random.chance(bad) {
            tally.faults += 1;
            self.late.push((1 + random.below(8), frame));
        } else {
            // Before one of those that are under way, or behind all.
            let place = if random.chance(bad) { random.below(self.arriving.len() + 1) } else { self.arriving.len() };
            self.arriving.insert(place, frame);
        }
    }

    /// Takes the frames that arrive now.
    fn arrive(&mut self) -> Vec<u8> {
        self.late.iter_mut().for_each(|(steps, _)| *steps -= 1);
        let (due, late) = std::mem::take(&mut self.late).into_iter().partition(|(steps, _)| *steps == 0);
        self.late = late;
        let due: Vec<(usize, Vec<u8>)> = due;
        let arriving = std::mem::take(&mut self.arriving);
        arriving.into_iter().chain(due.into_iter().map(|(_, frame)| frame)).flatten().collect()
    }
}

/// A robot with its controller.
struct Driver<S: Number> {
    index: u16,
    client: Client,
    briefing: Briefing<S, ROBOTS, SEGMENTS, REGIONS>,
    robot: Robot<S, ROBOTS, REGIONS, PIECES>,
    /// Whether it is asking for orders, and has to begin anew.
    asks: bool,
    /// Its path as it was told, and where it is on it.
    told: Option<Agent<S>>,
    path: Option<Agent<S>>,
    length: S,
    at: f64,
    speed: f64,
    stops: usize,
    hold: f64,
    /// Controls since it asked.
    waits: usize,
    /// Controls for which it says nothing.
    silent: usize,
}

/// Runs of a number format, from this seed on. With `reckless`, robots do not look at their holds.
pub(crate) fn runs<S: Rounded>(
    seeds: std::ops::Range<u64>,
    reckless: bool,
    mut connect: impl FnMut() -> Result<Box<dyn Supervisor>, Box<dyn Error>>,
) -> Result<Tally, Box<dyn Error>> {
    let mut tally = Tally { gap: f64::INFINITY, ..Tally::default() };
    for seed in seeds {
        let mut supervisor = connect()?;
        run::<S>(seed, reckless, &mut *supervisor, &mut tally).map_err(|error| format!("run {seed}: {error}"))?;
        tally.runs += 1;
    }
    Ok(tally)
}

/// A question of the planner on a line that is perfect.
fn ask<S: Number>(
    supervisor: &mut dyn Supervisor,
    planner: &mut Client,
    request: &Request<S>,
) -> Result<Answer<S>, Box<dyn Error>> {
    if !planner.ask(request) {
        return Err("a request is too long".into());
    }
    let bytes = supervisor.exchange(planner.frame())?;
    let last = bytes.into_iter().filter_map(|byte| planner.take(byte)).last();
    match last {
        Some(Event::Last(answer)) => Ok(answer),
        other => Err(format!("no answer to {request:?} but {other:?}").into()),
    }
}

/// A path through the middle of the arena.
fn path<S: Rounded>(random: &mut Random) -> heapless::Vec<Step<S>, { pcr_supervisor::agent::MAX_STEPS }> {
    (0..1 + random.below(STEPS))
        .map(|_| {
            let length = S::from_f64(0.5 + 2.5 * random.unit());
            let turn = if random.chance(500) { Turn::Left } else { Turn::Right };
            let radius = S::from_f64(0.6 + 2.0 * random.unit());
            let curve = if random.chance(500) { Curve::Line } else { Curve::Arc { radius, turn } };
            Step { curve, length }
        })
        .collect()
}

fn heading<S: Rounded>(random: &mut Random) -> S::Angle {
    let (sin, cos) = (std::f64::consts::TAU * random.unit()).sin_cos();
    <S::Angle as Angle<S>>::atan2(S::from_f64(sin), S::from_f64(cos))
}

fn limits<S: Rounded>() -> Limits<S> {
    Limits { speed: S::from_f64(1.0), acceleration: S::from_f64(1.0) }
}

fn agent<S: Rounded>(random: &mut Random) -> Agent<S> {
    let number = |value: f64| S::from_f64(value);
    let position = Point::new(number(5.0 * random.unit()), number(5.0 * random.unit()));
    Agent {
        radius: number(0.15 + 0.15 * random.unit()),
        start_time: number(0.0),
        limits: limits(),
        start: Pose { position, heading: heading::<S>(random) },
        path: path(random),
    }
}

fn run<S: Rounded>(
    seed: u64,
    reckless: bool,
    supervisor: &mut dyn Supervisor,
    tally: &mut Tally,
) -> Result<(), Box<dyn Error>> {
    let mut random = Random(seed);
    let bad = [0, 20, 100, 250][random.below(4)];
    let mut planner = Client::new();
    ask::<S>(supervisor, &mut planner, &Request::Hello)?;
    ask::<S>(supervisor, &mut planner, &Request::Clear)?;
    // Robots are added as long as a plan has room for them.
    let mut fleet: Vec<Agent<S>> = Vec::new();
    for _ in 0..2 + random.below(2 * ROBOTS) {
        let new = agent::<S>(&mut random);
        if fleet.len() == ROBOTS {
            break;
        }
        let Answer::Fleet { .. } = ask(supervisor, &mut planner, &Request::Add(new.clone()))? else { continue };
        let index = u16::try_from(fleet.len())?;
        let computed = ask::<S>(supervisor, &mut planner, &Request::Compute)?;
        let replanned = match computed {
            Answer::Computed { .. } => ask::<S>(supervisor, &mut planner, &Request::Replan { agent: index })?,
            refused => refused,
        };
        if matches!(replanned, Answer::Replanned { .. }) {
            fleet.push(new);
        } else {
            ask::<S>(supervisor, &mut planner, &Request::Remove { agent: index })?;
        }
    }
    ask::<S>(supervisor, &mut planner, &Request::Compute)?;
    let terms = Terms {
        run: 1 + (seed % 65_535) as u16,
        horizon: S::from_f64(0.5 + 2.0 * random.unit()),
        width: S::from_f64(0.0),
    };
    match ask(supervisor, &mut planner, &Request::Order(terms))? {
        Answer::Edition(_) => {}
        // A robot that comes as early as possible touches the one before it: such cases may be too close to decide.
        Answer::Refused(Refusal::Meeting(_) | Refusal::Stuck(_)) => return Ok(()),
        other => return Err(format!("no orders but {other:?}").into()),
    }
    let mut drivers: Vec<Driver<S>> = fleet
        .into_iter()
        .zip(0..)
        .map(|(agent, index)| Driver {
            index,
            client: Client::robot(index),
            briefing: Briefing::new(index),
            robot: Robot::new(),
            asks: false,
            told: None,
            path: Some(agent),
            // No robot is at the end of its path before it was told the length.
            length: S::LIMIT,
            at: 0.0,
            speed: 0.0,
            stops: 0,
            hold: 0.0,
            waits: 0,
            silent: 0,
        })
        .collect();
    tally.robots += drivers.len();
    let (mut there, mut back) = (Way::default(), Way::default());
    let mut missions = random.below(4);
    let forgets = if random.chance(500) { 3 } else { 0 };
    for _ in 0..CONTROLS {
        for driver in &mut drivers {
            driver.send(&mut there, &mut random, bad, tally);
        }
        let said = supervisor.exchange(&there.arrive())?;
        // Each frame suffers by itself.
        for frame in said.split_inclusive(|&byte| byte == 0).filter(|frame| frame.len() > 1) {
            back.send(&[&[0], frame].concat(), &mut random, bad, tally);
        }
        let heard = back.arrive();
        for driver in &mut drivers {
            driver.hear(&heard, tally)?;
            driver.control(&mut random, reckless)?;
            if random.chance(forgets) {
                driver.restart();
                tally.restarts += 1;
            }
        }
        advance(&mut drivers, tally)?;
        let arrived = |driver: &Driver<S>| driver.at >= driver.end();
        if missions > 0 && random.chance(30) {
            let index = random.below(drivers.len());
            if arrived(&drivers[index]) {
                missions -= 1;
                mission::<S>(index, supervisor, &mut planner, &mut random, tally)?;
            }
        }
        if missions == 0 && drivers.iter().all(|driver| arrived(driver) && !driver.asks) {
            break;
        }
    }
    match drivers.iter().find(|driver| driver.at < driver.end()) {
        Some(late) if !reckless => {
            let Driver { index, at, hold, asks, .. } = late;
            let (end, edition) = (late.end(), late.robot.edition());
            return Err(format!(
                "{index} stands at {at} m of {end} m for ever, hold {hold} m, {edition:?}, asking: {asks}"
            )
            .into());
        }
        _ => tally.arrived += drivers.len(),
    }
    Ok(())
}

/// The planner gives a robot another path, which may be refused.
fn mission<S: Rounded>(
    index: usize,
    supervisor: &mut dyn Supervisor,
    planner: &mut Client,
    random: &mut Random,
    tally: &mut Tally,
) -> Result<(), Box<dyn Error>> {
    let request: Request<S> = Request::Admit {
        agent: u16::try_from(index)?,
        heading: heading::<S>(random),
        limits: limits(),
        path: path(random),
    };
    match ask(supervisor, planner, &request)? {
        Answer::Edition(_) => tally.admitted += 1,
        Answer::Refused(
            Refusal::Blocked(_)
            | Refusal::Stuck(_)
            | Refusal::NotThere { .. }
            | Refusal::TableFull(_)
            | Refusal::Agent { .. },
        ) => tally.refused += 1,
        other => return Err(format!("no mission but {other:?}").into()),
    }
    Ok(())
}

impl<S: Rounded> Driver<S> {
    fn end(&self) -> f64 {
        self.length.to_f64()
    }

    /// Sends its question, or the last one again.
    fn send(&mut self, line: &mut Way, random: &mut Random, bad: usize, tally: &mut Tally) {
        self.waits += 1;
        if self.silent > 0 {
            self.silent -= 1;
            return;
        }
        let none = self.robot.edition() == Edition::default();
        if none && !self.asks {
            self.inquire();
        }
        // The same question again: answers that have already come are kept.
        if self.asks && !(self.waits == 1 || self.waits > 5) {
            return;
        }
        if self.asks {
            self.waits = 1;
        } else {
            let at = self.reported();
            let (agent, edition) = (self.index, self.robot.edition());
            let report = Request::Report { agent, edition, at: Interval::new(at, at) };
            assert!(self.client.ask(&report), "a report fits a frame");
        }
        line.send(self.client.frame(), random, bad, tally);
    }

    /// The length that it reports as passed, rounded down.
    fn reported(&self) -> S {
        if self.at >= self.end() { self.length } else { S::from_f64((self.at - 1e-4).max(0.0)) }
    }

    /// Its controller is switched off and on: the robot stands where it is, and knows nothing any more.
    fn restart(&mut self) {
        (self.client, self.robot) = (Client::robot(self.index), Robot::new());
        self.briefing.clear();
        (self.asks, self.told, self.speed, self.hold) = (false, None, 0.0, 0.0);
        self.silent = SILENCE;
    }

    fn inquire(&mut self) {
        (self.asks, self.waits) = (true, 0);
        self.briefing.clear();
        assert!(self.client.ask(&Request::<S>::Orders { agent: self.index }), "a question fits a frame");
    }

    fn hear(&mut self, bytes: &[u8], tally: &mut Tally) -> Result<(), Box<dyn Error>> {
        for &byte in bytes {
            let answer = match self.client.take::<S>(byte) {
                Some(Event::Answer(answer) | Event::Last(answer)) => answer,
                Some(Event::Changed) => {
                    self.inquire();
                    continue;
                }
                _ => continue,
            };
            match answer {
                Answer::Refused(Refusal::Edition(_)) => self.inquire(),
                Answer::Refused(refusal) if self.asks => return Err(format!("no orders but {refusal:?}").into()),
                answer if self.asks => {
                    match self.briefing.take(&answer) {
                        // They have changed meanwhile.
                        Err(Unclear::Disagreement) => self.inquire(),
                        other => other.map_err(|unclear| format!("{unclear:?}"))?,
                    }
                    match answer {
                        Answer::Member { agent, with, .. } if agent == self.index => self.told = Some(with),
                        Answer::Passing { pass: Pass::Second, .. } => tally.orders += 1,
                        Answer::Orders { .. } if self.asks => self.brief(tally)?,
                        _ => {}
                    }
                }
                answer => self.robot.hear(&self.briefing, &answer),
            }
        }
        Ok(())
    }

    fn brief(&mut self, tally: &mut Tally) -> Result<(), Box<dyn Error>> {
        self.asks = false;
        let at = self.reported();
        let fleet = motions(&self.briefing)?;
        let mut changed = self.robot.brief(&self.briefing, &fleet, at);
        if changed == Err(Unclear::Begun) {
            // It looks around; what it is told is the path that it is on.
            if self.told != self.path {
                return Err("another path was begun".into());
            }
            tally.resumed += 1;
            let resumed = self.robot.resume(&self.briefing);
            changed = resumed.and_then(|()| self.robot.brief(&self.briefing, &fleet, at));
        }
        if changed == Err(Unclear::Disagreement) {
            // They have changed meanwhile.
            drop(fleet);
            self.inquire();
            return Ok(());
        }
        if changed.map_err(|unclear| format!("{unclear:?}"))? {
            (self.at, self.speed, self.hold) = (0.0, 0.0, 0.0);
            self.path = self.told.take();
        }
        self.length = fleet.get(self.robot.own()).ok_or("its own path is not there")?.path().length();
        Ok(())
    }

    /// A control: how fast it goes until the next one.
    fn control(&mut self, random: &mut Random, reckless: bool) -> Result<(), Box<dyn Error>> {
        if !self.asks {
            let fleet = motions(&self.briefing)?;
            let hold = self.robot.hold(&fleet).to_f64();
            if hold < self.hold {
                return Err("a hold went back".into());
            }
            self.hold = hold;
        }
        if self.stops == 0 && random.chance(20) {
            self.stops = random.below(60);
        }
        self.stops = self.stops.saturating_sub(1);
        let way = if reckless { f64::INFINITY } else { self.hold - self.at };
        if way <= 1e-3 {
            (self.at, self.speed) = (self.at.max(self.hold), 0.0);
            return Ok(());
        }
        let safe = Brakes::new(1.0, STEP)?.speed(way.clamp(0.0, 1e3));
        let wanted = if self.stops > 0 { 0.0 } else { random.unit().max(0.5) };
        self.speed = safe.min(wanted).min(self.speed + STEP);
        Ok(())
    }
}

/// The paths that a robot knows.
pub(crate) fn motions<S: Number, const A: usize, const N: usize, const R: usize>(
    told: &Briefing<S, A, N, R>,
) -> Result<Motions<'_, S, A>, Box<dyn Error>> {
    let mut fleet = Motions::new();
    told.put_motions(&mut fleet).map_err(|invalid| format!("{invalid:?}"))?;
    Ok(fleet)
}

/// Moves all robots up to the next control step. Two discs that overlap by more than [`TOUCH`] are an error.
fn advance<S: Rounded>(drivers: &mut [Driver<S>], tally: &mut Tally) -> Result<(), Box<dyn Error>> {
    const PARTS: u32 = 5;
    for _ in 0..PARTS {
        for driver in drivers.iter_mut() {
            driver.at = (driver.at + driver.speed * STEP / f64::from(PARTS)).min(driver.end());
        }
        let discs: Vec<_> = drivers.iter().filter_map(Driver::disc).collect();
        for (index, (a, own)) in discs.iter().enumerate() {
            for (other, (b, radius)) in discs.iter().enumerate().skip(index + 1) {
                let gap = (a[0] - b[0]).hypot(a[1] - b[1]) - own - radius;
                tally.gap = tally.gap.min(gap);
                if gap < -TOUCH {
                    return Err(format!("{index} and {other} overlap by {} m", -gap).into());
                }
            }
        }
    }
    Ok(())
}

/// Overlap above which two discs are in contact \[m\]: at a hold they may just touch, and the positions here are rounded.
const TOUCH: f64 = 1e-3;

impl<S: Rounded> Driver<S> {
    /// Its true position, computed here from its path in `f64`, and its radius.
    fn disc(&self) -> Option<([f64; 2], f64)> {
        let path = self.path.as_ref()?;
        let start = &path.start;
        let (sin, cos) = <S::Angle as Angle<S>>::sin_cos(start.heading);
        let (mut x, mut y) = (start.position.x.to_f64(), start.position.y.to_f64());
        let one = S::from_f64(1.0);
        let mut heading = one.scale(sin).to_f64().atan2(one.scale(cos).to_f64());
        let mut rest = self.at;
        for step in &path.path {
            let length = rest.min(step.length.to_f64());
            rest -= length;
            match step.curve {
                Curve::Line => (x, y) = (x + length * heading.cos(), y + length * heading.sin()),
                Curve::Arc { radius, turn } => {
                    let sign = if turn == Turn::Left { 1.0 } else { -1.0 };
                    let (radius, turned) = (sign * radius.to_f64(), sign * length / radius.to_f64());
                    (x, y) = (
                        x + radius * ((heading + turned).sin() - heading.sin()),
                        y - radius * ((heading + turned).cos() - heading.cos()),
                    );
                    heading += turned;
                }
            }
        }
        Some(([x, y], path.radius.to_f64()))
    }
}

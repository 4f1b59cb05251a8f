//! Vehicles that do what the supervisor says, while messages are lost, late and repeated both ways; their true positions go to the
//! independent checker.

use pcr_certify::motion::{Mover, meetings};
use pcr_certify::raw::{self, RawAgent, RawAngle, RawMotion, RawSegment};
use pcr_core::BrakingModel;
use pcr_formats::splitmix64::SplitMix64;
use pcr_serve::event::SupervisorEvent;
use pcr_serve::journal::{self, ParsedFrames, frame};
use pcr_serve::journal_entry::{JournalEntry, JournalStore};
use pcr_serve::owned_path::{OwnedPath, PathElement, StartPose};
use pcr_serve::request_error::RequestError;
use pcr_serve::robot::{MissionEnd, RobotTraits};
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use std::f64::consts::PI;
use std::io;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex};

/// Time between two controls \[s\].
pub(crate) const STEP: f64 = 0.1;
/// A vehicle that is so near to where it may go has come there \[m\].
const THERE: f64 = 1e-3;
/// Controls between two certificates.
const WINDOW: u32 = 200;

/// A journal in memory, which outlives the supervisor; it may stop working after so many bytes.
#[derive(Clone)]
pub(crate) struct Disc {
    pub(crate) bytes: Arc<Mutex<Vec<u8>>>,
    pub(crate) fails_at: Arc<AtomicUsize>,
    /// Checksum of the last frame.
    sum: Arc<AtomicU32>,
}

impl Disc {
    pub(crate) fn new() -> Self {
        let (bytes, sum) = (Arc::new(Mutex::new(journal::HEADER.to_vec())), Arc::new(AtomicU32::new(journal::FIRST)));
        Self { bytes, fails_at: Arc::new(AtomicUsize::new(usize::MAX)), sum }
    }

    pub(crate) fn entries(&self) -> Vec<JournalEntry> {
        let mut bytes = self.bytes.lock().unwrap();
        let ParsedFrames { entries, end, sum, .. } = journal::read(&bytes).unwrap();
        bytes.truncate(end);
        self.sum.store(sum, Relaxed);
        entries
    }
}

impl JournalStore for Disc {
    fn keep(&mut self, entries: &[JournalEntry]) -> io::Result<()> {
        let mut bytes = self.bytes.lock().unwrap();
        let (frame, sum) = frame(entries, self.sum.load(Relaxed))?;
        let room = self.fails_at.load(Relaxed).saturating_sub(bytes.len());
        if room < frame.len() {
            bytes.extend(&frame[..room]);
            return Err(io::Error::other("killed"));
        }
        bytes.extend(frame);
        self.sum.store(sum, Relaxed);
        Ok(())
    }
}

pub(crate) struct Vehicle {
    pub(crate) name: String,
    pub(crate) abilities: RobotTraits,
    /// Its paths, with where each begins on all of its way.
    pieces: Vec<(f64, OwnedPath)>,
    pub(crate) path: u64,
    /// Where it is on the last one \[m\], and its speed \[m/s\].
    pub(crate) at: f64,
    pub(crate) speed: f64,
    pub(crate) hold: f64,
    stopped: bool,
    doubt: [f64; 2],
    stops_until: f64,
    /// Durations \[s\], ways \[m\] and speeds \[m/s\] since the last certificate.
    done: Vec<(f64, f64, [f64; 2])>,
    since: f64,
    pub(crate) missions: u32,
}

impl Vehicle {
    fn course(&self) -> &OwnedPath {
        &self.pieces[self.pieces.len() - 1].1
    }

    fn origin(&self) -> f64 {
        self.pieces[self.pieces.len() - 1].0
    }

    pub(crate) fn has_arrived(&self) -> bool {
        self.at + self.doubt[1] >= self.course().length() - THERE
    }

    fn report(&self) -> PositionReport {
        let end = self.course().length();
        let at = [(self.at - self.doubt[0]).max(0.0), (self.at + self.doubt[1]).min(end)];
        PositionReport { robot: self.name.clone(), path: self.path, at, age: 0.0 }
    }

    fn take(&mut self, path: u64, origin: f64, course: OwnedPath) {
        if path <= self.path {
            return;
        }
        let shift = self.origin() - origin;
        (self.at, self.hold) = (self.at + shift, self.hold + shift);
        self.path = path;
        self.pieces.push((origin, course));
    }

    fn drive(&mut self, now: f64) {
        let end = self.course().length();
        let thought = (self.at + self.doubt[1]).min(end);
        let left = self.hold.min(end) - thought;
        let brake = self.abilities.acceleration;
        let brakes = BrakingModel::new(brake, 0.5 * STEP).unwrap();
        let stands = self.stopped || self.stops_until > now;
        let wanted = if stands { 0.0 } else { brakes.speed(left - 0.5 * self.speed * STEP).min(self.abilities.speed) };
        let change = brake * STEP;
        let speed = wanted.clamp((self.speed - change).max(0.0), self.speed + change);
        let way =
            if speed == 0.0 { self.speed * self.speed / (2.0 * brake) } else { 0.5 * (self.speed + speed) * STEP };
        let way = way.min(end - self.at);
        // It may stop within the step.
        let stop = if speed == 0.0 && self.speed > 0.0 { (2.0 * way / self.speed).min(STEP) } else { STEP };
        self.done.push((stop, way, [self.speed, speed]));
        if stop < STEP {
            self.done.push((STEP - stop, 0.0, [0.0; 2]));
        }
        (self.at, self.speed) = (self.at + way, speed);
    }

    /// What it has done since the last time.
    fn agent(&mut self, id: u64, [begin, end]: [f64; 2]) -> RawAgent {
        let (from, to) = (self.since, self.origin() + self.at);
        let mut pieces: Vec<OwnedPath> = Vec::new();
        for (k, (origin, course)) in self.pieces.iter().enumerate() {
            let last = self.pieces.get(k + 1).map_or(to, |next| next.0.min(to));
            let (lo, hi) = (from.max(*origin), last);
            if hi > lo {
                pieces.push(course.part(lo - origin, hi - origin).unwrap());
            }
        }
        let standing = OwnedPath::new(self.course().pose(self.at), Vec::new()).unwrap();
        let path = path(if pieces.is_empty() { std::slice::from_ref(&standing) } else { &pieces }, to - from);
        let mut phases: Vec<raw::RawPhase> = Vec::new();
        let (mut time, mut length) = (0.0, 0.0);
        for (duration, way, speed) in self.done.drain(..) {
            let (later, further) = (time + duration, length + way);
            match phases.last_mut() {
                Some(last) if last.speed == [0.0; 2] && speed == [0.0; 2] => last.time[1] = later,
                _ => phases.push(raw::RawPhase { time: [time, later], length: [length, further], speed }),
            }
            (time, length) = (later, further);
        }
        assert!((time - (end - begin)).abs() < 1e-6 && (length - (to - from)).abs() < 1e-6);
        self.since = to;
        let keep = self.pieces.iter().rposition(|(origin, _)| *origin <= to).unwrap_or(0);
        self.pieces.drain(..keep);
        let travel = RawMotion { start: begin, phases, lag: 0.0, time_excess: 0.0 };
        RawAgent { id, radius: self.abilities.radius, path, travel: Some(travel) }
    }
}

fn path(pieces: &[OwnedPath], length: f64) -> raw::RawPath {
    let start = pieces[0].start();
    let (mut heading, mut from) = (start.heading, 0.0);
    let mut segments = Vec::new();
    for piece in pieces {
        let mut turns = vec![RawAngle::Radians(piece.start().heading - heading)];
        heading = piece.start().heading;
        for shape in piece.shapes() {
            let (long, radius) = match *shape {
                PathElement::Turn { sweep, .. } => {
                    turns.push(RawAngle::Radians(sweep));
                    heading += sweep;
                    continue;
                }
                PathElement::Line { length } => (length, None),
                PathElement::Shift { .. } => unreachable!("this world has none"),
                PathElement::Arc { radius, sweep } => {
                    heading += sweep;
                    (shape.length(), Some(radius.copysign(sweep)))
                }
            };
            if long > 0.0 {
                segments.push(RawSegment {
                    length: long,
                    radius,
                    turns: std::mem::take(&mut turns),
                    from,
                    to: from + long,
                });
                from += long;
            }
        }
    }
    if segments.is_empty() {
        segments.push(RawSegment { length: 0.0, radius: None, turns: Vec::new(), from: 0.0, to: 0.0 });
    }
    assert!((from - length).abs() < 1e-6, "the record is {from} m long, the way {length} m");
    let rounding = 1e-9;
    raw::RawPath { start: [start.x, start.y], heading: RawAngle::Radians(start.heading), segments, rounding, step: 0.0 }
}

enum Mail {
    /// With the time at which it was so.
    Report(PositionReport, f64),
    Event(SupervisorEvent, Option<(f64, OwnedPath)>),
}

/// How bad the messages are.
#[derive(Clone, Copy)]
pub(crate) struct Trouble {
    pub(crate) lost: f64,
    pub(crate) late: f64,
    pub(crate) stops: f64,
}

pub(crate) struct World {
    pub(crate) supervisor: Supervisor,
    pub(crate) disc: Disc,
    pub(crate) settings: SupervisorConfig,
    pub(crate) vehicles: Vec<Vehicle>,
    pub(crate) now: f64,
    tick: u32,
    certified: u32,
    dice: SplitMix64,
    mail: Vec<(f64, Mail)>,
    trouble: Trouble,
    half: f64,
    /// Certified intervals of time.
    pub(crate) steps: usize,
    pub(crate) open: bool,
    /// Whether missions may be admitted in parts, and number of parts that were.
    pub(crate) in_parts: bool,
    pub(crate) parts: u32,
    pub(crate) proposals: u32,
    pub(crate) waits: u32,
    pub(crate) kills: u32,
}

impl World {
    pub(crate) fn new(seed: u64, count: usize, trouble: Trouble) -> Self {
        let (disc, settings) = (Disc::new(), SupervisorConfig::default());
        let mut supervisor = Supervisor::new(settings, Box::new(disc.clone()));
        let mut dice = SplitMix64(seed);
        let side = (count as f64).sqrt().ceil() as usize;
        let half = 1.4 * side as f64;
        let mut vehicles = Vec::new();
        for k in 0..count {
            let cell = |n: usize| -half + 2.8 * (n as f64 + 0.5);
            let start = StartPose { x: cell(k % side), y: cell(k / side), heading: dice.uniform(-PI, PI) };
            let radius = dice.uniform(0.15, 0.35);
            let abilities = RobotTraits {
                radius,
                footprint: None,
                margin: 0.0,
                speed: dice.uniform(0.5, 1.5),
                acceleration: dice.uniform(0.4, 1.0),
            };
            let name = format!("robot {k}");
            supervisor.add(&name, abilities.clone(), start).unwrap();
            let course = OwnedPath::new(start, Vec::new()).unwrap();
            let doubt = [dice.uniform(0.0, 0.03), dice.uniform(0.0, 0.03)];
            vehicles.push(Vehicle {
                name,
                abilities,
                pieces: vec![(0.0, course)],
                path: 1,
                at: 0.0,
                speed: 0.0,
                hold: 0.0,
                stopped: false,
                doubt,
                stops_until: 0.0,
                done: Vec::new(),
                since: 0.0,
                missions: 0,
            });
        }
        let mail = Vec::new();
        Self {
            supervisor,
            disc,
            settings,
            vehicles,
            now: 0.0,
            tick: 0,
            certified: 0,
            dice,
            mail,
            trouble,
            half,
            steps: 0,
            open: true,
            in_parts: false,
            parts: 0,
            proposals: 0,
            waits: 0,
            kills: 0,
        }
    }

    pub(crate) fn dice(&mut self) -> &mut SplitMix64 {
        &mut self.dice
    }

    /// The process ends and is started again: what was on the way to robots gets there still.
    pub(crate) fn restart(&mut self) {
        let told: Vec<(u64, f64)> = self.vehicles.iter().map(|vehicle| (vehicle.path, vehicle.hold)).collect();
        let entries = self.disc.entries();
        self.supervisor = Supervisor::restored(self.settings, entries, Box::new(self.disc.clone())).unwrap();
        for (vehicle, (path, hold)) in self.vehicles.iter().zip(told) {
            let robot = self.supervisor.robot(&vehicle.name).unwrap();
            assert!(robot.path >= path, "a path that was told is lost");
            let hold = hold + vehicle.origin() - robot.origin;
            assert!(
                robot.notified_limit >= hold - 1e-9,
                "{}: {hold} was told, {} is known",
                vehicle.name,
                robot.notified_limit
            );
        }
    }

    /// From now on what matters goes to another journal, all of it.
    pub(crate) fn persist(&mut self, mut keeper: Box<dyn JournalStore>) {
        self.supervisor.settle(self.now).unwrap();
        keeper.keep(&self.supervisor.snapshot().unwrap()).unwrap();
        self.supervisor = Supervisor::restored(self.settings, self.supervisor.snapshot().unwrap(), keeper).unwrap();
    }

    fn post(&mut self, mail: Mail) {
        let late = if self.dice.unit() < 0.3 { self.dice.uniform(0.0, self.trouble.late) } else { 0.0 };
        self.mail.push((self.now + late, mail));
    }

    /// A way on from a place, that stays in the arena.
    fn shapes(&mut self, start: StartPose) -> Option<Vec<PathElement>> {
        let dice = &mut self.dice;
        let shapes = (0..1 + dice.below(4)).map(|_| match dice.below(3) {
            0 => PathElement::Turn { sweep: dice.uniform(-PI, PI), lever: None },
            1 => PathElement::Arc { radius: dice.uniform(0.3, 1.0), sweep: dice.uniform(-PI, PI) },
            _ => PathElement::Line { length: dice.uniform(0.3, 4.0) },
        });
        let course = OwnedPath::new(start, shapes.collect()).unwrap();
        let length = course.length();
        let inside = |k: u32| {
            let pose = course.pose(length * f64::from(k) / 40.0);
            pose.x.abs() < self.half && pose.y.abs() < self.half
        };
        (length > 0.2 && (0..=40).all(inside)).then(|| course.shapes().to_vec())
    }

    fn propose(&mut self) {
        let k = self.dice.below(self.vehicles.len());
        let robot = self.supervisor.robot(&self.vehicles[k].name).unwrap();
        let (told, length) = (robot.notified_limit, robot.course.length());
        let arrives = robot.arc_length >= length - self.settings.position_uncertainty;
        if !arrives && self.dice.unit() < 0.7 {
            return;
        }
        let after = if arrives { length } else { self.dice.uniform(told, length) };
        let robot = self.supervisor.robot(&self.vehicles[k].name).unwrap();
        let start = robot.course.arrival(after).unwrap();
        let Some(path) = self.shapes(start) else { return };
        self.proposals += 1;
        let proposal = MissionRequest {
            robot: self.vehicles[k].name.clone(),
            mission: format!("mission {}", self.proposals),
            after: (!arrives).then_some(after),
            expected_path: None,
            any_heading: false,
            start: Some(start),
            path,
        };
        let verdict = if self.in_parts {
            let end = |shapes| MissionEnd { mission: format!("part {}.{shapes}", self.proposals), shapes };
            let ends = (1..proposal.path.len()).map(end).collect();
            self.supervisor.mission_in_parts(&proposal, ends, self.now).unwrap()
        } else {
            let verdict = self.supervisor.mission(&proposal, self.now).unwrap();
            // To ask again changes nothing.
            let again = self.supervisor.mission(&proposal, self.now).unwrap();
            assert_eq!(verdict, again);
            verdict
        };
        self.waits += u32::from(matches!(verdict, AdmissionResult::Waiting { .. }));
    }

    /// A step of the fleet; returns what was told.
    pub(crate) fn step(&mut self) -> Vec<SupervisorEvent> {
        for k in 0..self.vehicles.len() {
            if self.dice.unit() < 0.5 {
                let report = self.vehicles[k].report();
                if self.dice.unit() >= self.trouble.lost {
                    if self.dice.unit() < 0.1 {
                        self.post(Mail::Report(report.clone(), self.now));
                    }
                    self.post(Mail::Report(report, self.now));
                }
            }
        }
        if self.open && self.dice.unit() < 0.6 {
            self.propose();
        }
        let due = |(time, _): &(f64, Mail)| *time <= self.now;
        let (mail, later): (Vec<_>, Vec<_>) = std::mem::take(&mut self.mail).into_iter().partition(due);
        self.mail = later;
        let mut news = Vec::new();
        for (_, mail) in mail {
            match mail {
                Mail::Report(report, said) => {
                    let report = PositionReport { age: self.now - said, ..report };
                    self.supervisor.position(&report, self.now).unwrap();
                }
                Mail::Event(event, course) => news.push((event, course)),
            }
        }
        let events = match self.supervisor.settle(self.now) {
            Ok(events) => events,
            Err(RequestError::Broken { .. }) => {
                self.kills += 1;
                assert!(self.supervisor.settle(self.now).is_err(), "no right is given any more");
                self.disc.fails_at.store(usize::MAX, Relaxed);
                self.restart();
                Vec::new()
            }
            Err(fault) => panic!("{fault}"),
        };
        let told = events.clone();
        for event in events {
            let is_hold = matches!(event, SupervisorEvent::Hold { .. });
            if is_hold && self.dice.unit() < self.trouble.lost {
                continue;
            }
            // What is about all is for people.
            let Some(name) = event.robot() else { continue };
            let admitted = matches!(event, SupervisorEvent::Admitted { .. });
            let is_part = |mission: &str| mission.starts_with("part");
            self.parts += u32::from(matches!(&event, SupervisorEvent::Admitted { mission, .. } if is_part(mission)));
            let robot = self.supervisor.robot(name).unwrap();
            let course = admitted.then(|| (robot.origin, robot.course.clone()));
            self.post(Mail::Event(event, course));
        }
        if self.tick.is_multiple_of(20) {
            self.tell_again();
        }
        for (event, course) in news {
            self.hear(&event, course);
        }
        let count = self.vehicles.len();
        let unlucky = (self.dice.unit() < self.trouble.stops * count as f64).then(|| self.dice.below(count));
        if let Some(unlucky) = unlucky.filter(|_| self.open) {
            self.vehicles[unlucky].stops_until = self.now + self.dice.uniform(0.0, 20.0);
        }
        for vehicle in &mut self.vehicles {
            vehicle.drive(self.now);
        }
        self.tick += 1;
        self.now = f64::from(self.tick) * STEP;
        if self.tick.is_multiple_of(WINDOW) {
            self.certify();
        }
        told
    }

    /// Whoever talks to robots asks what is so, and says it again.
    fn tell_again(&mut self) {
        for k in 0..self.vehicles.len() {
            let robot = self.supervisor.robot(&self.vehicles[k].name).unwrap();
            let (path, origin, granted, course) = (robot.path, robot.origin, robot.granted, robot.course.clone());
            let vehicle = &mut self.vehicles[k];
            vehicle.take(path, origin, course);
            vehicle.hold = vehicle.hold.max(granted);
            vehicle.stopped = robot.stopped.is_some();
        }
    }

    fn hear(&mut self, event: &SupervisorEvent, course: Option<(f64, OwnedPath)>) {
        let vehicle = self.vehicles.iter_mut().find(|vehicle| Some(vehicle.name.as_str()) == event.robot()).unwrap();
        match event {
            SupervisorEvent::Admitted { path, .. } => {
                let (origin, course) = course.unwrap();
                vehicle.missions += 1;
                vehicle.take(*path, origin, course);
            }
            SupervisorEvent::Hold { path, hold, .. } if *path == vehicle.path => vehicle.hold = vehicle.hold.max(*hold),
            SupervisorEvent::Stop { .. } => vehicle.stopped = true,
            SupervisorEvent::Go { .. } => vehicle.stopped = false,
            _ => {}
        }
    }

    pub(crate) fn certify(&mut self) {
        let window = [f64::from(self.certified) * STEP, self.now];
        self.certified = self.tick;
        let agents: Vec<RawAgent> =
            self.vehicles.iter_mut().enumerate().map(|(id, vehicle)| vehicle.agent(id as u64, window)).collect();
        let movers: Vec<Mover> = agents.iter().map(|agent| Mover::new(agent, window).unwrap()).collect();
        let found = meetings(&movers);
        self.steps += found.steps;
        assert!(found.contacts.is_empty() && found.undecided.is_empty(), "{found:?}");
    }
}

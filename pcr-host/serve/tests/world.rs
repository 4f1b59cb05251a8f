//! Vehicles that do what the supervisor says, while messages are lost, late and repeated both ways; their true positions go to the
//! independent checker.

use pcr_certify::data::{self, Agent, Angle, Segment, Travel};
use pcr_certify::motion::{Mover, meetings};
use pcr_core::Brakes;
use pcr_formats::random::Random;
use pcr_serve::course::{Course, Shape, Start};
use pcr_serve::entry::{Entry, Keep};
use pcr_serve::event::Event;
use pcr_serve::fault::Fault;
use pcr_serve::journal::{self, Frames, frame};
use pcr_serve::robot::Abilities;
use pcr_serve::supervisor::{Proposal, Report, Settings, Supervisor, Verdict};
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

    pub(crate) fn entries(&self) -> Vec<Entry> {
        let mut bytes = self.bytes.lock().unwrap();
        let Frames { entries, end, sum, .. } = journal::read(&bytes).unwrap();
        bytes.truncate(end);
        self.sum.store(sum, Relaxed);
        entries
    }
}

impl Keep for Disc {
    fn keep(&mut self, entries: &[Entry]) -> io::Result<()> {
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
    pub(crate) abilities: Abilities,
    /// Its paths, with where each begins on all of its way.
    pieces: Vec<(f64, Course)>,
    pub(crate) path: u64,
    /// Where it is on the last one \[m\], and its speed \[m/s\].
    pub(crate) at: f64,
    speed: f64,
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
    fn course(&self) -> &Course {
        &self.pieces[self.pieces.len() - 1].1
    }

    fn origin(&self) -> f64 {
        self.pieces[self.pieces.len() - 1].0
    }

    pub(crate) fn has_arrived(&self) -> bool {
        self.at + self.doubt[1] >= self.course().length() - THERE
    }

    fn report(&self) -> Report {
        let end = self.course().length();
        let at = [(self.at - self.doubt[0]).max(0.0), (self.at + self.doubt[1]).min(end)];
        Report { robot: self.name.clone(), path: self.path, at, age: 0.0 }
    }

    fn take(&mut self, path: u64, origin: f64, course: Course) {
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
        let brakes = Brakes::new(brake, 0.5 * STEP).unwrap();
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
    fn agent(&mut self, id: u64, [begin, end]: [f64; 2]) -> Agent {
        let (from, to) = (self.since, self.origin() + self.at);
        let mut pieces: Vec<Course> = Vec::new();
        for (k, (origin, course)) in self.pieces.iter().enumerate() {
            let last = self.pieces.get(k + 1).map_or(to, |next| next.0.min(to));
            let (lo, hi) = (from.max(*origin), last);
            if hi > lo {
                pieces.push(course.part(lo - origin, hi - origin).unwrap());
            }
        }
        let standing = Course::new(self.course().pose(self.at), Vec::new()).unwrap();
        let path = path(if pieces.is_empty() { std::slice::from_ref(&standing) } else { &pieces }, to - from);
        let mut phases: Vec<data::Phase> = Vec::new();
        let (mut time, mut length) = (0.0, 0.0);
        for (duration, way, speed) in self.done.drain(..) {
            let (later, further) = (time + duration, length + way);
            match phases.last_mut() {
                Some(last) if last.speed == [0.0; 2] && speed == [0.0; 2] => last.time[1] = later,
                _ => phases.push(data::Phase { time: [time, later], length: [length, further], speed }),
            }
            (time, length) = (later, further);
        }
        assert!((time - (end - begin)).abs() < 1e-6 && (length - (to - from)).abs() < 1e-6);
        self.since = to;
        let keep = self.pieces.iter().rposition(|(origin, _)| *origin <= to).unwrap_or(0);
        self.pieces.drain(..keep);
        let travel = Travel { start: begin, phases, lag: 0.0, time_excess: 0.0 };
        Agent { id, radius: self.abilities.radius, path, travel: Some(travel) }
    }
}

fn path(pieces: &[Course], length: f64) -> data::Path {
    let start = pieces[0].start();
    let (mut heading, mut from) = (start.heading, 0.0);
    let mut segments = Vec::new();
    for piece in pieces {
        let mut turns = vec![Angle::Radians(piece.start().heading - heading)];
        heading = piece.start().heading;
        for shape in piece.shapes() {
            let (long, radius) = match *shape {
                Shape::Turn { sweep } => {
                    turns.push(Angle::Radians(sweep));
                    heading += sweep;
                    continue;
                }
                Shape::Line { length } => (length, None),
                Shape::Arc { radius, sweep } => {
                    heading += sweep;
                    (shape.length(), Some(radius.copysign(sweep)))
                }
            };
            if long > 0.0 {
                segments.push(Segment {
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
        segments.push(Segment { length: 0.0, radius: None, turns: Vec::new(), from: 0.0, to: 0.0 });
    }
    assert!((from - length).abs() < 1e-6, "the record is {from} m long, the way {length} m");
    let rounding = 1e-9;
    data::Path { start: [start.x, start.y], heading: Angle::Radians(start.heading), segments, rounding, step: 0.0 }
}

enum Mail {
    /// With the time at which it was so.
    Report(Report, f64),
    Event(Event, Option<(f64, Course)>),
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
    pub(crate) settings: Settings,
    pub(crate) vehicles: Vec<Vehicle>,
    pub(crate) now: f64,
    tick: u32,
    certified: u32,
    dice: Random,
    mail: Vec<(f64, Mail)>,
    trouble: Trouble,
    half: f64,
    /// Certified intervals of time.
    pub(crate) steps: usize,
    pub(crate) open: bool,
    pub(crate) proposals: u32,
    pub(crate) waits: u32,
    pub(crate) kills: u32,
}

impl World {
    pub(crate) fn new(seed: u64, count: usize, trouble: Trouble) -> Self {
        let (disc, settings) = (Disc::new(), Settings::default());
        let mut supervisor = Supervisor::new(settings, Box::new(disc.clone()));
        let mut dice = Random(seed);
        let side = (count as f64).sqrt().ceil() as usize;
        let half = 1.4 * side as f64;
        let mut vehicles = Vec::new();
        for k in 0..count {
            let cell = |n: usize| -half + 2.8 * (n as f64 + 0.5);
            let start = Start { x: cell(k % side), y: cell(k / side), heading: dice.within(-PI, PI) };
            let radius = dice.within(0.15, 0.35);
            let abilities =
                Abilities { radius, margin: 0.0, speed: dice.within(0.5, 1.5), acceleration: dice.within(0.4, 1.0) };
            let name = format!("robot {k}");
            supervisor.add(&name, abilities, start).unwrap();
            let course = Course::new(start, Vec::new()).unwrap();
            let doubt = [dice.within(0.0, 0.03), dice.within(0.0, 0.03)];
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
            proposals: 0,
            waits: 0,
            kills: 0,
        }
    }

    pub(crate) fn dice(&mut self) -> &mut Random {
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
            assert!(robot.told >= hold - 1e-9, "{}: {hold} was told, {} is known", vehicle.name, robot.told);
        }
    }

    /// From now on what matters goes to another journal, all of it.
    pub(crate) fn persist(&mut self, mut keeper: Box<dyn Keep>) {
        self.supervisor.settle(self.now).unwrap();
        keeper.keep(&self.supervisor.snapshot().unwrap()).unwrap();
        self.supervisor = Supervisor::restored(self.settings, self.supervisor.snapshot().unwrap(), keeper).unwrap();
    }

    fn post(&mut self, mail: Mail) {
        let late = if self.dice.unit() < 0.3 { self.dice.within(0.0, self.trouble.late) } else { 0.0 };
        self.mail.push((self.now + late, mail));
    }

    /// A way on from a place, that stays in the arena.
    fn shapes(&mut self, start: Start) -> Option<Vec<Shape>> {
        let dice = &mut self.dice;
        let shapes = (0..1 + dice.below(4)).map(|_| match dice.below(3) {
            0 => Shape::Turn { sweep: dice.within(-PI, PI) },
            1 => Shape::Arc { radius: dice.within(0.3, 1.0), sweep: dice.within(-PI, PI) },
            _ => Shape::Line { length: dice.within(0.3, 4.0) },
        });
        let course = Course::new(start, shapes.collect()).unwrap();
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
        let (told, length) = (robot.told, robot.course.length());
        let arrives = robot.at >= length - self.settings.width;
        if !arrives && self.dice.unit() < 0.7 {
            return;
        }
        let after = if arrives { length } else { self.dice.within(told, length) };
        let robot = self.supervisor.robot(&self.vehicles[k].name).unwrap();
        let start = robot.course.arrival(after).unwrap();
        let Some(path) = self.shapes(start) else { return };
        self.proposals += 1;
        let proposal = Proposal {
            robot: self.vehicles[k].name.clone(),
            mission: format!("mission {}", self.proposals),
            after: (!arrives).then_some(after),
            of: None,
            start: Some(start),
            path,
        };
        let verdict = self.supervisor.mission(&proposal, self.now).unwrap();
        // To ask again changes nothing.
        let again = self.supervisor.mission(&proposal, self.now).unwrap();
        assert_eq!(verdict, again);
        self.waits += u32::from(matches!(verdict, Verdict::Waiting { .. }));
    }

    /// A step of the fleet; returns what was told.
    pub(crate) fn step(&mut self) -> Vec<Event> {
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
                    let report = Report { age: self.now - said, ..report };
                    self.supervisor.position(&report, self.now).unwrap();
                }
                Mail::Event(event, course) => news.push((event, course)),
            }
        }
        let events = match self.supervisor.settle(self.now) {
            Ok(events) => events,
            Err(Fault::Broken { .. }) => {
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
            let is_hold = matches!(event, Event::Hold { .. });
            if is_hold && self.dice.unit() < self.trouble.lost {
                continue;
            }
            let admitted = matches!(event, Event::Admitted { .. });
            let robot = self.supervisor.robot(event.robot()).unwrap();
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
            self.vehicles[unlucky].stops_until = self.now + self.dice.within(0.0, 20.0);
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

    fn hear(&mut self, event: &Event, course: Option<(f64, Course)>) {
        let vehicle = self.vehicles.iter_mut().find(|vehicle| vehicle.name == event.robot()).unwrap();
        match event {
            Event::Admitted { path, .. } => {
                let (origin, course) = course.unwrap();
                vehicle.missions += 1;
                vehicle.take(*path, origin, course);
            }
            Event::Hold { path, hold, .. } if *path == vehicle.path => vehicle.hold = vehicle.hold.max(*hold),
            Event::Stop { .. } => vehicle.stopped = true,
            Event::Go { .. } => vehicle.stopped = false,
            _ => {}
        }
    }

    pub(crate) fn certify(&mut self) {
        let window = [f64::from(self.certified) * STEP, self.now];
        self.certified = self.tick;
        let agents: Vec<Agent> =
            self.vehicles.iter_mut().enumerate().map(|(id, vehicle)| vehicle.agent(id as u64, window)).collect();
        let movers: Vec<Mover> = agents.iter().map(|agent| Mover::new(agent, window).unwrap()).collect();
        let found = meetings(&movers);
        self.steps += found.steps;
        assert!(found.contacts.is_empty() && found.undecided.is_empty(), "{found:?}");
    }
}

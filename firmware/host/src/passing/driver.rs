//! A robot with its controller.

use super::drawn::Random;
use super::line::Way;
use super::rounded::Rounded;
use super::tally::Tally;
use super::{PIECES, REGIONS, ROBOTS, SEGMENTS, STEP};
use pcr_core::scalar::Angle;
use pcr_core::{BrakingModel, Curve, FleetMotions, Interval, PassingState, TurnSide};
use pcr_supervisor::message::{Edition, Refusal};
use pcr_supervisor::robot::Unclear;
use pcr_supervisor::{Agent, Answer, Briefing, Client, Event, Number, Request, Robot};
use std::error::Error;

/// Control steps after which no frame from before a restart can still be on the line: 9 s.
const SILENCE: usize = 90;

/// A robot with its controller.
pub(super) struct Driver<S: Number> {
    pub(super) index: u16,
    client: Client,
    briefing: Briefing<S, ROBOTS, SEGMENTS, REGIONS>,
    pub(super) robot: Robot<S, ROBOTS, REGIONS, PIECES>,
    /// Whether it is asking for orders, and has to begin anew.
    pub(super) asks: bool,
    /// Its path as it was told, and where it is on it.
    told: Option<Agent<S>>,
    path: Option<Agent<S>>,
    length: S,
    pub(super) at: f64,
    pub(super) speed: f64,
    stops: usize,
    pub(super) hold: f64,
    /// Controls since it asked.
    waits: usize,
    /// Controls for which it says nothing.
    silent: usize,
}

impl<S: Rounded> Driver<S> {
    /// At the start of its path, without orders.
    pub(super) fn new(index: u16, agent: Agent<S>) -> Self {
        Self {
            index,
            client: Client::robot(index),
            briefing: Briefing::new(),
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
        }
    }

    /// Length of its path \[m\].
    pub(super) fn end(&self) -> f64 {
        self.length.to_f64()
    }

    /// Sends its question, or the last one again.
    pub(super) fn send(&mut self, line: &mut Way, random: &mut Random, bad: usize, tally: &mut Tally) {
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
    pub(super) fn restart(&mut self) {
        (self.client, self.robot) = (Client::robot(self.index), Robot::new());
        self.briefing.begin(self.index);
        (self.asks, self.told, self.speed, self.hold) = (false, None, 0.0, 0.0);
        self.silent = SILENCE;
    }

    fn inquire(&mut self) {
        (self.asks, self.waits) = (true, 0);
        self.briefing.begin(self.index);
        assert!(self.client.ask(&Request::<S>::Orders { agent: self.index }), "a question fits a frame");
    }

    pub(super) fn hear(&mut self, bytes: &[u8], tally: &mut Tally) -> Result<(), Box<dyn Error>> {
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
                        Answer::Passing { pass: PassingState::Second, .. } => tally.orders += 1,
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
        let fleet = motions(&self.briefing);
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
    pub(super) fn control(&mut self, random: &mut Random, reckless: bool) -> Result<(), Box<dyn Error>> {
        if !self.asks {
            let fleet = motions(&self.briefing);
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
        let safe = BrakingModel::new(1.0, STEP)?.speed(way.clamp(0.0, 1e3));
        let wanted = if self.stops > 0 { 0.0 } else { random.unit().max(0.5) };
        self.speed = safe.min(wanted).min(self.speed + STEP);
        Ok(())
    }

    /// Its true position, computed here from its path in `f64`, and its radius.
    pub(super) fn disc(&self) -> Option<([f64; 2], f64)> {
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
                    let sign = if turn == TurnSide::Left { 1.0 } else { -1.0 };
                    let (radius, turned) = (sign * radius.to_f64(), sign * length / radius.to_f64());
                    (x, y) = (
                        x + radius * ((heading + turned).sin() - heading.sin()),
                        y - radius * ((heading + turned).cos() - heading.cos()),
                    );
                    heading += turned;
                }
                Curve::Pivot { lever, turn } => {
                    let angle = length / lever.to_f64();
                    heading += if turn == TurnSide::Left { angle } else { -angle };
                }
            }
        }
        Some(([x, y], path.radius.to_f64()))
    }
}

/// The paths that a robot knows.
pub(crate) fn motions<S: Number, const A: usize, const N: usize, const R: usize>(
    told: &Briefing<S, A, N, R>,
) -> FleetMotions<'_, S, A> {
    let mut fleet = FleetMotions::new();
    fleet.fill(told.paths());
    fleet
}

//! A robot on its way: it keeps its hold, stops at corners and turns, and is stopped at random.

use super::way::Way;
use pcr_core::{Brakes, Interval, Progress};
use pcr_formats::import::Vehicle;

/// Time between two controls \[s\].
pub(super) const STEP: f64 = 0.1;

/// A robot stands so far before its hold at least, for rounding \[m\].
const SHORT: f64 = 1e-6;

/// So near to where it stops a robot has arrived \[m\].
const THERE: f64 = 1e-3;

/// What a robot can do, and the time it takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Abilities {
    pub(super) speed: f64,
    pub(super) acceleration: f64,
    rotation: f64,
    rotation_acceleration: f64,
    brakes: Brakes<f64>,
}

impl Abilities {
    pub(super) fn of(vehicle: &Vehicle) -> Option<Self> {
        let brakes = Brakes::new(vehicle.acceleration, STEP / 2.0).ok()?;
        let Vehicle { speed, acceleration, rotation, rotation_acceleration, .. } = *vehicle;
        Some(Self { speed, acceleration, rotation, rotation_acceleration, brakes })
    }

    /// Time of a turn in place from rest to rest \[s\].
    pub(super) fn turn(&self, angle: f64) -> f64 {
        let (angle, ramp) = (angle.abs(), self.rotation / self.rotation_acceleration);
        if angle > self.rotation * ramp {
            angle / self.rotation + ramp
        } else {
            2.0 * (angle / self.rotation_acceleration).sqrt()
        }
    }

    /// Time that is lost by a stop \[s\].
    pub(super) fn stop(&self) -> f64 {
        self.speed / self.acceleration
    }
}

/// A robot.
#[derive(Clone, Debug)]
pub(super) struct Robot<'a> {
    pub(super) way: Way<'a>,
    /// Travelled length \[m\] and speed \[m/s\].
    pub(super) at: f64,
    pub(super) speed: f64,
    /// Corners that it has turned at.
    pub(super) turned: usize,
    /// Rest of the turn that it is at \[s\].
    turning: f64,
    /// Until when it stands for no reason \[s\].
    pub(super) stopped_until: f64,
    /// Node of its next goal that it has no way to yet, and since when it waits \[s\].
    pub(super) wants: Option<(usize, f64)>,
}

impl<'a> Robot<'a> {
    pub(super) fn new(way: Way<'a>) -> Self {
        Self { way, at: 0.0, speed: 0.0, turned: 0, turning: 0.0, stopped_until: 0.0, wants: None }
    }

    /// What is known of it: all.
    pub(super) fn progress(&self, abilities: &Abilities) -> Progress<f64> {
        let stop = self.at + self.speed * self.speed / (2.0 * abilities.acceleration);
        Progress { at: Interval::new(self.at, self.at), stop: stop.min(self.way.length()) }
    }

    /// Where it stops next by itself: a corner, the goal, or the end \[m\].
    pub(super) fn next_stop(&self) -> f64 {
        let corner = self.way.corners.get(self.turned).map_or(f64::INFINITY, |corner| corner.0);
        corner.min(self.way.goal.unwrap_or(f64::INFINITY)).min(self.way.length())
    }

    /// Beyond what a hold matters for the next step \[m\].
    pub(super) fn horizon(&self, abilities: &Abilities) -> f64 {
        let speed = self.speed + abilities.acceleration * STEP;
        self.at + speed * STEP + speed * speed / (2.0 * abilities.acceleration) + 2.0 * SHORT
    }

    /// Goes on for a step, so that it can stop before this length; returns whether it is at its goal.
    pub(super) fn drive(&mut self, hold: f64, time: f64, abilities: &Abilities) -> bool {
        if self.turning > 0.0 {
            self.turning -= STEP;
            return false;
        }
        let next = self.next_stop();
        let left = next.min(hold - SHORT) - self.at;
        let wanted = abilities.brakes.speed(left - 0.5 * self.speed * STEP).min(abilities.speed);
        let wanted = if self.stopped_until > time { 0.0 } else { wanted };
        let change = abilities.acceleration * STEP;
        let speed = wanted.clamp((self.speed - change).max(0.0), self.speed + change);
        let stopping = self.speed * self.speed / (2.0 * abilities.acceleration);
        let way = if speed == 0.0 { stopping } else { 0.5 * (self.speed + speed) * STEP };
        (self.at, self.speed) = ((self.at + way).min(self.way.length()), speed);
        if next - self.at > THERE || self.speed > change {
            return false;
        }
        self.speed = 0.0;
        if let Some(&(corner, angle)) = self.way.corners.get(self.turned)
            && corner <= next
        {
            self.turned += 1;
            self.turning = abilities.turn(angle);
        }
        let arrived = self.way.goal.is_some_and(|goal| goal <= next);
        if arrived {
            self.way.goal = None;
        }
        arrived
    }

    /// Takes another way, the first `before` metres of the old one being cut off.
    pub(super) fn take(&mut self, way: Way<'a>, before: f64) {
        self.at = (self.at - before).max(0.0);
        // Where it stands at a corner the turn is still to be done.
        self.turned = way.corners.iter().filter(|corner| corner.0 < self.at - THERE).count();
        self.way = way;
    }

    /// Whether it stands at the end of its way.
    pub(super) fn has_arrived(&self) -> bool {
        self.speed == 0.0 && self.way.length() - self.at <= THERE
    }
}

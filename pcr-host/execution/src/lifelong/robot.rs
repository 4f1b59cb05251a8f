//! A robot in motion: it stops before its hold, at corners and at goals; it slips, and is stopped at random.

use super::kinematic_limits::KinematicLimits;
use super::route::Route;
use super::route_graph::RouteGraph;
use std::rc::Rc;

/// Least distance at which a robot stands before its hold, for rounding \[m\].
pub(super) const SHORT: f64 = 1e-6;

/// Lengths that differ by less are equal, for rounding \[m\].
const NEAR: f64 = 1e-9;

/// A part of a motion with constant acceleration, with the speeds at both its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RobotPhase {
    /// Time at which it begins \[s\].
    pub(super) time: f64,
    pub(super) duration: f64,
    pub(super) speed: [f64; 2],
}

/// A robot.
#[derive(Clone, Debug)]
pub(super) struct LifelongRobot {
    pub(super) way: Route,
    pub(super) abilities: KinematicLimits,
    /// If its way ends on an edge: the atoms on which others would touch it there.
    pub(super) cut: Option<Rc<[usize]>>,
    /// Travelled length \[m\] and speed \[m/s\].
    pub(super) at: f64,
    pub(super) speed: f64,
    /// Number of corners at which it has turned.
    pub(super) turned: usize,
    /// Time until which it turns \[s\].
    pub(super) turning: f64,
    /// Time until which it is stopped at random \[s\].
    pub(super) stopped_until: f64,
    /// Share of its speed that it loses at present.
    pub(super) slip: f64,
    /// Earliest time at which it sets off \[s\].
    pub(super) departs: f64,
    /// Time since which it has not moved \[s\].
    pub(super) still_since: f64,
    /// Its motion since the last report, and the atoms on which it was.
    pub(super) done: Vec<RobotPhase>,
    pub(super) trail: Vec<usize>,
    /// Number of atoms of its way that are in this list.
    entered: usize,
    /// Its stops at corners, goals and ends: the time \[s\], the number of atoms in `trail`, and the length on the last of these \[m\];
    /// infinite: at its end.
    pub(super) stops: Vec<(f64, usize, f64)>,
}

impl LifelongRobot {
    pub(super) fn new(way: Route, abilities: KinematicLimits) -> Self {
        Self {
            way,
            abilities,
            cut: None,
            at: 0.0,
            speed: 0.0,
            turned: 0,
            turning: 0.0,
            stopped_until: 0.0,
            slip: 0.0,
            departs: 0.0,
            still_since: 0.0,
            done: Vec::new(),
            trail: Vec::new(),
            entered: 0,
            stops: Vec::new(),
        }
    }

    /// Length at which it can come to rest \[m\].
    pub(super) fn stop(&self) -> f64 {
        if self.speed > 0.0 { (self.at + self.abilities.braking(self.speed)).min(self.way.length()) } else { self.at }
    }

    /// Its next stop: a corner, the goal, or the end \[m\].
    fn next_stop(&self) -> f64 {
        let corner = self.way.corners.get(self.turned).map_or(f64::INFINITY, |corner| corner.at);
        corner.min(self.way.goals.first().copied().unwrap_or(f64::INFINITY)).min(self.way.length())
    }

    /// Length beyond which a hold does not affect the next step \[m\].
    pub(super) fn horizon(&self, step: f64) -> f64 {
        let abilities = &self.abilities;
        let speed = (self.speed + abilities.acceleration * step).min(abilities.speed);
        self.at + speed * step + abilities.braking(speed) + 2.0 * SHORT
    }

    /// Advances by a step, so that it can still stop before `hold`. Returns whether it has reached its goal.
    pub(super) fn drive(&mut self, hold: f64, time: f64, step: f64) -> bool {
        let abilities = &self.abilities;
        let next = self.next_stop();
        let waits = self.turning > time || self.departs > time;
        let left = if waits { 0.0 } else { next.min(hold - SHORT) - self.at };
        let stopped = self.stopped_until > time;
        let limit = self.way.speeds[self.way.atom(self.at.max(1e-12))].min(abilities.speed) * (1.0 - self.slip);
        let phases = pace(self.speed, if stopped { 0.0 } else { limit }, left, self.slower_ahead(), step, abilities);
        let mut begin = time;
        let before = self.at;
        for (duration, to) in phases {
            if duration > 0.0 {
                self.at += 0.5 * (self.speed + to) * duration;
                self.record(begin, duration, to);
                begin += duration;
                self.speed = to;
            }
        }
        if self.speed == 0.0 && before < self.at {
            // The planned stop, corrected for rounding.
            let aim = before + left;
            if (aim - self.at).abs() < NEAR {
                self.at = aim;
            }
        }
        self.at = self.at.min(self.way.length());
        let comes = self.speed == 0.0 && next - self.at <= NEAR && !waits;
        if comes {
            self.at = next;
        }
        self.enter();
        if self.at > before {
            self.still_since = time + step;
        }
        if !comes {
            return false;
        }
        // At the start of a new way it is at the end of the atom before.
        let along = if self.entered > 0 { self.along() } else { f64::INFINITY };
        self.stops.push((time + step, self.trail.len(), along));
        // At a goal it may get another way before it turns for this one.
        if self.way.goals.first().is_some_and(|&goal| goal <= next) {
            self.way.goals.remove(0);
            return true;
        }
        if let Some(corner) = self.way.corners.get(self.turned)
            && corner.at <= next
        {
            self.turned += 1;
            self.turning = time + step + corner.turn;
        }
        false
    }

    /// Time of its way at its place, if it goes on as soon as it can; or the time on another way, with its place there and the
    /// time at which it sets off \[s\].
    pub(super) fn progress(&self, other: Option<(&Route, f64, f64)>, time: f64) -> f64 {
        let abilities = &self.abilities;
        let corner = self.turned.checked_sub(1).and_then(|last| self.way.corners.get(last));
        let (there, departs) = match other {
            Some((way, at, departs)) if !std::ptr::eq(way, &raw const self.way) => (way.time(at), departs),
            _ if corner.is_some_and(|corner| corner.at == self.at) => (self.way.left_for(self.at), self.departs),
            _ => (self.way.time(self.at), self.departs),
        };
        let slow = 0.5 * abilities.stop() * (1.0 - self.speed / abilities.speed);
        there - (departs.max(self.stopped_until).max(self.turning) - time).max(0.0) - slow
    }

    /// Adds the atoms that it has reached to the record.
    fn enter(&mut self) {
        while self.entered < self.way.atoms.len() && self.at > self.way.offsets[self.entered] {
            let atom = self.way.atoms[self.entered];
            // By rounding it can be back at the beginning of an atom, with another way along it. No atom follows itself.
            if self.trail.last() != Some(&atom) {
                self.trail.push(atom);
            }
            self.entered += 1;
        }
    }

    /// Takes its motion since the last report: phases, atoms, and the length on the first atom at which they begin \[m\].
    pub(super) fn report(&mut self, since: f64) -> (Vec<RobotPhase>, Vec<usize>, f64) {
        let last = self.trail.last().copied();
        let told = (std::mem::take(&mut self.done), std::mem::take(&mut self.trail), since);
        // At the start of a new way it is on no atom of that way yet.
        if self.entered > 0 {
            self.trail.extend(last);
        }
        told
    }

    /// Length on the atom with which the next record begins \[m\]; at a node, the end of the atom before.
    pub(super) fn along(&self) -> f64 {
        let begun = self.entered.checked_sub(1).and_then(|last| self.way.offsets.get(last));
        begun.map_or(0.0, |offset| self.at - offset)
    }

    /// Adds a phase to the record; a phase that continues the last one extends it.
    fn record(&mut self, time: f64, duration: f64, to: f64) {
        if let Some(last) = self.done.last_mut() {
            let alike = |a: f64, b: f64| (a - b).abs() < 1e-12;
            if last.speed == [self.speed; 2] && alike(self.speed, to) {
                last.duration = time + duration - last.time;
                return;
            }
        }
        self.done.push(RobotPhase { time, duration, speed: [self.speed, to] });
    }

    /// Distances of the lower speed limits within reach, and these speeds.
    fn slower_ahead(&self) -> impl Iterator<Item = (f64, f64)> + use<'_> {
        let abilities = &self.abilities;
        let k = self.way.atom(self.at.max(1e-12));
        let reach = self.at + 2.0 * abilities.braking(abilities.speed);
        let ahead = (k + 1..self.way.atoms.len()).take_while(move |&next| self.way.offsets[next] <= reach);
        let slower = ahead.filter(move |&next| self.way.speeds[next] < self.way.speeds[k]);
        slower.map(move |next| (self.way.offsets[next] - self.at, self.way.speeds[next]))
    }

    /// Takes another way; the first `before` metres of the old way are cut off.
    pub(super) fn take(&mut self, way: Route, before: f64) {
        // An atom that was entered by rounding only was not driven, and the new way may leave the node differently.
        if self.entered > 0 && self.along() < NEAR {
            self.trail.pop();
        }
        let turns = self.turned.checked_sub(1).and_then(|last| self.way.corners.get(last));
        let turns = turns.is_some_and(|corner| corner.at == self.at);
        self.at -= before;
        // At a node its place is set to the node's length on the new way; otherwise rounding could put it on another atom.
        if let Some(&node) = way.offsets.iter().find(|&&offset| (offset - self.at).abs() < NEAR) {
            self.at = node;
        }
        self.entered = way.offsets.partition_point(|&offset| offset < self.at);
        // At a corner where it stands, the turn is still to be done; but within an edge it is the one that it has begun.
        let goes_on = turns && way.offsets.iter().all(|&offset| (offset - self.at).abs() >= NEAR);
        let passed = |at: f64| if goes_on { at < self.at + NEAR } else { at < self.at };
        self.turned = way.corners.iter().filter(|corner| passed(corner.at)).count();
        self.way = way;
    }

    /// The atoms on which others would touch it at the end of its way.
    pub(super) fn end_covers(&self, site: &RouteGraph) -> Rc<[usize]> {
        self.cut.clone().unwrap_or_else(|| site.covers(self.way.end()))
    }

    /// Whether another robot on an atom would touch it at the end of its way.
    pub(super) fn ends_on(&self, site: &RouteGraph, atom: usize) -> bool {
        match &self.cut {
            Some(cut) => cut.contains(&atom),
            None => site.passes(atom, self.way.end()),
        }
    }

    /// Whether it stands at the end of its way.
    pub(super) fn has_arrived(&self) -> bool {
        self.speed == 0.0 && self.at >= self.way.length()
    }
}

/// Durations and final speeds of the parts of a step that leaves room to stop within `left` metres.
fn pace(
    speed: f64,
    limit: f64,
    left: f64,
    slower: impl Iterator<Item = (f64, f64)>,
    step: f64,
    abilities: &KinematicLimits,
) -> [(f64, f64); 2] {
    let braking = abilities.acceleration;
    let change = braking * step;
    if left <= 0.0 && speed == 0.0 {
        return [(step, 0.0), (0.0, 0.0)];
    }
    // It can stop exactly there within the step.
    if 0.5 * speed * step >= left {
        let duration = (2.0 * left / speed).max(speed / braking);
        if duration <= step {
            return [(duration, 0.0), (step - duration, 0.0)];
        }
    }
    // (v + v') dt / 2 + v'² / 2a = left
    let fastest = |left: f64, then: f64| {
        let half = 0.5 * braking * step;
        -half + (half * half + 2.0 * braking * (left - 0.5 * speed * step) + then * then).max(0.0).sqrt()
    };
    let mut wanted = limit.min(fastest(left, 0.0));
    for (distance, then) in slower {
        wanted = wanted.min(fastest(distance, then).max(then));
    }
    let to = wanted.clamp((speed - change).max(0.0), speed + change).max(0.0);
    if to == 0.0 && speed > 0.0 {
        let duration = (speed / braking).min(step);
        return [(duration, 0.0), (step - duration, 0.0)];
    }
    [(step, to), (0.0, to)]
}

//! A robot in motion: it stops before its hold, at corners and at goals; it slips, and is stopped at random.

use super::abilities::Abilities;
use super::way::Way;

/// A robot stands so far before its hold at least, for rounding \[m\].
pub(super) const SHORT: f64 = 1e-6;

/// Lengths that differ by less are the same, for rounding \[m\].
const NEAR: f64 = 1e-9;

/// So long at constant acceleration, between these speeds, on this atom from this length on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phase {
    /// When it begins \[s\].
    pub(super) time: f64,
    pub(super) duration: f64,
    pub(super) speed: [f64; 2],
}

/// A robot.
#[derive(Clone, Debug)]
pub(super) struct Robot {
    pub(super) way: Way,
    /// Travelled length \[m\] and speed \[m/s\].
    pub(super) at: f64,
    pub(super) speed: f64,
    /// Corners that it has turned at.
    pub(super) turned: usize,
    /// Until when it turns \[s\].
    pub(super) turning: f64,
    /// Until when it stands for no reason \[s\].
    pub(super) stopped_until: f64,
    /// Share of its speed that it loses for now.
    pub(super) slip: f64,
    /// Before this time it does not set off \[s\].
    pub(super) departs: f64,
    /// Since when it has not moved \[s\].
    pub(super) still_since: f64,
    /// What it has done, and on which atoms, since it was asked for that.
    pub(super) done: Vec<Phase>,
    pub(super) trail: Vec<usize>,
    /// Atoms of its way that are in there.
    entered: usize,
}

impl Robot {
    pub(super) fn new(way: Way) -> Self {
        Self {
            way,
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
        }
    }

    /// Where it is at rest at the latest \[m\].
    pub(super) fn stop(&self, abilities: &Abilities) -> f64 {
        if self.speed > 0.0 { (self.at + abilities.braking(self.speed)).min(self.way.length()) } else { self.at }
    }

    /// Where it stops next by itself: a corner, the goal, or the end \[m\].
    fn next_stop(&self) -> f64 {
        let corner = self.way.corners.get(self.turned).map_or(f64::INFINITY, |corner| corner.at);
        corner.min(self.way.goals.first().copied().unwrap_or(f64::INFINITY)).min(self.way.length())
    }

    /// Beyond what a hold does not matter for the next step \[m\].
    pub(super) fn horizon(&self, abilities: &Abilities, step: f64) -> f64 {
        let speed = (self.speed + abilities.acceleration * step).min(abilities.speed);
        self.at + speed * step + abilities.braking(speed) + 2.0 * SHORT
    }

    /// Goes on for a step, so that it can stop before this length; returns whether it has come to its goal.
    pub(super) fn drive(&mut self, hold: f64, time: f64, step: f64, abilities: &Abilities) -> bool {
        let next = self.next_stop();
        let waits = self.turning > time || self.departs > time;
        let left = if waits { 0.0 } else { next.min(hold - SHORT) - self.at };
        let stopped = self.stopped_until > time;
        let limit = self.way.speeds[self.way.atom(self.at.max(1e-12))].min(abilities.speed) * (1.0 - self.slip);
        let phases =
            pace(self.speed, if stopped { 0.0 } else { limit }, left, self.slower_ahead(abilities), step, abilities);
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
            // A stop is where it was to be, but for rounding.
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
        // At its goal it may get another way before it turns for this one.
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

    /// Time of its way at which it is, if it goes on as soon as it can; or of another way, where it is on that, and when it sets off
    /// \[s\].
    pub(super) fn progress(&self, other: Option<(&Way, f64, f64)>, time: f64, abilities: &Abilities) -> f64 {
        let corner = self.turned.checked_sub(1).and_then(|last| self.way.corners.get(last));
        let (there, departs) = match other {
            Some((way, at, departs)) if !std::ptr::eq(way, &raw const self.way) => (way.time(at), departs),
            _ if corner.is_some_and(|corner| corner.at == self.at) => (self.way.left_for(self.at), self.departs),
            _ => (self.way.time(self.at), self.departs),
        };
        let slow = 0.5 * abilities.stop() * (1.0 - self.speed / abilities.speed);
        there - (departs.max(self.stopped_until).max(self.turning) - time).max(0.0) - slow
    }

    /// Notes the atoms that it has come to.
    fn enter(&mut self) {
        while self.entered < self.way.atoms.len() && self.at > self.way.offsets[self.entered] {
            let atom = self.way.atoms[self.entered];
            // Back at its beginning by rounding, with another way along it: no atom follows itself.
            if self.trail.last() != Some(&atom) {
                self.trail.push(atom);
            }
            self.entered += 1;
        }
    }

    /// What it has done since it was asked last, and on which atoms, from which length of the first one on \[m\].
    pub(super) fn report(&mut self, since: f64) -> (Vec<Phase>, Vec<usize>, f64) {
        let last = self.trail.last().copied();
        let told = (std::mem::take(&mut self.done), std::mem::take(&mut self.trail), since);
        // At the start of a new way it is on no atom of that yet.
        if self.entered > 0 {
            self.trail.extend(last);
        }
        told
    }

    /// How far it is along the atom with which the next record begins \[m\]: at a node that is the end of the one that it came on.
    pub(super) fn along(&self) -> f64 {
        let begun = self.entered.checked_sub(1).and_then(|last| self.way.offsets.get(last));
        begun.map_or(0.0, |offset| self.at - offset)
    }

    /// A phase from now on; one that goes on as the last one makes that longer.
    fn record(&mut self, time: f64, duration: f64, to: f64) {
        if let Some(last) = self.done.last_mut() {
            let alike = |a: f64, b: f64| (a - b).abs() < 1e-12;
            if last.speed == [self.speed; 2] && alike(self.speed, to) {
                last.duration = time + duration - last.time;
                return;
            }
        }
        self.done.push(Phase { time, duration, speed: [self.speed, to] });
    }

    /// Where it has to be slower, and how fast it may be there.
    fn slower_ahead(&self, abilities: &Abilities) -> Option<(f64, f64)> {
        let k = self.way.atom(self.at.max(1e-12));
        let reach = self.at + 2.0 * abilities.braking(abilities.speed);
        let ahead = (k + 1..self.way.atoms.len()).take_while(|&next| self.way.offsets[next] <= reach);
        let slower = ahead.filter(|&next| self.way.speeds[next] < self.way.speeds[k]);
        slower.map(|next| (self.way.offsets[next] - self.at, self.way.speeds[next])).next()
    }

    /// Takes another way, the first `before` metres of the old one being cut off.
    pub(super) fn take(&mut self, way: Way, before: f64) {
        // What was entered by rounding alone was not gone along, and the new way may leave the node otherwise.
        if self.entered > 0 && self.along() < NEAR {
            self.trail.pop();
        }
        self.at -= before;
        // At a node it is exactly there on the new way, too: else it would be on the next atom already, or not yet.
        if let Some(&node) = way.offsets.iter().find(|&&offset| (offset - self.at).abs() < NEAR) {
            self.at = node;
        }
        self.entered = way.offsets.partition_point(|&offset| offset < self.at);
        // Where it stands at a corner the turn is still to be done.
        self.turned = way.corners.iter().filter(|corner| corner.at < self.at).count();
        self.way = way;
    }

    /// Whether it stands at the end of its way.
    pub(super) fn has_arrived(&self) -> bool {
        self.speed == 0.0 && self.at >= self.way.length()
    }
}

/// Durations and speeds after them of a step that leaves room to stop after `left` metres.
fn pace(
    speed: f64,
    limit: f64,
    left: f64,
    slower: Option<(f64, f64)>,
    step: f64,
    abilities: &Abilities,
) -> [(f64, f64); 2] {
    let braking = abilities.acceleration;
    let change = braking * step;
    if left <= 0.0 && speed == 0.0 {
        return [(step, 0.0), (0.0, 0.0)];
    }
    // It can stop within the step exactly there.
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
    if let Some((distance, then)) = slower {
        wanted = wanted.min(fastest(distance, then).max(then));
    }
    let to = wanted.clamp((speed - change).max(0.0), speed + change).max(0.0);
    if to == 0.0 && speed > 0.0 {
        let duration = (speed / braking).min(step);
        return [(duration, 0.0), (step - duration, 0.0)];
    }
    [(step, to), (0.0, to)]
}

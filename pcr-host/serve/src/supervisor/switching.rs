//! Robots that wait for one that will be there much later: they go before it, if everybody can still finish then.

use super::{Supervisor, fleet};
use crate::entry::Entry;
use pcr_core::{Mission, Pass, Refused, RegionRef};

/// Between two looks \[s\].
const PAUSE: f64 = 1.0;

/// Who has waited for so long goes before others, and is not tried again before so long \[s\].
const WAITED: f64 = 3.0;
const AGAIN: f64 = 8.0;

/// It has to be away so long before the other one would come \[s\].
const SLACK: f64 = 3.0;

/// A region of the same length is the same one \[m\].
const SAME: f64 = 1e-6;

impl Supervisor {
    /// Lets the one that has waited longest go first, where that makes nobody wait who is near.
    pub(super) fn switch(&mut self, now: f64) {
        if now < self.switched + PAUSE {
            return;
        }
        self.switched = now;
        let waits = |place: &usize| {
            let robot = &self.robots[*place];
            let stands = robot.alarm.is_none() && robot.stopped.is_none() && self.since(*place, now) > WAITED;
            stands && now >= robot.tried + AGAIN && self.kept_by(*place).is_some()
        };
        let waiting = (0..self.robots.len()).filter(waits);
        let longest = waiting.max_by(|a, b| self.since(*a, now).total_cmp(&self.since(*b, now)));
        // Whoever has been overtaken for long is not overtaken again.
        let Some(place) = longest.filter(|_| !self.is_overtaken(now)) else { return };
        self.robots[place].tried = now;
        if let Some(region) = self.is_early(place, now) {
            self.exchange(place, region);
        }
    }

    /// The region before which a robot waits for another one, that could be behind it before the other one comes: the other one, and where both
    /// enter it \[m\].
    fn is_early(&self, place: usize, now: f64) -> Option<(usize, f64)> {
        let by = self.kept_by(place)?;
        let [robot, other] = [place, by].map(|place| &self.robots[place]);
        let fleet = fleet(&self.robots);
        let row = self.orders.row(&fleet, place).ok()?;
        let ahead = row.filter(|(_, region, pass)| region.other() == by && *pass == Pass::Second);
        let ahead = ahead.map(|(_, region, _)| [region.length(), region.other_length()]);
        let [own, their] = ahead.min_by(|a, b| a[0].lo.total_cmp(&b[0].lo))?;
        let leaves = (own.hi - robot.at) / robot.abilities.speed;
        let stands = other.told < their.lo - self.settings.width && self.since(by, now) > WAITED;
        let comes = if stands { f64::INFINITY } else { (their.lo - other.at) / other.abilities.speed };
        (other.told <= their.lo && leaves + SLACK < comes).then_some((by, own.lo))
    }

    /// Admits the path that a robot has once more, with one order the other way round.
    fn exchange(&mut self, place: usize, (by, from): (usize, f64)) {
        let mut progress = self.progress();
        self.orders.passed(&progress);
        let course = self.robots[place].course.clone();
        let Ok(motion) = course.motion(self.robots[place].abilities.reach()) else { return };
        let tolerances = self.tolerances();
        let mut fleet = fleet(&self.robots);
        let Ok(row) = self.orders.row(&fleet, place) else { return };
        let kept: Vec<(usize, f64, Pass)> =
            row.map(|(_, region, pass)| (region.other(), region.length().lo, pass)).collect();
        let prefer = |region: &RegionRef<'_, f64>| {
            let is_same = |other: usize, lo: f64| region.other() == other && (region.length().lo - lo).abs() <= SAME;
            match kept.iter().find(|(other, lo, _)| is_same(*other, *lo)) {
                _ if is_same(by, from) => Pass::First,
                Some((_, _, pass)) => *pass,
                None => Pass::Second,
            }
        };
        let admitted = loop {
            let mission = Mission { agent: place, motion, progress: progress[place] };
            match self.orders.admit(&mut fleet, &mut progress, mission, tolerances, &mut self.reaches, prefer) {
                Err(Refused::Full(full)) if self.orders.grow(full).is_ok() => {}
                found => break found.is_ok(),
            }
        };
        drop(fleet);
        if admitted {
            self.counts.switched += 1;
            self.forget_holds_with(place);
            let known = self.known(place);
            self.entries.push(Entry::Robot(Box::new(known)));
        }
    }
}

//! Turns orders round where a robot waits for one that is late. Who goes first is decided when a mission is admitted, perhaps minutes
//! before the two come near one another.

use super::{Supervisor, Table, fleet};
use crate::entry::Entry;
use crate::robot::Robot;
use pcr_core::{Hold, Interval, Motion, Pass, Progress};

/// Between two looks \[s\].
const PAUSE: f64 = 0.25;

/// Whoever has stood for so long is looked at \[s\], and again after \[s\].
const STANDS: [f64; 2] = [1.0, 2.0];

/// The robot that waits has left a region so long before the other one would have to brake for it \[s\].
const SPARE: f64 = 10.0;

/// Orders that are turned round for a robot at once, at most.
const TURNS: usize = 8;

impl Supervisor {
    /// Looks for a robot that would have left the regions in front of it before those it waits for there come to them, and lets it go
    /// first: nobody is expected to wait for it. One at a time: each other look would have to start from what this one has changed.
    pub(super) fn pass_the_late(&mut self, now: f64) {
        if now < self.passed + PAUSE {
            return;
        }
        self.passed = now;
        let due = |place: &usize| {
            let robot = &self.robots[*place];
            let waits = self.waits_for(robot).is_some() && robot.told <= robot.at + self.settings.width;
            let is_well = robot.alarm.is_none() && robot.stopped.is_none() && !robot.silent;
            waits && is_well && self.since(*place, now) > STANDS[0] && now > robot.looked + STANDS[1]
        };
        let mut due: Vec<usize> = (0..self.robots.len()).filter(due).collect();
        due.sort_by(|&a, &b| self.robots[a].looked.total_cmp(&self.robots[b].looked));
        for place in due {
            self.robots[place].looked = now;
            if let Some(orders) = self.with_first(place, now) {
                self.orders = orders;
                self.counts.turned += 1;
                self.forget_holds_with(place);
                let known = self.known(place);
                self.entries.push(Entry::Robot(Box::new(known)));
                return;
            }
        }
    }

    /// The orders with which a robot need not wait until it has left all regions in which it would have to now; none if somebody else
    /// would have to wait for it, has been allowed to go there already, or somebody could not finish.
    fn with_first(&mut self, place: usize, now: f64) -> Option<Table> {
        let (progress, tolerances, fleet) = (self.progress(), self.tolerances(), fleet(&self.robots));
        let mut orders: Option<Table> = None;
        let mut clear = f64::NEG_INFINITY;
        for _ in 0..TURNS {
            let now_orders = orders.as_ref().unwrap_or(&self.orders);
            let (hold, by) = now_orders.wait(&fleet, place, &progress).ok()?;
            if orders.is_some() && hold.allows(clear) {
                let mut orders = orders?;
                return orders.check(&fleet, &progress, tolerances, &mut self.reaches).is_ok().then_some(orders);
            }
            // Who has got nowhere for long is passed by nobody: it would be overtaken again and again.
            let by = by.filter(|&by| self.since(by, now) <= self.settings.patience)?;
            let turn = turned(now_orders, &fleet, &progress, [place, by], &self.robots, now)?;
            clear = clear.max(turn.exit);
            let since = progress[by].at.lo;
            let orders = orders.get_or_insert_with(|| self.orders.clone());
            orders.decide_at(&fleet, turn.place, place, Pass::First, since).ok()?;
        }
        None
    }
}

/// An order that can be turned round.
struct Turn {
    /// Of its region in the table.
    place: usize,
    /// Where the one that goes first leaves the region \[m\].
    exit: f64,
}

/// The region at which one robot waits for another one, if it can go first there and will have left before the other one comes.
fn turned(
    orders: &Table,
    fleet: &[Motion<'_, f64>],
    progress: &[Progress<f64>],
    [robot, by]: [usize; 2],
    robots: &[Robot],
    now: f64,
) -> Option<Turn> {
    let [own, their] = [robot, by].map(|place| progress[place]);
    let row = orders.row(fleet, robot).ok()?;
    let seconds = row.filter(|(_, region, pass)| *pass == Pass::Second && region.other() == by);
    let held = seconds.map(|(place, region, _)| (region.hold(own.at.lo, their.at.lo), place, region));
    let (_, place, region) = held.min_by(|a, b| bound(a.0).total_cmp(&bound(b.0)))?;
    let exit = region.length().hi;
    let leaves = exit < robots[robot].course.length();
    // The other one has not been allowed to go where it would have to wait.
    let can_wait = region.clone().swapped().hold(their.at.lo, own.at.lo).allows(their.stop);
    let is_first = time_to_leave(&robots[robot], exit) + SPARE < time_to_come(&robots[by], region.other_length(), now);
    (leaves && can_wait && is_first).then_some(Turn { place, exit })
}

fn bound(hold: Hold<f64>) -> f64 {
    match hold {
        Hold::Free => f64::INFINITY,
        Hold::At(hold) => hold,
        Hold::Inside => f64::NEG_INFINITY,
    }
}

/// From standing, with its whole disc \[s\].
fn time_to_leave(robot: &Robot, exit: f64) -> f64 {
    let able = &robot.abilities;
    (exit - robot.at).max(0.0) / able.speed + able.speed / able.acceleration
}

/// At the earliest, to where it would have to brake if it could not go on \[s\].
fn time_to_come(robot: &Robot, region: Interval<f64>, now: f64) -> f64 {
    let able = &robot.abilities;
    (region.lo - able.braking() - robot.extent(now).hi).max(0.0) / able.speed
}

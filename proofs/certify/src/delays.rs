//! Start delays with which two discs never touch: all delays of an interval at once.
//!
//! Each agent has a clock of its own, which runs from 0, when it departs, until it arrives; outside of that it does not count. If the
//! second agent departs later by d, the clocks show t and t - d. So a pair of clock times is a point of a plane, each delay is a line of
//! it, and the claim is about all points of a band. The band is cut into *cells*: one clock within k of a time, the delay within h of
//! a delay, each agent on one leg of its motion. With r, v, w, a, b the relative position, both velocities and both accelerations in the
//! centre of a cell, u = v - w and c = a - b, the squared distance at the clock times +t and +(t + s), |t| <= k, |s| <= h, is at least
//!
//! ```text
//! |r|² + 2 r·u t - 2 r·w s + (u·u + r·c) t² - 2 (u·w + r·b) t s + (w·w - r·b) s²                        (quadratic)
//!   - |u·c| k³ - (2 |u·b| + |w·c|) k² h - (|u·b| + 2 |w·b|) k h² - |w·b| h³                             (cubic)
//! ```
//!
//! for motions without a third derivative; with bounds J and K on these derivatives the distance is less by J k³/6 + K (k + h)³/6 at
//! most. The least value of the quadratic is found in closed form, first over t, then over s, so that the bound knows that the distance
//! of closest approach changes with the delay by the speed at which either disc then comes nearer to the other one, and not by the
//! largest speed of a motion. Cells that this does not settle are cut in two, along the sides of the rectangle of both legs where they
//! reach beyond it.

use crate::ball::{Ball, BallReal, Ternary};
use crate::box_index::{BoxIndex, PlainBox};
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::motion::least;
use crate::moving_disc::{LegMotion, Mover, MoverLeg};
use crate::raw::RawAgent;
use std::cmp::Ordering;
use std::collections::VecDeque;

/// Cells of one pair at most.
const MOST: usize = 200_000;

/// The answer about the delays of two agents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// With none of the delays the discs touch.
    Free,
    /// With a delay they touch.
    Contact(Approach),
    /// Near a delay they come so near that rounding leaves it open, or the search has reached its limit.
    Undecided(Approach),
}

/// Two agents at one time with one delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// How much later the second agent departs \[s\].
    pub delay: f64,
    /// Time since the departure of the first agent \[s\].
    pub time: f64,
    /// Distance of the centres less the radii \[m\]; NaN where it is not known.
    pub clearance: f64,
}

/// A motion on a clock of its own.
#[derive(Clone, Debug)]
pub struct Traversal {
    mover: Mover,
    duration: f64,
}

impl Traversal {
    /// The motion of an agent, whose start does not count.
    ///
    /// # Errors
    /// What is wrong with its path, or that it has no motion.
    pub fn new(agent: &RawAgent) -> Result<Self, CertifyError> {
        let mut agent = agent.clone();
        let wrong = CertifyError::of(InputPart::Agent(agent.id, None));
        let travel = agent.travel.as_mut().ok_or_else(|| wrong(CertifyError::NoMotion))?;
        travel.start = 0.0;
        let duration = travel.phases.last().map_or(0.0, |last| last.time[1]);
        Ok(Self { mover: Mover::new(&agent, [0.0, duration])?, duration })
    }

    /// A disc that goes from one point straight to another \[m\] at a speed \[m/s\], with the exact direction and length.
    ///
    /// # Errors
    /// Numbers that are none or out of range.
    pub fn straight(radius: f64, ends: [[f64; 2]; 2], speed: f64) -> Result<Self, CertifyError> {
        let mover = Mover::straight(radius, ends, speed)?;
        Ok(Self { duration: mover.moves[1], mover })
    }

    /// How long it takes \[s\].
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The legs and the clock times of each. Of a motion that takes no time, its end.
    fn legs(&self) -> Vec<TimedLeg<'_>> {
        legs(&self.mover, self.duration)
    }

    /// Whether two discs touch with any delay outside of closed intervals that are disjoint and in increasing order \[s\], while both
    /// agents are under way. Returns the number of cells, too.
    pub fn outside(&self, second: &Self, forbidden: &[[f64; 2]]) -> (Verdict, usize) {
        let radius = [self.mover.radius, second.mover.radius];
        let look = |legs: &LegPair<'_>, cell: &Cell| legs.look(cell, radius);
        outside([self, second].map(|one| (one.duration, one.legs())), forbidden, &look)
    }
}

/// Whether two agents touch with any delay outside of closed intervals, each given by its duration and legs: `look` looks at cells. Returns the
/// number of cells, too.
pub(crate) fn outside(
    agents: [(f64, Vec<TimedLeg<'_>>); 2],
    forbidden: &[[f64; 2]],
    look: &dyn Fn(&LegPair<'_>, &Cell) -> Seen,
) -> (Verdict, usize) {
    let [(duration, own), (other_duration, their)] = &agents;
    let mut cells = 0;
    let mut from = -other_duration;
    let last = [*duration, *duration];
    for [lo, hi] in forbidden.iter().chain([&last]) {
        if from < *lo {
            let verdict = between([own, their], [from, *lo], look, &mut cells);
            if verdict != Verdict::Free {
                return (verdict, cells);
            }
        }
        // What is no number forbids nothing.
        from = from.max(*hi);
    }
    (Verdict::Free, cells)
}

/// A leg of a motion, and the clock times from and to which it lasts \[s\].
pub(crate) type TimedLeg<'a> = ([f64; 2], &'a MoverLeg);

fn between(
    [own, their]: [&[TimedLeg<'_>]; 2],
    delay: [f64; 2],
    look: &dyn Fn(&LegPair<'_>, &Cell) -> Seen,
    cells: &mut usize,
) -> Verdict {
    let mut rest = VecDeque::new();
    for (first_time, first) in own {
        for (second_time, second) in their {
            let legs = LegPair { legs: [first, second], times: [*first_time, *second_time] };
            // On the clock of the shorter leg: a motion may change fast within it, and then no bound on it holds for long.
            let times = [*first_time, *second_time];
            let [own, their] = times.map(|[from, to]| to - from);
            let clock = usize::from(their < own);
            let cell = Cell { clock, time: times[clock], delay };
            rest.extend(legs.within(cell).map(|cell| (legs, cell)));
        }
    }
    // In the order of their sizes: where a contact is, a large cell shows it.
    while let Some((legs, cell)) = rest.pop_front() {
        *cells += 1;
        let seen = look(&legs, &cell);
        if seen.clear {
            continue;
        }
        let approach = cell.approach(seen.clearance);
        if seen.meets.is_certain() && legs.has(&cell) {
            return Verdict::Contact(approach);
        }
        let halves = legs.cut(&cell, seen.by_delay);
        if halves.is_empty() || *cells >= MOST {
            return Verdict::Undecided(approach);
        }
        rest.extend(halves.into_iter().filter_map(|half| legs.within(half)).map(|half| (legs, half)));
    }
    Verdict::Free
}

/// The legs of a motion on a clock of its own, and the clock times of each. Of a motion that takes no time, its end.
pub(crate) fn legs(mover: &Mover, duration: f64) -> Vec<TimedLeg<'_>> {
    let all = &mover.legs;
    let own = all.windows(2).skip(1).map(|pair| ([pair[0].0, pair[1].0], &pair[0].1));
    let own: Vec<_> = own.filter(|([from, to], _)| from < to).collect();
    match (own.is_empty(), all.last()) {
        (true, Some((_, last))) => vec![([0.0, duration], last)],
        _ => own,
    }
}

/// Which of some motions may come near one another.
pub struct Neighbours(BoxIndex);

impl Neighbours {
    /// An index of boxes around all that each of them passes.
    pub(crate) fn of(areas: Vec<PlainBox>) -> Self {
        Self(BoxIndex::new(areas))
    }

    /// An index of them.
    pub fn new(traversals: &[Traversal]) -> Self {
        Self::of(traversals.iter().map(|traversal| traversal.mover.area).collect())
    }

    /// The indices behind this one of those whose boxes meet its own, in order.
    pub fn after(&self, index: usize) -> Vec<usize> {
        self.0.after(index)
    }
}

/// Times of one of the clocks, and delays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// Of the first agent 0, of the second one 1.
    pub(crate) clock: usize,
    pub(crate) time: [f64; 2],
    pub(crate) delay: [f64; 2],
}

pub(crate) fn middle([lo, hi]: [f64; 2]) -> f64 {
    lo + 0.5 * (hi - lo)
}

/// The distance from the middle to the farther end, rounded up.
pub(crate) fn half([lo, hi]: [f64; 2]) -> f64 {
    let middle = middle([lo, hi]);
    (hi - middle).max(middle - lo) * (1.0 + 4.0 * f64::EPSILON) + f64::MIN_POSITIVE
}

impl Cell {
    /// What the other clock shows less what this one shows, of each delay.
    fn shift(&self) -> [f64; 2] {
        let [lo, hi] = self.delay;
        if self.clock == 0 { [-hi, -lo] } else { [lo, hi] }
    }

    fn approach(&self, clearance: f64) -> Approach {
        let (time, delay) = (middle(self.time), middle(self.delay));
        Approach { delay, time: if self.clock == 0 { time } else { time + delay }, clearance }
    }
}

/// What one look at a cell shows.
pub(crate) struct Seen {
    pub(crate) clear: bool,
    pub(crate) meets: Ternary,
    pub(crate) clearance: f64,
    /// Whether half of the delays would do more for the bound than half of the times, if that is known.
    pub(crate) by_delay: Option<bool>,
}

/// A leg of each agent.
#[derive(Clone, Copy)]
pub(crate) struct LegPair<'a> {
    pub(crate) legs: [&'a MoverLeg; 2],
    times: [[f64; 2]; 2],
}

impl LegPair<'_> {
    /// The part of a cell in which both agents may be on these legs, but for rounding; `None` if there is none.
    fn within(&self, cell: Cell) -> Option<Cell> {
        let [[from, to], [first, last]] = [self.times[cell.clock], self.times[1 - cell.clock]];
        let [lo, hi] = cell.shift();
        // The other clock shows `time + shift`, which is between `first` and `last`.
        let time =
            [cell.time[0].max(from).max((first - hi).next_down()), cell.time[1].min(to).min((last - lo).next_up())];
        let ([a, b], [c, d]) = (self.times, cell.delay);
        let delay = [f64::max(c, (a[0] - b[1]).next_down()), f64::min(d, (a[1] - b[0]).next_up())];
        (time[0] <= time[1] && delay[0] <= delay[1]).then_some(Cell { time, delay, ..cell })
    }

    /// Whether the centre of a cell is certain to be a time of both legs.
    fn has(&self, cell: &Cell) -> bool {
        let time = middle(cell.time);
        let [from, to] = self.times[cell.clock];
        let delay = DoubleDouble::from(middle(cell.delay));
        let other = DoubleDouble::from(time) + if cell.clock == 0 { -delay } else { delay };
        let [first, last] = self.times[1 - cell.clock].map(DoubleDouble::from);
        from <= time && time <= to && first <= other && other <= last
    }

    /// Two cells that hold all of a cell in which both agents are on these legs; none, if there is no number in between.
    fn cut(&self, cell: &Cell, by_delay: Option<bool>) -> Vec<Cell> {
        let (time, delay) = (middle(cell.time), middle(cell.delay));
        let [k, h] = [cell.time, cell.delay].map(|[lo, hi]| hi - lo);
        let inside = |at: f64, [lo, hi]: [f64; 2]| lo < at && at < hi;
        let [may_time, may_delay] = [inside(time, cell.time), inside(delay, cell.delay)];
        // Where the leg of the other agent begins or ends within the cell, it is to be cut there, and not by what the bound says.
        let [first, last] = self.times[1 - cell.clock];
        let [lo, hi] = cell.shift();
        let beyond = [cell.time[0] + lo < first, cell.time[1] + hi > last];
        let is_wide = 4.0 * h > k;
        let of_delay = by_delay.filter(|_| beyond == [false; 2]).unwrap_or(is_wide);
        if may_delay && (of_delay || !may_time) {
            return [[cell.delay[0], delay], [delay, cell.delay[1]]].map(|delay| Cell { delay, ..*cell }).into();
        }
        if !may_time {
            return Vec::new();
        }
        let mut halves = [[cell.time[0], time], [time, cell.time[1]]].map(|time| Cell { time, ..*cell });
        // Times of the other clock are those that begin or end with its leg.
        let turned = |time| Cell { clock: 1 - cell.clock, time, delay: cell.delay };
        if beyond[0] && !is_wide {
            halves[0] = turned([first, (time + hi).next_up()]);
        }
        if beyond[1] && !is_wide {
            halves[1] = turned([(time + lo).next_down(), last]);
        }
        halves.into()
    }

    fn look(&self, cell: &Cell, radius: [f64; 2]) -> Seen {
        let near = self.look_with::<f64>(cell, radius, |leg| &leg.near);
        match near.0 {
            Ternary::Yes => near.1,
            Ternary::No if near.1.meets != Ternary::Doubt => near.1,
            _ => self.look_with::<DoubleDouble>(cell, radius, |leg| &leg.exact).1,
        }
    }

    fn look_with<R: BallReal>(
        &self,
        cell: &Cell,
        radius: [f64; 2],
        course: impl Fn(&MoverLeg) -> &LegMotion<R>,
    ) -> (Ternary, Seen) {
        let number = Ball::<R>::from;
        let legs = [self.legs[cell.clock], self.legs[1 - cell.clock]];
        let courses = legs.map(&course);
        let delay = number(middle(cell.delay));
        let time = number(middle(cell.time));
        let times = [time, if cell.clock == 0 { time - delay } else { time + delay }];
        let [k, h] = [cell.time, cell.delay].map(half).map(number);
        let spans = [k, k + h];
        let [[p, v, a], [q, w, b]] = [0, 1].map(|one| courses[one].at(times[one]));
        let [r, u, c] = [p - q, v - w, a - b];
        let off = number(legs[0].off) + number(legs[1].off);
        let radius = number(radius[0]) + number(radius[1]);
        let distance = r.norm();
        let between = distance - radius;
        let clearance = Ball { err: between.err + off.to_f64(), ..between }.display_length();
        // Largest speeds within the cell, and what they allow.
        let gains = courses.map(|course| course.ramp.acceleration.abs());
        let speeds = [0, 1].map(|one| courses[one].ramp.speed_at(times[one]).abs() + gains[one] * spans[one]);
        let mut clear = distance.above(radius + off + speeds[0] * spans[0] + speeds[1] * spans[1]);
        let mut by_delay = None;
        if !clear.is_certain() {
            let two = number(2.0);
            let third = [0, 1].map(|one| {
                let (bend, speed) = (number(legs[one].curvature), speeds[one]);
                bend * speed * (bend * speed * speed + number(3.0) * gains[one])
            });
            let quadratic = Quadratic {
                one: r.dot(r),
                t: two * r.dot(u),
                s: -two * r.dot(w),
                tt: u.dot(u) + r.dot(c),
                ts: -two * (u.dot(w) + r.dot(b)),
                ss: w.dot(w) - r.dot(b),
            };
            let [uc, ub, wc, wb] = [u.dot(c), u.dot(b), w.dot(c), w.dot(b)].map(Ball::abs);
            // The squared distance of the motions without a third derivative, and what the distance is less by.
            let bound = |k: Ball<R>, h: Ball<R>| {
                let cubic = uc * k * k * k + ((two * ub + wc) * k * k + (ub + two * wb) * k * h + wb * h * h) * h;
                let other = k + h;
                let lost = (third[0] * k * k * k + third[1] * other * other * other) / number(6.0);
                [quadratic.least(k, h) - cubic, lost]
            };
            let [square, lost] = bound(k, h);
            clear = clear.or((square.max(number(0.0)).sqrt() - lost - off).above(radius));
            if !clear.is_certain() {
                // What helps more: half of the delays, or of the times.
                let [of_delay, of_time] = [bound(k, h.half()), bound(k.half(), h)]
                    .map(|[square, lost]| (square - two * radius * lost).to_f64());
                by_delay = of_delay.partial_cmp(&of_time).filter(|order| order.is_ne()).map(Ordering::is_gt);
            }
        }
        let meets = radius.above(distance + off);
        (clear, Seen { clear: clear.is_certain(), meets, clearance, by_delay })
    }
}

/// A polynomial of second order of two numbers.
struct Quadratic<R> {
    one: Ball<R>,
    t: Ball<R>,
    s: Ball<R>,
    tt: Ball<R>,
    ts: Ball<R>,
    ss: Ball<R>,
}

impl<R: BallReal> Quadratic<R> {
    /// A lower bound for `|t| <= k` and `|s| <= h`.
    fn least(&self, k: Ball<R>, h: Ball<R>) -> Ball<R> {
        let Self { one, t, s, tt, ts, ss } = *self;
        // Without what bends it upward it is least at an end.
        let bend = tt.min(Ball::from(0.0));
        let end = |k: Ball<R>, bend: Ball<R>| least(one + t * k + bend * k * k, s + ts * k, ss, h);
        let ends = end(k, bend).min(end(-k, bend));
        if !tt.is_positive().is_certain() {
            return ends;
        }
        // The vertex is at -(t + ts s) / 2 tt.
        let two = Ball::from(2.0);
        if (t.abs() - ts.abs() * h).above(two * tt * k).is_certain() {
            return end(if t.to_f64() > 0.0 { -k } else { k }, tt);
        }
        let part = ts / (two * tt);
        let all = least(one - t * t / (two * two * tt), s - t * part, ss - ts * part.half(), h);
        ends.max(all)
    }
}

#[cfg(test)]
mod tests;

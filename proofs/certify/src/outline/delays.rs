//! Start delays with which two bodies never touch: all delays of an interval at once.
//!
//! The search is that of [`crate::delays`] for discs: cells of clock times and delays. What a cell shows is a bound on the distance along
//! directions that move with one of the bodies ([`super::separation`]): with the lengths of both at the clock times +t and +(t + s),
//! |t| <= k, |s| <= h, of first order in t and s, so that two bodies that follow one another lose nothing by t, and with a bound on the second
//! derivative along the line from the middle.

use super::body::Body;
use super::motion::{Driven, Precision};
use super::separation::{Change, above, below};
use crate::ball::{Ball, Ternary};
use crate::delays::{Cell, LegPair, Neighbours, Seen, Verdict, half, legs, middle, outside};
use crate::double_double::DoubleDouble;
use crate::error::CertifyError;

/// A body on a clock of its own.
#[derive(Clone, Debug)]
pub struct Traversal<'a> {
    driven: Driven<'a>,
    duration: f64,
}

impl<'a> Traversal<'a> {
    /// Returns the motion of a body, whose start does not count.
    ///
    /// # Errors
    /// A motion that is none, or that goes back or jumps; no motion.
    pub fn new(body: &'a Body<'a>) -> Result<Self, CertifyError> {
        let (driven, duration) = Driven::on_own_clock(body)?;
        Ok(Self { driven, duration })
    }

    /// Decides whether two bodies touch with any delay outside of closed intervals that are disjoint and in increasing order \[s\], while
    /// both are under way. Returns the number of cells, too.
    pub fn outside(&self, second: &Self, forbidden: &[[f64; 2]]) -> (Verdict, usize) {
        let pair = BodyPair([&self.driven, &second.driven]);
        let agents = [self, second].map(|one| (one.duration, legs(&one.driven.mover, one.duration)));
        outside(agents, forbidden, &|legs, cell| pair.look(legs, cell))
    }
}

/// Returns which of some motions may come near one another.
///
/// Where each body may be is the box around its path, larger by what its motion may be off.
pub fn neighbours(traversals: &[Traversal<'_>]) -> Neighbours {
    let area = |one: &Traversal<'_>| {
        let driven = &one.driven;
        let reach = (driven.lever * driven.mover.position_error + driven.body.jumps) * (1.0 + 1e-9) + f64::MIN_POSITIVE;
        driven.body.area(reach)
    };
    Neighbours::of(traversals.iter().map(area).collect())
}

/// Two bodies.
struct BodyPair<'a>([&'a Driven<'a>; 2]);

impl BodyPair<'_> {
    fn look(&self, legs: &LegPair<'_>, cell: &Cell) -> Seen {
        let near = self.look_with::<f64>(legs, cell);
        if near.clear || near.meets == Ternary::No { near } else { self.look_with::<DoubleDouble>(legs, cell) }
    }

    fn look_with<R: Precision>(&self, legs: &LegPair<'_>, cell: &Cell) -> Seen {
        let number = Ball::<R>::from;
        // The clock of the cell first.
        let order = [cell.clock, 1 - cell.clock];
        let bodies = order.map(|one| self.0[one]);
        let legs = order.map(|one| legs.legs[one]);
        let (time, delay) = (number(middle(cell.time)), number(middle(cell.delay)));
        let times = [time, if cell.clock == 0 { time - delay } else { time + delay }];
        let [half, shift] = [cell.time, cell.delay].map(half).map(number);
        let carried = [0, 1].map(|k| R::carried(bodies[k].body, legs[k].place));
        let ramps = legs.map(R::ramp);
        let [a, b] = [0, 1].map(|k| carried[k].posture(ramps[k].length_at(times[k])));
        let speeds = [0, 1].map(|k| ramps[k].speed_at(times[k]));
        let accelerations = ramps.map(|ramp| ramp.acceleration);
        let seen = below(carried, [&a, &b], &Change::Clocks { speeds, accelerations, half, shift });
        let radius = bodies.iter().fold(number(0.0), |sum, body| sum + Ball::from_twofold(body.body.radius));
        let off = [0, 1].map(|k| number(legs[k].off) * number(bodies[k].lever));
        let far = radius + off[0] + off[1];
        let most = above([&a, &b]);
        let between = most - radius;
        let clearance = Ball { err: between.err + (off[0] + off[1]).to_f64(), ..between }.display_length();
        let meets = if seen.middle.above(far).is_certain() {
            Ternary::No
        } else if radius.above(most + off[0] + off[1]).is_certain() {
            Ternary::Yes
        } else {
            Ternary::Doubt
        };
        let [by_time, by_delay] = seen.weights;
        Seen {
            clear: seen.anywhere.above(far).is_certain(),
            meets,
            clearance,
            by_delay: by_delay.partial_cmp(&by_time).filter(|order| order.is_ne()).map(std::cmp::Ordering::is_gt),
        }
    }
}

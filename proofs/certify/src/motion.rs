//! Discs in motion: no contact at any time, proved, or a time of contact.
//!
//! In an interval of half-length k about t in which both agents keep phase and segment, with r, w, q the relative position,
//! velocity and acceleration at t, and J a bound on the third derivative, `|r(t + τ)| >= √μ - J k³/6` with
//!
//! ```text
//! μ = min over |τ| <= k of |r|² + 2 r·w τ + (|w|² + r·q) τ²  -  |w·q| k³
//! ```
//!
//! (the square of the polynomial of second order, its term |q|²τ⁴/4 left out). Before that, whatever the agents do, `|r| - (v + v') k`.
//! What neither settles is cut: where a phase or a segment ends, then in half.

use crate::ball::{Ball, BallReal, Ternary};
use crate::moving_disc::{LegMotion, MoverLeg};

use crate::box_index::BoxIndex;
use crate::double_double::DoubleDouble;
pub use crate::moving_disc::Mover;
use std::collections::HashMap;

/// Two discs in contact, or so near that rounding does not tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactWitness {
    /// Numbers of the agents.
    pub agents: [u64; 2],
    /// When \[s\].
    pub time: f64,
    /// Distance of the centres less the radii \[m\]; NaN where it is not known.
    pub clearance: f64,
}

/// What has come of a check of motions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionFindings {
    /// Contacts, one of each pair of discs.
    pub contacts: Vec<ContactWitness>,
    /// Where it is not decided.
    pub undecided: Vec<ContactWitness>,
    /// Intervals that were looked at.
    pub steps: usize,
    /// Pairs of discs.
    pub pairs: usize,
}

/// Intervals of one pair at most.
const MOST: usize = 2_000_000;

/// All pairs of agents with different numbers, at all times. Those whose boxes are apart have no contact.
pub fn meetings(movers: &[Mover]) -> MotionFindings {
    let pairs_of = |discs: usize| discs * discs.saturating_sub(1) / 2;
    let mut bodies: HashMap<u64, usize> = HashMap::new();
    movers.iter().for_each(|mover| *bodies.entry(mover.id).or_default() += 1);
    let own: usize = bodies.values().map(|&discs| pairs_of(discs)).sum();
    let mut found = MotionFindings { pairs: pairs_of(movers.len()) - own, ..MotionFindings::default() };
    let near = BoxIndex::new(movers.iter().map(|mover| mover.area).collect());
    for (place, own) in movers.iter().enumerate() {
        for other in near.after(place).into_iter().map(|other| &movers[other]).filter(|other| other.id != own.id) {
            pair(own, other, &mut found);
        }
    }
    found
}

fn pair(own: &Mover, other: &Mover, found: &mut MotionFindings) {
    let (from, to) = (own.time[0].max(other.time[0]), own.time[1].min(other.time[1]));
    // Before both set off, and after both have arrived, nothing changes.
    let (first, last) = (own.moves[0].min(other.moves[0]), own.moves[1].max(other.moves[1]));
    let (from, to) = (from.max(first.min(to)), to.min(last.max(from)));
    if from > to {
        return;
    }
    let agents = [own.id, other.id];
    let mut rest = vec![[from, to]];
    let mut taken = 0;
    while let Some([lo, hi]) = rest.pop() {
        (taken, found.steps) = (taken + 1, found.steps + 1);
        let both = MoverPair { own, other, lo, hi };
        let near = both.sample_clearance::<f64>(|leg| &leg.near);
        let seen = match near.clear {
            Ternary::Doubt => both.sample_clearance::<DoubleDouble>(|leg| &leg.exact),
            Ternary::No if near.meets == Ternary::Doubt => both.sample_clearance::<DoubleDouble>(|leg| &leg.exact),
            _ => near,
        };
        if seen.clear.is_certain() {
            continue;
        }
        let meeting = ContactWitness { agents, time: both.middle(), clearance: seen.clearance };
        if seen.meets.is_certain() {
            found.contacts.push(meeting);
            return;
        }
        match both.cut() {
            Some(cut) if taken < MOST && seen.meets == Ternary::No => rest.extend([[cut, hi], [lo, cut]]),
            _ => {
                found.undecided.push(meeting);
                return;
            }
        }
    }
}

/// Two agents in an interval of time.
struct MoverPair<'a> {
    own: &'a Mover,
    other: &'a Mover,
    lo: f64,
    hi: f64,
}

/// What one look shows.
struct ClearanceSample {
    clear: Ternary,
    meets: Ternary,
    clearance: f64,
}

impl MoverPair<'_> {
    fn middle(&self) -> f64 {
        self.lo + 0.5 * (self.hi - self.lo)
    }

    /// Where a leg ends, nearest to the middle, or the middle; nowhere, if there is no number in between.
    fn cut(&self) -> Option<f64> {
        let inside = |cut: &f64| self.lo < *cut && *cut < self.hi;
        let middle = self.middle();
        // Legs are in order: the nearest ones end just before the middle and behind it.
        let ends = [self.own, self.other].into_iter().flat_map(|mover| {
            let after = mover.legs.partition_point(|(from, _)| *from < middle);
            mover.legs[after.saturating_sub(1)..].iter().take(3).map(|(from, _)| *from)
        });
        let far = |end: f64| (end - middle).abs();
        let nearest = ends.filter(inside).min_by(|a, b| far(*a).total_cmp(&far(*b)));
        nearest.or(Some(middle).filter(inside))
    }

    fn sample_clearance<R: BallReal>(&self, course: impl Fn(&MoverLeg) -> &LegMotion<R>) -> ClearanceSample {
        let middle = self.middle();
        // No less than the way to either end, whatever was rounded.
        let half =
            0.5 * (self.hi - self.lo) * (1.0 + 4.0 * f64::EPSILON) + f64::EPSILON * middle.abs() + f64::MIN_POSITIVE;
        let places = [self.own.leg(middle), self.other.leg(middle)];
        let legs = [&self.own.legs[places[0]].1, &self.other.legs[places[1]].1];
        let [a, b] = legs.map(|leg| course(leg).at(Ball::from(middle)));
        let [r, w, q] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let number = Ball::<R>::from;
        let off = number(legs[0].off) + number(legs[1].off);
        let (radius, k) = (number(self.own.radius) + number(self.other.radius), number(half));
        let distance = r.norm();
        let meets = radius.above(distance + off);
        let between = distance - radius;
        let clearance = Ball { err: between.err + off.to_f64(), ..between }.display_length();
        let ways = k * (number(self.own.speed) + number(self.other.speed));
        let all = number(self.own.position_error.max(self.other.position_error));
        let mut clear = distance.above(radius + ways + all + all);
        // The leg that begins with the end of the interval counts from there on.
        let until = |mover: &Mover, place: usize| {
            mover.legs.get(place + 1).is_none_or(|(next, _)| self.hi <= *next) && mover.legs[place].0 <= self.lo
        };
        let one_leg = until(self.own, places[0]) && until(self.other, places[1]);
        if one_leg && !clear.is_certain() {
            let third = legs.iter().fold(number(0.0), |sum, leg| {
                let (bend, speed) = (number(leg.curvature), number(leg.speed));
                let gain = number({
                    let acceleration = leg.exact.ramp.acceleration.abs();
                    (acceleration.to_f64() + acceleration.err) * (1.0 + 4.0 * f64::EPSILON)
                });
                sum + bend * bend * speed * speed * speed + number(3.0) * bend * speed * gain
            });
            let cube = k * k * k;
            let least = least(r.dot(r), number(2.0) * r.dot(w), w.dot(w) + r.dot(q), k) - w.dot(q).abs() * cube;
            let bound = least.max(number(0.0)).sqrt() - third * cube / number(6.0) - off;
            clear = clear.or(bound.above(radius));
        }
        ClearanceSample { clear, meets, clearance }
    }
}

/// A lower bound on `a + b τ + c τ²` for `|τ| <= k`, the least value unless that is in doubt.
pub(crate) fn least<R: BallReal>(a: Ball<R>, b: Ball<R>, c: Ball<R>, k: Ball<R>) -> Ball<R> {
    let ends = a - b.abs() * k + c * k * k;
    let bends = c.is_positive();
    if bends == Ternary::No {
        return ends;
    }
    // The vertex is at -b / 2c.
    let outside = b.abs().above(Ball::from(2.0) * c * k);
    if outside.is_certain() {
        ends
    } else if bends.is_certain() {
        a - b * b / (Ball::from(4.0) * c)
    } else {
        a - b.abs() * k - c.abs() * k * k
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raw::{RawAgent, RawAngle, RawMotion, RawPath, RawPhase, RawSegment};
    use std::f64::consts::PI;

    /// An agent that goes from rest to rest in two ramps.
    fn agent(id: u64, start: [f64; 2], heading: f64, parts: &[(f64, Option<f64>)], at: f64, top: f64) -> RawAgent {
        let mut from = 0.0;
        let segments: Vec<RawSegment> = parts
            .iter()
            .map(|&(length, radius)| {
                let before = from;
                from += length;
                RawSegment { length, radius, turns: Vec::new(), from: before, to: from }
            })
            .collect();
        let half = from / top;
        let phases = vec![
            RawPhase { time: [0.0, half], length: [0.0, 0.5 * from], speed: [0.0, top] },
            RawPhase { time: [half, 2.0 * half], length: [0.5 * from, from], speed: [top, 0.0] },
        ];
        let path = RawPath { start, heading: RawAngle::Radians(heading), segments, rounding: 1e-14, step: 0.0 };
        RawAgent { id, radius: 0.5, path, travel: Some(RawMotion { start: at, phases, lag: 0.0, time_excess: 0.0 }) }
    }

    fn movers(agents: &[RawAgent]) -> Vec<Mover> {
        agents.iter().map(|agent| Mover::new(agent, [-1e12, 1e12]).unwrap()).collect()
    }

    #[test]
    fn what_is_no_radius_is_no_disc() {
        for radius in [f64::NAN, f64::INFINITY, -0.1] {
            let wrong = RawAgent { radius, ..agent(1, [0.0; 2], 0.0, &[(4.0, None)], 0.0, 1.0) };
            assert!(Mover::new(&wrong, [0.0, 1.0]).is_err(), "{radius}");
        }
    }

    /// The least distance of the centres at so many times.
    fn sampled(movers: &[Mover], from: f64, to: f64) -> f64 {
        let at = |mover: &Mover, t: f64| {
            let [place, ..] = mover.legs[mover.leg(t)].1.near.at(Ball::from(t));
            [place.x.to_f64(), place.y.to_f64()]
        };
        let distance = |t: f64| {
            let [[a, b], [c, d]] = [at(&movers[0], t), at(&movers[1], t)];
            (a - c).hypot(b - d)
        };
        (0..=20_000).map(|k| distance(from + (to - from) * f64::from(k) / 20_000.0)).fold(f64::INFINITY, f64::min)
    }

    /// 2^33 s, where two times are 2^-19 s apart.
    const LATE: f64 = 8_589_934_592.0;
    const DIGIT: f64 = 1.0 / 524_288.0;

    /// A disc of 10 µm on a line, with phases of times, lengths and speeds.
    fn driven(id: u64, start: [f64; 2], heading: f64, at: f64, phases: &[[[f64; 2]; 3]]) -> RawAgent {
        let length = phases.last().map_or(0.0, |phase| phase[1][1]);
        let mut agent = RawAgent { radius: 1e-5, ..agent(id, start, heading, &[(length, None)], at, 1.0) };
        let phases = phases.iter().map(|&[time, length, speed]| RawPhase { time, length, speed }).collect();
        agent.travel = Some(RawMotion { start: at, phases, lag: 0.0, time_excess: 0.0 });
        agent
    }

    /// At this speed until a time since the start.
    fn steady(speed: f64, until: f64) -> [[f64; 2]; 3] {
        [[0.0, until], [0.0, speed * until], [speed; 2]]
    }

    fn is_proved(agents: &[RawAgent]) -> bool {
        let found = meetings(&movers(agents));
        found.contacts.is_empty() && found.undecided.is_empty()
    }

    /// Half a metre to the side there is nobody, whatever is rounded.
    fn is_proved_beside(agents: [RawAgent; 2]) -> bool {
        let [one, mut other] = agents;
        other.path.start[0] += 0.5;
        is_proved(&[one, other])
    }

    #[test]
    fn an_agent_moves_until_its_exact_arrival() {
        // It arrives 1/4 digit after the rounded time, 0.5 mm on.
        let arrives = driven(1, [0.0, 0.0], 0.0, LATE, &[steady(1024.0, 1.0 + 0.25 * DIGIT)]);
        let end = 1024.0 * (1.0 + 0.25 * DIGIT);
        // Who stands 0.2 mm too near to its end is met from then on.
        let stands = driven(2, [end + 2e-5 - 2e-4, 0.0], 0.0, LATE, &[]);
        // Who crosses its last way before the end is met in that quarter only.
        let crosses = driven(3, [end - 2.5e-4, -2.5e-4], 0.5 * PI, LATE + 1.0, &[steady(1024.0, 0.5)]);
        for other in [stands, crosses] {
            assert!(!is_proved(&[arrives.clone(), other.clone()]), "{other:?}");
            assert!(is_proved_beside([arrives.clone(), other]));
        }
    }

    #[test]
    fn the_speed_of_the_next_phase_counts_before_its_rounded_beginning() {
        // It waits until 1/4 digit before the rounded time: until that one it has gone 0.5 mm.
        let until = 1.0 + 0.75 * DIGIT;
        let wait = [[0.0, until], [0.0, 0.0], [0.0, 0.0]];
        let waits = driven(1, [0.0, 0.0], 0.0, LATE, &[wait, [[until, until + 1.0], [0.0, 1024.0], [1024.0, 1024.0]]]);
        // Half of the way later another one is there, which has passed by then.
        let (x, y) = (1024.0 * 0.125 * DIGIT, 1024.0 * 0.875 * DIGIT);
        let crosses = driven(2, [x, y], -0.5 * PI, LATE + 1.0, &[steady(1024.0, 0.5)]);
        assert!(!is_proved(&[waits.clone(), crosses.clone()]));
        assert!(is_proved_beside([waits, crosses]));
    }

    #[test]
    fn a_way_that_rounding_leaves_no_time_for_is_gone_all_the_same() {
        // One metre through a disc, within a digit of the time; alone, and between two phases that last.
        let hop = 0.25 * DIGIT;
        let alone = driven(1, [0.0, 0.0], 0.0, LATE, &[steady(1.0 / hop, hop)]);
        let phases =
            [steady(1.0, 1.0), [[1.0, 1.0 + hop], [1.0, 2.0], [0.0, 0.0]], [[1.0 + hop, 3.0], [2.0, 4.0], [1.0, 1.0]]];
        let between = driven(1, [-1.0, 0.0], 0.0, LATE, &phases);
        for hops in [alone, between] {
            let stands = driven(2, [0.5, 0.0], 0.0, LATE, &[]);
            assert!(!is_proved(&[hops.clone(), stands.clone()]));
            let beside = driven(2, [0.5, 4.0], 0.0, LATE, &[]);
            assert!(is_proved(&[hops, beside]));
        }
    }

    #[test]
    fn a_speed_that_is_no_number_is_any() {
        // Its acceleration is beyond all numbers: nothing is known of it but for its ends.
        let shot = driven(1, [0.0, 0.0], 0.0, 0.0, &[[[0.0, 1e-300], [0.0, 4.0], [0.0, 0.0]]]);
        let slow = |y: f64| driven(2, [2.0, y], 0.5 * PI, 0.0, &[steady(1e-9, 10.0)]);
        let found = meetings(&movers(&[shot.clone(), slow(0.0)]));
        assert!(found.contacts.is_empty() && found.undecided.len() == 1);
        assert!(found.undecided[0].clearance.is_nan(), "{found:?}");
        assert!(is_proved(&[shot, slow(1.0)]));
    }

    fn crossing_pair(later: f64) -> [RawAgent; 2] {
        let arc = std::f64::consts::FRAC_PI_2 * 2.0;
        [
            agent(1, [0.0, 0.0], 0.0, &[(3.0, None), (arc, Some(2.0)), (2.0, None)], 0.0, 1.25),
            agent(2, [5.0, -3.0], 1.5, &[(2.0, None), (4.0, Some(3.0)), (1.0, None)], later, 0.9),
        ]
    }

    #[test]
    fn contacts_are_shown_and_the_clear_proved() {
        let (mut met, mut passed) = (0, 0);
        for k in 0..60 {
            let agents = crossing_pair(0.5 * f64::from(k) - 10.0);
            let movers = movers(&agents);
            let (found, nearest) = (meetings(&movers), sampled(&movers, -12.0, 60.0));
            assert!(found.undecided.is_empty(), "{k}: {found:?}");
            assert_eq!(found.contacts.is_empty(), nearest > 1.0, "{k}: {found:?}, sampled {nearest}");
            assert!(found.steps < 500, "{found:?}");
            (met, passed) = (met + found.contacts.len(), passed + usize::from(found.contacts.is_empty()));
            // With the radii at what samples find, less or more than their error: nothing below is a contact.
            for (by, clear) in [(-1e-4, true), (1e-4, false)] {
                let mut close = agents.clone();
                close[0].radius = 0.5 * (nearest + by);
                close[1].radius = 0.5 * (nearest + by);
                let found = meetings(&self::movers(&close));
                assert_eq!((found.contacts.is_empty(), found.undecided.len()), (clear, 0), "{k} {by}: {found:?}");
                assert!(found.steps < 20_000, "{found:?}");
            }
        }
        assert!(met > 5 && passed > 5, "{met} {passed}");
    }

    #[test]
    fn agents_that_stand_touch_or_do_not() {
        let stands = |id, x| RawAgent {
            travel: Some(RawMotion { start: 3.0, phases: Vec::new(), lag: 0.0, time_excess: 0.0 }),
            ..agent(id, [x, 0.0], 0.3, &[(0.0, None)], 0.0, 1.0)
        };
        let found = |x| meetings(&movers(&[stands(1, 0.0), stands(2, x)]));
        assert_eq!(found(0.999_999).contacts.len(), 1);
        assert!(found(1.000_001).contacts.is_empty() && found(1.000_001).undecided.is_empty());
        // Just at contact: neither.
        assert_eq!(found(1.0).undecided.len(), 1);
    }

    #[test]
    fn discs_of_one_body_do_not_collide() {
        let one = agent(1, [0.0, 0.0], 0.0, &[(3.0, None)], 0.0, 1.0);
        let found = meetings(&movers(&[one.clone(), one.clone(), RawAgent { id: 2, ..one }]));
        assert_eq!((found.pairs, found.contacts.len()), (2, 2));
    }
}

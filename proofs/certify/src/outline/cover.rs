//! Claims about lengths on one segment of each of two bodies: that no two of a box are within a distance, that each length of a range is
//! within a distance of some length of another range, that rectangles hold all lengths within a distance.
//!
//! A box is cut in half where the bounds of [`super::separation`] do not show the claim; the half-lengths of both bodies shrink to what the
//! bounds need. Where the distance in the middle of a box breaks the claim, it is refuted there, and where rounding leaves that open even
//! with 106 bits, it is undecided. Two kinds of claims stay undecided, because their truth is within rounding or takes too many
//! boxes: those in which the distance equals the bound up to rounding, and those in which it comes nearer to the bound than about 10^-7 m
//! along a whole curve in the plane of lengths that is parallel to neither axis.

use super::body::{Carried, Placed};
use super::separation::{Change, above, above_along, below, meet, nearest, overlap, sketched};
use crate::ball::{Ball, BallReal, Real106, Ternary};
use crate::double_double::DoubleDouble;
use crate::pair::gaps;

/// A range of lengths along a segment \[m\].
pub type Range = [DoubleDouble; 2];

/// What has come of a claim about lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It holds.
    Proved,
    /// It does not hold at these lengths along the segments \[m\].
    Refuted([DoubleDouble; 2]),
    /// At these lengths rounding does not tell, or they take too many steps.
    Undecided([DoubleDouble; 2]),
}

/// Boxes that are looked at for one claim at most.
const MOST: usize = 400_000;
/// Cells of one range that are looked at for one claim at most; each takes a search.
const MOST_CELLS: usize = 20_000;

/// Two bodies, each on one segment.
#[derive(Clone, Copy, Debug)]
pub struct Segments<'a>(pub [&'a Placed; 2]);

fn number<R: BallReal>(value: DoubleDouble) -> Ball<R> {
    Ball::from_twofold(Ball { mid: value, err: 0.0 })
}

fn middle(range: Range) -> DoubleDouble {
    (range[0] + range[1]).half()
}

/// Half the length of a range, and what rounding leaves of its middle.
fn half<R: BallReal>(range: Range) -> Ball<R> {
    let [lo, hi] = range.map(|end| Ball::<DoubleDouble> { mid: end, err: 0.0 });
    let middle = (lo + hi).half();
    let half = (hi - lo).half();
    Ball::from_twofold(Ball { mid: half.mid, err: half.err + middle.err })
}

/// One look at a box.
struct Look {
    /// Whether all of it is farther than the bound.
    clear: Ternary,
    /// Whether its middle is within the bound.
    meets: Ternary,
    /// Which length to cut.
    cut: usize,
    /// How the distance changes with each length, about.
    slopes: [f64; 2],
    /// Whether the bound on the distance misses the claim by not much more than rounding.
    is_close: bool,
    /// The longer half of it as a way of the bodies, over what rounding leaves of the distance.
    over: f64,
}

fn look<R: BallReal>(bodies: [&Carried<R>; 2], ranges: [Range; 2], least: Real106) -> Look {
    let least = Ball::from_twofold(least);
    let halves = ranges.map(half);
    let [a, b] = [0, 1].map(|k| bodies[k].posture(number(middle(ranges[k]))));
    let seen = below(bodies, [&a, &b], &Change::Box(halves));
    let ways = [0, 1].map(|k| (bodies[k].lever * halves[k]).to_f64());
    let clear = if seen.anywhere.above(least).is_certain() { Ternary::Yes } else { Ternary::Doubt };
    let meets = if seen.middle.above(least).is_certain() {
        Ternary::No
    } else if least.above(above([&a, &b])).is_certain() {
        Ternary::Yes
    } else {
        Ternary::Doubt
    };
    // Where nothing tells which length costs more, the longer way.
    let weights = if seen.weights[0] == seen.weights[1] { ways } else { seen.weights };
    let cut = usize::from(weights[1] > weights[0]);
    let over = ways[0].max(ways[1]) / (seen.middle.err + f64::MIN_POSITIVE);
    let missing = least - seen.anywhere;
    let is_close = missing.to_f64() < 8.0 * missing.err;
    Look { clear, meets, cut, slopes: seen.slopes, is_close, over }
}

impl<'a> Segments<'a> {
    /// Decides whether all lengths of two ranges are farther apart than `least`, as a distance of the polygons. Counts the boxes.
    pub fn farther(&self, ranges: [Range; 2], least: Real106, steps: &mut usize) -> Verdict {
        let near = self.0.map(|body| &body.near);
        let exact = self.0.map(|body| &body.exact);
        let mut rest = vec![ranges];
        let mut taken = 0;
        while let Some(ranges) = rest.pop() {
            (taken, *steps) = (taken + 1, *steps + 1);
            let mut seen = look::<f64>(near, ranges, least);
            // With 106 bits where 53 do not tell, or where only what they leave stands in the way.
            if seen.clear != Ternary::Yes && (seen.meets == Ternary::Doubt || seen.is_close || seen.over < 1024.0) {
                seen = look::<DoubleDouble>(exact, ranges, least);
            }
            if seen.clear.is_certain() {
                continue;
            }
            let at = ranges.map(middle);
            match seen.meets {
                Ternary::Yes => return Verdict::Refuted(at),
                Ternary::No if taken < MOST && seen.over > 8.0 => {}
                _ => return Verdict::Undecided(at),
            }
            // A range of one length has no halves.
            let splits = |k: &usize| ranges[*k][0] < at[*k] && at[*k] < ranges[*k][1];
            let Some(k) = [seen.cut, 1 - seen.cut].into_iter().find(splits) else { return Verdict::Undecided(at) };
            // The nearer half first: where the claim is broken, halves with both would lead to where it is only just so.
            let mut parts = [[ranges[k][0], at[k]], [at[k], ranges[k][1]]];
            if seen.slopes[k] > 0.0 {
                parts.swap(0, 1);
            }
            for part in parts {
                let mut half = ranges;
                half[k] = part;
                rest.push(half);
            }
        }
        Verdict::Proved
    }

    /// Whether one look at a box shows that all of it is farther apart than `least`.
    pub(crate) fn is_farther_at_once(&self, ranges: [Range; 2], least: Real106) -> bool {
        look::<f64>(self.0.map(|body| &body.near), ranges, least).clear.is_certain()
            || look::<DoubleDouble>(self.0.map(|body| &body.exact), ranges, least).clear.is_certain()
    }

    /// Whether one look shows that a length of the first segment is within `most` of all of a cell of the second one.
    pub(crate) fn is_within_at(&self, at: DoubleDouble, cell: Range, most: Real106) -> bool {
        witnessed::<f64>(self.0.map(|body| &body.near), 1, cell, [at, at], at, most)
            || witnessed::<DoubleDouble>(self.0.map(|body| &body.exact), 1, cell, [at, at], at, most)
    }

    /// Decides whether each length of the range of the body `of` is within `most` of some length of the range of the other one, as a
    /// distance of the polygons. Counts the steps.
    pub fn within(&self, of: usize, ranges: [Range; 2], most: Real106, steps: &mut usize) -> Verdict {
        let mut rest = vec![ranges[of]];
        let mut taken = 0;
        while let Some(cell) = rest.pop() {
            (taken, *steps) = (taken + 1, *steps + 1);
            let at = middle(cell);
            let guess = self.guess(of, at, ranges[1 - of]);
            let near = self.0.map(|body| &body.near);
            let exact = self.0.map(|body| &body.exact);
            let shown = witnessed::<f64>(near, of, cell, ranges[1 - of], guess, most)
                || witnessed::<DoubleDouble>(exact, of, cell, ranges[1 - of], guess, most);
            if shown {
                continue;
            }
            let point = [at, at];
            if !witnessed::<DoubleDouble>(exact, of, point, ranges[1 - of], guess, most) {
                let mut strip = ranges;
                strip[of] = point;
                return match self.farther(strip, most, steps) {
                    Verdict::Proved => Verdict::Refuted(self.pair(of, at, guess)),
                    _ => Verdict::Undecided(self.pair(of, at, guess)),
                };
            }
            if taken >= MOST_CELLS || at <= cell[0] || cell[1] <= at {
                return Verdict::Undecided(self.pair(of, at, guess));
            }
            rest.extend([[at, cell[1]], [cell[0], at]]);
        }
        Verdict::Proved
    }

    fn pair(&self, of: usize, at: DoubleDouble, other: DoubleDouble) -> [DoubleDouble; 2] {
        if of == 0 { [at, other] } else { [other, at] }
    }

    /// The length of the other body at which it is nearest, about. Nothing rests on it.
    pub(crate) fn guess(&self, of: usize, at: DoubleDouble, range: Range) -> DoubleDouble {
        const PARTS: usize = 24;
        /// How many of its least values are refined.
        const NEAREST: usize = 4;
        let own = self.0[of].near.sketch(at.to_f64());
        let span = range[1] - range[0];
        let distance = |part: f64| {
            let other = self.0[1 - of].near.sketch((range[0] + span * part).to_f64());
            sketched([&own, &other])
        };
        let samples: Vec<f64> = (0..=PARTS).map(|k| distance(k as f64 / PARTS as f64)).collect();
        let is_least = |k: &usize| {
            let beside = [k.saturating_sub(1), (k + 1).min(PARTS)];
            beside.iter().all(|&other| samples[*k] <= samples[other])
        };
        let mut places: Vec<usize> = (0..=PARTS).filter(is_least).collect();
        places.sort_by(|&a, &b| samples[a].total_cmp(&samples[b]));
        let (mut least, mut part) = (f64::INFINITY, 0.0);
        for &place in places.iter().take(NEAREST) {
            let (mut found, mut at, mut step) = (samples[place], place as f64 / PARTS as f64, 0.5 / PARTS as f64);
            while step > 1e-15 {
                let tried = [at - step, at + step].map(|part| part.clamp(0.0, 1.0));
                match tried.map(|part| (distance(part), part)).into_iter().find(|(distance, _)| *distance < found) {
                    Some(better) => (found, at) = better,
                    None => step *= 0.5,
                }
            }
            if found < least {
                (least, part) = (found, at);
            }
        }
        (range[0] + span * part).clamp(range[0], range[1])
    }

    /// The boxes of lengths that rectangles leave free. Each part of the second segment between ends of rectangles is looked at by itself:
    /// there a rectangle holds all of it or nothing of it (`docs/theory/certificates.md`, lemma 2).
    pub(crate) fn left_free(&self, rectangles: &[[Range; 2]]) -> Vec<[Range; 2]> {
        let whole = self.0.map(|body| [DoubleDouble::ZERO, body.stretch.placed.length]);
        let mut cuts: Vec<DoubleDouble> = rectangles.iter().flat_map(|rectangle| rectangle[1]).collect();
        cuts.extend(whole[1]);
        // An end that is no number, or beyond the segment, holds nothing.
        cuts.retain(|cut| whole[1][0] <= *cut && *cut <= whole[1][1]);
        cuts.sort_by(DoubleDouble::total_cmp);
        cuts.dedup();
        let cells: Vec<Range> =
            if cuts.len() == 1 { vec![whole[1]] } else { cuts.windows(2).map(|cut| [cut[0], cut[1]]).collect() };
        let mut free = Vec::new();
        for cell in cells {
            let holds = |rectangle: &&[Range; 2]| rectangle[1][0] <= cell[0] && cell[1] <= rectangle[1][1];
            let held = rectangles.iter().filter(holds).map(|rectangle| rectangle[0]).collect();
            free.extend(gaps(held, whole[0]).into_iter().map(|gap| [gap, cell]));
        }
        free
    }

    /// Decides whether all lengths of both segments within `least` of each other lie in rectangles. Returns where that is not proved, once
    /// for each box that they leave free.
    pub fn covered(&self, rectangles: &[[Range; 2]], least: Real106, steps: &mut usize) -> Vec<Verdict> {
        let free = self.left_free(rectangles).into_iter();
        free.map(|ranges| self.farther(ranges, least, steps)).filter(|verdict| *verdict != Verdict::Proved).collect()
    }
}

/// Whether a pair of points of the bodies shows that a cell is within a distance of the other range, while the other body goes on at a
/// constant speed, one at which the two points move as little as possible relative to each other.
fn witnessed<R: BallReal>(
    bodies: [&Carried<R>; 2],
    of: usize,
    cell: Range,
    range: Range,
    guess: DoubleDouble,
    most: Real106,
) -> bool {
    let other = 1 - of;
    let half: Ball<R> = half(cell);
    let own = bodies[of].posture(number(middle(cell)));
    let look = |at: DoubleDouble, speed: f64| {
        let there = bodies[other].posture(number(at));
        let (mut postures, mut speeds) = ([&own, &own], [Ball::from(1.0); 2]);
        (postures[other], speeds[other]) = (&there, Ball::from(speed));
        let pair = nearest(postures);
        let bound = pair.above(bodies, postures, speeds, half);
        let most = Ball::from_twofold(most);
        let slides = || pair.above_sliding(bodies, postures, speeds, half);
        if most.above(bound).is_certain() || slides().is_some_and(|bound| most.above(bound).is_certain()) {
            return true;
        }
        if !meet(postures).is_certain() {
            return false;
        }
        // The signed distance changes by no more than the bodies go. It is negative as long as no gap opens.
        let ways = (bodies[of].lever + bodies[other].lever * Ball::from(speed.abs())) * half;
        let shows = |gap: Ball<R>| Ball::from(0.0).above(gap).is_certain() && most.above(gap).is_certain();
        most.above(overlap(postures) + ways).is_certain()
            || above_along(bodies, postures, speeds, half).is_some_and(shows)
    };
    if look(guess, 0.0) {
        return true;
    }
    let there = bodies[other].posture(number(guess));
    let mut postures = [&own, &own];
    postures[other] = &there;
    let speed = nearest(postures).match_speed(postures, of).clamp(-4.0, 4.0);
    // The other body must not leave its range: it begins a bit farther inside.
    let away =
        DoubleDouble::from(speed.abs()) * DoubleDouble::from(half.to_f64() + half.err) * DoubleDouble::from(1.0 + 1e-9);
    let (lo, hi) = (range[0] + away, range[1] - away);
    speed != 0.0 && speed.is_finite() && lo <= hi && look(guess.clamp(lo, hi), speed)
}

//! Two parts of segments: whether all of one is farther from the other than so much, or all of it within so much.
//!
//! A *cell* is a part of the segment x, `f` the distance of a point of it from the part y. Bounds on `f` over the cell,
//! each in closed form, `g` being the distance from the carrier of y and `d` those from its ends:
//!
//! 1. `f` changes by no more than the length along x: `f(middle) ± half`.
//! 2. `f >= g`. Where all feet of the cell are on y, `f = g`.
//! 3. `f <= d` for both ends. Where no foot of the cell is on y, `f` is the lesser `d`: along a line the square of a distance, along
//!    a circle the chord, is monotone either way from the foot up to the point opposite.
//!
//! What none of them settles is cut in half. The end is where the cell is as small as what rounding leaves of its distance.

use crate::ball::{Ball, BallReal, Ternary};
use crate::double_double::DoubleDouble;
use crate::plane::{BallCarrier, BallRange, BallVector, SegmentPart};

/// A segment on its carrier, for both types of number.
#[derive(Clone, Debug)]
pub struct SegmentCarrier {
    /// With 106 bits.
    pub exact: BallCarrier<DoubleDouble>,
    /// With 53.
    pub near: BallCarrier<f64>,
    /// Length \[m\].
    pub length: DoubleDouble,
}

impl SegmentCarrier {
    /// A segment of this length on a carrier.
    pub fn new(exact: BallCarrier<DoubleDouble>, length: DoubleDouble) -> Self {
        Self { exact, near: BallCarrier::of(exact), length }
    }

    /// A part of it.
    pub fn part(&self, range: [DoubleDouble; 2]) -> DualPrecisionPart<'_> {
        DualPrecisionPart { placed: self, range, approximate: SegmentPart::new(&self.near, range), exact: None }
    }

    /// All of it.
    pub fn whole(&self) -> DualPrecisionPart<'_> {
        self.part([DoubleDouble::ZERO, self.length])
    }
}

/// A part of a segment with 53 bits, and with 106 from when that is asked for.
#[derive(Clone, Debug)]
pub struct DualPrecisionPart<'a> {
    placed: &'a SegmentCarrier,
    /// Lengths along the segment \[m\].
    pub range: [DoubleDouble; 2],
    approximate: SegmentPart<f64>,
    exact: Option<SegmentPart<DoubleDouble>>,
}

impl DualPrecisionPart<'_> {
    /// With 106 bits.
    pub fn exact(&mut self) -> &SegmentPart<DoubleDouble> {
        self.exact.get_or_insert_with(|| SegmentPart::new(&self.placed.exact, self.range))
    }

    /// The length along the segment, rounded, at which it is nearest to a point \[m\].
    pub fn foot(&mut self, point: BallVector<DoubleDouble>) -> DoubleDouble {
        let foot = self.exact().foot(point);
        (self.middle() + DoubleDouble::from(foot)).clamp(self.range[0], self.range[1])
    }

    /// The two halves.
    pub fn halves(&self) -> [Self; 2] {
        let [lo, hi] = self.range;
        let middle = (lo + hi).half();
        [self.placed.part([lo, middle]), self.placed.part([middle, hi])]
    }

    /// The length in its middle \[m\].
    pub fn middle(&self) -> DoubleDouble {
        (self.range[0] + self.range[1]).half()
    }
}

/// What is claimed of all points of a cell.
#[derive(Clone, Copy, Debug)]
pub enum DistanceClaim {
    /// They are farther from the other part than this.
    Above(Ball<DoubleDouble>),
    /// They are within this of it.
    Within(Ball<DoubleDouble>),
}

/// What has come of a claim.
#[derive(Clone, Copy, Debug)]
pub enum ClaimVerdict {
    /// It holds.
    Proved,
    /// It does not hold at this length along the segment of the cell \[m\].
    Refuted(DoubleDouble),
    /// At this length rounding does not tell.
    Undecided(DoubleDouble),
}

/// Cells that are looked at for one claim at most. No claim about numbers of a format took a tenth as many.
const MOST: usize = 20_000;

impl DistanceClaim {
    /// Decides the claim about all points of a part. Counts the cells.
    pub fn decide(
        self,
        cell: &DualPrecisionPart<'_>,
        other: &mut DualPrecisionPart<'_>,
        steps: &mut usize,
    ) -> ClaimVerdict {
        let mut left = vec![cell.clone()];
        let mut taken = 0;
        while let Some(mut cell) = left.pop() {
            (taken, *steps) = (taken + 1, *steps + 1);
            let (mut outcome, mut limit) = self.evaluate(&cell.approximate, &other.approximate);
            let small = cell.approximate.half.to_f64() <= 1024.0 * limit;
            if outcome == Ternary::Doubt || (outcome == Ternary::No && small) {
                let exact = cell.exact();
                (outcome, limit) = self.evaluate(exact, other.exact());
            }
            if outcome.is_certain() {
                continue;
            }
            let middle = cell.middle();
            match self.fails(&mut cell, other) {
                Ternary::Yes => return ClaimVerdict::Refuted(middle),
                Ternary::No if cell.approximate.half.to_f64() > 8.0 * limit && taken < MOST => {}
                _ => return ClaimVerdict::Undecided(middle),
            }
            left.extend(cell.halves());
        }
        ClaimVerdict::Proved
    }

    /// Whether one look at the cell shows it.
    pub fn holds_at_once(self, cell: &mut DualPrecisionPart<'_>, other: &mut DualPrecisionPart<'_>) -> bool {
        let (near, _) = self.evaluate(&cell.approximate, &other.approximate);
        near.is_certain() || (near == Ternary::Doubt && self.evaluate(cell.exact(), other.exact()).0.is_certain())
    }

    /// Whether it fails in the middle of a cell.
    pub fn fails(self, cell: &mut DualPrecisionPart<'_>, other: &mut DualPrecisionPart<'_>) -> Ternary {
        let near = match self.fails_at(&cell.approximate, &other.approximate) {
            Ternary::Doubt => None,
            answer => Some(answer),
        };
        near.unwrap_or_else(|| self.fails_at(cell.exact(), other.exact()))
    }

    fn fails_at<R: BallReal>(self, cell: &SegmentPart<R>, other: &SegmentPart<R>) -> Ternary {
        let distance = other.nearest(cell.middle);
        match self {
            Self::Above(least) => Ball::from_twofold(least).above(distance),
            Self::Within(most) => distance.above(Ball::from_twofold(most)),
        }
    }

    /// Whether one of the bounds shows it, and what rounding leaves of the distance in the middle.
    fn evaluate<R: BallReal>(self, cell: &SegmentPart<R>, other: &SegmentPart<R>) -> (Ternary, f64) {
        let near = other.nearest(cell.middle);
        match self {
            Self::Above(least) => {
                let least: Ball<R> = Ball::from_twofold(least);
                let middle = near - least;
                let rounding = middle.err;
                let mut answer = middle.above(cell.half);
                if !answer.is_certain() {
                    answer = answer.or(carrier_distance(cell, other).lo.above(least));
                }
                if !answer.is_certain() {
                    let [off, _] = feet(cell, other);
                    let ends = || other.ends.map(|end| cell.nearest(end).above(least));
                    answer =
                        answer.or(if off == Ternary::No { Ternary::No } else { off.and(ends()[0]).and(ends()[1]) });
                }
                (answer, rounding)
            }
            Self::Within(most) => {
                let most: Ball<R> = Ball::from_twofold(most);
                let middle = most - near;
                let rounding = middle.err;
                let mut answer = middle.above(cell.half);
                for end in other.ends {
                    if !answer.is_certain() {
                        answer = answer.or(most.above(cell.farthest(end)));
                    }
                }
                if !answer.is_certain() {
                    let [_, on] = feet(cell, other);
                    answer = answer.or(on.and(most.above(carrier_distance(cell, other).hi)));
                }
                (answer, rounding)
            }
        }
    }
}

/// Bounds on the distance of the points of a cell from the carrier of the other part.
fn carrier_distance<R: BallReal>(cell: &SegmentPart<R>, other: &SegmentPart<R>) -> BallRange<R> {
    let zero = Ball::from(0.0);
    let (below, above) = match &other.circle {
        None => {
            let BallRange { lo, hi } = cell.components(other.middle, other.axis.left());
            (lo, hi)
        }
        Some(circle) => {
            let (near, far) = (cell.nearest(circle.centre), cell.farthest(circle.centre));
            (near - circle.radius, far - circle.radius)
        }
    };
    BallRange { lo: zero.max(below).max(-above), hi: above.max(-below) }
}

/// Whether none of the feet of a cell is on the other part, and whether all are.
fn feet<R: BallReal>(cell: &SegmentPart<R>, other: &SegmentPart<R>) -> [Ternary; 2] {
    match &other.circle {
        None => {
            let BallRange { lo, hi } = cell.components(other.middle, other.axis);
            let half = other.half;
            [lo.above(half).or((-half).above(hi)), half.above(hi).and(lo.above(-half))]
        }
        Some(circle) => {
            let at = cell.middle - circle.centre;
            let angle = Ball::angle(other.axis.dot(at), other.axis.cross(at));
            let spread = cell.spread(at);
            [(angle - spread).above(circle.half_angle), circle.half_angle.above(angle + spread)]
        }
    }
}

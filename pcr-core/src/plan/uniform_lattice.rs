//! The motions from which a speed plan is chosen if one speed and one acceleration are allowed on the whole path.
//!
//! The path is divided into cells of equal length, with one shorter cell in the middle. At the border of two cells the
//! agent has one of a few speeds; their squares are evenly spaced from 0 to the top speed. A cell is as long as a ramp
//! from one of these speeds to the next at full acceleration (or twice, four times ... as long, on a path of many
//! cells). Hence the set contains the fastest motion from rest to rest over the whole path.

use crate::error::{InvalidInput, not_negative, positive};
use crate::plan::lattice::{LEVELS, LatticeEdge, SpeedLattice, level};
use crate::plan::limits::SpeedPlanLimits;
use crate::profile::Limits;
use crate::scalar::{Scalar, Wide};
use core::borrow::Borrow;

/// Number of speeds with those at the two ends of the path.
const SPEEDS: usize = LEVELS + 2;

/// Speeds, cells, and the motions between speeds at neighbouring borders.
#[derive(Clone, Debug)]
pub(super) struct UniformLattice<S> {
    speeds: [S; SPEEDS],
    edges: [[Option<LatticeEdge<S>>; SPEEDS]; SPEEDS],
    /// The motions over the shorter cell in the middle.
    short: [[Option<LatticeEdge<S>>; SPEEDS]; SPEEDS],
    /// Length of a cell, and of the shorter cell in the middle \[m\].
    cell: S,
    middle: S,
    /// Number of cells before and after the middle.
    halves: [usize; 2],
    /// Indices of the speeds at both ends of the path.
    ends: [usize; 2],
}

impl<S: Scalar> UniformLattice<S> {
    /// A lattice of at least two and at most `most` cells.
    pub(super) fn new(length: S, drive: SpeedPlanLimits<S>, most: usize) -> Result<Self, InvalidInput> {
        let Limits { speed, acceleration } = drive.limits;
        positive(speed, "largest speed")?;
        positive(acceleration, "largest acceleration")?;
        for (end, what) in [(drive.start, "speed at the start"), (drive.goal, "speed at the goal")] {
            if not_negative(end, what)? > speed {
                return Err(InvalidInput::OutOfRange(what));
            }
        }
        // The top speed that is reached if the ramps up and down meet: v² = a L + (v₀² + v₁²) / 2.
        let square = |v: S| v.times(v);
        let peak = acceleration.times(length) + (square(drive.start) + square(drive.goal)).half();
        let peak = if peak < square(speed) { peak.sqrt() } else { speed };
        let [rest, first, second, third, top] = [0, 1, 2, 3, 4].map(|index| level(peak, index));
        let speeds = [rest, first, second, third, top, drive.start, drive.goal];
        let ramp = peak.times(peak.quotient(acceleration)).narrow().half();
        // Cells are shorter on a path that is only a part of a ramp.
        let mut cell = ramp.half().half().min(length.half().half());
        // The quarter of a few last digits rounds to 0, and doubling 0 does not help.
        if cell <= S::ZERO {
            cell = S::slack(length);
        }
        positive(cell, "length of the path")?;
        let mut count = cells(length, cell, most);
        while count.is_none() && cell < length {
            cell = cell.double();
            count = cells(length, cell, most);
        }
        let Some((count, middle)) = count else {
            return Err(InvalidInput::Full("station"));
        };
        let edges = |length: S| speeds.map(|from| speeds.map(|to| LatticeEdge::new(from, to, length, acceleration)));
        let place = |end: S, place: usize| if end > S::ZERO { place } else { 0 };
        let half = count / 2;
        Ok(Self {
            speeds,
            edges: edges(cell),
            short: edges(middle),
            cell,
            middle,
            halves: [half, count.saturating_sub(half)],
            ends: [place(drive.start, LEVELS), place(drive.goal, LEVELS.saturating_add(1))],
        })
    }
}

impl<S: Scalar> SpeedLattice<S> for UniformLattice<S> {
    /// The length \[m\], and whether it is the cell in the middle.
    type Cell = (S, bool);

    fn cells(&self) -> impl DoubleEndedIterator<Item = (S, bool)> {
        let [before, after] = self.halves;
        let cell = (self.cell, false);
        let middle = (self.middle > S::ZERO).then_some((self.middle, true));
        core::iter::repeat_n(cell, before).chain(middle).chain(core::iter::repeat_n(cell, after))
    }

    fn end(&self, (length, _): (S, bool), from: S) -> S {
        from + length
    }

    fn edge(&self, (_, is_middle): (S, bool), from: usize, to: usize) -> Option<impl Borrow<LatticeEdge<S>>> {
        let edges = if is_middle { &self.short } else { &self.edges };
        edges.get(from)?.get(to)?.as_ref()
    }

    fn ends(&self) -> [usize; 2] {
        self.ends
    }

    fn speed(&self) -> S {
        let [start, _] = self.ends;
        self.speeds.get(start).copied().unwrap_or_default()
    }
}

/// The number of cells, and the rest in the middle \[m\]; `None` for more than `most` or less than 2 cells.
fn cells<S: Scalar>(length: S, cell: S, most: usize) -> Option<(usize, S)> {
    if cell <= S::ZERO {
        return None;
    }
    let (mut count, mut rest) = (0_usize, length);
    while rest >= cell {
        rest = rest - cell;
        count = count.saturating_add(1);
        if count > most {
            return None;
        }
    }
    // Each difference may be off by a rounding.
    let rounding = S::rounding(length);
    if cell - rest <= rounding {
        (count, rest) = (count.saturating_add(1), S::ZERO);
    } else if rest <= rounding {
        rest = S::ZERO;
    }
    let all = count.saturating_add(usize::from(rest > S::ZERO));
    (2 <= all && all <= most).then_some((count, rest))
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::cells;

    #[test]
    fn what_is_left_of_a_length_is_a_cell() {
        assert_eq!([cells(2.5, 1.0, 3), cells(2.5, 1.0, 2)], [Some((2, 0.5)), None]);
        assert_eq!([cells(1.5, 1.0, 2), cells(1.0, 1.0, 2), cells(0.5, 1.0, 2)], [Some((1, 0.5)), None, None]);
        assert_eq!([cells(2.0, 1.0, 2), cells(3.0, 1.0, 2), cells(2.0, 0.0, 9)], [Some((2, 0.0)), None, None]);
        // Because of rounding, there is a small rest, or a cell is missing.
        let digit = f64::EPSILON;
        assert_eq!([cells(2.0 + 2.0 * digit, 1.0, 2), cells(2.0 - digit, 1.0, 2)], [Some((2, 0.0)); 2]);
    }
}

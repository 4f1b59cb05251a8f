//! The set of motions from which a speed plan is chosen.
//!
//! The path is divided into cells of equal length, with one shorter cell in the middle. At the border of two cells the
//! agent has one of a few speeds; their squares are evenly spaced from 0 to the top speed. A cell is as long as a ramp
//! from one of these speeds to the next at full acceleration (or twice, four times ... as long, on a path of many
//! cells). Inside a cell the agent speeds up at once, or slows down as late as possible, at full acceleration:
//!
//! ```text
//! speed   ____        ____
//!        /                \        the fastest motions between two speeds
//!       /                  \       that stay at or below the higher one
//! ```
//!
//! Hence the set contains the fastest motion from rest to rest over the whole path.

use crate::error::{Invalid, not_negative, positive};
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::profile::{Limits, Phase};
use crate::scalar::{Scalar, Wide};

/// Number of speeds at the borders of cells: rest and four others, the last of which is the top speed.
pub(super) const LEVELS: usize = 5;
/// Number of speeds with those at the two ends of the path.
const SPEEDS: usize = LEVELS + 2;
/// Number of slabs into which a cell is divided; for each slab it is known when it is blocked.
pub(super) const SLABS: usize = 4;

/// The limits of an agent's speed plan, and the speeds at both ends of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Drive<S> {
    /// Largest speed and acceleration.
    pub limits: Limits<S>,
    /// Speed at the start of the path \[m/s\]. An agent that is already moving there cannot wait.
    pub start: S,
    /// Speed at the end of the path \[m/s\].
    pub goal: S,
}

impl<S: Scalar> Drive<S> {
    /// A drive that begins and ends at rest.
    pub const fn rest_to_rest(limits: Limits<S>) -> Self {
        Self { limits, start: S::ZERO, goal: S::ZERO }
    }

    /// The drive of a motion: its largest speed and acceleration, and its speeds at the start and the end. `None` if the
    /// motion is slower on its way than these alone allow, by more than the [tolerance](Scalar::tolerance). There is a
    /// reason for that which a drive cannot hold: it turns in place or waits there, or a lower limit holds on a part of
    /// the path.
    ///
    /// ```
    /// use pcr_core::{Drive, Limits, Motion, Path, Point, Pose, Profile, Radians};
    /// let pose = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// let path = Path::<f64, 1>::starting_at(pose)?.line(4.0)?;
    /// let limits = Limits { speed: 1.0, acceleration: 1.0 };
    /// let fastest = Profile::<f64, 3>::rest_to_rest(4.0, limits)?;
    /// let motion = Motion::new(path.as_path(), fastest.as_profile(), 0.25, 0.0)?;
    /// assert_eq!(Drive::of(&motion), Some(Drive::rest_to_rest(limits)));
    ///
    /// // It stops after 2 m, for 3 s.
    /// let stop = [(1.0, 1.0), (1.0, 0.0), (1.0, -1.0), (3.0, 0.0), (1.0, 1.0), (1.0, 0.0), (1.0, -1.0)];
    /// let stops = Profile::<f64, 7>::from_pieces(0.0, stop)?;
    /// assert_eq!(Drive::of(&motion.with_profile(stops.as_profile(), 0.0)?), None);
    /// # Ok::<(), pcr_core::Invalid>(())
    /// ```
    pub fn of(motion: &Motion<'_, S>) -> Option<Self> {
        let phases = motion.profile().phases();
        let accelerations = phases.iter().map(|phase| phase.acceleration().abs());
        let limits = Limits { speed: motion.profile().top_speed(), acceleration: accelerations.fold(S::ZERO, S::max) };
        if !is_fastest(phases, limits) {
            return None;
        }
        let [start, _] = phases.first().map_or([S::ZERO; 2], Phase::speed);
        let [_, goal] = phases.last().map_or([S::ZERO; 2], Phase::speed);
        Some(Self { limits, start, goal })
    }
}

/// Whether phases speed up, go on at the largest speed and slow down, in this order, and each as fast as the limits allow.
fn is_fastest<S: Scalar>(phases: &[Phase<S>], limits: Limits<S>) -> bool {
    let reaches = |value: S, limit: S| value >= limit - S::tolerance(limit);
    let mut last = Stage::Up;
    phases.iter().filter(|phase| phase.time().length() > S::ZERO).all(|phase| {
        let (speed, acceleration) = (phase.speed(), phase.acceleration());
        let (stage, fully) = if acceleration > S::ZERO {
            (Stage::Up, reaches(acceleration, limits.acceleration))
        } else if acceleration < S::ZERO {
            (Stage::Down, reaches(-acceleration, limits.acceleration))
        } else {
            (Stage::Top, speed.into_iter().all(|speed| reaches(speed, limits.speed)))
        };
        let in_order = last <= stage;
        last = stage;
        in_order && fully
    })
}

/// What the fastest motion does, in its order.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Stage {
    Up,
    Top,
    Down,
}

/// The fastest motion over a cell between two speeds that does not exceed the higher one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge<S> {
    phases: [Phase<S>; 2],
    /// Times at which each slab is entered and the last one is left, from the begin of the cell on \[s\].
    pub(super) passes: [S; SLABS + 1],
}

impl<S: Scalar> Edge<S> {
    /// `None` if the speeds are too far apart for the cell.
    fn new(from: S, to: S, length: S, acceleration: S) -> Option<Self> {
        let (slow, fast) = (from.min(to), from.max(to));
        if fast <= S::ZERO || length <= S::ZERO {
            return None;
        }
        let ramp = (fast - slow).quotient(acceleration);
        let mut way = (slow + fast).times(ramp).half().narrow();
        let rounding = S::rounding(length);
        if way > length + rounding.double() {
            return None;
        }
        // A rest of the cell that is due to rounding does not get a phase of its own.
        if length - way <= rounding.double() {
            way = length;
        }
        let cruise = (length - way).quotient(fast);
        let origin = Phase::origin(from);
        let phases = if from < to {
            let first = origin.until(ramp, way, to, acceleration);
            [first, first.until(cruise, length, to, S::ZERO)]
        } else {
            let first = origin.until(cruise, length - way, from, S::ZERO);
            [first, first.until(ramp, length, to, -acceleration)]
        };
        let mut passes = [S::ZERO; SLABS + 1];
        let [first, second] = &phases;
        for (pass, border) in passes.iter_mut().zip(borders(Interval::new(S::ZERO, length))) {
            let phase = if border <= first.length().hi { first } else { second };
            *pass = phase.time_at(border);
        }
        if let Some(last) = passes.last_mut() {
            *last = second.time().hi;
        }
        Some(Self { phases, passes })
    }

    /// Time that the agent takes for the cell \[s\].
    pub(super) fn duration(&self) -> S {
        let [_, last] = &self.phases;
        last.time().hi
    }

    /// The phases of non-zero duration: duration, length, final speed, acceleration.
    pub(super) fn phases(&self) -> impl Iterator<Item = (S, S, S, S)> {
        let phases = self.phases.iter().filter(|phase| phase.time().length() > S::ZERO);
        phases.map(|phase| {
            let [_, after] = phase.speed();
            (phase.time().length(), phase.length().length(), after, phase.acceleration())
        })
    }
}

/// The borders of the slabs of a cell.
pub(super) fn borders<S: Scalar>(cell: Interval<S>) -> [S; SLABS + 1] {
    let (quarter, half) = (cell.length().half().half(), cell.length().half());
    [cell.lo, cell.lo + quarter, cell.lo + half, cell.lo + half + quarter, cell.hi]
}

/// Speeds, cells, and the motions between speeds at neighbouring borders.
#[derive(Clone, Debug)]
pub(super) struct Lattice<S> {
    speeds: [S; SPEEDS],
    edges: [[Option<Edge<S>>; SPEEDS]; SPEEDS],
    /// The motions over the shorter cell in the middle.
    short: [[Option<Edge<S>>; SPEEDS]; SPEEDS],
    /// Length of a cell, and of the shorter cell in the middle \[m\].
    cell: S,
    middle: S,
    /// Number of cells before and after the middle.
    halves: [usize; 2],
    /// Indices of the speeds at both ends of the path.
    ends: [usize; 2],
}

impl<S: Scalar> Lattice<S> {
    /// A lattice of at least two and at most `most` cells.
    pub(super) fn new(length: S, drive: Drive<S>, most: usize) -> Result<Self, Invalid> {
        let Limits { speed, acceleration } = drive.limits;
        positive(speed, "largest speed")?;
        positive(acceleration, "largest acceleration")?;
        for (end, what) in [(drive.start, "speed at the start"), (drive.goal, "speed at the goal")] {
            if not_negative(end, what)? > speed {
                return Err(Invalid::OutOfRange(what));
            }
        }
        // The top speed that is reached if the ramps up and down meet: v² = a L + (v₀² + v₁²) / 2.
        let square = |v: S| v.times(v);
        let peak = acceleration.times(length) + (square(drive.start) + square(drive.goal)).half();
        let peak = if peak < square(speed) { peak.sqrt() } else { speed };
        let top = square(peak);
        let quarter = top.half().half();
        let levels = [S::Wide::ZERO, quarter, top.half(), top.half() + quarter].map(Wide::sqrt);
        let [rest, first, second, third] = levels;
        let speeds = [rest, first, second, third, peak, drive.start, drive.goal];
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
            return Err(Invalid::Full("station"));
        };
        let edges = |length: S| speeds.map(|from| speeds.map(|to| Edge::new(from, to, length, acceleration)));
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

    /// The lengths of the cells in order \[m\], and whether a cell is the one in the middle.
    pub(super) fn cells(&self) -> impl DoubleEndedIterator<Item = (S, bool)> + use<S> {
        let [before, after] = self.halves;
        let cell = (self.cell, false);
        let middle = (self.middle > S::ZERO).then_some((self.middle, true));
        core::iter::repeat_n(cell, before).chain(middle).chain(core::iter::repeat_n(cell, after))
    }

    /// The motion over a cell from one speed to another, both given by index.
    pub(super) fn edge(&self, is_middle: bool, from: usize, to: usize) -> Option<&Edge<S>> {
        let edges = if is_middle { &self.short } else { &self.edges };
        edges.get(from)?.get(to)?.as_ref()
    }

    /// The speed with this index \[m/s\].
    pub(super) fn speed(&self, place: usize) -> S {
        self.speeds.get(place).copied().unwrap_or_default()
    }

    /// Indices of the speeds at the start and at the goal.
    pub(super) fn ends(&self) -> [usize; 2] {
        self.ends
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

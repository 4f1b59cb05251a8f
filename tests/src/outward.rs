//! "Outward by construction", held against 106 bits: every exact collision is in a region, and every point of a region
//! is within the stated excess of a collision.
//!
//! Points are looked for in `f64` and decided exactly: on both sides of the ends of slices, at the ends of ranges, on
//! both sides of the boundary as bisection finds it, and where two discs that hardly touch are nearest. The numbers of
//! the format are exact inputs; a point is one of a time and a length that the format can write down.

mod search;
mod view;

use crate::case_ranges::{CaseRange, Total, in_every_format};
use crate::disc::{Course, Disc, Drive};
use crate::exact::{DoubleDouble, Route, Travel};
use crate::generators::{Dice, case};
use pcr_core::{CapacityError, excess};
use pcr_planning::fleet::{HostScalar, build_ecm};
use std::fmt;
use view::View;

/// What is checked of a pair, and how far it went.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Pairs.
    pub pairs: u64,
    /// Regions, both directions counted.
    pub regions: u64,
    /// Points that were decided with 106 bits.
    pub decided: u64,
    /// Collisions, each in a region.
    pub inside: u64,
    /// Points further than the excess from a collision, none of them in a region.
    pub outside: u64,
    /// Largest clearance of a point in a region, as a part of the excess.
    pub excess: f64,
    /// Least clearance of an end of a slice, as a part of the excess: below 0 a collision would be lost.
    pub margin: f64,
}

impl Default for Seen {
    fn default() -> Self {
        Self { pairs: 0, regions: 0, decided: 0, inside: 0, outside: 0, excess: 0.0, margin: f64::INFINITY }
    }
}

impl Seen {
    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            pairs: self.pairs + other.pairs,
            regions: self.regions + other.regions,
            decided: self.decided + other.decided,
            inside: self.inside + other.inside,
            outside: self.outside + other.outside,
            excess: self.excess.max(other.excess),
            margin: self.margin.min(other.margin),
        }
    }
}

/// What does not hold, and where.
pub type Violation = String;

/// What a run over many pairs has come to.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Counts and extremes of all pairs that were checked.
    pub seen: Seen,
    /// Pairs that the format or a table cannot hold.
    pub refused: u64,
    /// What did not hold, with the number of the case.
    pub violations: Vec<Violation>,
}

impl Tally {
    /// Cases, those included that were refused.
    pub fn cases(&self) -> u64 {
        self.seen.pairs + self.refused
    }
}

impl Total for Tally {
    fn add(&mut self, other: &Self) {
        self.seen = self.seen.and(other.seen);
        self.refused += other.refused;
        self.violations.extend_from_slice(&other.violations);
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seen, refused, violations } = self;
        let Seen { pairs, regions, decided, inside, outside, excess, margin } = seen;
        write!(
            f,
            "{pairs} pairs ({refused} refused), {regions} regions, {inside} collisions, {outside} points clear, "
        )?;
        write!(f, "{decided} decisions with 106 bits; clearance of ends {margin:.3} to {excess:.3} of the excess; ")?;
        write!(f, "{} violations", violations.len())
    }
}

/// The formats by name.
pub const FORMATS: &[(&str, CaseRange<Tally>)] = &in_every_format!(run);

/// Checks the cases `first`, `first + 1`, ... of [`crate::generators::case`].
pub fn run<S: HostScalar>(first: u64, count: u64) -> Tally {
    let mut tally = Tally::default();
    for seed in first..first + count {
        let ((pair, drives), mut dice) = case(seed);
        match Checked::<S>::new(&pair, &drives) {
            Err(_) => tally.refused += 1,
            Ok(checked) => match checked.check(&mut dice, &mut tally.seen) {
                Ok(true) => {}
                Ok(false) => tally.refused += 1,
                Err(violation) => tally.violations.push(format!("{seed}: {violation}")),
            },
        }
    }
    tally
}

/// A disc in motion, in the library and exactly.
struct Agent<S: HostScalar> {
    course: Course<S>,
    route: Route,
}

impl<S: HostScalar> Agent<S> {
    fn new(disc: &Disc, drive: &Drive, start: f64) -> Result<Self, Violation> {
        let disc = disc.rounded::<S>();
        let start = S::from_f64(start).to_f64();
        let course = Course::<S>::driven(&disc, &drive.rounded::<S>(), start).map_err(|why| why.to_string())?;
        Ok(Self { course, route: Route::new::<S>(&disc) })
    }
}

/// A pair that the format can hold.
pub struct Checked<S: HostScalar> {
    agents: [Agent<S>; 2],
    /// Sum of the radii \[m\].
    radius: DoubleDouble,
    /// What a clearance in `f64` may be off \[m\].
    doubt: f64,
}

impl<S: HostScalar> Checked<S> {
    /// The pair, with a drive and a start time for each.
    ///
    /// # Errors
    /// Why the library refuses it: numbers above the limits of the format, or a profile that does not fit the path any
    /// more once it is rounded.
    pub fn new(pair: &(Disc, Disc), drives: &[(Drive, f64); 2]) -> Result<Self, Violation> {
        let [(first, start), (second, other_start)] = drives;
        let agents = [Agent::<S>::new(&pair.0, first, *start)?, Agent::new(&pair.1, second, *other_start)?];
        let radii = agents.each_ref().map(|agent| DoubleDouble::from(agent.course.motion().radius().to_f64()));
        let extents = agents.each_ref().map(|agent| agent.course.motion().extent().to_f64());
        // A dozen operations on numbers of this size, rounded to 53 bits.
        let doubt = 16.0 * f64::EPSILON * (extents[0] + extents[1]);
        Ok(Self { agents, radius: radii[0] + radii[1], doubt })
    }

    /// Checks both directions; `false` if it did not, as no table can hold the pair.
    ///
    /// # Errors
    /// The first violation.
    pub fn check(&self, dice: &mut Dice, seen: &mut Seen) -> Result<bool, Violation> {
        let motions = self.agents.each_ref().map(|agent| agent.course.motion());
        let pairs_of_segments = motions.iter().map(|motion| motion.path().segments().len()).product::<usize>();
        let ecm = match build_ecm(&motions) {
            Ok(ecm) => ecm,
            // Long paths that meet all along, most of their segments in a piece or two: what no storage can hold.
            Err(CapacityError::Pair(_)) if 2 * pairs_of_segments > (1 << 15) => return Ok(false),
            Err(full) => return Err(full.to_string()),
        };
        let excess = excess(&motions[0], &motions[1]).to_f64();
        seen.pairs += 1;
        for ego in [0, 1] {
            let other = 1 - ego;
            let routes = [&self.agents[ego].route, &self.agents[other].route];
            let view = View {
                motions: [&motions[ego], &motions[other]],
                travel: Travel::new(&motions[other], routes[1].length()),
                routes,
                radius: self.radius,
                doubt: self.doubt,
                regions: ecm.pair(&motions, ego, other).expect("the table of the fleet").collect(),
                excess,
            };
            seen.regions += view.regions.len() as u64;
            view.slices(dice, seen)?;
            view.points(dice, seen)?;
            view.ranges(dice, seen)?;
        }
        Ok(true)
    }
}

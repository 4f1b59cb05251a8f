//! What has to hold for every pair, in every number format, numbered in `tests/properties.rs`, checked
//! against the oracle.
//!
//! Geometry is checked at 1 m/s ([`Drive::Unit`](crate::disc::Drive)), where time is the length along the other's path.

use crate::disc::{Course, Disc};
use crate::oracle::{Pair, line, plane};
use pcr_core::{Interval, Motion, RegionRef, excess};
use pcr_planning::fleet::{HostEcm, HostScalar, build_ecm};

/// What the oracle's own positions may be off, in units in the last place of the extent in `f64`: a dozen rounded
/// operations a segment. Contacts that are less deep prove nothing.
pub const ORACLE_ULPS: f64 = 16.0;

/// A pair of discs, in the library and in the oracle.
pub struct Audit<S: HostScalar> {
    courses: [Course<S>; 2],
    oracle: Pair,
    /// The stated bound of the pair \[m\].
    excess: f64,
    /// What the oracle may be off \[m\].
    doubt: f64,
}

/// What has been seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// Largest residual at slice ends, as a part of the bound.
    pub residual: f64,
    /// Regions.
    pub regions: usize,
    /// Pairs whose number of regions the oracle knows.
    pub certain: usize,
}

/// A property that does not hold, and where.
pub type Violation = String;

macro_rules! ensure {
    ($condition:expr, $($message:tt)+) => {
        let holds: bool = $condition;
        if !holds {
            return Err(format!($($message)+));
        }
    };
}

impl<S: HostScalar> Audit<S> {
    /// The pair; its numbers have to be numbers of the format ([`Disc::rounded`]).
    ///
    /// # Errors
    /// Where the library refuses it.
    pub fn new(ego: &Disc, other: &Disc) -> Result<Self, Violation> {
        let course = |disc| Course::<S>::new(disc).map_err(|invalid| format!("refused: {invalid}"));
        let courses = [course(ego)?, course(other)?];
        let motions = [courses[0].motion(), courses[1].motion()];
        let excess = excess(&motions[0], &motions[1]).to_f64();
        let doubt = ORACLE_ULPS * f64::EPSILON * (motions[0].extent() + motions[1].extent()).to_f64();
        Ok(Self { courses, oracle: Pair::new(ego, other), excess, doubt })
    }

    /// Bound on the residual `| |ρ_i(l) - ρ_j(s)| - R |` of slice ends \[m\]: the stated one, and what the oracle may be
    /// off.
    pub fn bound(&self) -> f64 {
        self.excess + self.doubt
    }

    /// The motions and their table.
    pub fn table(&self) -> ([Motion<'_, S>; 2], HostEcm<S>) {
        let motions = [self.courses[0].motion(), self.courses[1].motion()];
        let ecm = build_ecm(&motions).expect("two agents");
        (motions, ecm)
    }

    /// Everything below.
    ///
    /// # Errors
    /// The first violation.
    pub fn all(&self, effort: plane::Effort, samples: usize, seen: &mut Seen) -> Result<(), Violation> {
        self.transpose()?;
        self.contours(samples, seen)?;
        self.coverage(samples)?;
        self.sections(samples)?;
        self.ranges()?;
        self.components(effort, seen)
    }

    /// Swapping ego and other exchanges the lengths, and nothing else.
    ///
    /// # Errors
    /// The first violation.
    pub fn transpose(&self) -> Result<(), Violation> {
        let (motions, ecm) = self.table();
        let (regions, transposed) = (
            ecm.pair(&motions, 0, 1).expect("the table of the fleet"),
            ecm.pair(&motions, 1, 0).expect("the table of the fleet"),
        );
        let (count, mirrored) = (regions.clone().count(), transposed.clone().count());
        ensure!(count == mirrored, "{count} regions, {mirrored} from the other side");
        for (region, mirror) in regions.zip(transposed) {
            let exchanged = (mirror.other_length(), mirror.length());
            ensure!((region.length(), region.other_length()) == exchanged, "the transposed ranges differ");
            ensure!((region.ego(), region.other()) == (mirror.other(), mirror.ego()), "the agents are not exchanged");
        }
        Ok(())
    }

    /// Slices are disjoint, in order, within the ranges; their ends are contacts, or ends of the path.
    ///
    /// # Errors
    /// The first violation.
    pub fn contours(&self, samples: usize, seen: &mut Seen) -> Result<(), Violation> {
        let (motions, ecm) = self.table();
        let mirrored = Pair { ego: self.oracle.other.clone(), other: self.oracle.ego.clone(), ..self.oracle };
        for (ego, pair) in [(0, &self.oracle), (1, &mirrored)] {
            for region in ecm.pair(&motions, ego, 1 - ego).expect("the table of the fleet") {
                seen.regions += 1 - ego;
                self.contour(&region, pair, samples, seen)?;
            }
        }
        Ok(())
    }

    fn contour(
        &self,
        region: &RegionRef<'_, S>,
        pair: &Pair,
        samples: usize,
        seen: &mut Seen,
    ) -> Result<(), Violation> {
        let (s, l) = (region.other_length(), region.length());
        let (s_lo, s_hi) = (s.lo.to_f64(), s.hi.to_f64());
        // As the library sums it up.
        let path = self.courses[region.ego()].motion().path().length().to_f64();
        ensure!(s_lo <= s_hi && l.lo <= l.hi, "empty range {s:?} {l:?}");
        for k in 0..=samples {
            let time = S::from_f64(s_lo + (s_hi - s_lo) * k as f64 / samples as f64);
            // A path of length 0 has one time; at 1 m/s every other has the length as its time.
            let at = region.other_motion().length_at(time).to_f64();
            let mut after = f64::NEG_INFINITY;
            for interval in region.slice_at(time) {
                let (lo, hi) = (interval.lo.to_f64(), interval.hi.to_f64());
                ensure!(after < lo && lo <= hi, "slice at {time:?} not in order");
                ensure!(l.lo <= interval.lo && interval.hi <= l.hi, "slice {interval:?} at {time:?} outside {l:?}");
                after = hi;
                for end in [lo, hi] {
                    let clearance = pair.clearance(at, end);
                    let clipped = end <= 0.0 || end >= path;
                    let residual = if clipped { clearance } else { clearance.abs() };
                    seen.residual = seen.residual.max((residual - self.doubt) / self.excess);
                    ensure!(
                        residual <= self.bound(),
                        "residual {residual:e} at ({at}, {end}), {:e} stated",
                        self.excess
                    );
                }
                for part in [0.25, 0.5, 0.75] {
                    let inside = lo + part * (hi - lo);
                    let clearance = pair.clearance(at, inside);
                    ensure!(clearance <= self.bound(), "({at}, {inside}) is {clearance:e} clear of contact");
                }
            }
        }
        Ok(())
    }

    /// No sampled collision is outside all regions, none is in two of them, and nothing clear of contact is in one;
    /// both views and both queries agree.
    ///
    /// # Errors
    /// The first violation.
    pub fn coverage(&self, samples: usize) -> Result<(), Violation> {
        let (motions, ecm) = self.table();
        let regions: Vec<_> = ecm.pair(&motions, 0, 1).expect("the table of the fleet").collect();
        let transposed: Vec<_> = ecm.pair(&motions, 1, 0).expect("the table of the fleet").collect();
        for (s, l) in self.sampled(samples) {
            let clearance = self.oracle.clearance(s.to_f64(), l.to_f64());
            let holding = regions.iter().filter(|region| region.contains(s, l)).count();
            let mirrored = transposed.iter().filter(|region| region.contains(l, s)).count();
            for count in [holding, mirrored] {
                ensure!(
                    count > 0 || clearance > -self.doubt,
                    "missed ({s:?}, {l:?}): {clearance:e}, held by {holding} and {mirrored}"
                );
                ensure!(count == 0 || clearance <= self.bound(), "invented ({s:?}, {l:?}): {clearance:e}");
                ensure!(
                    count <= 1 || clearance >= -self.bound(),
                    "({s:?}, {l:?}) is in {count} regions: {clearance:e}"
                );
            }
            for region in &regions {
                let sliced = region.slice_at(s).any(|interval| interval.contains(l));
                ensure!(region.contains(s, l) == sliced, "contains and slice_at disagree at ({s:?}, {l:?})");
            }
        }
        Ok(())
    }

    /// What the oracle is sure that the other covers of the ego's path, however little, is in one slice.
    ///
    /// # Errors
    /// The first violation.
    pub fn sections(&self, samples: usize) -> Result<(), Violation> {
        let (motions, ecm) = self.table();
        let end = self.end(0).to_f64();
        let tolerance = self.excess.max(1e-9);
        for k in 0..=samples {
            let s = S::from_f64(self.oracle.other.length() * k as f64 / samples as f64).min(self.end(1));
            let overlap = |l| self.oracle.clearance(s.to_f64(), l) + self.doubt;
            let slices: Vec<_> = ecm
                .pair(&motions, 0, 1)
                .expect("the table of the fleet")
                .flat_map(|region| region.slice_at(s))
                .collect();
            for (lo, hi) in line::below(overlap, 0.0, self.oracle.ego.length(), 0.0, tolerance).inner {
                let holds = |slice: &Interval<S>| slice.lo.to_f64() <= lo && hi.min(end) <= slice.hi.to_f64();
                ensure!(slices.iter().any(holds), "at {s:?} [{lo}, {hi}] is covered, the slices are {slices:?}");
            }
        }
        Ok(())
    }

    /// Points `(s, l)`: evenly over the rectangle, and along its edges.
    pub fn sampled(&self, samples: usize) -> impl Iterator<Item = (S, S)> {
        let (length, width) = (self.oracle.ego.length(), self.oracle.other.length());
        // Additive recurrence with the plastic number: even in any rectangle.
        let even = |k: usize| (((k as f64 + 0.5) * 0.754_877_666).fract(), ((k as f64 + 0.5) * 0.569_840_296).fract());
        let inside = (0..samples * samples).map(even);
        let edges = (0..=samples).flat_map(move |k| {
            let part = k as f64 / samples as f64;
            [(0.0, part), (1.0, part), (part, 0.0), (part, 1.0)]
        });
        let ends = [0, 1].map(|agent| self.end(agent));
        inside
            .chain(edges)
            .map(move |(u, v)| (S::from_f64(u * width).min(ends[1]), S::from_f64(v * length).min(ends[0])))
    }

    /// Signed distance from contact \[m\].
    pub fn clearance(&self, s: S, l: S) -> f64 {
        self.oracle.clearance(s.to_f64(), l.to_f64())
    }

    /// Length of a path as the library sums it up: of the ego's (0) or the other's (1).
    fn end(&self, agent: usize) -> S {
        self.courses[agent].motion().path().length()
    }

    /// The ranges are reached: at their ends there is contact. Regions that are nowhere deeper than the bound are left
    /// out: whether they exist at all is a matter of rounding.
    ///
    /// # Errors
    /// The first violation.
    pub fn ranges(&self) -> Result<(), Violation> {
        let (motions, ecm) = self.table();
        for region in
            ecm.pair(&motions, 0, 1).expect("the table of the fleet").filter(|region| self.depth(region) > self.bound())
        {
            let (s, l) = (region.other_length(), region.length());
            let (s, l) = ((s.lo.to_f64(), s.hi.to_f64()), (l.lo.to_f64(), l.hi.to_f64()));
            let (bound, step) = (self.bound(), 0.5 * self.excess + 1e-12);
            for end in [l.0, l.1] {
                let clearance = |s| self.oracle.clearance(s, end);
                let reached = line::reaches(clearance, s.0, s.1, bound, step);
                let nearest = || line::nearest(clearance, s.0, s.1) / self.excess;
                ensure!(reached, "no contact at the end {end} of {l:?}: {} bounds clear", nearest());
            }
            for end in [s.0, s.1] {
                let clearance = |l| self.oracle.clearance(end, l);
                let reached = line::reaches(clearance, l.0, l.1, bound, step);
                let nearest = || line::nearest(clearance, l.0, l.1) / self.excess;
                ensure!(reached, "no contact at the end {end} of {s:?}: {} bounds clear", nearest());
            }
        }
        Ok(())
    }

    /// About the largest overlap in a region \[m\], in the middle of slices.
    fn depth(&self, region: &RegionRef<'_, S>) -> f64 {
        const SLICES: u32 = 32;
        let range = region.other_length();
        let depth = |k: u32| {
            let s = S::from_f64(range.lo.to_f64() + range.length().to_f64() * f64::from(k) / f64::from(SLICES));
            let s = s.clamp(range.lo, range.hi);
            let deepest = |depth: f64, slice: Interval<S>| depth.max(-self.clearance(s, slice.middle()));
            region.slice_at(s).fold(f64::NEG_INFINITY, deepest)
        };
        (0..=SLICES).map(depth).fold(f64::NEG_INFINITY, f64::max)
    }

    /// What the oracle knows of the components, positions right within `margin` \[m\].
    pub fn known(&self, effort: plane::Effort, margin: f64) -> plane::Components {
        plane::components(&self.oracle, margin, effort)
    }

    /// What is surely connected is in one region, what is surely apart is in different ones, and a region reaches as far as
    /// what is surely in it.
    ///
    /// # Errors
    /// The first violation.
    pub fn components(&self, effort: plane::Effort, seen: &mut Seen) -> Result<(), Violation> {
        let (motions, ecm) = self.table();
        let regions: Vec<_> = ecm.pair(&motions, 0, 1).expect("the table of the fleet").collect();
        let found = self.known(effort, self.bound());
        seen.certain += usize::from(found.certain());
        // Region that was found to be about an outer component.
        let mut about = vec![None; regions.len()];
        for (place, outer) in found.outer.iter().enumerate() {
            for inner in &outer.inner {
                if let Some(owner) = self.owner(&regions, inner)? {
                    let other = about[owner].replace(place).filter(|other| *other != place);
                    ensure!(other.is_none(), "one region about {:?} and {:?}", outer.bounds, other);
                    self.reaches(&regions[owner], inner.bounds)?;
                }
            }
        }
        Ok(())
    }

    /// The one region that holds all points of an inner component.
    fn owner(&self, regions: &[RegionRef<'_, S>], inner: &plane::Inner) -> Result<Option<usize>, Violation> {
        /// Points tried of each component.
        const POINTS: usize = 200;
        let mut owner = None;
        for &(s, l) in inner.points.iter().step_by(1 + inner.points.len() / POINTS) {
            let (s, l) = (S::from_f64(s).min(self.end(1)), S::from_f64(l).min(self.end(0)));
            let clearance = self.clearance(s, l);
            // Two regions may overlap by their rounding, and a point that was rounded may have left its box.
            if clearance > -self.bound() {
                continue;
            }
            let Some(index) = regions.iter().position(|region| region.contains(s, l)) else {
                return Err(format!("missed ({s:?}, {l:?}), {clearance:e}, in the component {:?}", inner.bounds));
            };
            let before = owner.replace(index).filter(|before| *before != index);
            ensure!(before.is_none(), "the component {:?} is in regions {index} and {before:?}", inner.bounds);
        }
        Ok(owner)
    }

    fn reaches(&self, region: &RegionRef<'_, S>, bounds: plane::Bounds) -> Result<(), Violation> {
        let reach = |range: Interval<S>, (lo, hi): (f64, f64), agent: usize| {
            // The sum of the lengths may have been rounded down.
            let hi = hi.min(self.end(agent).to_f64());
            range.lo.to_f64() <= lo + self.doubt && hi - self.doubt <= range.hi.to_f64()
        };
        let ranges = (region.other_length(), region.length());
        ensure!(reach(ranges.0, bounds.s, 1) && reach(ranges.1, bounds.l, 0), "{ranges:?} does not reach {bounds:?}");
        Ok(())
    }
}

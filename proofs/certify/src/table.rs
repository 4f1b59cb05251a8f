//! A whole table: every pair of agents, every pair of their segments.

use crate::arc_length_motion;
use crate::ball::Ball;
use crate::box_index::{BoxIndex, PlainBox, area};
use crate::distance_claim::DualPrecisionPart;
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::pair::{Findings, PairRadii, SegmentPairPieces, pieces_of};
use crate::path::{LEAST, PreparedSegment, stretches};
use crate::raw::{RawAgent, RawPair, RawTable};
use crate::{regions, segments};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// Beside an arc whose radius is R within 2 ε, what is told of a length lies within R and so much of ε. That is the bound of every end of a
/// range in docs/theory/errors.md; elsewhere a whole ε is asked, which is less than what is derived.
const TOLD_BESIDE: f64 = 1.5;

/// How much farther than R contacts have to be covered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoverageMargin {
    /// As far as all queries of the library need it: it looks up lengths that are off by the lag of the motion and by the rounding
    /// of the path's, and an interval of the second path by its middle, which takes ε/4.
    Needed,
    /// So many ε, whatever the queries need.
    Epsilons(f64),
}

/// A disc with its path in the plane.
#[derive(Clone, Debug)]
pub struct PreparedAgent<'a> {
    agent: &'a RawAgent,
    stretches: Vec<PreparedSegment>,
    /// By how much an arc is longer than one turn at most \[m\].
    over: f64,
}

/// A table whose numbers have been looked through.
#[derive(Clone, Debug)]
pub struct Checker<'a> {
    agents: Vec<PreparedAgent<'a>>,
    pairs: &'a [RawPair],
    apart: Option<f64>,
}

/// Who may come near whom: of these a table has to tell the regions.
#[derive(Clone, Debug)]
pub struct ProximityIndex(pub(crate) BoxIndex);

impl ProximityIndex {
    /// Those of a table whose pairs have an ε of this at most \[m\].
    ///
    /// # Errors
    /// A path that is none.
    pub fn new(agents: &[RawAgent], excess: f64) -> Result<Self, CertifyError> {
        let area = |agent: &RawAgent| Ok(swept_box(agent, &stretches(&agent.path)?, excess));
        Ok(Self(BoxIndex::new(agents.iter().map(area).collect::<Result<_, CertifyError>>()?)))
    }

    /// Places behind this one that may come near it, in order.
    pub fn after(&self, place: usize) -> Vec<usize> {
        self.0.after(place)
    }
}

/// The box of all that an agent passes. Two agents whose boxes do not meet are nowhere within R and all that has to be covered or may
/// be told beyond it: that is ε, or what their lengths are off, at most.
fn swept_box(agent: &RawAgent, stretches: &[PreparedSegment], excess: f64) -> PlainBox {
    let off = agent.path.rounding + agent.travel.as_ref().map_or(0.0, |travel| travel.lag);
    area(stretches, ((agent.radius + off).next_up() + excess).next_up())
}

impl<'a> Checker<'a> {
    /// Puts the paths into the plane.
    ///
    /// # Errors
    /// What is wrong with the table: numbers out of range, a path that is none, a pair that is missing or there twice.
    pub fn new(table: &'a RawTable) -> Result<Self, CertifyError> {
        let agents = table.agents.iter().enumerate().map(|(place, agent)| {
            let wrong = CertifyError::of(InputPart::Agent(agent.id, Some(place)));
            let numbers = [agent.radius, agent.path.rounding, agent.travel.as_ref().map_or(0.0, |travel| travel.lag)];
            if !numbers.iter().all(|&number| (0.0..1e15).contains(&number)) {
                return Err(wrong(CertifyError::OutOfRange("a radius, rounding or lag")));
            }
            let stretches = stretches(&agent.path).map_err(wrong)?;
            arc_length_motion::checked(agent).and_then(|()| arc_length_motion::arrives(agent)).map_err(wrong)?;
            let arcs = agent.path.segments.iter().filter_map(|segment| Some((segment.length, segment.radius?.abs())));
            let over = arcs.map(|(length, radius)| length - TAU * radius).fold(0.0, f64::max);
            Ok(PreparedAgent { agent, stretches, over })
        });
        let checker = Self { agents: agents.collect::<Result<_, _>>()?, pairs: &table.pairs, apart: table.apart };
        checker.all_pairs_are_there()?;
        Ok(checker)
    }

    fn all_pairs_are_there(&self) -> Result<(), CertifyError> {
        let count = self.agents.len();
        let id = |place: usize| self.agents[place].agent.id;
        let mut there = HashSet::with_capacity(self.pairs.len());
        for pair in self.pairs {
            let [a, b] = pair.agents;
            if a == b || a >= count || b >= count || id(a) == id(b) || !there.insert([a.min(b), a.max(b)]) {
                return Err(CertifyError::NoPair([a, b]));
            }
            if !(LEAST..1e15).contains(&pair.excess) {
                return Err(CertifyError::Excess([a, b]));
            }
            // The rounding of a full turn, to a whole digit of sixteen; of what is more there would be a third lap.
            if let Some(place) = [a, b].into_iter().find(|&place| self.agents[place].over > 0.125 * pair.excess) {
                return Err(CertifyError::ArcTooLong(place));
            }
        }
        if let Some(excess) = self.apart {
            return self.all_near_are_among(&there, excess);
        }
        let mut bodies: HashMap<u64, usize> = HashMap::new();
        (0..count).for_each(|place| *bodies.entry(id(place)).or_default() += 1);
        let pairs_of = |discs: usize| discs * discs.saturating_sub(1) / 2;
        if there.len() == pairs_of(count) - bodies.values().map(|&discs| pairs_of(discs)).sum::<usize>() {
            return Ok(());
        }
        let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let missing = all.into_iter().find(|&[a, b]| id(a) != id(b) && !there.contains(&[a, b]));
        Err(CertifyError::MissingPair(missing.unwrap_or_default()))
    }

    fn all_near_are_among(&self, there: &HashSet<[usize; 2]>, excess: f64) -> Result<(), CertifyError> {
        if !(LEAST..1e15).contains(&excess) {
            return Err(CertifyError::OutOfRange("the excess of those that are left out"));
        }
        let area = |placed: &PreparedAgent<'_>| swept_box(placed.agent, &placed.stretches, excess);
        let (near, id) =
            (BoxIndex::new(self.agents.iter().map(area).collect()), |place: usize| self.agents[place].agent.id);
        let missing = |a: usize| near.after(a).into_iter().find(|&b| id(a) != id(b) && !there.contains(&[a, b]));
        match (0..self.agents.len()).find_map(|a| missing(a).map(|b| (a, b))) {
            Some((a, b)) => Err(CertifyError::MissingNearPair([a, b])),
            None => Ok(()),
        }
    }

    /// Checks every pair.
    ///
    /// # Errors
    /// A piece that is none.
    pub fn check(&self, margin: CoverageMargin) -> Result<Findings, CertifyError> {
        self.watched(margin, &|_| {})
    }

    /// Checks every pair as [`Checker::check`], and tells before each one how many are checked.
    ///
    /// # Errors
    /// A piece that is none.
    pub fn watched(&self, margin: CoverageMargin, told: &dyn Fn(usize)) -> Result<Findings, CertifyError> {
        let wholes = self.wholes();
        let mut findings = Findings::default();
        for (checked, pair) in self.pairs.iter().enumerate() {
            told(checked);
            findings.add(self.pair(pair, &wholes, self.radii(pair, margin), true)?);
        }
        Ok(findings)
    }

    fn wholes(&self) -> Vec<Vec<DualPrecisionPart<'_>>> {
        self.agents.iter().map(|agent| agent.stretches.iter().map(|stretch| stretch.placed.whole()).collect()).collect()
    }

    fn radii(&self, pair: &RawPair, margin: CoverageMargin) -> PairRadii {
        let [first, second] = pair.agents.map(|place| self.agents[place].agent);
        let rounding =
            [first, second].map(|agent| agent.path.rounding + agent.travel.as_ref().map_or(0.0, |travel| travel.lag));
        let more = match margin {
            CoverageMargin::Needed => rounding[0].max(rounding[1]).max(0.25 * pair.excess),
            CoverageMargin::Epsilons(part) => part * pair.excess,
        };
        let number = Ball::<DoubleDouble>::from;
        let radius = number(first.radius) + number(second.radius);
        PairRadii {
            radius,
            covered: radius + number(more),
            reported: radius + number(pair.excess),
            beside_large_arc: radius + number(TOLD_BESIDE * pair.excess),
        }
    }

    fn pair(
        &self,
        pair: &RawPair,
        wholes: &[Vec<DualPrecisionPart<'a>>],
        radii: PairRadii,
        tells: bool,
    ) -> Result<Findings, CertifyError>
    where
        Self: 'a,
    {
        let [a, b] = pair.agents;
        let (first, second) = (&self.agents[a].stretches, &self.agents[b].stretches);
        let named = CertifyError::of(InputPart::Pair([a, b]));
        let pieces = pieces_of(&pair.pieces, [first, second]).map_err(named)?;
        let mut findings = Findings::default();
        for (i, own) in first.iter().enumerate() {
            for (j, other) in second.iter().enumerate() {
                let begin = pieces.partition_point(|piece| piece.segments < [i, j]);
                let those = pieces[begin..].iter().take_while(|piece| piece.segments == [i, j]);
                let mut segments = SegmentPairPieces {
                    stretches: [own, other],
                    whole: [wholes[a][i].clone(), wholes[b][j].clone()],
                    pieces: those.map(|piece| (piece.lengths, piece.share)).collect(),
                };
                segments::check(&mut segments, pair, &radii, tells, &mut findings);
            }
        }
        if tells {
            let agents = [self.agents[a].agent, self.agents[b].agent];
            let discs = regions::Discs { stretches: [first, second], pair, radii: &radii };
            regions::check(agents, [first, second], pair, &pieces, &discs, &mut findings).map_err(named)?;
        }
        Ok(findings)
    }

    /// The largest margin, in ε of its pair, at which contacts are covered in all pairs with regions, and the place of the pair that
    /// limits it: what a search for a wrong table makes as small as it can. A table that keeps its promise has 0 or more, an exact one
    /// with a slack of ε/2 would have 1/2. Found to 2^-12, up to 1; costs a dozen checks.
    ///
    /// # Errors
    /// As [`Checker::check`].
    pub fn margin(&self) -> Result<Option<(f64, usize)>, CertifyError> {
        self.margin_below(f64::INFINITY)
    }

    /// As [`Checker::margin`], where it is below `known`; none where it is not, which takes one check.
    ///
    /// # Errors
    /// As [`Checker::check`].
    pub fn margin_below(&self, known: f64) -> Result<Option<(f64, usize)>, CertifyError> {
        const STEPS: u32 = 12;
        let wholes = self.wholes();
        let holds = |pair: &RawPair, part: f64| {
            let found = self.pair(pair, &wholes, self.radii(pair, CoverageMargin::Epsilons(part)), false);
            found.map(|found| found.refuted.is_empty() && found.undecided.is_empty())
        };
        let (mut least, mut place_of_least) = (known, None);
        for (place, pair) in self.pairs.iter().enumerate() {
            if pair.pieces.is_empty() || (least < f64::INFINITY && holds(pair, least)?) {
                continue;
            }
            let (mut lo, mut hi) = (-1.0, least.min(1.0));
            if !holds(pair, lo)? {
                return Ok(Some((f64::NEG_INFINITY, place)));
            }
            for _ in 0..=STEPS {
                let middle = 0.5 * (lo + hi);
                if holds(pair, middle)? { lo = middle } else { hi = middle }
            }
            (least, place_of_least) = (lo, Some(place));
        }
        Ok(place_of_least.map(|place| (least, place)))
    }
}

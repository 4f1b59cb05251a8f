//! Compares the other contents of an answer of `pcr regions` with its tables.

use super::CertificateTable;
use super::error::{CertifyInputError, RegionDifference};
use pcr_certify::outline::RawBody;
use pcr_certify::raw::{RawAgent, RawPair, RawRegion, RawTable};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// The bodies of an agent, of which only the number counts. Answers of version 1 had discs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) struct ReportedBodies {
    id: u64,
    #[serde(alias = "discs")]
    parts: Vec<IgnoredAny>,
}

/// A region as it is printed. Crossings, slices and the numbers of segments are not looked at.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) struct ReportedRegion {
    i: u64,
    j: u64,
    t: [f64; 2],
    l: [f64; 2],
    open_start: bool,
    open_end: bool,
    pieces: Vec<ReportedPiece>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
struct ReportedPiece {
    #[serde(rename = "type")]
    kind: String,
    i_length: [f64; 2],
    j_length: [f64; 2],
}

/// Two bodies with one number are parts of one agent: as many as are told of it.
pub(super) fn bodies(table: &RawTable, reported: &[ReportedBodies]) -> Result<(), CertifyInputError> {
    let mut told: HashMap<u64, usize> = HashMap::new();
    reported.iter().for_each(|bodies| *told.entry(bodies.id).or_default() += bodies.parts.len());
    let counts = counts(table);
    for (&id, &count) in &counts {
        match told.get(&id) {
            None if count > 1 => return Err(CertifyInputError::UntoldBodies { id, count }),
            Some(&told) if told != count => return Err(CertifyInputError::BodyCount { id, count, told }),
            _ => {}
        }
    }
    // Wherever an agent has an outline, less of the regions is compared: the agent has to be there.
    match told.keys().find(|id| !counts.contains_key(id)) {
        Some(&id) => Err(CertifyInputError::BodiesOfNobody(id)),
        None => Ok(()),
    }
}

/// Checks that two tables are about the same discs on the same paths at the same times, in the second one with margins.
pub(super) fn enlarged(discs: &RawTable, margins: &RawTable) -> Result<(), CertifyInputError> {
    let counts = [discs, margins].map(|table| table.agents.len());
    if counts[0] != counts[1] {
        return Err(CertifyInputError::DiscCounts(counts));
    }
    for (place, (disc, margin)) in discs.agents.iter().zip(&margins.agents).enumerate() {
        let differs = match () {
            () if disc.id != margin.id => "id",
            () if disc.path != margin.path => "path",
            () if disc.travel != margin.travel => "travel",
            () if margin.radius < disc.radius => "radius, which is smaller with the margin",
            () => continue,
        };
        return Err(CertifyInputError::AgentsDiffer(place, differs));
    }
    Ok(())
}

/// Checks that two tables have the same outlines but for their radii.
pub(super) fn same_corners(bodies: &CertificateTable, margins: &CertificateTable) -> Result<(), CertifyInputError> {
    let (CertificateTable::Outlines(bodies), CertificateTable::Outlines(margins)) = (bodies, margins) else {
        return Ok(());
    };
    let pairs = bodies.bodies.iter().zip(&margins.bodies).enumerate();
    let same = |a: &RawBody, b: &RawBody| {
        a.outline.corners == b.outline.corners
            && a.segments.iter().zip(&b.segments).all(|(a, b)| a.heading == b.heading && a.course == b.course)
    };
    match pairs.into_iter().find(|(_, (body, margin))| !same(body, margin)) {
        Some((place, _)) => Err(CertifyInputError::OutlinesDiffer(place)),
        None => Ok(()),
    }
}

/// Checks that the requested agent is in the certificate; otherwise nothing would be compared.
pub(super) fn asked(table: &RawTable, agent: Option<u64>) -> Result<(), CertifyInputError> {
    match agent {
        Some(asked) if !table.agents.iter().any(|agent| agent.id == asked) => {
            Err(CertifyInputError::NoSuchAgent(asked))
        }
        _ => Ok(()),
    }
}

/// How many discs have which number.
fn counts(table: &RawTable) -> BTreeMap<u64, usize> {
    let mut counts = BTreeMap::new();
    table.agents.iter().for_each(|agent| *counts.entry(agent.id).or_default() += 1);
    counts
}

/// Pairs of discs of different bodies: those whose contacts are looked at.
pub(super) fn pairs(table: &RawTable) -> usize {
    let pairs_of = |discs: usize| discs * discs.saturating_sub(1) / 2;
    pairs_of(table.agents.len()) - counts(table).values().map(|&discs| pairs_of(discs)).sum::<usize>()
}

/// Regions of two agents with their places in the list.
type RegionsByPair<R> = BTreeMap<[u64; 2], Vec<(usize, R)>>;

/// The scope of an answer: the requested agent, if there is one, and the agents that are several bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegionScope<'a> {
    pub(super) agent: Option<u64>,
    pub(super) bodies: &'a [ReportedBodies],
}

/// Compares the regions in the list of this name with a table.
///
/// # Errors
/// The first difference.
pub(super) fn compare(
    list: &'static str,
    told: &[ReportedRegion],
    table: &RawTable,
    asked: RegionScope<'_>,
) -> Result<(), CertifyInputError> {
    let mut held: RegionsByPair<ReportedRegion> = BTreeMap::new();
    for pair in &table.pairs {
        for (place, region) in pair.regions.iter().enumerate() {
            // Without motions there are no times to be told.
            let Some(times) = region.times else { continue };
            for first in [0, 1] {
                let told = expected_region(table, pair, (place, region), times, first)?;
                if asked.agent.is_none_or(|agent| agent == told.i) {
                    let of_pair = held.entry([told.i, told.j]).or_default();
                    of_pair.push((of_pair.len(), told));
                }
            }
        }
    }
    let mut there: RegionsByPair<&ReportedRegion> = BTreeMap::new();
    for (place, region) in told.iter().enumerate() {
        there.entry([region.i, region.j]).or_default().push((place, region));
    }
    let outlined: HashSet<u64> = asked.bodies.iter().map(|bodies| bodies.id).collect();
    let pairs: BTreeSet<[u64; 2]> = held.keys().chain(there.keys()).copied().collect();
    for [i, j] in pairs {
        let mut own = there.remove(&[i, j]).unwrap_or_default();
        let mut theirs = held.remove(&[i, j]).unwrap_or_default();
        if !outlined.is_empty() {
            unions(list, [i, j], &own, &theirs, ![i, j].iter().any(|id| outlined.contains(id)))?;
            continue;
        }
        if own.len() != theirs.len() {
            let (told, held) = (own.len(), theirs.len());
            return Err(CertifyInputError::RegionCount { list, agents: [i, j], told, held });
        }
        let order = |a: &ReportedRegion, b: &ReportedRegion| a.t[0].total_cmp(&b.t[0]).then(a.l[0].total_cmp(&b.l[0]));
        own.sort_by(|(_, a), (_, b)| order(a, b));
        theirs.sort_by(|(_, a), (_, b)| order(a, b));
        for ((place, own), (_, theirs)) in own.iter().zip(&theirs) {
            own.same(theirs).map_err(|problem| CertifyInputError::Region {
                list,
                place: *place,
                agents: [i, j],
                problem,
            })?;
        }
    }
    Ok(())
}

/// If any agent has an outline, regions are unions of those of its discs: the region of each disc has to lie in a union, and
/// the ends of a union are ends of some of them. Lengths of outlines are on other paths than those of discs, and are not
/// compared.
fn unions(
    list: &'static str,
    agents: [u64; 2],
    own: &[(usize, &ReportedRegion)],
    theirs: &[(usize, ReportedRegion)],
    discs: bool,
) -> Result<(), CertifyInputError> {
    let within = |[lo, hi]: [f64; 2], [from, to]: [f64; 2]| from <= lo && hi <= to;
    let holds =
        |own: &ReportedRegion, part: &ReportedRegion| within(part.t, own.t) && (!discs || within(part.l, own.l));
    if let Some((_, none)) = theirs.iter().find(|(_, part)| !own.iter().any(|(_, own)| holds(own, part))) {
        return Err(CertifyInputError::NotHeld { list, agents, times: none.t });
    }
    let made = |range: &dyn Fn(&ReportedRegion) -> [f64; 2], own: &ReportedRegion| {
        (0..2).all(|end| theirs.iter().any(|(_, part)| range(part)[end] == range(own)[end]))
    };
    for (k, &(place, region)) in own.iter().enumerate() {
        let wrong = |problem| CertifyInputError::Region { list, place, agents, problem };
        if !made(&|told| told.t, region) {
            return Err(wrong(RegionDifference::Unmade { name: "t", told: region.t, of: "times" }));
        }
        if discs && !made(&|told| told.l, region) {
            return Err(wrong(RegionDifference::Unmade { name: "l", told: region.l, of: "lengths" }));
        }
        if own[..k].iter().any(|&(_, before)| before == region) {
            return Err(wrong(RegionDifference::Twice));
        }
    }
    Ok(())
}

/// The expected content for a region of a table, seen from one of its two agents.
fn expected_region(
    table: &RawTable,
    pair: &RawPair,
    (place, region): (usize, &RawRegion),
    times: [[f64; 2]; 2],
    first: usize,
) -> Result<ReportedRegion, CertifyInputError> {
    let second = 1 - first;
    let agent = |k: usize| table.agents.get(pair.agents[k]).ok_or(CertifyInputError::NoPair(pair.agents));
    let (own, other) = (agent(first)?, agent(second)?);
    let letter = |agent: &RawAgent, segment: usize| {
        agent.path.segments.get(segment).map_or('?', |segment| if segment.radius.is_some() { 'A' } else { 'S' })
    };
    let pieces = pair.pieces.iter().filter(|piece| piece.region == place).map(|piece| ReportedPiece {
        kind: [letter(own, piece.segments[first]), letter(other, piece.segments[second])].into_iter().collect(),
        i_length: piece.lengths[first],
        j_length: piece.lengths[second],
    });
    let [from, to] = region.lengths[second];
    let end = other.path.segments.last().map_or(0.0, |last| last.to);
    Ok(ReportedRegion {
        i: own.id,
        j: other.id,
        t: times[second],
        l: region.lengths[first],
        open_start: from <= 0.0,
        open_end: to >= end,
        pieces: pieces.collect(),
    })
}

impl ReportedRegion {
    /// Whether a region is told as it is held, or what is not.
    fn same(&self, held: &Self) -> Result<(), RegionDifference> {
        for (name, told, held) in [("t", self.t, held.t), ("l", self.l, held.l)] {
            if told != held {
                let [told, held] = [told, held].map(|range| format!("{range:?}"));
                return Err(RegionDifference::Field { name, told, held });
            }
        }
        for (name, told, held) in
            [("open_start", self.open_start, held.open_start), ("open_end", self.open_end, held.open_end)]
        {
            if told != held {
                return Err(RegionDifference::Field { name, told: told.to_string(), held: held.to_string() });
            }
        }
        if self.pieces.len() != held.pieces.len() {
            return Err(RegionDifference::PieceCount([self, held].map(|region| region.pieces.len())));
        }
        let (own, held) = (sorted(&self.pieces), sorted(&held.pieces));
        match own.into_iter().zip(held).find(|(own, held)| own != held) {
            None => Ok(()),
            Some((own, held)) => {
                let (told, held) = (own.describe(), held.describe());
                Err(RegionDifference::Field { name: "a piece", told, held })
            }
        }
    }
}

impl ReportedPiece {
    fn describe(&self) -> String {
        format!("{} with the lengths {:?} and {:?}", self.kind, self.i_length, self.j_length)
    }
}

fn sorted(pieces: &[ReportedPiece]) -> Vec<&ReportedPiece> {
    let mut sorted: Vec<&ReportedPiece> = pieces.iter().collect();
    let key = |part: &ReportedPiece| [part.i_length[0], part.j_length[0], part.i_length[1], part.j_length[1]];
    sorted.sort_by(|a, b| {
        let orders = key(a).into_iter().zip(key(b)).map(|(a, b)| a.total_cmp(&b));
        orders.fold(a.kind.cmp(&b.kind), std::cmp::Ordering::then)
    });
    sorted
}

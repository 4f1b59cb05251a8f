//! The method of this library.

use super::{
    CollisionMethod, ComparedScalar, ComparisonFleet, MethodAnswer, MethodContact, MethodError, MethodQuestion,
    MethodResult, RegionSet,
};
use pcr_core::{Aabb, BroadPhase, EcmEntry, Interval, Motion, Piece, RegionRef};
use pcr_fixed::Q16;
use pcr_planning::agent_regions::{AgentRegions, rows};
use pcr_planning::fleet::{HostEcm, build_ecm};
use rayon::prelude::*;
use std::marker::PhantomData;

#[derive(Clone, Copy, PartialEq)]
enum Parallelism {
    One,
    All,
}

impl Parallelism {
    fn suffix(self) -> &'static str {
        match self {
            Self::One => "",
            Self::All => ", all cores",
        }
    }
}

/// Collision regions in the format `S`.
struct PcrRegionsMethod<S>(Parallelism, PhantomData<S>);

/// Parts of the time in which pairs are sorted out.
const PARTS: usize = 16;

/// Two agents, and when they are in contact.
type FoundInterval<S> = ([usize; 2], Interval<S>);

/// Conflicts in the format `S`.
struct PcrConflictsMethod<S>(Parallelism, PhantomData<S>);

pub(super) fn regions() -> Vec<Box<dyn CollisionMethod>> {
    vec![
        Box::new(PcrRegionsMethod::<f64>(Parallelism::One, PhantomData)),
        Box::new(PcrRegionsMethod::<f64>(Parallelism::All, PhantomData)),
        Box::new(PcrRegionsMethod::<f32>(Parallelism::One, PhantomData)),
        Box::new(PcrRegionsMethod::<Q16>(Parallelism::One, PhantomData)),
    ]
}

pub(super) fn conflicts() -> Vec<Box<dyn CollisionMethod>> {
    vec![
        Box::new(PcrConflictsMethod::<f64>(Parallelism::One, PhantomData)),
        Box::new(PcrConflictsMethod::<f64>(Parallelism::All, PhantomData)),
        Box::new(PcrConflictsMethod::<f32>(Parallelism::One, PhantomData)),
        Box::new(PcrConflictsMethod::<Q16>(Parallelism::One, PhantomData)),
    ]
}

impl<S: ComparedScalar> CollisionMethod for PcrRegionsMethod<S> {
    fn name(&self) -> String {
        format!("pcr {}{}", S::NAME, self.0.suffix())
    }

    fn question(&self) -> MethodQuestion {
        MethodQuestion::Regions
    }

    fn output_description(&self) -> &'static str {
        "regions, rounded outward"
    }

    fn is_parallel(&self) -> bool {
        self.0 == Parallelism::All
    }

    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f> {
        let motions = S::motions(field).ok_or(MethodError::Beyond)?;
        Ok(MethodAnswer::Regions(match self.0 {
            Parallelism::One => Box::new(WholeTable { motions, table: build_ecm(motions)? }),
            Parallelism::All => Box::new(AgentTables(rows(motions)?)),
        }))
    }
}

/// One table.
struct WholeTable<'f, 'a, S: ComparedScalar> {
    motions: &'f [Motion<'a, S>],
    table: HostEcm<S>,
}

/// A table an agent, of its regions with those after it.
struct AgentTables<'f, S: ComparedScalar>(Vec<AgentRegions<'f, S>>);

fn bytes<S: ComparedScalar>(table: &HostEcm<S>) -> usize {
    table.len() * size_of::<EcmEntry>() + table.pieces() * size_of::<Piece<S>>()
}

fn slice<'a, S: ComparedScalar>(regions: impl Iterator<Item = RegionRef<'a, S>>, time: f64) -> Vec<[f64; 2]> {
    let time = S::from_f64(time);
    let slices = regions.flat_map(|region| region.slice_at(time).collect::<Vec<_>>());
    slices.map(|slice| [slice.lo.to_f64(), slice.hi.to_f64()]).collect()
}

impl<S: ComparedScalar> RegionSet for WholeTable<'_, '_, S> {
    fn count(&self) -> usize {
        2 * self.table.len()
    }

    fn bytes(&self) -> usize {
        bytes(&self.table)
    }

    fn slice(&self, ego: usize, other: usize, time: f64) -> Vec<[f64; 2]> {
        slice(self.table.pair(self.motions, ego, other).expect("the table of the fleet"), time)
    }
}

impl<S: ComparedScalar> RegionSet for AgentTables<'_, S> {
    fn count(&self) -> usize {
        self.0.iter().map(|row| 2 * row.table().len()).sum()
    }

    fn bytes(&self) -> usize {
        self.0.iter().map(|row| bytes(row.table())).sum()
    }

    fn slice(&self, ego: usize, other: usize, time: f64) -> Vec<[f64; 2]> {
        let row = self.0.get(ego.min(other));
        row.map_or(Vec::new(), |row| slice(row.pair(ego, other).expect("the row of one of them"), time))
    }
}

impl<S: ComparedScalar> CollisionMethod for PcrConflictsMethod<S> {
    fn name(&self) -> String {
        format!("pcr {}{}", S::NAME, self.0.suffix())
    }

    fn question(&self) -> MethodQuestion {
        MethodQuestion::Conflicts
    }

    fn output_description(&self) -> &'static str {
        "intervals, certified"
    }

    fn is_parallel(&self) -> bool {
        self.0 == Parallelism::All
    }

    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f> {
        let motions = S::motions(field).ok_or(MethodError::Beyond)?;
        let during = field.horizon.map(S::from_f64);
        let during = Interval::new(during[0], during[1]);
        let boxes = vec![Aabb::default(); motions.len() * (1 + PARTS)];
        let broad_phase = BroadPhase::new(boxes, motions, during)?;
        let found = |(agents, time): FoundInterval<S>| MethodContact {
            agents,
            begin: time.lo.to_f64(),
            end: Some(time.hi.to_f64()),
        };
        Ok(MethodAnswer::Conflicts(match self.0 {
            Parallelism::One => broad_phase.contacts().map(found).collect(),
            Parallelism::All => {
                let candidates: Vec<_> = broad_phase.candidates().collect();
                let contacts = candidates.into_par_iter();
                let of = |(agents, during)| broad_phase.contacts_of(agents, during).expect("agents of the fleet");
                contacts.flat_map_iter(of).map(found).collect()
            }
        }))
    }
}

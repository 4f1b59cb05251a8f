//! The method of this library.

use super::{Answer, BEYOND, Field, Found, Method, Number, Outcome, Question, Regions};
use pcr_core::{Bounds, BroadPhase, Interval, Motion, Piece, Region, RegionRef};
use pcr_fixed::Q16;
use pcr_planning::fleet::{HostEcm, build_ecm};
use pcr_planning::rows::{Row, rows};
use rayon::prelude::*;
use std::marker::PhantomData;

#[derive(Clone, Copy, PartialEq)]
enum Cores {
    One,
    All,
}

impl Cores {
    fn suffix(self) -> &'static str {
        match self {
            Self::One => "",
            Self::All => ", all cores",
        }
    }
}

/// Collision regions in the format `S`.
struct Map<S>(Cores, PhantomData<S>);

/// Parts of the time in which pairs are sorted out.
const PARTS: usize = 16;

/// Two agents, and when they are in contact.
type Contact<S> = ([usize; 2], Interval<S>);

/// Conflicts in the format `S`.
struct Conflicts<S>(Cores, PhantomData<S>);

pub(super) fn regions() -> Vec<Box<dyn Method>> {
    vec![
        Box::new(Map::<f64>(Cores::One, PhantomData)),
        Box::new(Map::<f64>(Cores::All, PhantomData)),
        Box::new(Map::<f32>(Cores::One, PhantomData)),
        Box::new(Map::<Q16>(Cores::One, PhantomData)),
    ]
}

pub(super) fn conflicts() -> Vec<Box<dyn Method>> {
    vec![
        Box::new(Conflicts::<f64>(Cores::One, PhantomData)),
        Box::new(Conflicts::<f64>(Cores::All, PhantomData)),
        Box::new(Conflicts::<f32>(Cores::One, PhantomData)),
        Box::new(Conflicts::<Q16>(Cores::One, PhantomData)),
    ]
}

impl<S: Number> Method for Map<S> {
    fn name(&self) -> String {
        format!("pcr {}{}", S::NAME, self.0.suffix())
    }

    fn question(&self) -> Question {
        Question::Regions
    }

    fn tells(&self) -> &'static str {
        "regions, rounded outward"
    }

    fn is_parallel(&self) -> bool {
        self.0 == Cores::All
    }

    fn answer<'f>(&self, field: &'f Field<'_>) -> Outcome<'f> {
        let motions = S::motions(field).ok_or(BEYOND)?;
        Ok(Answer::Regions(match self.0 {
            Cores::One => Box::new(Whole { motions, table: build_ecm(motions).map_err(|full| full.to_string())? }),
            Cores::All => Box::new(Rows(rows(motions).map_err(|full| full.to_string())?)),
        }))
    }
}

/// One table.
struct Whole<'f, 'a, S: Number> {
    motions: &'f [Motion<'a, S>],
    table: HostEcm<S>,
}

/// A table an agent, of its regions with those after it.
struct Rows<'f, S: Number>(Vec<Row<'f, S>>);

fn bytes<S: Number>(table: &HostEcm<S>) -> usize {
    table.len() * size_of::<Region>() + table.pieces() * size_of::<Piece<S>>()
}

fn slice<'a, S: Number>(regions: impl Iterator<Item = RegionRef<'a, S>>, time: f64) -> Vec<[f64; 2]> {
    let time = S::from_f64(time);
    let slices = regions.flat_map(|region| region.slice_at(time).collect::<Vec<_>>());
    slices.map(|slice| [slice.lo.to_f64(), slice.hi.to_f64()]).collect()
}

impl<S: Number> Regions for Whole<'_, '_, S> {
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

impl<S: Number> Regions for Rows<'_, S> {
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

impl<S: Number> Method for Conflicts<S> {
    fn name(&self) -> String {
        format!("pcr {}{}", S::NAME, self.0.suffix())
    }

    fn question(&self) -> Question {
        Question::Conflicts
    }

    fn tells(&self) -> &'static str {
        "intervals, certified"
    }

    fn is_parallel(&self) -> bool {
        self.0 == Cores::All
    }

    fn answer<'f>(&self, field: &'f Field<'_>) -> Outcome<'f> {
        let motions = S::motions(field).ok_or(BEYOND)?;
        let during = field.horizon.map(S::from_f64);
        let during = Interval::new(during[0], during[1]);
        let boxes = vec![Bounds::default(); motions.len() * (1 + PARTS)];
        let broad_phase = BroadPhase::new(boxes, motions, during).map_err(|full| full.to_string())?;
        let found = |(agents, time): Contact<S>| Found { agents, begin: time.lo.to_f64(), end: Some(time.hi.to_f64()) };
        Ok(Answer::Conflicts(match self.0 {
            Cores::One => broad_phase.contacts().map(found).collect(),
            Cores::All => {
                let candidates: Vec<_> = broad_phase.candidates().collect();
                let contacts = candidates.into_par_iter();
                let of = |(agents, during)| broad_phase.contacts_of(agents, during).expect("agents of the fleet");
                contacts.flat_map_iter(of).map(found).collect()
            }
        }))
    }
}

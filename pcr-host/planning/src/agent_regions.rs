//! Collision regions of fleets of any size, one agent at a time: a row is the table of an agent with the later agents
//! that come near it. Rows are independent of one another, so they are computed on all cores, and a fleet whose table
//! would not fit into memory can be processed row by row.
//!
//! Agents are processed along a space-filling curve, so that the paths of neighbours are still in the cache. Each
//! thread has one row and reuses its storage.

mod grid;

pub use grid::BoxGrid;

use crate::failure::ComputationError;
use crate::fleet::{HostEcm, HostScalar, table_of};
use crate::memory_budget::MemoryBudget;
use crate::parallel;
use pcr_core::{CapacityError, EcmError, MismatchError, Motion, RegionRef, excess};
use rayon::prelude::*;

/// Reports progress: what is done, and all.
pub type ProgressFn<'t> = &'t dyn Fn(usize, usize);

/// The regions of an agent with others, those after it or all.
#[derive(Debug)]
pub struct AgentRegions<'a, S: HostScalar> {
    /// The agent and those that come near it, in increasing order.
    agents: Vec<u32>,
    /// Index of the agent among them.
    place: usize,
    motions: Vec<Motion<'a, S>>,
    table: HostEcm<S>,
}

impl<S: HostScalar> Default for AgentRegions<'_, S> {
    fn default() -> Self {
        Self { agents: Vec::new(), place: 0, motions: Vec::new(), table: HostEcm::new(Vec::new(), Vec::new()) }
    }
}

impl<'a, S: HostScalar> AgentRegions<'a, S> {
    /// The row of `ego` with these agents, which are in increasing order.
    ///
    /// # Errors
    /// [`CapacityError::Agents`] for more than 65534 others, [`CapacityError::Pair`] where two of them have more than 32767 pieces.
    ///
    /// # Panics
    /// For an agent that the fleet does not have: without it the row would say that it is free of it.
    pub fn new(motions: &[Motion<'a, S>], ego: usize, others: &[u32]) -> Result<Self, CapacityError> {
        let mut row = Self::default();
        row.fill(motions, ego, others)?;
        Ok(row)
    }

    /// Becomes the row of `ego` with these agents, in the storage that it has.
    fn fill(&mut self, motions: &[Motion<'a, S>], ego: usize, others: &[u32]) -> Result<(), CapacityError> {
        // In the order of the fleet, so that its pairs are computed as in the table of all.
        self.place = others.partition_point(|&other| (other as usize) < ego);
        let (before, after) = others.split_at(self.place);
        self.agents.clear();
        self.agents.extend_from_slice(before);
        self.agents.push(ego as u32);
        self.agents.extend_from_slice(after);
        self.motions.clear();
        self.motions.extend(self.agents.iter().map(|&agent| &motions[agent as usize]));
        let filled = match self.table.fill_row(&self.motions, self.place) {
            Err(EcmError::Full(CapacityError::Regions { .. } | CapacityError::Pieces { .. })) => {
                let agents = self.agents.len();
                table_of(&self.motions, self.place, [2 * agents, 3 * agents]).map(|table| self.table = table)
            }
            Err(EcmError::Full(full)) => Err(full),
            Err(EcmError::Mismatch(mismatch)) => unreachable!("{mismatch}: it was added above"),
            Ok(()) => Ok(()),
        };
        filled.map_err(|full| match full {
            CapacityError::Pair(places) => CapacityError::Pair(places.map(|place| self.agents[place] as usize)),
            full => full,
        })
    }

    /// Numbers in the fleet of the agent and those that come near it, in increasing order.
    pub fn agents(&self) -> &[u32] {
        &self.agents
    }

    /// Index of the agent of the row in [`AgentRegions::agents`], which is its index in the table.
    pub(crate) fn agent_index(&self) -> usize {
        self.place
    }

    /// The motions of these agents.
    pub fn motions(&self) -> &[Motion<'a, S>] {
        &self.motions
    }

    /// The table of these agents, which are numbered from 0 there.
    pub fn table(&self) -> &HostEcm<S> {
        &self.table
    }

    /// The regions of the agent of the row with another one of the fleet, either of whom comes first; none with one that is not
    /// of this row, which says nothing of those before its agent, and of those after it that they are far away.
    ///
    /// # Errors
    /// [`MismatchError::OnlyRow`] for two others.
    pub fn pair(&self, ego: usize, other: usize) -> Result<impl Iterator<Item = RegionRef<'_, S>>, MismatchError> {
        let place = |agent: usize| self.agents.iter().position(|&there| there as usize == agent);
        let places = place(ego).zip(place(other));
        let regions = places.map(|(ego, other)| self.table.pair(&self.motions, ego, other)).transpose()?;
        Ok(regions.into_iter().flatten())
    }
}

/// An index of the areas that agents can come to, grown by all that rounding may add to a region.
pub fn grid<S: HostScalar>(motions: &[Motion<'_, S>]) -> BoxGrid {
    BoxGrid::new(motions.iter().map(area).collect())
}

/// The area that a disc can come to: left, bottom, right and top \[m\].
pub fn area<S: HostScalar>(motion: &Motion<'_, S>) -> [f64; 4] {
    expanded_box(motion, motion.radius().to_f64() + excess(motion, motion).to_f64())
}

/// The box of a path, grown by a reach \[m\].
pub(crate) fn expanded_box<S: HostScalar>(motion: &Motion<'_, S>, reach: f64) -> [f64; 4] {
    let bounds = motion.bounds();
    let [left, bottom, right, top] = [bounds.x.lo, bounds.y.lo, bounds.x.hi, bounds.y.hi].map(S::to_f64);
    [left - reach, bottom - reach, right + reach, top + reach]
}

/// Rows one after the other, in one storage.
#[derive(Debug)]
pub struct AgentRegionsWalk<'m, 'a, S: HostScalar> {
    motions: &'m [Motion<'a, S>],
    grid: &'m BoxGrid,
    neighbours: Vec<u32>,
    row: AgentRegions<'a, S>,
}

impl<'m, 'a, S: HostScalar> AgentRegionsWalk<'m, 'a, S> {
    /// Through a fleet with the index of [`grid`].
    pub fn new(motions: &'m [Motion<'a, S>], grid: &'m BoxGrid) -> Self {
        Self { motions, grid, neighbours: Vec::new(), row: AgentRegions::default() }
    }

    /// The row of an agent with those after it.
    ///
    /// # Errors
    /// As [`AgentRegions::new`].
    pub fn row(&mut self, ego: usize) -> Result<&AgentRegions<'a, S>, CapacityError> {
        self.grid.after(ego, &mut self.neighbours);
        self.row.fill(self.motions, ego, &self.neighbours)?;
        Ok(&self.row)
    }

    /// The row of an agent with all others.
    ///
    /// # Errors
    /// As [`AgentRegions::new`].
    pub fn whole(&mut self, ego: usize) -> Result<&AgentRegions<'a, S>, CapacityError> {
        self.grid.around(ego, &mut self.neighbours);
        self.row.fill(self.motions, ego, &self.neighbours)?;
        Ok(&self.row)
    }
}

/// All rows to `take`, which is called from several threads, in no order. O(agents + regions) for fleets of constant density.
///
/// # Errors
/// As [`AgentRegions::new`].
pub fn each<'a, S: HostScalar>(
    motions: &[Motion<'a, S>],
    take: impl Fn(&AgentRegions<'a, S>) + Sync,
) -> Result<(), CapacityError> {
    let grid = grid(motions);
    let walk = || AgentRegionsWalk::new(motions, &grid);
    grid.order().into_par_iter().with_min_len(STRETCH).try_for_each_init(walk, |walk, ego| {
        take(walk.row(ego as usize)?);
        Ok(())
    })
}

/// Fewest agents that a thread takes at once, neighbours of one another: few enough that a fleet of 100 has some for every core.
const STRETCH: usize = 16;

/// Agents whose rows are computed between two questions for memory.
const GATHERED: usize = 1024;

/// What is made of each row, one after the other by their agents; rows are computed on all cores, and none is kept.
///
/// # Errors
/// As [`AgentRegions::new`], and [`MemoryError`](crate::memory_budget::MemoryError) where memory does not hold `what` they make.
pub(crate) fn gathered<'a, S: HostScalar, T: Send>(
    motions: &[Motion<'a, S>],
    what: &str,
    told: ProgressFn<'_>,
    make: impl Fn(&AgentRegions<'a, S>) -> Vec<T> + Sync,
) -> Result<Vec<T>, ComputationError> {
    let grid = grid(motions);
    let (mut all, mut held) = (Vec::new(), MemoryBudget::default());
    told(0, motions.len());
    for first in (0..motions.len()).step_by(GATHERED) {
        let end = motions.len().min(first + GATHERED);
        let of_stretch = |stretch: usize| {
            let mut walk = AgentRegionsWalk::new(motions, &grid);
            let begin = first + stretch * STRETCH;
            let rows = (begin..end.min(begin + STRETCH)).map(|ego| Ok(make(walk.row(ego)?)));
            rows.collect::<Result<Vec<Vec<T>>, CapacityError>>()
        };
        for stretch in parallel::map_parallel(0..(end - first).div_ceil(STRETCH), &of_stretch) {
            for row in stretch? {
                held.extend(&mut all, row, 0, what)?;
            }
        }
        told(end, motions.len());
    }
    Ok(all)
}

/// All rows, by their agents, computed on all cores.
///
/// # Errors
/// As [`AgentRegions::new`].
pub fn rows<'a, S: HostScalar>(motions: &[Motion<'a, S>]) -> Result<Vec<AgentRegions<'a, S>>, CapacityError> {
    let grid = grid(motions);
    (0..motions.len())
        .into_par_iter()
        .map_init(Vec::new, |near, ego| {
            grid.after(ego, near);
            AgentRegions::new(motions, ego, near)
        })
        .collect()
}

//! Collision regions of fleets of any size, an agent at a time: a row is the table of an agent with those after it that
//! come near. Rows are independent of one another: they are computed on all cores, and a fleet of which no table would fit
//! into memory can be worked through row by row.

mod grid;

pub use grid::Grid;

use crate::fleet::{Format, HostEcm, table_of};
use pcr_core::{Full, Motion, RegionRef, excess};
use rayon::prelude::*;

/// The regions of an agent with those after it.
#[derive(Debug)]
pub struct Row<'a, S: Format> {
    /// The agent, then those that come near it, in increasing order.
    agents: Vec<u32>,
    motions: Vec<Motion<'a, S>>,
    table: HostEcm<S>,
}

impl<'a, S: Format> Row<'a, S> {
    /// The row of `ego` with these agents.
    ///
    /// # Errors
    /// [`Full::Agents`] for more than 65534 others, [`Full::Pair`] where two of them have more than 65535 pieces.
    pub fn new(motions: &[Motion<'a, S>], ego: usize, others: &[u32]) -> Result<Self, Full> {
        let mut agents = vec![ego as u32];
        agents.extend_from_slice(others);
        let motions: Vec<_> = agents.iter().filter_map(|&agent| motions.get(agent as usize).copied()).collect();
        let table = table_of(&motions, 0, [2 * agents.len(), 3 * agents.len()])?;
        Ok(Self { agents, motions, table })
    }

    /// Numbers in the fleet: the agent, then those that come near it.
    pub fn agents(&self) -> &[u32] {
        &self.agents
    }

    /// The table of these agents, which are numbered from 0 there.
    pub fn table(&self) -> &HostEcm<S> {
        &self.table
    }

    /// The regions of two agents of the fleet; none if they are not of this row.
    pub fn pair(&self, ego: usize, other: usize) -> impl Iterator<Item = RegionRef<'_, S>> {
        let place = |agent: usize| self.agents.iter().position(|&there| there as usize == agent);
        let places = place(ego).zip(place(other));
        places.into_iter().flat_map(|(ego, other)| self.table.pair(&self.motions, ego, other))
    }
}

/// An index of the areas that agents can come to, grown by all that rounding may add to a region.
pub fn grid<S: Format>(motions: &[Motion<'_, S>]) -> Grid {
    Grid::new(motions.iter().map(area).collect())
}

/// The area that a disc can come to: left, bottom, right and top \[m\].
pub fn area<S: Format>(motion: &Motion<'_, S>) -> [f64; 4] {
    let reach = motion.radius().to_f64() + excess(motion, motion).to_f64();
    let bounds = motion.bounds();
    let [left, bottom, right, top] = [bounds.x.lo, bounds.y.lo, bounds.x.hi, bounds.y.hi].map(S::to_f64);
    [left - reach, bottom - reach, right + reach, top + reach]
}

/// All rows, one after the other to `take`, which is called from several threads, in no order. O(agents + regions) for fleets of
/// constant density.
///
/// # Errors
/// As [`Row::new`].
pub fn each<'a, S: Format>(motions: &[Motion<'a, S>], take: impl Fn(usize, Row<'a, S>) + Sync) -> Result<(), Full> {
    let grid = grid(motions);
    // Neighbours one after the other: they are still in the cache.
    grid.order().into_par_iter().try_for_each(|ego| {
        let ego = ego as usize;
        take(ego, Row::new(motions, ego, &grid.after(ego))?);
        Ok(())
    })
}

/// All rows, by their agents, computed on all cores.
///
/// # Errors
/// As [`Row::new`].
pub fn rows<'a, S: Format>(motions: &[Motion<'a, S>]) -> Result<Vec<Row<'a, S>>, Full> {
    let grid = grid(motions);
    (0..motions.len()).into_par_iter().map(|ego| Row::new(motions, ego, &grid.after(ego))).collect()
}

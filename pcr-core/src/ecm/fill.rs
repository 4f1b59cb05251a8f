//! Adds the regions of an agent to a table, or removes them; entries stay sorted by pair.

use super::fleet_checksum::FleetChecksum;
use super::{Ecm, EcmCapacity, EcmEntry};
use crate::bit_rows::{self, SetBits};
use crate::error::CapacityError;
use crate::motion::Motion;
use crate::pair::AgentPair;
use crate::piece_store::Piece;
use crate::scalar::Scalar;
use crate::segment::ROW;
use core::cell::Cell;
use core::ops::Range;

impl<S, R, P> Ecm<S, R, P>
where
    S: Scalar,
    R: AsRef<[EcmEntry]> + AsMut<[EcmEntry]>,
    P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
{
    /// Computes all regions of a fleet, or those of one row.
    pub(super) fn compute(
        &mut self,
        fleet: &[Motion<'_, S>],
        add: impl Fn(&mut Self) -> Result<(), CapacityError>,
    ) -> Result<(), CapacityError> {
        self.clear();
        match add(self) {
            Ok(()) => self.fleet = FleetChecksum::all(fleet),
            Err(full) => {
                self.clear();
                return Err(full);
            }
        }
        Ok(())
    }

    /// Adds the regions of an agent with all others. If they do not fit, none is added.
    pub(super) fn add_row(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), CapacityError> {
        let mut partners = [0..agent, agent.saturating_add(1)..fleet.len()].into_iter();
        let added = partners.try_for_each(|partners| self.add_pairs(fleet, agent, partners));
        if added.is_err() {
            self.take_out(agent);
        }
        added
    }

    /// Adds the regions of an agent with others, which are all before it or all after it in the fleet.
    pub(super) fn add_pairs(
        &mut self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        partners: Range<usize>,
    ) -> Result<(), CapacityError> {
        let (Some(own), Some(others)) = (fleet.get(agent), fleet.get(partners.clone())) else {
            return Ok(());
        };
        let swept = own.swept();
        for (row, begin) in others.chunks(ROW).zip(partners.step_by(ROW)) {
            for place in SetBits(bit_rows::row(row.iter().map(|other| swept.meets(other.swept())))) {
                let (Some(other), partner) = (row.get(place as usize), begin.wrapping_add(place as usize)) else {
                    break;
                };
                let lower = partner < agent;
                let (agents, first, second) =
                    if lower { ([partner, agent], other, own) } else { ([agent, partner], own, other) };
                self.add_pair(agents, AgentPair::new(first, second))?;
            }
        }
        Ok(())
    }

    /// The pieces of a pair, pending; none if there is no room.
    fn find_pair(&mut self, agents: [usize; 2], pair: AgentPair<'_, S>) -> Result<(), CapacityError> {
        pair.find(&mut self.pieces).map_err(|full| {
            let no_storage_helps = self.pieces.pair_is_full();
            self.pieces.take_back();
            if no_storage_helps { CapacityError::Pair(agents) } else { full }
        })
    }

    /// Counts the regions and pieces of a pair, in storage in which nothing else is.
    pub(super) fn count_pair(
        &mut self,
        agents: [usize; 2],
        pair: AgentPair<'_, S>,
    ) -> Result<EcmCapacity, CapacityError> {
        self.find_pair(agents, pair)?;
        let (mut regions, pieces) = (0_usize, self.pieces.len());
        while self.pieces.take_region().is_some() {
            regions = regions.saturating_add(1);
        }
        self.pieces.clear();
        let numbered = agents.into_iter().all(|agent| u16::try_from(agent).is_ok());
        if regions > 0 && !numbered { Err(CapacityError::Agents) } else { Ok(EcmCapacity { regions, pieces }) }
    }

    /// If there is no room, some regions of the pair may remain: the caller then removes one of the agents, or all.
    fn add_pair(&mut self, agents: [usize; 2], pair: AgentPair<'_, S>) -> Result<(), CapacityError> {
        self.find_pair(agents, pair)?;
        if self.pieces.pending() == 0 {
            return Ok(());
        }
        // While a table is built from scratch, new entries belong at its end.
        let entries = self.entries();
        let at_end = entries.last().is_none_or(|last| last.agents() < agents);
        let mut index = if at_end { entries.len() } else { entries.partition_point(|region| region.agents() < agents) };
        while let Some(head) = self.pieces.take_region() {
            if let Err(full) = self.insert_entry(index, agents, head) {
                self.pieces.settle();
                return Err(full);
            }
            // An entry with this index exists, so this does not saturate.
            index = index.saturating_add(1);
        }
        Ok(())
    }

    fn insert_entry(&mut self, index: usize, agents: [usize; 2], head: u32) -> Result<(), CapacityError> {
        let [Ok(first), Ok(second)] = agents.map(u16::try_from) else {
            return Err(CapacityError::Agents);
        };
        let len = self.len.saturating_add(1);
        let regions = self.regions.as_mut();
        let full = CapacityError::Regions { needed: len, capacity: regions.len() };
        let behind = regions.get_mut(index..len).ok_or(full)?;
        // Every entry from here on moves back by one place.
        let places = Cell::from_mut(behind).as_slice_of_cells();
        for neighbours in places.windows(2).rev() {
            if let [place, next] = neighbours {
                next.set(place.get());
            }
        }
        if let Some(place) = places.first() {
            place.set(EcmEntry { agents: [first, second], head });
        }
        self.len = len;
        Ok(())
    }

    /// Removes the entries of an agent and frees their pieces.
    pub(super) fn take_out(&mut self, agent: usize) {
        let mut kept = 0_usize;
        for index in 0..self.len {
            let regions = self.regions.as_mut();
            let Some(&region) = regions.get(index) else {
                break;
            };
            if !region.agents().contains(&agent) {
                if let Some(place) = regions.get_mut(kept) {
                    *place = region;
                }
                // Never larger than `index`: it cannot saturate, but the compiler does not know that.
                kept = kept.saturating_add(1);
            }
        }
        self.len = kept;
        self.pieces.keep(self.regions.as_mut().get_mut(..kept).unwrap_or_default(), |region| &mut region.head);
    }
}

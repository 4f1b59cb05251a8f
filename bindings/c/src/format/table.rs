//! Functions for a fleet and its table of regions.

use super::fleet::{Fleet, number};
use super::number::Real;
use super::points::{Room, ask, change, interval, short, status};
use super::types::{PcrAgent, PcrFleet, PcrInterval, PcrMemory, PcrRegion};
use crate::memory::{get, put};
use crate::status::{PcrInputError, PcrStatus, given};
use pcr_core::RegionRef;

/// Creates a fleet without agents in the memory of the caller.
#[unsafe(export_name = name!("fleet_init"))]
pub extern "C" fn pcr_fleet_init(place: Option<&mut PcrFleet>, memory: Option<&PcrMemory>) -> PcrStatus {
    status(given(place).and_then(|place| {
        put(place, Fleet::new(given(memory)?)?);
        Ok(())
    }))
}

/// Adds an agent; agents are numbered from 0. The table does not include it before `pcr_fleet_build`.
#[unsafe(export_name = name!("fleet_add"))]
pub extern "C" fn pcr_fleet_add(place: Option<&mut PcrFleet>, agent: Option<&PcrAgent>) -> PcrStatus {
    change(place, |fleet| fleet.add(given(agent)?))
}

/// Moves a fleet, with its table and orders, into other memory, which must not overlap the memory that it has; that is free
/// afterwards. A fleet that had no memory for orders, and has it now, must be built again. PCR_STATUS_NO_ROOM or
/// PCR_STATUS_TABLE_FULL if it does not fit; the fleet is unchanged then.
#[unsafe(export_name = name!("fleet_move"))]
pub extern "C" fn pcr_fleet_move(place: Option<&mut PcrFleet>, memory: Option<&PcrMemory>) -> PcrStatus {
    change(place, |fleet| {
        *fleet = fleet.copied(given(memory)?)?;
        Ok(())
    })
}

/// Says why the last agent was refused that was given to `pcr_fleet_add`, `pcr_fleet_replace` or `pcr_fleet_admit`.
#[unsafe(export_name = name!("fleet_input_error"))]
pub extern "C" fn pcr_fleet_input_error(place: Option<&PcrFleet>, out: Option<&mut PcrInputError>) -> PcrStatus {
    ask(place, |fleet| {
        *given(out)? = fleet.fault().into();
        Ok(())
    })
}

/// Number of agents; 0 for a null pointer.
#[unsafe(export_name = name!("fleet_agents"))]
pub extern "C" fn pcr_fleet_agents(place: Option<&PcrFleet>) -> usize {
    place.map_or(0, |place| get(place).motions().len())
}

/// Computes the regions of all pairs of agents; all their orders are undecided then. If the table is too small, it is
/// empty afterwards.
#[unsafe(export_name = name!("fleet_build"))]
pub extern "C" fn pcr_fleet_build(place: Option<&mut PcrFleet>) -> PcrStatus {
    change(place, Fleet::build)
}

/// Computes the regions of one agent with all others only, which is enough for a robot that computes its own hold.
/// Queries about other agents return PCR_STATUS_ONLY_ROW.
#[unsafe(export_name = name!("fleet_build_row"))]
pub extern "C" fn pcr_fleet_build_row(place: Option<&mut PcrFleet>, agent: usize) -> PcrStatus {
    change(place, |fleet| fleet.build_row(agent))
}

/// Delays the start of an agent by `delay` (s). The table stays valid: its lengths do not change, and times are
/// computed when queried.
#[unsafe(export_name = name!("fleet_delay"))]
pub extern "C" fn pcr_fleet_delay(place: Option<&mut PcrFleet>, agent: usize, delay: Real) -> PcrStatus {
    change(place, |fleet| fleet.delay(agent, number(delay)?))
}

/// Replaces an agent and, if the regions of all pairs were built, computes its regions. Those of one agent
/// (`pcr_fleet_build_row`) are computed again if it is that agent and the fleet has no memory for orders; otherwise the
/// table is then not built. The memory needs room for the segments and phases of the new agent in addition to those of
/// the old one, which become free. The new agent is at the start of its path, and its regions are undecided; the orders
/// between the other agents stay. A call that fails leaves everything unchanged.
#[unsafe(export_name = name!("fleet_replace"))]
pub extern "C" fn pcr_fleet_replace(place: Option<&mut PcrFleet>, agent: usize, by: Option<&PcrAgent>) -> PcrStatus {
    change(place, |fleet| fleet.replace(agent, given(by)?))
}

/// Removes an agent; the number of every agent behind it decreases by one, orders included. If the regions of all pairs
/// were built, they stay so; those of one agent (`pcr_fleet_build_row`) do not.
#[unsafe(export_name = name!("fleet_remove"))]
pub extern "C" fn pcr_fleet_remove(place: Option<&mut PcrFleet>, agent: usize) -> PcrStatus {
    change(place, |fleet| fleet.remove(agent))
}

/// The regions that an agent has to keep out of, sorted by the other agent, and their count. Ranges are rounded
/// outward.
#[unsafe(export_name = name!("fleet_regions"))]
pub extern "C" fn pcr_fleet_regions(
    place: Option<&PcrFleet>,
    ego: usize,
    out: *mut PcrRegion,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    let record = |region: RegionRef<'_, _>| PcrRegion {
        ego: short(region.ego()),
        other: short(region.other()),
        time: interval(region.time()),
        length: interval(region.length()),
        open_start: region.is_open_at_start(),
        open_end: region.is_open_at_end(),
    };
    ask(place, |fleet| {
        let room = Room::new(out, capacity, count)?;
        fleet.motion(ego)?;
        room.fill(fleet.table().row(fleet.motions(), ego)?.map(record))
    })
}

/// The lengths along the path of the ego at which it overlaps the other agent at a time, and how many intervals there
/// are: those of one region after the other, rounded outward. PCR_STATUS_NO_SUCH_AGENT where both are one.
#[unsafe(export_name = name!("fleet_slices"))]
pub extern "C" fn pcr_fleet_slices(
    place: Option<&PcrFleet>,
    ego: usize,
    other: usize,
    time: Real,
    out: *mut PcrInterval,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    ask(place, |fleet| {
        let room = Room::new(out, capacity, count)?;
        let time = number(time)?;
        fleet.motion(ego)?;
        fleet.motion(other)?;
        let regions = fleet.table().pair(fleet.motions(), ego, other)?;
        fleet.two(ego, other)?;
        room.fill(regions.flat_map(|region| region.slice_at(time)).map(interval))
    })
}

//! The functions that C calls.

use crate::fleet::Fleet;
use crate::memory::{fleet, fleet_mut, places, put};
use crate::types::{PcrAgent, PcrConflict, PcrFleet, PcrInterval, PcrMemory, PcrRegion, PcrStatus};
use pcr_core::{Encounter, Interval, RegionRef};

/// What C gets to know.
fn status(outcome: Result<(), PcrStatus>) -> PcrStatus {
    outcome.err().unwrap_or(PcrStatus::Ok)
}

fn interval(interval: Interval<f32>) -> PcrInterval {
    PcrInterval { lo: interval.lo, hi: interval.hi }
}

/// Copies values out, and tells how many there are; those that do not fit are counted.
fn copy<T>(all: impl Iterator<Item = T>, out: &mut [T], count: Option<&mut usize>) -> Result<(), PcrStatus> {
    let count = count.ok_or(PcrStatus::Null)?;
    let mut places = out.iter_mut();
    let mut fits = true;
    *count = 0;
    for value in all {
        match places.next() {
            Some(place) => *place = value,
            None => fits = false,
        }
        *count = count.saturating_add(1);
    }
    if fits { Ok(()) } else { Err(PcrStatus::BufferTooSmall) }
}

/// Makes a fleet without agents in the caller's memory.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_init(place: Option<&mut PcrFleet>, memory: Option<&PcrMemory>) -> PcrStatus {
    let (Some(place), Some(memory)) = (place, memory) else {
        return PcrStatus::Null;
    };
    status(Fleet::new(memory).map(|fleet| put(place, fleet)))
}

/// Adds an agent; agents are numbered from 0. The table does not know it before `pcr_fleet_build`.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_add(place: Option<&mut PcrFleet>, agent: Option<&PcrAgent>) -> PcrStatus {
    let (Some(place), Some(agent)) = (place, agent) else {
        return PcrStatus::Null;
    };
    status(fleet_mut(place).add(agent))
}

/// Number of agents; 0 for a null pointer.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_agents(place: Option<&PcrFleet>) -> usize {
    place.map_or(0, |place| fleet(place).motions().len())
}

/// Computes the regions of all pairs of agents. Where the table is full it is empty afterwards.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_build(place: Option<&mut PcrFleet>) -> PcrStatus {
    place.map_or(PcrStatus::Null, |place| status(fleet_mut(place).build()))
}

/// Lets an agent set off later by `delay` (s). The table serves on as it is: lengths do not change, times follow.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_delay(place: Option<&mut PcrFleet>, agent: usize, delay: f32) -> PcrStatus {
    place.map_or(PcrStatus::Null, |place| status(fleet_mut(place).delay(agent, delay)))
}

/// The regions that an agent has to keep out of, by the other agent, and their count. Ranges are rounded outward.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_regions(
    place: Option<&PcrFleet>,
    ego: usize,
    out: *mut PcrRegion,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    let (Some(place), Some(out)) = (place, places(out, capacity)) else {
        return PcrStatus::Null;
    };
    let fleet = fleet(place);
    let number = |agent| u16::try_from(agent).unwrap_or(u16::MAX);
    let record = |region: RegionRef<'_, f32>| PcrRegion {
        ego: number(region.ego()),
        other: number(region.other()),
        time: interval(region.time()),
        length: interval(region.length()),
        open_start: region.is_open_at_start(),
        open_end: region.is_open_at_end(),
    };
    let regions = || copy(fleet.table().row(fleet.motions(), ego)?.map(record), out, count);
    status(fleet.motion(ego).and_then(|_| regions()))
}

/// The lengths along the path of the ego at which it overlaps the other agent at a time, and how many intervals there
/// are: those of one region after the other, rounded outward.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_slices(
    place: Option<&PcrFleet>,
    ego: usize,
    other: usize,
    time: f32,
    out: *mut PcrInterval,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    let (Some(place), Some(out)) = (place, places(out, capacity)) else {
        return PcrStatus::Null;
    };
    if !time.is_finite() {
        return PcrStatus::NonFinite;
    }
    let fleet = fleet(place);
    let slices = || {
        let regions = fleet.table().pair(fleet.motions(), ego, other)?;
        copy(regions.flat_map(|region| region.slice_at(time)).map(interval), out, count)
    };
    status(fleet.motion(ego).and_then(|_| fleet.motion(other)).and_then(|_| slices()))
}

/// The conflicts of two agents on their motions, in order of time from the first start of any agent to the last arrival,
/// and their count. It asks the motions, not the table.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_conflicts(
    place: Option<&PcrFleet>,
    ego: usize,
    other: usize,
    out: *mut PcrConflict,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    let (Some(place), Some(out)) = (place, places(out, capacity)) else {
        return PcrStatus::Null;
    };
    let fleet = fleet(place);
    let (Ok(first), Ok(second)) = (fleet.motion(ego), fleet.motion(other)) else {
        return PcrStatus::NoSuchAgent;
    };
    let conflicts = Encounter::new(first, second).conflicts(fleet.duration());
    let record = |conflict: pcr_core::Conflict<f32>| PcrConflict {
        time: interval(conflict.time),
        length: interval(conflict.length),
        other_length: interval(conflict.other_length),
        depth: conflict.depth,
        touching: conflict.touching,
    };
    status(copy(conflicts.map(record), out, count))
}

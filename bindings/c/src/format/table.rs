//! The functions that C calls.

use crate::fleet::Fleet;
use crate::memory::{Stack, fleet, fleet_mut, places, put};
use crate::types::{
    PcrAgent, PcrConflict, PcrFleet, PcrInterval, PcrMemory, PcrMet, PcrMotion, PcrRegion, PcrStatus, PcrUnsolved,
};
use pcr_core::{
    Conflict, Encounter, Interval, RegionRef, Scalar, earliest_start, first_conflict, first_overlap, safe_intervals,
};

/// What C gets to know.
fn status(outcome: Result<(), PcrStatus>) -> PcrStatus {
    outcome.err().unwrap_or(PcrStatus::Ok)
}

fn interval(interval: Interval<f32>) -> PcrInterval {
    PcrInterval { lo: interval.lo, hi: interval.hi }
}

fn record(conflict: &Conflict<f32>) -> PcrConflict {
    PcrConflict {
        time: interval(conflict.time),
        length: interval(conflict.length),
        other_length: interval(conflict.other_length),
        depth: conflict.depth,
        touching: conflict.touching,
    }
}

/// A number that the format takes.
fn number(value: f32) -> Result<f32, PcrStatus> {
    match value {
        _ if !value.is_finite() => Err(PcrStatus::NonFinite),
        _ if value.abs() > f32::LIMIT => Err(PcrStatus::OutOfRange),
        _ => Ok(value),
    }
}

/// An interval of such numbers.
fn range(interval: PcrInterval) -> Result<Interval<f32>, PcrStatus> {
    let (lo, hi) = (number(interval.lo)?, number(interval.hi)?);
    if lo <= hi { Ok(Interval::new(lo, hi)) } else { Err(PcrStatus::OutOfRange) }
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
    let index = |agent| u16::try_from(agent).unwrap_or(u16::MAX);
    let record = |region: RegionRef<'_, f32>| PcrRegion {
        ego: index(region.ego()),
        other: index(region.other()),
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
    if let Err(refused) = number(time) {
        return refused;
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
    status(copy(conflicts.map(|conflict| record(&conflict)), out, count))
}

/// Puts another agent in the place of one, and its regions into the table if that was built. The memory needs room for the
/// segments and phases of the new one beside those of the old one, which become free. Whatever fails leaves all as it was.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_replace(place: Option<&mut PcrFleet>, agent: usize, by: Option<&PcrAgent>) -> PcrStatus {
    let (Some(place), Some(by)) = (place, by) else {
        return PcrStatus::Null;
    };
    status(fleet_mut(place).replace(agent, by))
}

/// The earliest conflict of an agent with any other, from the first start of any agent to the last arrival, and whether
/// there is one. Mere touches are passed over, unless they are asked for: plans make agents touch on purpose.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_first_conflict(
    place: Option<&PcrFleet>,
    ego: usize,
    touches: bool,
    out: Option<&mut PcrMet>,
    found: Option<&mut bool>,
) -> PcrStatus {
    let (Some(place), Some(out), Some(found)) = (place, out, found) else {
        return PcrStatus::Null;
    };
    let fleet = fleet(place);
    let search = || {
        let (motion, during) = (fleet.motion(ego)?, fleet.duration());
        let row = fleet.table().row(fleet.motions(), ego)?;
        Ok(if touches { first_conflict(motion, row, during) } else { first_overlap(motion, row, during) })
    };
    status(search().map(|met| {
        *found = met.is_some();
        if let Some(met) = met {
            *out = PcrMet { other: met.other, conflict: record(&met.conflict) };
        }
    }))
}

/// The least delay of an agent's start, from `from` on (s), with which it meets none of the others, each moving as it does
/// now. `PCR_STATUS_NO_PLAN` where no delay helps. `pcr_fleet_delay` makes it so.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_earliest_start(
    place: Option<&PcrFleet>,
    agent: usize,
    from: f32,
    delay: Option<&mut f32>,
) -> PcrStatus {
    let (Some(place), Some(delay)) = (place, delay) else {
        return PcrStatus::Null;
    };
    let fleet = fleet(place);
    let search = || {
        let from = number(from)?;
        earliest_start(fleet.table().row(fleet.motions(), agent)?, from).ok_or(PcrStatus::NoPlan)
    };
    status(search().map(|found| *delay = found))
}

/// The times in an interval (s) at which no other agent is in the way on a part of the ego's path (m), wherever on it the ego
/// is, and how many intervals there are. It asks the motions, not the table.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_safe_intervals(
    place: Option<&PcrFleet>,
    ego: usize,
    length: PcrInterval,
    during: PcrInterval,
    out: *mut PcrInterval,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    let (Some(place), Some(out)) = (place, places(out, capacity)) else {
        return PcrStatus::Null;
    };
    let fleet = fleet(place);
    let search = || {
        let (length, during) = (range(length)?, range(during)?);
        let safe = safe_intervals(fleet.motions(), ego, length, during)?;
        copy(safe.map(interval), out, count)
    };
    status(search())
}

/// Delays the starts of all agents so that none overlaps another, each as little as those before it in the order allow.
/// `order` lists each agent once, the highest priority first, and comes back as it was used. `room` is for a motion an agent,
/// and free afterwards. Where there is no plan, nobody is delayed and `why` tells who is in the way; it may be null.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_fleet_plan_delays(
    place: Option<&mut PcrFleet>,
    order: *mut usize,
    count: usize,
    room: *mut PcrMotion,
    room_count: usize,
    why: Option<&mut PcrUnsolved>,
) -> PcrStatus {
    let (Some(place), Some(order), Some(room)) = (place, places(order, count), Stack::new(room, room_count)) else {
        return PcrStatus::Null;
    };
    status(fleet_mut(place).plan(room, order).map_err(|(status, unsolved)| {
        if let (Some(why), Some(unsolved)) = (why, unsolved) {
            *why = unsolved.into();
        }
        status
    }))
}

//! Conflicts of motions, and functions that resolve them.

use super::fleet::number;
use super::number::{Real, S, plain};
use super::points::{Room, ask, change, interval, range};
use super::types::{PcrAgentConflict, PcrConflict, PcrFleet, PcrInterval, PcrMotionStorage};
use crate::memory::{Stack, places};
use crate::status::{PcrPlanError, PcrStatus, given};
use pcr_core::{Conflict, Encounter, RegionRef, earliest_start, excess, first_conflict, first_overlap, safe_intervals};

fn record(conflict: &Conflict<S>) -> PcrConflict {
    PcrConflict {
        time: interval(conflict.time),
        length: interval(conflict.length),
        other_length: interval(conflict.other_length),
        depth: plain(conflict.depth),
        touching: conflict.touching,
    }
}

/// The conflicts of two agents on their motions, in order of time from the first start of any agent to the last arrival,
/// and their count. It asks the motions, not the table. PCR_STATUS_NO_SUCH_AGENT where both are one.
#[unsafe(export_name = name!("fleet_conflicts"))]
pub extern "C" fn pcr_fleet_conflicts(
    place: Option<&PcrFleet>,
    ego: usize,
    other: usize,
    out: *mut PcrConflict,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    ask(place, |fleet| {
        let room = Room::new(out, capacity, count)?;
        let [own, others] = fleet.two(ego, other)?;
        let encounter = Encounter::new(own, others);
        room.fill(encounter.conflicts(fleet.duration()).map(|conflict| record(&conflict)))
    })
}

/// The delays of the start of the ego with which it would meet the other agent, one interval for each region of the two, rounded
/// outward; negative ones are earlier starts, and the largest magnitude of the format stands for infinity. With `passing`, only
/// meetings while both are under way: the unsafe intervals that solvers such as CCBS and SIPP ask for, for two edges of a
/// roadmap. A fleet of the two edges is enough: `pcr_fleet_replace` puts another edge in the place of one of them.
#[unsafe(export_name = name!("fleet_forbidden_delays"))]
pub extern "C" fn pcr_fleet_forbidden_delays(
    place: Option<&PcrFleet>,
    ego: usize,
    other: usize,
    passing: bool,
    out: *mut PcrInterval,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    ask(place, |fleet| {
        let room = Room::new(out, capacity, count)?;
        fleet.two(ego, other)?;
        let regions = fleet.table().pair(fleet.motions(), ego, other)?;
        let delays = |region: RegionRef<'_, S>| {
            if passing { region.passing_delays() } else { region.forbidden_delays() }
        };
        room.fill(regions.map(delays).map(interval))
    })
}

/// The earliest conflict of an agent with any other, from the first start of any agent to the last arrival, and whether
/// there is one. Mere touches are skipped unless `touches` is set, because plans make agents touch on purpose.
#[unsafe(export_name = name!("fleet_first_conflict"))]
pub extern "C" fn pcr_fleet_first_conflict(
    place: Option<&PcrFleet>,
    ego: usize,
    touches: bool,
    out: Option<&mut PcrAgentConflict>,
    found: Option<&mut bool>,
) -> PcrStatus {
    ask(place, |fleet| {
        let (out, found) = (given(out)?, given(found)?);
        let (motion, during) = (fleet.motion(ego)?, fleet.duration());
        let row = fleet.table().row(fleet.motions(), ego)?;
        let met = if touches { first_conflict(motion, row, during)? } else { first_overlap(motion, row, during)? };
        *found = met.is_some();
        if let Some(met) = met {
            *out = PcrAgentConflict { other: met.other, conflict: record(&met.conflict) };
        }
        Ok(())
    })
}

/// The least delay of an agent's start, from `from` on (s), with which it meets none of the others, which move as they
/// do now. `PCR_STATUS_NO_PLAN` if no delay helps. Apply it with `pcr_fleet_delay`.
#[unsafe(export_name = name!("fleet_earliest_start"))]
pub extern "C" fn pcr_fleet_earliest_start(
    place: Option<&PcrFleet>,
    agent: usize,
    from: Real,
    delay: Option<&mut Real>,
) -> PcrStatus {
    ask(place, |fleet| {
        let (delay, from) = (given(delay)?, number(from)?);
        let row = fleet.table().row(fleet.motions(), agent)?;
        *delay = plain(earliest_start(row, from).ok_or(PcrStatus::NoPlan)?);
        Ok(())
    })
}

/// The times in an interval (s) at which no other agent blocks any of these lengths of the ego's path (m), and the
/// number of intervals. It uses the motions and not the table. PCR_STATUS_OUT_OF_RANGE where none of the lengths is on
/// the path; of an interval that goes beyond an end of the path, the part on it is asked for.
#[unsafe(export_name = name!("fleet_safe_intervals"))]
pub extern "C" fn pcr_fleet_safe_intervals(
    place: Option<&PcrFleet>,
    ego: usize,
    length: PcrInterval,
    during: PcrInterval,
    out: *mut PcrInterval,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    ask(place, |fleet| {
        let room = Room::new(out, capacity, count)?;
        let (length, during) = (range(length)?, range(during)?);
        let own = fleet.motion(ego)?;
        // The library would answer for the end of the path. A length that is off by a rounding means that end.
        let rounding = excess(own, own);
        if length.hi < -rounding || length.lo > own.path().length() + rounding {
            return Err(PcrStatus::OutOfRange);
        }
        room.fill(safe_intervals(fleet.motions(), ego, length, during)?.map(interval))
    })
}

/// Delays the starts of all agents so that none overlap; each delay is as small as the agents before it in the order
/// allow. `order` lists each agent once, the highest priority first, and returns the order that was used. `room` needs
/// one motion for each agent and can be reused afterwards. If there is no plan, no agent is delayed, `order` is the one
/// that was tried last, and `why` names the agent in the way. `why` may be null.
#[unsafe(export_name = name!("fleet_plan_delays"))]
pub extern "C" fn pcr_fleet_plan_delays(
    place: Option<&mut PcrFleet>,
    order: *mut usize,
    count: usize,
    room: *mut PcrMotionStorage,
    room_count: usize,
    why: Option<&mut PcrPlanError>,
) -> PcrStatus {
    change(place, |fleet| {
        let (order, room) = (given(places(order, count))?, given(Stack::new(room, room_count))?);
        fleet.plan(room, order).map_err(|(status, unsolved)| {
            if let (Some(why), Some(unsolved)) = (why, unsolved) {
                *why = unsolved.into();
            }
            status
        })
    })
}

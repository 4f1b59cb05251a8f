//! Passing orders: who passes a region first. Whoever keeps its hold touches nobody, however late anybody is.

use super::fleet::OrderedMut;
use super::number::{Real, S, inner, plain};
use super::points::{Room, ask, change, given, interval, number, range, short, status};
use super::types::{PcrAgent, PcrBrakes, PcrFleet, PcrHold, PcrPassing, PcrProgress, PcrTolerances};
use crate::memory::values;
use crate::status::{PcrHoldKind, PcrRefused, PcrStatus, decision, pass};
use pcr_core::{Brakes, Hold, Interval, Pass, Progress, Refused, Scalar, Tolerances};

/// What a refusal comes to, told where there is a place for it.
fn refused(why: Option<&mut PcrRefused>, refused: Refused) -> PcrStatus {
    if let (Some(why), Some(refused)) = (why, PcrRefused::of(refused)) {
        *why = refused;
    }
    refused.into()
}

fn progress(progress: PcrProgress) -> Result<Progress<S>, PcrStatus> {
    let (at, stop) = (range(progress.at)?, number(progress.stop)?);
    if at.lo < S::ZERO {
        return Err(PcrStatus::Negative);
    }
    if at.hi <= stop { Ok(Progress { at, stop }) } else { Err(PcrStatus::OutOfRange) }
}

fn tolerances(tolerances: Option<&PcrTolerances>) -> Result<Tolerances<S>, PcrStatus> {
    let tolerances = given(tolerances)?;
    let (width, gain) = (number(tolerances.width)?, number(tolerances.gain)?);
    match () {
        () if width < S::ZERO => Err(PcrStatus::Negative),
        () if gain <= S::ZERO => Err(PcrStatus::NonPositive),
        () => Ok(Tolerances { width, gain }),
    }
}

/// The regions of an agent, who passes them first, and their count.
#[unsafe(export_name = name!("fleet_passings"))]
pub extern "C" fn pcr_fleet_passings(
    place: Option<&PcrFleet>,
    agent: usize,
    out: *mut PcrPassing,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    ask(place, |fleet| {
        let room = Room::new(out, capacity, count)?;
        let row = fleet.ordered()?.0.row(fleet.motions(), agent)?;
        room.fill(row.map(|(place, region, seen)| PcrPassing {
            place,
            other: short(region.other()),
            pass: pass(seen),
            length: interval(region.length()),
            other_length: interval(region.other_length()),
        }))
    })
}

/// Takes the orders in which the motions of the fleet pass their regions, those of a plan without collisions. Decisions that
/// were made before are overwritten. PCR_STATUS_REFUSED where two meet, or pass so near that it cannot be told who is first;
/// `why` tells who, and may be null.
#[unsafe(export_name = name!("fleet_orders_as_planned"))]
pub extern "C" fn pcr_fleet_orders_as_planned(place: Option<&mut PcrFleet>, why: Option<&mut PcrRefused>) -> PcrStatus {
    change(place, |fleet| {
        let OrderedMut { orders, motions, .. } = fleet.ordered_mut()?;
        orders.as_planned(motions).map_err(|refusal| refused(why, refusal))
    })
}

/// Decides about all regions of two agents that are not decided yet: whether the ego passes them first (PCR_FIRST) or second
/// (PCR_SECOND). What is behind the second is passed. `pcr_fleet_check` tells whether everybody can finish then.
#[unsafe(export_name = name!("fleet_decide"))]
pub extern "C" fn pcr_fleet_decide(place: Option<&mut PcrFleet>, ego: usize, other: usize, pass: u8) -> PcrStatus {
    change(place, |fleet| {
        let pass = decision(pass)?;
        fleet.two(ego, other)?;
        let OrderedMut { orders, motions, progress, .. } = fleet.ordered_mut()?;
        let second = if pass == Pass::First { other } else { ego };
        let since = progress.get(second).ok_or(PcrStatus::NoSuchAgent)?.at.lo;
        Ok(orders.decide(motions, ego, other, pass, since)?)
    })
}

/// The same for the region in one place of the table (`PcrPassing.place`), whether it is decided or not.
/// PCR_STATUS_NO_SUCH_REGION where the agent has none there.
#[unsafe(export_name = name!("fleet_decide_at"))]
pub extern "C" fn pcr_fleet_decide_at(place: Option<&mut PcrFleet>, region: usize, ego: usize, pass: u8) -> PcrStatus {
    change(place, |fleet| {
        let pass = decision(pass)?;
        let other = {
            let (orders, _) = fleet.ordered()?;
            let mut row = orders.row(fleet.motions(), ego)?;
            let found = row.find(|(place, ..)| *place == region).map(|(_, region, _)| region.other());
            found.ok_or(PcrStatus::NoSuchRegion)?
        };
        let OrderedMut { orders, motions, progress, .. } = fleet.ordered_mut()?;
        let second = if pass == Pass::First { other } else { ego };
        let since = progress.get(second).ok_or(PcrStatus::NoSuchAgent)?.at.lo;
        Ok(orders.decide_at(motions, region, ego, pass, since)?)
    })
}

/// Takes in where an agent is. Reports may come late, twice and in any order: none takes back what another one has said. It must be
/// about the path that the agent has now.
#[unsafe(export_name = name!("fleet_report"))]
pub extern "C" fn pcr_fleet_report(
    place: Option<&mut PcrFleet>,
    agent: usize,
    report: Option<&PcrProgress>,
) -> PcrStatus {
    change(place, |fleet| {
        let new = progress(*given(report)?)?;
        let known = fleet.ordered_mut()?.progress.get_mut(agent).ok_or(PcrStatus::NoSuchAgent)?;
        let later = |known, new| Scalar::max(known, new);
        let at = Interval::new(later(known.at.lo, new.at.lo), later(known.at.hi, new.at.hi));
        *known = Progress { at, stop: later(known.stop, new.stop) };
        Ok(())
    })
}

/// How far an agent may go, given what was reported of the others: it has to brake so that it stays there
/// (`pcr_stopping_speed`). Old reports give a hold that is too low, never one that is too high.
#[unsafe(export_name = name!("fleet_hold"))]
pub extern "C" fn pcr_fleet_hold(place: Option<&PcrFleet>, agent: usize, out: Option<&mut PcrHold>) -> PcrStatus {
    ask(place, |fleet| {
        let (out, (orders, progress)) = (given(out)?, fleet.ordered()?);
        let hold = orders.hold(fleet.motions(), agent, progress)?;
        let kind = match hold {
            Hold::Free => PcrHoldKind::Free,
            Hold::At(_) => PcrHoldKind::At,
            Hold::Inside => PcrHoldKind::Inside,
        };
        let length = hold.length(fleet.motion(agent)?.path().length());
        *out = PcrHold { kind, length: plain(length.unwrap_or(S::ZERO)) };
        Ok(())
    })
}

/// Whether everybody can get to the end of its path, from where all were reported, without breaking an order.
/// PCR_STATUS_REFUSED where somebody would wait for ever, or is where it should have waited; `why` tells who, and may be null.
#[unsafe(export_name = name!("fleet_check"))]
pub extern "C" fn pcr_fleet_check(
    place: Option<&mut PcrFleet>,
    accepted: Option<&PcrTolerances>,
    why: Option<&mut PcrRefused>,
) -> PcrStatus {
    change(place, |fleet| {
        let tolerances = tolerances(accepted)?;
        let OrderedMut { orders, motions, progress, reaches } = fleet.ordered_mut()?;
        orders.check(motions, progress, tolerances, reaches).map_err(|refusal| refused(why, refusal))
    })
}

/// Gives an agent a new path, with orders for all its regions so that everybody can finish; the orders that the others have with
/// one another stay as they are. `report` is where it is on the new path, which goes on along the old one up to where the agent
/// can stop. `prefer` says of every agent whether the admitted one should pass it first (PCR_FIRST) or second, where both are
/// possible; null for all second. The table must be built, and the memory needs room as for `pcr_fleet_replace`.
///
/// PCR_STATUS_REFUSED leaves everything as it was; `why` tells who is in the way, and may be null.
#[unsafe(export_name = name!("fleet_admit"))]
pub extern "C" fn pcr_fleet_admit(
    place: Option<&mut PcrFleet>,
    agent: usize,
    by: Option<&PcrAgent>,
    report: Option<&PcrProgress>,
    accepted: Option<&PcrTolerances>,
    prefer: *const u8,
    why: Option<&mut PcrRefused>,
) -> PcrStatus {
    change(place, |fleet| {
        let (by, progress, tolerances) = (given(by)?, progress(*given(report)?)?, tolerances(accepted)?);
        let count = if prefer.is_null() { 0 } else { fleet.motions().len() };
        let prefer = given(values(prefer, count))?;
        prefer.iter().try_for_each(|&pass| decision(pass).map(drop))?;
        let wanted = |other: usize| prefer.get(other).and_then(|&pass| decision(pass).ok());
        let admitted =
            fleet.admit(agent, by, progress, tolerances, |region| wanted(region.other()).unwrap_or(Pass::Second));
        admitted.map_err(|(status, refusal)| refusal.map_or(status, |refusal| refused(why, refusal)))
    })
}

/// Drops the orders of regions that the first agent has left: they cost no time any more.
#[unsafe(export_name = name!("fleet_passed"))]
pub extern "C" fn pcr_fleet_passed(place: Option<&mut PcrFleet>) -> PcrStatus {
    change(place, |fleet| {
        let OrderedMut { orders, progress, .. } = fleet.ordered_mut()?;
        orders.passed(progress);
        Ok(())
    })
}

fn brakes(brakes: Option<&PcrBrakes>) -> Result<Brakes<S>, PcrStatus> {
    let brakes = given(brakes)?;
    Ok(Brakes::new(inner(brakes.deceleration), inner(brakes.reaction))?)
}

/// The way that is needed to stop from a speed (m/s), rounded up (m).
#[unsafe(export_name = name!("stopping_way"))]
pub extern "C" fn pcr_stopping_way(how: Option<&PcrBrakes>, speed: Real, way: Option<&mut Real>) -> PcrStatus {
    status(brakes(how).and_then(|brakes| {
        *given(way)? = plain(brakes.distance(number(speed)?));
        Ok(())
    }))
}

/// The speed from which this way (m) is enough to stop, rounded down (m/s); 0 where there is no way.
#[unsafe(export_name = name!("stopping_speed"))]
pub extern "C" fn pcr_stopping_speed(how: Option<&PcrBrakes>, way: Real, speed: Option<&mut Real>) -> PcrStatus {
    status(brakes(how).and_then(|brakes| {
        *given(speed)? = plain(brakes.speed(number(way)?));
        Ok(())
    }))
}

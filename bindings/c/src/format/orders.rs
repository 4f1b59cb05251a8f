//! Passing orders: which agent passes a region first. Agents that keep their holds do not touch one another, whatever
//! their delays.

use super::fleet::{OrderedMut, number, on_path};
use super::number::{Real, S, inner, plain};
use super::points::{Room, ask, change, interval, range, short, status};
use super::types::{
    PcrAgent, PcrBrakingModel, PcrCheckTolerances, PcrFleet, PcrMovementAuthority, PcrProgress, PcrRegionPrecedence,
};
use crate::memory::values;
use crate::status::{PcrAdmissionError, PcrAuthorityKind, PcrStatus, decision, given, pass};
use pcr_core::{
    AdmissionError, BrakingModel, CheckTolerances, Interval, MovementAuthority, PassingState, Progress, Scalar,
};

/// Converts a refusal, and writes the reason if there is a place for it.
fn refused(why: Option<&mut PcrAdmissionError>, refused: AdmissionError) -> PcrStatus {
    if let (Some(why), Some(refused)) = (why, PcrAdmissionError::of(refused)) {
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

fn tolerances(tolerances: Option<&PcrCheckTolerances>) -> Result<CheckTolerances<S>, PcrStatus> {
    let tolerances = given(tolerances)?;
    let (width, gain) = (number(tolerances.width)?, number(tolerances.gain)?);
    match () {
        () if width < S::ZERO => Err(PcrStatus::Negative),
        () if gain <= S::ZERO => Err(PcrStatus::NonPositive),
        () => Ok(CheckTolerances { width, gain }),
    }
}

/// The regions of an agent, the order in which it passes them, and their count.
#[unsafe(export_name = name!("fleet_passings"))]
pub extern "C" fn pcr_fleet_passings(
    place: Option<&PcrFleet>,
    agent: usize,
    out: *mut PcrRegionPrecedence,
    capacity: usize,
    count: Option<&mut usize>,
) -> PcrStatus {
    ask(place, |fleet| {
        let room = Room::new(out, capacity, count)?;
        let row = fleet.ordered()?.0.row(fleet.motions(), agent)?;
        room.fill(row.map(|(place, region, seen)| PcrRegionPrecedence {
            place,
            other: short(region.other()),
            pass: pass(seen),
            length: interval(region.length()),
            other_length: interval(region.other_length()),
        }))
    })
}

/// Takes the orders from the motions of the fleet, which must be those of a plan without collisions. Earlier decisions
/// are overwritten. PCR_STATUS_REFUSED if two agents meet, or pass so close that it cannot be decided which one is
/// first; `why` then names them. `why` may be null.
#[unsafe(export_name = name!("fleet_orders_as_planned"))]
pub extern "C" fn pcr_fleet_orders_as_planned(
    place: Option<&mut PcrFleet>,
    why: Option<&mut PcrAdmissionError>,
) -> PcrStatus {
    change(place, |fleet| {
        let OrderedMut { orders, motions, .. } = fleet.ordered_mut()?;
        orders.as_planned(motions).map_err(|refusal| refused(why, refusal))
    })
}

/// Decides the order of all undecided regions of two agents: whether the ego passes them first (PCR_FIRST) or second
/// (PCR_SECOND). Parts of a region behind the second agent count as passed. `pcr_fleet_check` checks that all agents
/// can still finish.
#[unsafe(export_name = name!("fleet_decide"))]
pub extern "C" fn pcr_fleet_decide(place: Option<&mut PcrFleet>, ego: usize, other: usize, pass: u8) -> PcrStatus {
    change(place, |fleet| {
        let pass = decision(pass)?;
        fleet.two(ego, other)?;
        let OrderedMut { orders, motions, progress, .. } = fleet.ordered_mut()?;
        let second = if pass == PassingState::First { other } else { ego };
        let since = progress.get(second).ok_or(PcrStatus::NoSuchAgent)?.at.lo;
        Ok(orders.decide(motions, ego, other, pass, since)?)
    })
}

/// Decides the order of the region at one index of the table (`PcrRegionPrecedence.place`). An order that exists is overwritten.
/// PCR_STATUS_NO_SUCH_REGION if the agent has no region there.
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
        let second = if pass == PassingState::First { other } else { ego };
        let since = progress.get(second).ok_or(PcrStatus::NoSuchAgent)?.at.lo;
        Ok(orders.decide_at(motions, region, ego, pass, since)?)
    })
}

/// Updates the progress of an agent. Reports may come late, twice and in any order; an older report does not undo a
/// newer one. The report must be about the present path of the agent; PCR_STATUS_OUT_OF_RANGE if none of its lengths is
/// on it.
#[unsafe(export_name = name!("fleet_report"))]
pub extern "C" fn pcr_fleet_report(
    place: Option<&mut PcrFleet>,
    agent: usize,
    report: Option<&PcrProgress>,
) -> PcrStatus {
    change(place, |fleet| {
        let new = on_path(progress(*given(report)?)?, fleet.motion(agent)?)?;
        let known = fleet.ordered_mut()?.progress.get_mut(agent).ok_or(PcrStatus::NoSuchAgent)?;
        let later = |known, new| Scalar::max(known, new);
        let at = Interval::new(later(known.at.lo, new.at.lo), later(known.at.hi, new.at.hi));
        *known = Progress { at, stop: later(known.stop, new.stop) };
        Ok(())
    })
}

/// How far an agent may go, given the reports of the others. The agent has to brake so that it does not exceed this
/// (`pcr_stopping_speed`). Reports that are out of date give a hold that is too low, never one that is too high.
#[unsafe(export_name = name!("fleet_hold"))]
pub extern "C" fn pcr_fleet_hold(
    place: Option<&PcrFleet>,
    agent: usize,
    out: Option<&mut PcrMovementAuthority>,
) -> PcrStatus {
    ask(place, |fleet| {
        let (out, (orders, progress)) = (given(out)?, fleet.ordered()?);
        let hold = orders.hold(fleet.motions(), agent, progress)?;
        let kind = match hold {
            MovementAuthority::Free => PcrAuthorityKind::Free,
            MovementAuthority::At(_) => PcrAuthorityKind::At,
            MovementAuthority::Inside => PcrAuthorityKind::Inside,
        };
        let length = hold.length(fleet.motion(agent)?.path().length());
        *out = PcrMovementAuthority { kind, length: plain(length.unwrap_or(S::ZERO)) };
        Ok(())
    })
}

/// Checks that every agent can reach the end of its path, from the place that was reported last, without breaking an
/// order. PCR_STATUS_REFUSED if an agent would wait for ever, or is where it should have waited; `why` then names it.
/// `why` may be null.
#[unsafe(export_name = name!("fleet_check"))]
pub extern "C" fn pcr_fleet_check(
    place: Option<&mut PcrFleet>,
    accepted: Option<&PcrCheckTolerances>,
    why: Option<&mut PcrAdmissionError>,
) -> PcrStatus {
    change(place, |fleet| {
        let tolerances = tolerances(accepted)?;
        let OrderedMut { orders, motions, progress, reaches } = fleet.ordered_mut()?;
        orders.check(motions, progress, tolerances, reaches).map_err(|refusal| refused(why, refusal))
    })
}

/// Gives an agent a new path and orders for all its regions, with which it can finish, and so can every agent that could
/// if this one were not there. The orders between the other agents stay as they are. `report` is
/// the place of the agent on the new path, which follows the old one at least up to where the agent can stop. `prefer`
/// has a value for every agent: whether the admitted one should pass it first (PCR_FIRST) or second, where both are
/// possible; that of the admitted one is not read. If it is null, second. The table must be built, and the memory needs
/// room as for `pcr_fleet_replace`.
///
/// The `stop` that each of the others has reported last must be as far as it can still come: at least the hold that it was told. One that
/// has been told a hold since, and is beyond its report, counts as able to wait where it no longer is.
///
/// PCR_STATUS_REFUSED leaves everything unchanged; `why` then names the agent in the way. `why` may be null.
#[unsafe(export_name = name!("fleet_admit"))]
pub extern "C" fn pcr_fleet_admit(
    place: Option<&mut PcrFleet>,
    agent: usize,
    by: Option<&PcrAgent>,
    report: Option<&PcrProgress>,
    accepted: Option<&PcrCheckTolerances>,
    prefer: *const u8,
    why: Option<&mut PcrAdmissionError>,
) -> PcrStatus {
    change(place, |fleet| {
        let (by, progress, tolerances) = (given(by)?, progress(*given(report)?)?, tolerances(accepted)?);
        let count = if prefer.is_null() { 0 } else { fleet.motions().len() };
        let prefer = given(values(prefer, count))?;
        let others = prefer.iter().enumerate().filter(|(other, _)| *other != agent);
        others.map(|(_, &pass)| decision(pass)).try_for_each(|pass| pass.map(drop))?;
        let wanted = |other: usize| prefer.get(other).and_then(|&pass| decision(pass).ok());
        let admitted = fleet
            .admit(agent, by, progress, tolerances, |region| wanted(region.other()).unwrap_or(PassingState::Second));
        admitted.map_err(|(status, refusal)| refusal.map_or(status, |refusal| refused(why, refusal)))
    })
}

/// Drops the orders of regions that the first agent has left, so that they are not evaluated any more.
#[unsafe(export_name = name!("fleet_passed"))]
pub extern "C" fn pcr_fleet_passed(place: Option<&mut PcrFleet>) -> PcrStatus {
    change(place, |fleet| {
        let OrderedMut { orders, progress, .. } = fleet.ordered_mut()?;
        orders.passed(progress);
        Ok(())
    })
}

fn brakes(brakes: Option<&PcrBrakingModel>) -> Result<BrakingModel<S>, PcrStatus> {
    let brakes = given(brakes)?;
    Ok(BrakingModel::new(inner(brakes.deceleration), inner(brakes.reaction))?)
}

/// The stopping distance from a speed (m/s), rounded up (m). PCR_STATUS_OUT_OF_RANGE if it is beyond the range of the
/// format.
#[unsafe(export_name = name!("stopping_way"))]
pub extern "C" fn pcr_stopping_way(how: Option<&PcrBrakingModel>, speed: Real, way: Option<&mut Real>) -> PcrStatus {
    status(brakes(how).and_then(|brakes| {
        let (way, speed) = (given(way)?, number(speed)?);
        if speed < S::ZERO {
            return Err(PcrStatus::Negative);
        }
        let distance = brakes.distance(speed);
        if !Scalar::is_finite(distance) || distance > S::LIMIT {
            return Err(PcrStatus::OutOfRange);
        }
        *way = plain(distance);
        Ok(())
    }))
}

/// The largest speed from which this distance (m) is enough to stop, rounded down (m/s); 0 if the distance is not above
/// 0.
#[unsafe(export_name = name!("stopping_speed"))]
pub extern "C" fn pcr_stopping_speed(how: Option<&PcrBrakingModel>, way: Real, speed: Option<&mut Real>) -> PcrStatus {
    status(brakes(how).and_then(|brakes| {
        *given(speed)? = plain(brakes.speed(number(way)?));
        Ok(())
    }))
}

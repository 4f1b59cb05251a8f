//! Zone sets that the manager sends to a vehicle. Those that the vehicle uses count: nobody gets authority into a blocked zone, edges in a zone
//! with a limited speed get the limit, and an order against a one-way zone is refused. The vehicle keeps to all of them itself, too.

use super::journal_notes::noted;
use super::map_check::map_of;
use super::{Recipient, VehicleAdapter};
use crate::robot::SupervisedRobot;
use crate::supervisor::{JournalError, Supervisor, ZoneArea};
use pcr_formats::vda5050::decode::{self, DecodeError, MessageLimits};
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::order_state::RejectedOrder;
use pcr_formats::vda5050::state::{ErrorEntry, State};
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::OrderRejection;
use pcr_formats::vda5050::zone_set::{Zone, ZoneRule, ZoneSet, ZoneSetMessage};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Key of the note with the zone sets.
const NOTE: &str = "zones";

/// Most zone sets of a vehicle that are kept.
const MOST: usize = 16;

/// The zone sets of a vehicle.
#[derive(Debug, Default)]
pub(super) struct VehicleZones {
    kept: StoredZones,
    /// Whether the supervisor knows them.
    are_told: bool,
}

/// The part that is kept in the journal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct StoredZones {
    /// The sets that were sent to the vehicle.
    sets: Vec<ZoneSet>,
    /// Ids of those that it uses, as it says.
    enabled: BTreeSet<String>,
    /// The map that they have to be of, if it is known.
    map: Option<String>,
}

impl StoredZones {
    /// The zones that the vehicle uses, each with its set.
    fn used(&self) -> impl Iterator<Item = (&ZoneSet, &Zone)> {
        let is_used = |set: &&ZoneSet| {
            self.enabled.contains(&set.zone_set_id) && self.map.as_ref().is_none_or(|map| *map == set.map_id)
        };
        self.sets.iter().filter(is_used).flat_map(|set| set.zones.iter().map(move |zone| (set, zone)))
    }
}

fn name(set: &ZoneSet, zone: &Zone) -> String {
    format!("zone {} of {}", zone.zone_id, set.zone_set_id)
}

/// What a zone is to the supervisor; `None` for one that changes nothing about how far the vehicle may go.
fn area(set: &ZoneSet, zone: &Zone) -> Result<Option<ZoneArea>, DecodeError> {
    let speed = match zone.rule()? {
        ZoneRule::Blocked => None,
        ZoneRule::SpeedLimit(speed) => Some(speed),
        ZoneRule::OneWay(_) | ZoneRule::OfVehicle => return Ok(None),
    };
    Ok(Some(ZoneArea { name: name(set, zone), corners: zone.corners(), speed }))
}

impl VehicleZones {
    /// What the journal has.
    ///
    /// # Errors
    /// [`JournalError`] where that cannot be read.
    pub(super) fn remembered(robot: Option<&SupervisedRobot>) -> Result<Self, JournalError> {
        Ok(Self { kept: noted(robot, NOTE)?.unwrap_or_default(), are_told: false })
    }

    /// Rejects an order with a straight edge against a one-way zone. A trajectory counts more than such a zone, as the standard says.
    ///
    /// # Errors
    /// [`RejectedOrder`] for the first such edge.
    pub(super) fn check(&self, order: &Order) -> Result<(), RejectedOrder> {
        for (set, zone) in self.kept.used() {
            let Ok(ZoneRule::OneWay(way)) = zone.rule() else { continue };
            for (k, (edge, ends)) in order.edges.iter().zip(order.nodes.windows(2)).enumerate() {
                let place = |k: usize| ends.get(k)?.node_position.as_ref().map(|at| [at.x, at.y]);
                let Some((from, to)) = place(0).zip(place(1)).filter(|_| edge.trajectory.is_none()) else { continue };
                if way.forbids(from, to) && zone.length_inside(from, to) > 0.0 {
                    let field = format!("edges[{k}]");
                    let why = format!("edge {} leads against {}, which is one way", edge.edge_id, name(set, zone));
                    return Err(RejectedOrder::new(OrderRejection::Order, &field, why));
                }
            }
        }
        Ok(())
    }

    /// Errors for sets that the vehicle uses and that were never sent here.
    pub(super) fn errors(&self) -> impl Iterator<Item = ErrorEntry> {
        let is_known = |id: &&String| self.kept.sets.iter().any(|set| set.zone_set_id == **id);
        self.kept.enabled.iter().filter(move |id| !is_known(id)).map(|id| {
            let why = format!(
                "the vehicle uses the zone set {id}, which was not sent on its topic: only the vehicle keeps to its zones"
            );
            ErrorEntry::warning("zoneSetUnknown", why, &[("zoneSetId", id)])
        })
    }

    /// Takes a set; returns whether it is new.
    ///
    /// # Errors
    /// The type of the error, the zone if it is one, and what is wrong.
    fn take(&mut self, set: ZoneSet) -> Result<bool, (&'static str, Option<String>, DecodeError)> {
        for (k, zone) in set.zones.iter().enumerate() {
            let checked = area(&set, zone).and_then(|area| match area.map(|area| area.check()) {
                Some(Err(why)) => Err(DecodeError::new("vertices", why)),
                _ => Ok(()),
            });
            if let Err(DecodeError { field, why }) = checked {
                let refusal = DecodeError::new(format!("zoneSet.zones[{k}].{field}"), why);
                return Err(("VALIDATION_FAILURE", Some(zone.zone_id.clone()), refusal));
            }
        }
        if let Some(known) = self.kept.sets.iter().find(|known| known.zone_set_id == set.zone_set_id) {
            let why = "the vehicle has another set of this id, whose content must not change";
            let other = ("DUPLICATE_ZONE_SET", None, DecodeError::new("zoneSet.zoneSetId", why));
            return if *known == set { Ok(false) } else { Err(other) };
        }
        if self.kept.sets.len() >= MOST {
            let Some(unused) = self.kept.sets.iter().position(|it| !self.kept.enabled.contains(&it.zone_set_id)) else {
                let why = format!("the vehicle uses {MOST} sets already");
                return Err(("VALIDATION_FAILURE", None, DecodeError::new("zoneSet", why)));
            };
            self.kept.sets.remove(unused);
        }
        self.kept.sets.push(set);
        Ok(true)
    }
}

impl VehicleAdapter {
    /// Takes a zone set, and passes it on.
    ///
    /// # Errors
    /// [`DecodeError`] for an invalid set, and for one with a zone that is not supported here. The vehicle does not get it, and the manager is
    /// told.
    pub fn zone_set(
        &mut self,
        supervisor: &mut Supervisor,
        payload: &[u8],
        limits: MessageLimits,
        is_third: bool,
    ) -> Result<(), DecodeError> {
        let message: ZoneSetMessage = decode::read(payload, limits)?;
        message.header.check(&self.profile.key, is_third)?;
        let set = message.zone_set.zone_set_id.clone();
        match self.zones.take(message.zone_set) {
            Ok(is_new) => {
                if is_new {
                    self.zones.are_told = false;
                    self.note_zones(supervisor);
                    self.follow_zones(supervisor);
                }
                self.forward(Recipient::Vehicle, TopicKind::ZoneSet, is_third, payload);
                Ok(())
            }
            Err((kind, zone, refusal)) => {
                let mut references = vec![("zoneSetId", set.as_str())];
                references.extend(zone.as_deref().map(|zone| ("zoneId", zone)));
                self.complain(ErrorEntry::warning(kind, refusal.to_string(), &references));
                self.mirror();
                Err(refusal)
            }
        }
    }

    /// Takes from a state which zone sets the vehicle uses.
    pub(super) fn follow_zone_sets(&mut self, supervisor: &mut Supervisor, state: &State) {
        // A state without them says nothing of them.
        let Some(said) = state.rest.get("zoneSets").and_then(|sets| sets.as_array()) else { return };
        let enabled = said.iter().filter(|set| set["zoneSetStatus"] == "ENABLED");
        let enabled = enabled.filter_map(|set| Some(set["zoneSetId"].as_str()?.to_owned())).collect::<BTreeSet<_>>();
        if enabled.is_empty() && self.zones.kept.enabled.is_empty() {
            return;
        }
        let known = supervisor.robot(&self.name).ok().and_then(map_of);
        let map = known.or_else(|| state.position().map(|pose| pose.map_id.as_str())).map(str::to_owned);
        if (&self.zones.kept.enabled, &self.zones.kept.map) != (&enabled, &map) {
            (self.zones.kept.enabled, self.zones.kept.map) = (enabled, map);
            self.zones.are_told = false;
            self.note_zones(supervisor);
            self.follow_zones(supervisor);
        }
    }

    /// Tells the supervisor of the zones, if it does not know them.
    pub(crate) fn follow_zones(&mut self, supervisor: &mut Supervisor) {
        if std::mem::replace(&mut self.zones.are_told, true) {
            return;
        }
        let areas: Vec<ZoneArea> =
            self.zones.kept.used().filter_map(|(set, zone)| area(set, zone).ok().flatten()).collect();
        if areas.is_empty() && !supervisor.has_zones(&self.name) {
            return;
        }
        // They were checked when they came; what is in the journal was, too.
        if let Err(why) = supervisor.set_zones(&self.name, &areas) {
            self.remarks.push(format!("its zones: {why}"));
        }
    }

    /// Stores the zone sets in the journal, if there are any.
    pub(super) fn note_zones(&self, supervisor: &mut Supervisor) {
        if self.zones.kept != StoredZones::default() {
            self.note(supervisor, NOTE, &self.zones.kept);
        }
    }
}

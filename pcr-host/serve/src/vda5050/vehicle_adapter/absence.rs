//! A vehicle that is away, or that others wait for because it has not said where it stands.

use super::recency::RecencyFilter;
use super::{NoticeKind, PositionSource, VehicleAdapter};
use crate::owned_path::StartPose;
use crate::supervisor::{StandingPlace, Supervisor};
use pcr_formats::vda5050::state::{ErrorEntry, VehiclePosition};
use pcr_formats::vda5050::topics::TopicKind;

/// Why others wait for a vehicle.
pub(crate) struct WaitReason {
    /// In words, with what to do.
    pub(crate) why: String,
    /// Where it may stand; empty if nothing is known of that, so that everybody waits.
    pub(crate) places: Vec<StandingPlace>,
}

impl VehicleAdapter {
    /// Why others wait for the vehicle, if they do; `is_unknown`: it is not in the supervisor.
    pub(crate) fn waited_for(&self, supervisor: &Supervisor, is_unknown: bool) -> Option<WaitReason> {
        const WHAT: &str = "switch it on, or say that it is away";
        let is_away = supervisor.is_away(&self.name);
        if let Some(misfit) = self.misfit().filter(|_| !(is_away && is_unknown)) {
            let why =
                format!("is not as the file says, so no vehicle is released anything: {misfit}; correct the file");
            return Some(WaitReason { why, places: Vec::new() });
        }
        if is_away || !is_unknown && !self.is_doubtful {
            return None;
        }
        // What it has said of itself is newer than the file.
        let has_said = self
            .state
            .as_deref()
            .is_some_and(|state| state.driving || state.position().is_some_and(VehiclePosition::is_known));
        let places = if is_unknown && !has_said { self.standing_places() } else { Vec::new() };
        let who = match places.is_empty() {
            true => "no vehicle is released anything",
            false => "others keep away from the places where it may stand",
        };
        let why = match &self.elsewhere {
            Some(elsewhere) => format!("stands nowhere that counts ({elsewhere}), so {who}: {WHAT}"),
            None => format!("has not said where it stands, so {who}: {WHAT}"),
        };
        Some(WaitReason { why, places })
    }

    /// The places of its configuration, with room for all of the vehicle.
    fn standing_places(&self) -> Vec<StandingPlace> {
        let room = self.profile.abilities.radius_with_margin();
        self.profile.places.iter().map(|place| StandingPlace { radius: place.radius + room, ..*place }).collect()
    }

    /// Tells the manager for whom others wait, and what is closed: the kind of each, a name, and the rest of a sentence.
    pub(crate) fn notice(&mut self, notices: Vec<(NoticeKind, [String; 2])>) {
        self.notices = notices;
        self.mirror();
    }

    /// The same as errors in states.
    pub(super) fn notice_errors(&self) -> impl Iterator<Item = ErrorEntry> {
        let error = |(kind, [name, why]): &(NoticeKind, [String; 2])| {
            let (kind, reference) = match kind {
                NoticeKind::Unplaced => ("waitsForVehicle", Some("vehicle")),
                NoticeKind::Closed => ("closed", Some("closure")),
                NoticeKind::Limited => ("limited", Some("closure")),
                NoticeKind::Paused => ("paused", None),
            };
            let references: Vec<(&str, &str)> =
                reference.map(|reference| (reference, name.as_str())).into_iter().collect();
            ErrorEntry::warning(kind, format!("{name} {why}"), &references)
        };
        self.notices.iter().map(error)
    }

    /// Takes it that the vehicle is away, or no longer. What it has said before then does not tell where it stands when it is back.
    pub(crate) fn follow_absence(&mut self, supervisor: &Supervisor) {
        let is_away = supervisor.is_away(&self.name);
        if is_away && !self.is_away {
            self.newest.insert(TopicKind::State, RecencyFilter::begun());
            self.newest.remove(&TopicKind::Visualization);
            self.interim = super::interim::Interim::default();
            (self.state, self.astray, self.elsewhere) = (None, None, None);
            self.early.clear();
        }
        self.is_away = is_away;
    }

    /// A vehicle that was away says where it is: it is not away any more. Where it is not in the supervisor, it counts as standing there; if it does
    /// not stand, it is not where it may be, and if that place is too uncertain, it has not said where it stands.
    pub(super) fn comes_back(
        &mut self,
        supervisor: &mut Supervisor,
        pose: &VehiclePosition,
        is_still: bool,
        with: PositionSource,
        now: f64,
    ) {
        let is_placed = supervisor.robot(&self.name).is_ok();
        let is_certain = self.remaining_margin(pose) >= 0.0;
        if !is_placed && !is_still && is_certain {
            let start = StartPose { x: pose.x, y: pose.y, heading: pose.theta };
            if self.seat(supervisor, start, &pose.map_id, with).is_ok() {
                // The place is finite, and the robot is there: this cannot be refused.
                let _ = supervisor.report_off_path(&self.name, [pose.x, pose.y], 0.0, now);
            }
        }
        if is_placed || !is_still || !is_certain {
            // It is known, and after a broken journal nothing is told.
            let _ = supervisor.set_away(&self.name, false);
        }
    }
}

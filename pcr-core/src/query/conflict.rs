//! Conflicts: contacts with their place and depth.

use crate::error::MismatchError;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::clearance::ClosestApproach;
use crate::query::contact::{Contacts, Encounter};
use crate::query::safe::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// A contact of two agents, from its begin to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Conflict<S> {
    /// The interval of time \[s\].
    pub time: Interval<S>,
    /// Lengths of the ego's path during the contact \[m\].
    pub length: Interval<S>,
    /// Lengths of the other's path during the contact \[m\].
    pub other_length: Interval<S>,
    /// The closest approach during the contact.
    pub deepest: ClosestApproach<S>,
    /// Largest overlap \[m\], the length of the least translation that separates the two: sum of the radii minus the least separation, within half of [`Encounter::tolerance`]; 0 if they only touch.
    pub depth: S,
    /// Whether the depth is at most half of [`Encounter::tolerance`]: it may then be no contact. A touch is in truth no deeper than the tolerance.
    pub touching: bool,
}

/// The conflicts of two agents, in increasing order of time.
#[derive(Clone, Debug)]
pub struct Conflicts<'a, S: Scalar> {
    encounter: Encounter<'a, S>,
    contacts: Contacts<'a, S>,
}

#[cfg(feature = "defmt")]
impl<S: Scalar + defmt::Format> defmt::Format for Conflicts<'_, S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "conflicts from {}", self.contacts);
    }
}

impl<'a, S: Scalar> Encounter<'a, S> {
    /// The contacts during an interval of time \[s\], with their place and depth. Cost: that of
    /// [`Encounter::contacts`], and of [`Encounter::closest`] for each contact.
    pub fn conflicts(&self, during: Interval<S>) -> Conflicts<'a, S> {
        Conflicts { encounter: *self, contacts: self.contacts(during) }
    }
}

/// A conflict with an agent of the fleet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AgentConflict<S> {
    /// Index of the other agent in the fleet.
    pub other: usize,
    /// The conflict.
    pub conflict: Conflict<S>,
}

/// The earliest conflict of a motion with the agents of some regions during an interval of time \[s\]. Pass the regions
/// of the agent's row in the table. Of two conflicts at the same time, the one whose region comes first is returned.
/// The motion needs the path of the regions' ego and a disc that is not larger, but may differ in start time or
/// profile. The conflict may be a mere touch ([`Conflict::touching`]), which plans make on purpose; [`first_overlap`] skips touches.
///
/// Cost: four inversions of a profile for each region; and that of [`Encounter::contacts`], up to the earliest contact
/// known so far, for regions in which both agents are at the same time.
///
/// # Errors
/// [`MismatchError::OtherFleet`] for another path or a larger disc than that of the regions' ego.
///
/// ```
/// use pcr_core::{Ecm, Interval, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry, first_conflict};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// let met = first_conflict(&fleet[0], ecm.row(&fleet, 0)?, Interval::new(0.0, 9.0))?.unwrap();
/// assert!(met.other == 1 && (met.conflict.depth - 0.5).abs() < 1e-9);
/// let later = fleet[0].delayed(1.0)?;
/// assert_eq!(first_conflict(&later, ecm.row(&fleet, 0)?, Interval::new(0.0, 9.0))?, None);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn first_conflict<'a, S: Scalar>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>>,
    during: Interval<S>,
) -> Result<Option<AgentConflict<S>>, MismatchError> {
    first(ego, regions, during, |_, _| true)
}

/// Like [`first_conflict`], but returns the earliest conflict that is deeper than a touch.
///
/// Cost: that of [`first_conflict`], and that of [`Encounter::closest`] for each touch before the conflict.
///
/// # Errors
/// As [`first_conflict`].
pub fn first_overlap<'a, S: Scalar>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>>,
    during: Interval<S>,
) -> Result<Option<AgentConflict<S>>, MismatchError> {
    first(ego, regions, during, |encounter, contact| !encounter.conflict(encounter.whole(contact, during)).touching)
}

/// The earliest conflict that the filter accepts.
fn first<'a, S: Scalar>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>>,
    during: Interval<S>,
    counts: impl Fn(&Encounter<'_, S>, Interval<S>) -> bool,
) -> Result<Option<AgentConflict<S>>, MismatchError> {
    let during = during.limited();
    let (mut first, mut until) = (None, during.hi);
    for region in regions {
        if !ego.is_within(region.ego_motion()) {
            return Err(MismatchError::OtherFleet);
        }
        let Some(window) = region.window(ego, Interval::new(during.lo, until)) else { continue };
        let encounter = Encounter::new(ego, region.other_motion());
        let mut earlier = encounter.contacts(window).take_while(|contact| first.is_none() || contact.lo < until);
        if let Some(contact) = earlier.find(|contact| counts(&encounter, *contact)) {
            until = contact.lo;
            first = Some((region.other(), encounter, contact));
        }
    }
    Ok(first.map(|(other, encounter, contact)| {
        let conflict = encounter.conflict(encounter.whole(contact, during));
        AgentConflict { other, conflict }
    }))
}

impl<S: Scalar> RegionRef<'_, S> {
    /// The part of an interval of time in which both agents are on the lengths of the region, where `ego` may be
    /// another motion along the ego's path. All contacts that belong to the region are in it.
    fn window(&self, ego: &Motion<'_, S>, during: Interval<S>) -> Option<Interval<S>> {
        let window = times(self.other_motion(), self.other_length(), during)?;
        times(ego, self.length(), window)
    }

    /// The first conflict in the time window of this region that is more than a touch.
    pub(crate) fn overlap(&self, ego: &Motion<'_, S>, during: Interval<S>) -> Option<Conflict<S>> {
        let window = self.window(ego, during)?;
        Encounter::new(ego, self.other_motion()).conflicts(window).find(|conflict| !conflict.touching)
    }
}

impl<S: Scalar> Iterator for Conflicts<'_, S> {
    type Item = Conflict<S>;

    fn next(&mut self) -> Option<Conflict<S>> {
        let time = self.contacts.next()?;
        Some(self.encounter.conflict(time))
    }
}

impl<S: Scalar> Encounter<'_, S> {
    /// Extends a contact to its end: a search in a part of the time may have found only its begin. A new search from
    /// there on might miss a touch.
    fn whole(&self, contact: Interval<S>, during: Interval<S>) -> Interval<S> {
        let again = self.contacts(Interval::new(contact.lo, during.hi)).next();
        again.filter(|again| again.lo <= contact.hi).map_or(contact, |again| contact.hull(again))
    }

    /// The place and depth of a contact.
    fn conflict(&self, time: Interval<S>) -> Conflict<S> {
        let Self { ego, other, .. } = self;
        let deepest = self.closest(time);
        let depth = (self.radius() - deepest.separation).max(S::ZERO);
        Conflict {
            time,
            length: Interval::new(ego.length_at(time.lo), ego.length_at(time.hi)),
            other_length: Interval::new(other.length_at(time.lo), other.length_at(time.hi)),
            deepest,
            depth,
            touching: depth <= self.tolerance().half(),
        }
    }
}

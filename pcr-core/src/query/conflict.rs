//! Conflicts: contacts with where and how deep.

use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::clearance::Approach;
use crate::query::contact::{Contacts, Encounter};
use crate::query::safe::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// A contact of two agents, from its begin to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Conflict<S> {
    /// From when to when \[s\].
    pub time: Interval<S>,
    /// Lengths along the ego's path meanwhile \[m\].
    pub length: Interval<S>,
    /// Lengths along the other's path meanwhile \[m\].
    pub other_length: Interval<S>,
    /// When the centres are nearest to one another.
    pub deepest: Approach<S>,
    /// Largest overlap: sum of the radii less the least separation, 0 where the discs only touch \[m\].
    pub depth: S,
    /// Whether the depth is within [`Encounter::tolerance`] of 0.
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
    /// The contacts during an interval of time \[s\], with where they are and how deep. Cost: that of
    /// [`Encounter::contacts`], and of [`Encounter::closest`] for each.
    pub fn conflicts(&self, during: Interval<S>) -> Conflicts<'a, S> {
        Conflicts { encounter: *self, contacts: self.contacts(during) }
    }
}

/// A conflict, and with whom.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Met<S> {
    /// Index of the other agent in the fleet.
    pub other: usize,
    /// The conflict.
    pub conflict: Conflict<S>,
}

/// The earliest conflict of a motion with the agents of some regions, those of its row in the table, during an interval of
/// time \[s\]; of two at the same time the one that comes first among the regions. The motion may differ from the one that
/// the regions are told of, but not in path and radius: a delay, or another profile. It may be a mere touch
/// ([`Conflict::touching`]), which plans make on purpose: what overlaps first, [`first_overlap`] tells.
///
/// Cost: four times of lengths a region, and that of [`Encounter::contacts`] for those where both are at the same time, up to
/// the earliest contact that is known already.
///
/// ```
/// use pcr_core::{Ecm, Interval, Motion, Path, Piece, Point, Pose, Profile, Radians, Region, first_conflict};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([Region::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// let met = first_conflict(&fleet[0], ecm.row(&fleet, 0)?, Interval::new(0.0, 9.0)).unwrap();
/// assert!(met.other == 1 && (met.conflict.depth - 0.5).abs() < 1e-9);
/// let later = fleet[0].delayed(1.0)?;
/// assert_eq!(first_conflict(&later, ecm.row(&fleet, 0)?, Interval::new(0.0, 9.0)), None);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn first_conflict<'a, S: Scalar>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>>,
    during: Interval<S>,
) -> Option<Met<S>> {
    first(ego, regions, during, |_, _| true)
}

/// As [`first_conflict`], the earliest conflict that is deeper than a touch.
///
/// Cost: that of [`first_conflict`], and for each touch on the way that of [`Encounter::closest`].
pub fn first_overlap<'a, S: Scalar>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>>,
    during: Interval<S>,
) -> Option<Met<S>> {
    first(ego, regions, during, |encounter, contact| !encounter.conflict(encounter.whole(contact, during)).touching)
}

/// The conflict of the earliest contact that counts.
fn first<'a, S: Scalar>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>>,
    during: Interval<S>,
    counts: impl Fn(&Encounter<'_, S>, Interval<S>) -> bool,
) -> Option<Met<S>> {
    let during = during.limited();
    let (mut first, mut until) = (None, during.hi);
    for region in regions {
        let Some(window) = region.window(ego, Interval::new(during.lo, until)) else { continue };
        let encounter = Encounter::new(ego, region.other_motion());
        let mut earlier = encounter.contacts(window).take_while(|contact| first.is_none() || contact.lo < until);
        if let Some(contact) = earlier.find(|contact| counts(&encounter, *contact)) {
            until = contact.lo;
            first = Some((region.other(), encounter, contact));
        }
    }
    let (other, encounter, contact) = first?;
    Some(Met { other, conflict: encounter.conflict(encounter.whole(contact, during)) })
}

impl<S: Scalar> RegionRef<'_, S> {
    /// The times of an interval at which both agents are on the lengths of the region, the ego by another motion along its
    /// path: all contacts of the region are among them.
    fn window(&self, ego: &Motion<'_, S>, during: Interval<S>) -> Option<Interval<S>> {
        let window = times(self.other_motion(), self.other_length(), during)?;
        times(ego, self.length(), window)
    }

    /// The first conflict in the window of this region that is more than touching.
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
    /// A contact to its end, of which a search in a part of the time may have found the begin only. A search from there on
    /// need not find a touch again.
    fn whole(&self, contact: Interval<S>, during: Interval<S>) -> Interval<S> {
        let again = self.contacts(Interval::new(contact.lo, during.hi)).next();
        again.filter(|again| again.lo <= contact.hi).map_or(contact, |again| contact.hull(again))
    }

    /// Where a contact is and how deep.
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
            touching: depth <= self.tolerance(),
        }
    }
}

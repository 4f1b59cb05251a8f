//! Conflicts: contacts with where and how deep.

use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::clearance::Approach;
use crate::query::contact::{Contacts, Encounter};
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
/// the regions are told of, but not in path and radius: a delay, or another profile.
///
/// Cost: that of [`Encounter::contacts`] for each other agent, up to the earliest contact that is known already.
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
/// let met = first_conflict(&fleet[0], ecm.row(&fleet, 0), Interval::new(0.0, 9.0)).unwrap();
/// assert!(met.other == 1 && (met.conflict.depth - 0.5).abs() < 1e-9);
/// let later = fleet[0].delayed(1.0)?;
/// assert_eq!(first_conflict(&later, ecm.row(&fleet, 0), Interval::new(0.0, 9.0)), None);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn first_conflict<'a, S: Scalar>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>>,
    during: Interval<S>,
) -> Option<Met<S>> {
    let (mut first, mut until, mut before) = (None, during.hi, None);
    for region in regions {
        // The regions of a pair come one after the other.
        if before.replace(region.other()) == Some(region.other()) {
            continue;
        }
        let encounter = Encounter::new(ego, region.other_motion());
        let contact = encounter.contacts(Interval::new(during.lo, until)).next();
        if let Some(contact) = contact.filter(|contact| first.is_none() || contact.lo < until) {
            until = contact.lo;
            let conflict = encounter.conflicts(Interval::new(contact.lo, during.hi)).next();
            first = conflict.map(|conflict| Met { other: region.other(), conflict }).or(first);
        }
    }
    first
}

impl<S: Scalar> Iterator for Conflicts<'_, S> {
    type Item = Conflict<S>;

    fn next(&mut self) -> Option<Conflict<S>> {
        let time = self.contacts.next()?;
        let Encounter { ego, other, .. } = self.encounter;
        let deepest = self.encounter.closest(time);
        let depth = (self.encounter.radius() - deepest.separation).max(S::ZERO);
        Some(Conflict {
            time,
            length: Interval::new(ego.length_at(time.lo), ego.length_at(time.hi)),
            other_length: Interval::new(other.length_at(time.lo), other.length_at(time.hi)),
            deepest,
            depth,
            touching: depth <= self.encounter.tolerance(),
        })
    }
}

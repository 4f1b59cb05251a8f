//! Conflicts: contacts with where and how deep.

use crate::geometry::Interval;
use crate::query::clearance::Approach;
use crate::query::contact::{Contacts, Encounter};
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

impl<'a, S: Scalar> Encounter<'a, S> {
    /// The contacts during an interval of time \[s\], with where they are and how deep. Cost: that of
    /// [`Encounter::contacts`], and of [`Encounter::closest`] for each.
    pub fn conflicts(&self, during: Interval<S>) -> Conflicts<'a, S> {
        Conflicts { encounter: *self, contacts: self.contacts(during) }
    }
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

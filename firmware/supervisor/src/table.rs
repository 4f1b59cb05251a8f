//! The table of a supervisor: regions, with passing orders if there is memory for them.

use crate::agent::Agent;
use crate::message::{Answer, Edition, Refusal, Terms};
use crate::number::Number;
use pcr_core::{
    CapacityError, Ecm, EcmCapacity, EcmEntry, EcmError, Interval, MismatchError, Motion, Piece, PrecedenceTable,
    RegionPrecedence,
};

/// A table of at most `R` regions in `P` pieces.
pub type Regions<S, const R: usize, const P: usize> = Ecm<S, [EcmEntry; R], [Piece<S>; P]>;

/// A table of at most `R` regions in `P` pieces, and `O` orders.
pub type Ordered<S, const R: usize, const P: usize, const O: usize> =
    PrecedenceTable<S, [EcmEntry; R], [Piece<S>; P], [RegionPrecedence<S>; O]>;

/// A table that a [`Service`](crate::Service) keeps. A table without orders refuses requests about orders.
pub trait Table<S: Number, const R: usize, const P: usize> {
    /// The regions.
    fn regions(&self) -> &Regions<S, R, P>;

    /// Adds the last agent of a fleet. The table must be that of the fleet without this agent.
    ///
    /// # Errors
    /// [`EcmError`].
    fn insert(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), EcmError>;

    /// Replaces an agent, and computes only its regions.
    ///
    /// # Errors
    /// [`EcmError`]; the new fleet then has no table.
    fn replace<'m>(&mut self, fleet: &mut [Motion<'m, S>], agent: usize, motion: Motion<'m, S>)
    -> Result<(), EcmError>;

    /// Removes an agent; the index of every agent behind it decreases by one.
    ///
    /// # Errors
    /// [`MismatchError`].
    fn erase(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), MismatchError>;

    /// Counts the regions and pieces that a fleet needs, and removes the fleet.
    ///
    /// # Errors
    /// [`CapacityError`].
    fn needed(&mut self, fleet: &[Motion<'_, S>]) -> Result<EcmCapacity, CapacityError>;

    /// Removes the fleet.
    fn clear(&mut self);

    /// Whether robots are under way with orders.
    fn is_running(&self) -> bool {
        false
    }

    /// Takes the orders from a plan. [`Request::Order`](crate::Request::Order).
    ///
    /// # Errors
    /// [`Refusal`].
    fn order(&mut self, _fleet: &[Motion<'_, S>], _terms: Terms<S>) -> Result<Edition, Refusal> {
        Err(Refusal::NoOrders)
    }

    /// Updates the place of a robot. [`Request::Report`](crate::Request::Report).
    ///
    /// # Errors
    /// [`Refusal`].
    fn report(
        &mut self,
        _fleet: &[Motion<'_, S>],
        _agent: usize,
        _edition: Edition,
        _at: Interval<S>,
        _send: &mut impl FnMut(Answer<S>),
    ) -> Result<Answer<S>, Refusal> {
        Err(Refusal::NoOrders)
    }

    /// The orders of a robot; `with` are the agents with these indices. [`Request::Orders`](crate::Request::Orders).
    ///
    /// # Errors
    /// [`Refusal`].
    fn orders(
        &self,
        _fleet: &[Motion<'_, S>],
        _agent: usize,
        _with: impl Fn(usize) -> Result<Agent<S>, Refusal>,
        _send: &mut impl FnMut(Answer<S>),
    ) -> Result<Answer<S>, Refusal> {
        Err(Refusal::NoOrders)
    }

    /// Checks that a robot is at the end of its path.
    ///
    /// # Errors
    /// [`Refusal`].
    fn arrived(&self, _fleet: &[Motion<'_, S>], _agent: usize) -> Result<(), Refusal> {
        Err(Refusal::NoOrders)
    }

    /// Gives a robot another path. [`Request::Admit`](crate::Request::Admit).
    ///
    /// # Errors
    /// [`Refusal`].
    fn admit<'m>(
        &mut self,
        _fleet: &mut [Motion<'m, S>],
        _agent: usize,
        _motion: Motion<'m, S>,
    ) -> Result<Edition, Refusal> {
        Err(Refusal::NoOrders)
    }
}

impl<S: Number, const R: usize, const P: usize> Table<S, R, P> for Regions<S, R, P> {
    fn regions(&self) -> &Self {
        self
    }

    // Separate functions, with stacks of their own; so are those below.
    #[inline(never)]
    fn insert(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), EcmError> {
        Ecm::insert(self, fleet, agent)
    }

    #[inline(never)]
    fn replace<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<(), EcmError> {
        Ecm::replace(self, fleet, agent, motion)
    }

    #[inline(never)]
    fn erase(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), MismatchError> {
        Ecm::erase(self, fleet, agent)
    }

    #[inline(never)]
    fn needed(&mut self, fleet: &[Motion<'_, S>]) -> Result<EcmCapacity, CapacityError> {
        Ecm::needed(self, fleet)
    }

    fn clear(&mut self) {
        Ecm::clear(self);
    }
}

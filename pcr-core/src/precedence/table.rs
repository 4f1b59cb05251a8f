//! The table of orders: one order for each region, at the same indices.

use crate::ecm::{Ecm, EcmCapacity, EcmEntry};
use crate::error::{CapacityError, EcmError, MismatchError};
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::precedence::authority::MovementAuthority;
use crate::precedence::entry::{PassingState, Progress, RegionPrecedence, other};
use crate::precedence::error::AdmissionError;
use crate::query::{first_overlap, times};
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// The collision regions of a fleet, and for each of them which agent passes it first.
///
/// Agents that keep their [`PrecedenceTable::hold`] never touch one another, however late they are. If [`PrecedenceTable::check`] passes,
/// all of them arrive (`docs/theory/precedence.md` has the proofs). Paths and radii matter; the times of the motions are used by
/// [`PrecedenceTable::as_planned`] only. As with [`Ecm`], every method that reads paths takes the fleet, and refuses another one.
///
/// The caller provides the storage, as for [`Ecm`]. One [`RegionPrecedence`] is needed for each region; [`PrecedenceTable::admit`] needs as
/// many more as its agent has regions.
///
/// A robot can compute its hold from its own row alone ([`PrecedenceTable::fill_row`], then [`PrecedenceTable::decide`] as it is told).
/// For that it has to know how far the robots before it have come, but nothing about clocks or speeds.
///
/// ```
/// use pcr_core::{MovementAuthority, Limits, Motion, RegionPrecedence, PrecedenceTable, PassingState, Path, Piece, Point, Pose, Profile, Progress, Radians, EcmEntry};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
///
/// // What robot 1 knows: its own row, and that robot 0 goes first.
/// let mut orders = PrecedenceTable::new([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], [RegionPrecedence::EMPTY; 4]);
/// orders.fill_row(&fleet, 1)?;
/// orders.decide(&fleet, 1, 0, PassingState::Second, 0.0)?;
/// let mut progress = [Progress::at_rest(0.0); 2];
/// assert!(matches!(orders.hold(&fleet, 1, &progress)?, MovementAuthority::At(hold) if (hold - 1.5).abs() < 1e-9));
/// progress[0] = Progress::at_rest(2.6);
/// assert_eq!(orders.hold(&fleet, 1, &progress)?, MovementAuthority::Free);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PrecedenceTable<S, R, P, O> {
    pub(super) ecm: Ecm<S, R, P>,
    pub(super) orders: O,
}

#[cfg(feature = "defmt")]
impl<S: Scalar, R, P, O> defmt::Format for PrecedenceTable<S, R, P, O> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "orders of a {}", self.ecm);
    }
}

impl<S: Scalar, R, P, O> PrecedenceTable<S, R, P, O> {
    /// An empty table.
    pub const fn new(regions: R, pieces: P, orders: O) -> Self {
        Self { ecm: Ecm::new(regions, pieces), orders }
    }

    /// The table of regions.
    pub const fn ecm(&self) -> &Ecm<S, R, P> {
        &self.ecm
    }
}

impl<S, R, P, O> PrecedenceTable<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[EcmEntry]>,
    P: AsRef<[Piece<S>]>,
    O: AsRef<[RegionPrecedence<S>]>,
{
    /// The regions of an agent: their indices in the table, pairs and orders.
    pub(super) fn places(&self, agent: usize) -> impl Iterator<Item = (usize, [usize; 2], RegionPrecedence<S>)> {
        // Only the pair is read first, because most regions belong to other agents.
        (0..self.ecm.len()).filter_map(move |place| {
            let agents = self.ecm.agents_at(place).filter(|agents| agents.contains(&agent))?;
            Some((place, agents, self.order(place)))
        })
    }

    /// All indices with their pairs and orders.
    pub(super) fn all(&self) -> impl Iterator<Item = (usize, [usize; 2], RegionPrecedence<S>)> {
        (0..self.ecm.len()).filter_map(|place| Some((place, self.ecm.agents_at(place)?, self.order(place))))
    }

    pub(super) fn order(&self, place: usize) -> RegionPrecedence<S> {
        self.orders.as_ref().get(place).copied().unwrap_or_default()
    }

    /// The regions of an agent's row, their indices, and the order in which it passes them. O(agents + regions).
    ///
    /// # Errors
    /// [`MismatchError`]. If there is no error, an empty iterator means that the agent has no regions.
    pub fn row<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
        agent: usize,
    ) -> Result<impl Iterator<Item = (usize, RegionRef<'a, S>, PassingState)>, MismatchError> {
        self.ecm.holds(fleet, [agent, agent])?;
        Ok(self.places(agent).filter_map(move |(place, agents, order)| {
            Some((place, self.ecm.at(fleet, place, agent)?, order.pass_of(agent, agents)))
        }))
    }

    /// How far an agent may go, given the progress of the others. The agent has to brake so that it does not exceed the
    /// hold, wherever it may be itself. For agents that pass first, the lower end of their place counts; an agent
    /// without an entry in `progress` is taken to be at the start of its path. Places that are out of date give a hold
    /// that is too low, never one that is too high.
    ///
    /// The places in `progress` must belong to the paths in `fleet`.
    ///
    /// Cost: O(agents + regions) to find the row, and that of [`RegionRef::hold`] for each region of it that may limit
    /// the hold.
    ///
    /// # Errors
    /// As [`PrecedenceTable::row`].
    pub fn hold(
        &self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        progress: &[Progress<S>],
    ) -> Result<MovementAuthority<S>, MismatchError> {
        self.hold_before(fleet, agent, progress, MovementAuthority::Free)
    }

    /// The hold, or `other` if that is more restrictive; regions that begin beyond `other` are skipped. Use this for an
    /// agent that only needs to know whether it may go on for a while.
    ///
    /// # Errors
    /// As [`PrecedenceTable::row`].
    pub fn hold_before(
        &self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        progress: &[Progress<S>],
        other: MovementAuthority<S>,
    ) -> Result<MovementAuthority<S>, MismatchError> {
        self.nearest(fleet, agent, progress, other).map(|(hold, _)| hold)
    }

    /// The hold, and the index of the region that limits it; `None` if it is `elsewhere`.
    pub(super) fn nearest(
        &self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        progress: &[Progress<S>],
        elsewhere: MovementAuthority<S>,
    ) -> Result<(MovementAuthority<S>, Option<usize>), MismatchError> {
        self.ecm.holds(fleet, [agent, agent])?;
        let (mut hold, mut nearest) = (elsewhere, None);
        for (place, agents, order) in self.places(agent) {
            let first = Progress::of(progress, other(agents, agent)).known();
            let held = match order.pass_of(agent, agents) {
                PassingState::First | PassingState::Over => continue,
                PassingState::Second if first > order.exit => continue,
                // The hold at this region is at least the entry.
                PassingState::Second if order.bounds_from_entry() && !hold.allows_beyond(order.entry) => continue,
                PassingState::Second => self.ecm.at(fleet, place, agent).map(|region| region.hold(order.since, first)),
                PassingState::Undecided => {
                    self.ecm.at(fleet, place, agent).map(|region| region.hold_undecided(progress))
                }
            };
            let least = hold.min(held.unwrap_or(MovementAuthority::Inside));
            if least != hold {
                (hold, nearest) = (least, Some(place));
            }
        }
        Ok((hold, nearest))
    }
}

impl<S, R, P, O> PrecedenceTable<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[EcmEntry]> + AsMut<[EcmEntry]>,
    P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
    O: AsRef<[RegionPrecedence<S>]> + AsMut<[RegionPrecedence<S>]>,
{
    /// Computes the table of a fleet of at most 65536 agents, with no order decided. Cost: that of [`Ecm::build`].
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small.
    pub fn build(regions: R, pieces: P, orders: O, fleet: &[Motion<'_, S>]) -> Result<Self, CapacityError> {
        let mut table = Self { ecm: Ecm::build(regions, pieces, fleet)?, orders };
        table.undecide().map(|()| table)
    }

    /// Computes the table of a whole fleet, like [`PrecedenceTable::build`], in the existing storage.
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small; the table is then empty, as after [`PrecedenceTable::clear`].
    pub fn fill(&mut self, fleet: &[Motion<'_, S>]) -> Result<(), CapacityError> {
        self.ecm.fill(fleet)?;
        self.undecide()
    }

    /// Begins to compute the table of a whole fleet in parts, like [`Ecm::begin_fill`].
    pub fn begin_fill(&mut self, fleet: &[Motion<'_, S>]) {
        self.ecm.begin_fill(fleet);
    }

    /// Continues with at most `pairs` pairs of agents, like [`Ecm::fill_pairs`]. Returns whether the table is complete; when it has
    /// become so, no order is decided.
    ///
    /// # Errors
    /// As [`Ecm::fill_pairs`].
    pub fn fill_pairs(&mut self, fleet: &[Motion<'_, S>], pairs: usize) -> Result<bool, EcmError> {
        let was_complete = self.ecm.is_complete().is_ok();
        let is_complete = self.ecm.fill_pairs(fleet, pairs)?;
        if is_complete && !was_complete {
            self.undecide()?;
        }
        Ok(is_complete)
    }

    /// Counts the regions and pieces that the table of a fleet takes, like [`Ecm::needed`]. One order is needed for each region. The table is
    /// then empty, and no order is decided.
    ///
    /// # Errors
    /// As [`Ecm::needed`].
    pub fn needed(&mut self, fleet: &[Motion<'_, S>]) -> Result<EcmCapacity, CapacityError> {
        self.ecm.needed(fleet)
    }

    /// Computes the table of one agent's row only, with no order decided, in the existing storage. It answers holds of
    /// that agent. Cost: that of [`Ecm::fill_row`].
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small; the table is then empty, as after [`PrecedenceTable::clear`].
    /// [`MismatchError::NoSuchAgent`]; the table is then unchanged.
    pub fn fill_row(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), EcmError> {
        self.ecm.fill_row(fleet, agent)?;
        Ok(self.undecide()?)
    }

    /// Removes all regions and orders; the table is then that of a fleet without agents.
    pub fn clear(&mut self) {
        self.ecm.clear();
    }

    /// Resets the orders of all regions.
    fn undecide(&mut self) -> Result<(), CapacityError> {
        if let Some(orders) = self.orders.as_mut().get_mut(..self.ecm.len()) {
            orders.fill(RegionPrecedence::EMPTY);
            return Ok(());
        }
        let full = self.lacks_orders(self.ecm.len());
        self.ecm.clear();
        Err(full)
    }

    /// The error of a storage with fewer orders than this.
    pub(super) fn lacks_orders(&self, needed: usize) -> CapacityError {
        CapacityError::Orders { needed, capacity: self.orders.as_ref().len() }
    }

    /// Makes this table a copy of another one, with its orders, in its own storage, like [`Ecm::copy_from`].
    ///
    /// # Errors
    /// As [`Ecm::copy_from`], and [`CapacityError::Orders`]; this table is then unchanged.
    pub fn copy_from<R2, P2, O2>(&mut self, other: &PrecedenceTable<S, R2, P2, O2>) -> Result<(), CapacityError>
    where
        R2: AsRef<[EcmEntry]>,
        P2: AsRef<[Piece<S>]>,
        O2: AsRef<[RegionPrecedence<S>]>,
    {
        let (room, used) = (self.orders.as_mut().iter_mut(), other.orders.as_ref().iter().take(other.ecm.len()));
        if room.len() < used.len() {
            return Err(CapacityError::Orders { needed: used.len(), capacity: room.len() });
        }
        self.ecm.copy_from(&other.ecm)?;
        room.zip(used).for_each(|(slot, order)| *slot = *order);
        Ok(())
    }

    /// Adds the regions of one agent with all others of the fleet, like [`Ecm::insert`], with no order decided.
    ///
    /// # Errors
    /// [`CapacityError`] if the storage is too small, and [`MismatchError`]; the table is then unchanged.
    pub fn insert(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), EcmError> {
        let kept = self.ecm.len();
        self.ecm.insert(fleet, agent)?;
        if self.ecm.len() > self.orders.as_ref().len() {
            let full = self.lacks_orders(self.ecm.len());
            self.ecm.remove(fleet, agent)?;
            return Err(full.into());
        }
        self.spread(agent, kept, |_| RegionPrecedence::EMPTY);
        Ok(())
    }

    /// Removes the regions of one agent and their orders, like [`Ecm::remove`]. O(agents + regions + pieces).
    ///
    /// # Errors
    /// [`MismatchError`]; the table is then unchanged.
    pub fn remove(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), MismatchError> {
        self.ecm.holds_all(fleet)?;
        self.gather(agent, |_, _| {});
        self.ecm.remove(fleet, agent)
    }

    /// Removes one agent for good, with its regions and their orders, like [`Ecm::erase`]: the index of every agent
    /// behind it decreases by one. O(agents + regions + pieces).
    ///
    /// # Errors
    /// [`MismatchError`]; the table is then unchanged.
    pub fn erase(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), MismatchError> {
        self.ecm.holds_all(fleet)?;
        self.gather(agent, |_, _| {});
        self.ecm.erase(fleet, agent)
    }

    /// Decides the order of all undecided regions of `ego` and `other`: whether the ego passes them first or second.
    /// `since` is the least length at which the agent that goes second is now \[m\], from 0 to the length of its path;
    /// parts of a region behind it count as passed. [`PassingState::Over`] frees both agents: the caller knows that one of them
    /// has left the regions. O(agents + regions).
    ///
    /// # Errors
    /// [`MismatchError`].
    pub fn decide(
        &mut self,
        fleet: &[Motion<'_, S>],
        ego: usize,
        other: usize,
        pass: PassingState,
        since: S,
    ) -> Result<(), MismatchError> {
        self.ecm.holds(fleet, [ego, other])?;
        for place in 0..self.ecm.len() {
            let undecided = self.order(place).pass == PassingState::Undecided;
            let agents = self.ecm.agents_at(place);
            if undecided && agents == Some([ego.min(other), ego.max(other)]) {
                self.set(fleet, place, ego, pass, since);
            }
        }
        Ok(())
    }

    /// Decides the order of the region at one index of the table, one of `ego`. An existing order is overwritten.
    ///
    /// It does not check that both agents can still keep the order, nor that all can finish (see [`PrecedenceTable::check`]).
    ///
    /// # Errors
    /// [`MismatchError`], also if the region at this index is not one of `ego`.
    pub fn decide_at(
        &mut self,
        fleet: &[Motion<'_, S>],
        place: usize,
        ego: usize,
        pass: PassingState,
        since: S,
    ) -> Result<(), MismatchError> {
        let agents = self.ecm.agents_at(place).filter(|agents| agents.contains(&ego));
        self.ecm.holds(fleet, agents.unwrap_or([ego, ego]))?;
        agents.ok_or(MismatchError::NoSuchRegion(place))?;
        self.set(fleet, place, ego, pass, since);
        Ok(())
    }

    fn set(&mut self, fleet: &[Motion<'_, S>], place: usize, ego: usize, pass: PassingState, since: S) {
        let Some(region) = self.ecm.at(fleet, place, ego) else { return };
        if let Some(order) = self.orders.as_mut().get_mut(place) {
            *order = RegionPrecedence::new(&region, pass, since);
        }
    }

    /// Takes the orders from the motions of the fleet, which must be those of a plan without collisions. Earlier
    /// decisions are overwritten, but not on an error: then they are as before. Cost: that of [`first_overlap`] for each
    /// region.
    ///
    /// # Errors
    /// [`AdmissionError::Meeting`] for two agents that do more than touch, or pass so close that it cannot be decided which
    /// one is first; [`AdmissionError::Mismatch`].
    pub fn as_planned(&mut self, fleet: &[Motion<'_, S>]) -> Result<(), AdmissionError> {
        self.ecm.holds_all(fleet)?;
        let places = 0..self.ecm.len();
        let all = || places.clone().filter_map(|place| Some((place, self.ecm.agents_at(place)?)));
        for (place, [lower, higher]) in all() {
            let Some(region) = self.ecm.at(fleet, place, lower) else { continue };
            let always = Interval::new(-S::LIMIT, S::LIMIT);
            let met = first_overlap(region.ego_motion(), core::iter::once(region.clone()), always)?.is_some();
            if met || planned(&region).is_none() {
                return Err(AdmissionError::Meeting([lower, higher]));
            }
        }
        for place in places {
            let order = self.ecm.agents_at(place).and_then(|[lower, _]| {
                let region = self.ecm.at(fleet, place, lower)?;
                Some(RegionPrecedence::new(&region, planned(&region)?, S::ZERO))
            });
            if let (Some(order), Some(room)) = (order, self.orders.as_mut().get_mut(place)) {
                *room = order;
            }
        }
        Ok(())
    }

    /// Drops the orders of regions that the first agent has left, so that they are not evaluated any more. O(regions).
    pub fn passed(&mut self, progress: &[Progress<S>]) {
        for (place, order) in (0..self.ecm.len()).zip(self.orders.as_mut()) {
            let Some(agents) = self.ecm.agents_at(place) else { continue };
            let first = match order.pass {
                PassingState::First => agents[0],
                PassingState::Second => agents[1],
                PassingState::Undecided | PassingState::Over => continue,
            };
            if progress.get(first).is_some_and(|first| first.known() > order.exit) {
                order.pass = PassingState::Over;
            }
        }
    }

    /// Moves the orders of all other agents to the beginning of the storage, and passes those of `agent` to `taken`.
    /// Returns the number of orders at the beginning.
    pub(super) fn gather(
        &mut self,
        agent: usize,
        mut taken: impl FnMut(&mut [RegionPrecedence<S>], RegionPrecedence<S>),
    ) -> usize {
        let mut kept = 0_usize;
        for place in 0..self.ecm.len() {
            let order = self.order(place);
            let orders = self.orders.as_mut();
            if self.ecm.agents_at(place).is_some_and(|agents| agents.contains(&agent)) {
                taken(orders, order);
            } else if let Some(room) = orders.get_mut(kept) {
                *room = order;
                kept = kept.saturating_add(1);
            }
        }
        kept
    }

    /// Moves the first `kept` orders, those of the others, back to the indices of their regions. The orders of the
    /// agent are taken from `own`, the last one first.
    pub(super) fn spread(
        &mut self,
        agent: usize,
        kept: usize,
        mut own: impl FnMut(&[RegionPrecedence<S>]) -> RegionPrecedence<S>,
    ) {
        let mut next = kept;
        for place in (0..self.ecm.len()).rev() {
            let orders = self.orders.as_mut();
            let order = if self.ecm.agents_at(place).is_some_and(|agents| agents.contains(&agent)) {
                own(orders)
            } else {
                next = next.saturating_sub(1);
                orders.get(next).copied().unwrap_or_default()
            };
            if let Some(room) = orders.get_mut(place) {
                *room = order;
            }
        }
    }
}

/// Whether the ego passes a region first or second: whether it is at a point inside the region before the other agent.
fn planned<S: Scalar>(region: &RegionRef<'_, S>) -> Option<PassingState> {
    let always = Interval::new(-S::LIMIT, S::LIMIT);
    region.inner_points().find_map(|[length, other_length]| {
        let own = times(region.ego_motion(), Interval::new(length, length), always)?;
        let their = times(region.other_motion(), Interval::new(other_length, other_length), always)?;
        if own.hi < their.lo {
            Some(PassingState::First)
        } else if their.hi < own.lo {
            Some(PassingState::Second)
        } else {
            None
        }
    })
}

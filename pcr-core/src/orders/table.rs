//! The table of orders: one for each region, in the same places.

use crate::ecm::{Ecm, Region};
use crate::error::{Full, Mismatch, Unchanged};
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::orders::hold::Hold;
use crate::orders::order::{Order, Pass, Progress};
use crate::orders::refused::Refused;
use crate::pieces::Piece;
use crate::query::{first_overlap, times};
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// The collision regions of a fleet, and who passes each of them first.
///
/// Every agent that keeps its [`Orders::hold`] never touches another one, however late whoever is; if [`Orders::check`] has
/// passed, everybody arrives (`docs/theory.md` has the proofs). Only paths and radii matter, not when the motions say an agent
/// is where, but for [`Orders::as_planned`]. As with [`Ecm`], the fleet is handed to each method, and another one is refused.
///
/// The storage is the caller's, as that of [`Ecm`]. There must be an [`Order`] a region; [`Orders::admit`] needs as
/// many more as its agent has regions.
///
/// A robot that has but its own row ([`Orders::fill_row`], and [`Orders::decide`] as it is told) computes its
/// own hold from that: it needs to know how far those before it have come, and nothing about clocks or speeds.
///
/// ```
/// use pcr_core::{Hold, Limits, Motion, Order, Orders, Pass, Path, Piece, Point, Pose, Profile, Progress, Radians, Region};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
///
/// // What robot 1 knows: its own row, and that robot 0 goes first.
/// let mut orders = Orders::new([Region::EMPTY; 4], [Piece::EMPTY; 4], [Order::EMPTY; 4]);
/// orders.fill_row(&fleet, 1)?;
/// orders.decide(&fleet, 1, 0, Pass::Second, 0.0)?;
/// let mut progress = [Progress::at_rest(0.0); 2];
/// assert!(matches!(orders.hold(&fleet, 1, &progress)?, Hold::At(hold) if (hold - 1.5).abs() < 1e-9));
/// progress[0] = Progress::at_rest(2.6);
/// assert_eq!(orders.hold(&fleet, 1, &progress)?, Hold::Free);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Orders<S, R, P, O> {
    pub(super) ecm: Ecm<S, R, P>,
    pub(super) orders: O,
}

#[cfg(feature = "defmt")]
impl<S: Scalar, R, P, O> defmt::Format for Orders<S, R, P, O> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "orders of a {}", self.ecm);
    }
}

impl<S: Scalar, R, P, O> Orders<S, R, P, O> {
    /// An empty table.
    pub const fn new(regions: R, pieces: P, orders: O) -> Self {
        Self { ecm: Ecm::new(regions, pieces), orders }
    }

    /// The regions.
    pub const fn ecm(&self) -> &Ecm<S, R, P> {
        &self.ecm
    }
}

impl<S, R, P, O> Orders<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[Region]>,
    P: AsRef<[Piece<S>]>,
    O: AsRef<[Order<S>]>,
{
    /// The places of an agent's regions in the table, their pairs and orders.
    pub(super) fn places(&self, agent: usize) -> impl Iterator<Item = (usize, [usize; 2], Order<S>)> {
        self.ecm.places(agent).map(|(place, agents)| (place, agents, self.order(place)))
    }

    /// All places with their pairs and orders.
    pub(super) fn all(&self) -> impl Iterator<Item = (usize, [usize; 2], Order<S>)> {
        (0..self.ecm.len()).filter_map(|place| Some((place, self.ecm.agents_at(place)?, self.order(place))))
    }

    pub(super) fn order(&self, place: usize) -> Order<S> {
        self.orders.as_ref().get(place).copied().unwrap_or_default()
    }

    /// The regions of an agent's row, their places in the table, and whether it passes them first. O(agents + regions).
    ///
    /// # Errors
    /// [`Mismatch`]: none is an answer.
    pub fn row<'a>(
        &'a self,
        fleet: &'a [Motion<'a, S>],
        agent: usize,
    ) -> Result<impl Iterator<Item = (usize, RegionRef<'a, S>, Pass)>, Mismatch> {
        self.ecm.holds(fleet, [agent, agent])?;
        Ok(self.places(agent).filter_map(move |(place, agents, order)| {
            Some((place, self.ecm.at(fleet, place, agent)?, order.pass_of(agent, agents)))
        }))
    }

    /// How far an agent may go, given what is known of the others: it has to brake so that it stays there, wherever it may be
    /// itself. Of those that pass first the lower end of the place counts; of an agent that nothing is known of, the
    /// start of its path. Old places give a hold that is too low, never one that is too high.
    ///
    /// It must not be asked with places on another path than that of `fleet`.
    ///
    /// Cost: O(agents + regions) to find the row, and that of [`RegionRef::hold`] for each region of it that may be the nearest.
    ///
    /// # Errors
    /// As [`Orders::row`].
    pub fn hold(&self, fleet: &[Motion<'_, S>], agent: usize, progress: &[Progress<S>]) -> Result<Hold<S>, Mismatch> {
        self.hold_before(fleet, agent, progress, Hold::Free)
    }

    /// The hold, or this other one if that leaves less way: regions that begin beyond it are not looked at. An agent that needs
    /// to know no more than whether it may go on for a while asks so.
    ///
    /// # Errors
    /// As [`Orders::row`].
    pub fn hold_before(
        &self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        progress: &[Progress<S>],
        other: Hold<S>,
    ) -> Result<Hold<S>, Mismatch> {
        self.nearest(fleet, agent, progress, other).map(|(hold, _)| hold)
    }

    /// The hold and the place of the region that it is before; none where it is `other`.
    pub(super) fn nearest(
        &self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        progress: &[Progress<S>],
        other: Hold<S>,
    ) -> Result<(Hold<S>, Option<usize>), Mismatch> {
        self.ecm.holds(fleet, [agent, agent])?;
        let (mut hold, mut nearest) = (other, None);
        for (place, agents, order) in self.places(agent) {
            let other = if agents[0] == agent { agents[1] } else { agents[0] };
            let first = progress.get(other).copied().unwrap_or_default().at.lo;
            let held = match order.pass_of(agent, agents) {
                Pass::First | Pass::Over => continue,
                Pass::Second if first > order.exit => continue,
                // It is held nowhere before the entry.
                Pass::Second if order.bounds_from_entry() && !hold.allows_beyond(order.entry) => continue,
                Pass::Second => self.ecm.at(fleet, place, agent).map(|region| region.hold(order.since, first)),
                Pass::Undecided => self.ecm.at(fleet, place, agent).map(|region| region.hold(S::ZERO, S::ZERO)),
            };
            let least = hold.min(held.unwrap_or(Hold::Inside));
            if least != hold {
                (hold, nearest) = (least, Some(place));
            }
        }
        Ok((hold, nearest))
    }
}

impl<S, R, P, O> Orders<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[Region]> + AsMut<[Region]>,
    P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
    O: AsRef<[Order<S>]> + AsMut<[Order<S>]>,
{
    /// The table of a whole fleet of at most 65535 agents, nothing decided. Cost: that of [`Ecm::build`].
    ///
    /// # Errors
    /// [`Full`] where the storage is too small.
    pub fn build(regions: R, pieces: P, orders: O, fleet: &[Motion<'_, S>]) -> Result<Self, Full> {
        let mut table = Self { ecm: Ecm::build(regions, pieces, fleet)?, orders };
        table.undecide().map(|()| table)
    }

    /// Becomes the table of a whole fleet, as [`Orders::build`], in the storage that it has.
    ///
    /// # Errors
    /// [`Full`] where the storage is too small; the table is then that of nobody.
    pub fn fill(&mut self, fleet: &[Motion<'_, S>]) -> Result<(), Full> {
        self.ecm.fill(fleet)?;
        self.undecide()
    }

    /// Becomes the table of one agent's row only, nothing decided, in the storage that it has: that agent asks it for its holds.
    /// Cost: that of [`Ecm::fill_row`].
    ///
    /// # Errors
    /// [`Full`] where the storage is too small; the table is then that of nobody.
    pub fn fill_row(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Full> {
        self.ecm.fill_row(fleet, agent)?;
        self.undecide()
    }

    /// Forgets all regions, orders and agents.
    pub fn clear(&mut self) {
        self.ecm.clear();
    }

    /// No order for any region.
    fn undecide(&mut self) -> Result<(), Full> {
        if let Some(orders) = self.orders.as_mut().get_mut(..self.ecm.len()) {
            orders.fill(Order::EMPTY);
            return Ok(());
        }
        self.ecm.clear();
        Err(Full::Orders)
    }

    /// Adds the regions of one agent with all others of the fleet, nothing decided, as [`Ecm::insert`].
    ///
    /// # Errors
    /// [`Full`] where the storage is too small, and [`Mismatch`]; the table is then as it was.
    pub fn insert(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Unchanged> {
        let kept = self.ecm.len();
        self.ecm.insert(fleet, agent)?;
        if self.ecm.len() > self.orders.as_ref().len() {
            self.ecm.remove(fleet, agent)?;
            return Err(Full::Orders.into());
        }
        self.spread(agent, kept, |_| Order::EMPTY);
        Ok(())
    }

    /// Removes one agent, its regions and their orders, as [`Ecm::remove`]. O(agents + regions).
    ///
    /// # Errors
    /// [`Mismatch`]; the table is then as it was.
    pub fn remove(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Mismatch> {
        self.ecm.holds_all(fleet)?;
        self.gather(agent, |_, _| {});
        self.ecm.remove(fleet, agent)
    }

    /// Removes one agent for good, its regions and their orders: those behind it move up by one number, as [`Ecm::erase`].
    /// O(agents + regions).
    ///
    /// # Errors
    /// [`Mismatch`]; the table is then as it was.
    pub fn erase(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Mismatch> {
        self.ecm.holds_all(fleet)?;
        self.gather(agent, |_, _| {});
        self.ecm.erase(fleet, agent)
    }

    /// Decides about all regions that `ego` and `other` have and that are not decided yet: whether the ego passes them first or
    /// second. `since` is the least length at which the second of the two is now \[m\]: what is behind it is passed.
    ///
    /// # Errors
    /// [`Mismatch`].
    pub fn decide(
        &mut self,
        fleet: &[Motion<'_, S>],
        ego: usize,
        other: usize,
        pass: Pass,
        since: S,
    ) -> Result<(), Mismatch> {
        self.ecm.holds(fleet, [ego, other])?;
        for place in 0..self.ecm.len() {
            let undecided = self.order(place).pass == Pass::Undecided;
            let agents = self.ecm.agents_at(place);
            if undecided && agents == Some([ego.min(other), ego.max(other)]) {
                self.set(fleet, place, ego, pass, since);
            }
        }
        Ok(())
    }

    /// The same for the region in one place of the table, of which `ego` is an agent, whether it is decided or not.
    ///
    /// It is not checked whether both can still keep it, nor whether everybody can finish: [`Orders::check`] does the latter.
    ///
    /// # Errors
    /// [`Mismatch`], also where there is no region of `ego` in the place.
    pub fn decide_at(
        &mut self,
        fleet: &[Motion<'_, S>],
        place: usize,
        ego: usize,
        pass: Pass,
        since: S,
    ) -> Result<(), Mismatch> {
        let agents = self.ecm.agents_at(place).filter(|agents| agents.contains(&ego));
        self.ecm.holds(fleet, agents.unwrap_or([ego, ego]))?;
        agents.ok_or(Mismatch::NoSuchRegion(place))?;
        self.set(fleet, place, ego, pass, since);
        Ok(())
    }

    fn set(&mut self, fleet: &[Motion<'_, S>], place: usize, ego: usize, pass: Pass, since: S) {
        let Some(region) = self.ecm.at(fleet, place, ego) else { return };
        if let Some(order) = self.orders.as_mut().get_mut(place) {
            *order = Order::new(&region, pass, since);
        }
    }

    /// Takes the orders in which the motions of the fleet pass their regions, those of a plan without collisions.
    /// Decisions that were made before are overwritten. Cost: that of [`first_overlap`] a region.
    ///
    /// # Errors
    /// [`Refused::Meeting`] for two that do more than touch, or pass so near that it cannot be told who is first;
    /// [`Refused::Mismatch`].
    pub fn as_planned(&mut self, fleet: &[Motion<'_, S>]) -> Result<(), Refused> {
        self.ecm.holds_all(fleet)?;
        for place in 0..self.ecm.len() {
            let Some([lower, higher]) = self.ecm.agents_at(place) else { continue };
            let Some(region) = self.ecm.at(fleet, place, lower) else { continue };
            let always = Interval::new(-S::LIMIT, S::LIMIT);
            let met = first_overlap(region.ego_motion(), core::iter::once(region.clone()), always).is_some();
            let pass = planned(&region).filter(|_| !met).ok_or(Refused::Meeting([lower, higher]))?;
            let order = Order::new(&region, pass, S::ZERO);
            if let Some(room) = self.orders.as_mut().get_mut(place) {
                *room = order;
            }
        }
        Ok(())
    }

    /// Drops the orders of regions that the first agent has left: they cost nothing any more. O(regions).
    pub fn passed(&mut self, progress: &[Progress<S>]) {
        for (place, order) in (0..self.ecm.len()).zip(self.orders.as_mut()) {
            let Some(agents) = self.ecm.agents_at(place) else { continue };
            let first = match order.pass {
                Pass::First => agents[0],
                Pass::Second => agents[1],
                Pass::Undecided | Pass::Over => continue,
            };
            if progress.get(first).is_some_and(|first| first.at.lo > order.exit) {
                order.pass = Pass::Over;
            }
        }
    }

    /// Moves the orders of all others together at the beginning; those of an agent are taken away. Returns how many
    /// there are of the others.
    pub(super) fn gather(&mut self, agent: usize, mut taken: impl FnMut(&mut [Order<S>], Order<S>)) -> usize {
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

    /// Puts the orders of the others, so many at the beginning, in the places of their regions, and what `own` says in those of
    /// an agent, the last one first.
    pub(super) fn spread(&mut self, agent: usize, kept: usize, mut own: impl FnMut(&[Order<S>]) -> Order<S>) {
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

/// Whether the ego of a region passes it first or second: at a point of it, whose time is earlier.
fn planned<S: Scalar>(region: &RegionRef<'_, S>) -> Option<Pass> {
    let always = Interval::new(-S::LIMIT, S::LIMIT);
    region.inner_points().find_map(|[length, other_length]| {
        let own = times(region.ego_motion(), Interval::new(length, length), always)?;
        let their = times(region.other_motion(), Interval::new(other_length, other_length), always)?;
        if own.hi < their.lo {
            Some(Pass::First)
        } else if their.hi < own.lo {
            Some(Pass::Second)
        } else {
            None
        }
    })
}

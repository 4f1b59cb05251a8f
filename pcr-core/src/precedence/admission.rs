//! Admission of a new path: chooses orders with which its agent can finish, and that keep no other agent from
//! finishing.
//!
//! For each region of the new path where both orders are possible, the caller says which agent goes first. If the
//! agent would then wait for ever, orders that keep an agent stuck are reversed, one after the other, each at most once.
//! If it can finish, it keeps no other agent from that: an agent goes first only in regions that it leaves. Choosing
//! orders is NP-hard in general. Hence a path that is refused may be possible, but one that is admitted is safe and free
//! of deadlock.

use crate::ecm::EcmEntry;
use crate::error::{CapacityError, EcmError, MismatchError};
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::precedence::deadlock_check::{CheckState, CheckTolerances};
use crate::precedence::entry::{PassingState, Progress, RegionPrecedence, other};
use crate::precedence::error::AdmissionError;
use crate::precedence::table::PrecedenceTable;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// A new path for an agent.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PathProposal<'a, S: Scalar> {
    /// The agent that gets the path.
    pub agent: usize,
    /// The path and the disc; the profile does not matter. The path begins where the agent is, or before that, and
    /// follows the old path at least up to the point where the agent can stop.
    pub motion: Motion<'a, S>,
    /// Where the agent is on the new path.
    pub progress: Progress<S>,
}

impl<S, R, P, O> PrecedenceTable<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[EcmEntry]> + AsMut<[EcmEntry]>,
    P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>,
    O: AsRef<[RegionPrecedence<S>]> + AsMut<[RegionPrecedence<S>]>,
{
    /// Gives an agent a new path and orders for all its regions, with which it can finish, and so can every agent that
    /// could if this one were not there. The orders between the other agents stay as they are. The path in `fleet` and the
    /// entry in `progress` are replaced.
    ///
    /// `prefer` is called for regions, whose ego is the agent, and says which one should go first: [`PassingState::First`] or
    /// [`PassingState::Second`]. Its answer is used if both orders are possible: the second agent must be able to stop before
    /// the region, and the first one to leave it. An agent that is in a region, or cannot stop before it, never loses
    /// its right to go on. The new orders can lower the hold of another agent, which must not have set out beyond the
    /// new hold. So places and stopping points (`Progress::stop`) must be current, or lengths that agents have promised
    /// not to exceed.
    ///
    /// Cost: that of [`Ecm::replace`](crate::Ecm::replace), two to four holds for each region of the row, and at most
    /// one check more than the row has regions.
    ///
    /// # Errors
    /// [`AdmissionError`], which names the agent in the way; everything is then unchanged, except in the rare case of
    /// [`Ecm::replace`](crate::Ecm::replace) in which the table is empty. Another path, or the same path later, may be
    /// admitted.
    ///
    /// ```
    /// use pcr_core::{
    ///     MovementAuthority, Limits, PathProposal, Motion, RegionPrecedence, PrecedenceTable, PassingState, Path, Piece, Point, Pose, Profile, Progress, Radians, CheckState,
    ///     AdmissionError, EcmEntry, CheckTolerances,
    /// };
    /// let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    /// let east = Path::<f64, 1>::starting_at(pose(-2.0, 0.0, 0.0))?.line(4.0)?;
    /// let north = Path::<f64, 1>::starting_at(pose(0.0, -2.0, core::f64::consts::FRAC_PI_2))?.line(4.0)?;
    /// let (waiting, standing) = (Path::<f64, 1>::starting_at(pose(0.0, -2.0, 0.0))?, Profile::<f64, 1>::standing());
    /// let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    /// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
    ///
    /// let mut fleet = [motion(east.as_path())?, Motion::new(waiting.as_path(), standing.as_profile(), 0.25, 0.0)?];
    /// let mut progress = [Progress::at_rest(0.0); 2];
    /// let mut orders = PrecedenceTable::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], [RegionPrecedence::EMPTY; 8], &fleet)?;
    /// let (tolerances, mut reaches) = (CheckTolerances { width: 0.01, gain: 0.001 }, [CheckState::EMPTY; 2]);
    /// let mission = PathProposal { agent: 1, motion: motion(north.as_path())?, progress: Progress::at_rest(0.0) };
    /// orders.admit(&mut fleet, &mut progress, mission, tolerances, &mut reaches, |_| PassingState::Second)?;
    /// assert!(matches!(orders.hold(&fleet, 1, &progress)?, MovementAuthority::At(hold) if (hold - 1.5).abs() < 1e-9));
    /// assert_eq!(orders.hold(&fleet, 0, &progress)?, MovementAuthority::Free);
    ///
    /// // An agent that stands on the crossing is in the way for good.
    /// let stands = Path::<f64, 1>::starting_at(pose(0.0, 0.0, 0.0))?;
    /// fleet[0] = Motion::new(stands.as_path(), standing.as_profile(), 0.25, 0.0)?;
    /// progress[0] = Progress::at_rest(0.0);
    /// let mut orders = PrecedenceTable::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], [RegionPrecedence::EMPTY; 8], &fleet)?;
    /// let refused = orders.admit(&mut fleet, &mut progress, mission, tolerances, &mut reaches, |_| PassingState::First);
    /// assert_eq!(refused, Err(AdmissionError::Blocked { agent: 1, by: 0 }));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn admit<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        progress: &mut [Progress<S>],
        mission: PathProposal<'m, S>,
        tolerances: CheckTolerances<S>,
        reaches: &mut [CheckState<S>],
        prefer: impl FnMut(&RegionRef<'_, S>) -> PassingState,
    ) -> Result<(), AdmissionError> {
        let PathProposal { agent, motion, progress: own } = mission;
        let tolerances = tolerances.limited();
        self.ecm.holds_all(fleet)?;
        let (Some(&before), Some(place)) = (fleet.get(agent), progress.get_mut(agent)) else {
            return Err(MismatchError::NoSuchAgent(agent).into());
        };
        let stood = core::mem::replace(place, own);
        let replaced = self.exchange(fleet, agent, motion).map_err(AdmissionError::from);
        let admitted = replaced.and_then(|saved| {
            let chosen = self.choose(fleet, progress, agent, tolerances.width, prefer);
            let found = chosen.and_then(|()| self.repair(fleet, progress, agent, tolerances, reaches));
            if found.is_err() {
                self.restore(fleet, agent, before, saved)?;
            }
            found
        });
        if admitted.is_err()
            && let Some(place) = progress.get_mut(agent)
        {
            *place = stood;
        }
        admitted
    }

    /// Replaces the path of an agent and leaves all its regions undecided. The orders between the other agents stay as
    /// they are. Like [`PrecedenceTable::admit`], it needs room for as many additional orders as the agent has regions.
    ///
    /// # Errors
    /// [`CapacityError`] and [`MismatchError`]; everything is then unchanged, except in the rare case of
    /// [`Ecm::replace`](crate::Ecm::replace) in which the table is empty.
    pub fn replace<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<(), EcmError> {
        self.ecm.holds_all(fleet)?;
        self.exchange(fleet, agent, motion).map(drop)
    }

    /// Replaces the path. The old orders of the agent are kept at the end of the storage, the last one first. Returns
    /// the number of these orders.
    fn exchange<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<usize, EcmError> {
        let saved = self.places(agent).fold(0_usize, |count, _| count.saturating_add(1));
        let room = self.orders.as_ref().len().saturating_sub(saved);
        let Some(&before) = fleet.get(agent) else { return Err(MismatchError::NoSuchAgent(agent).into()) };
        if self.ecm.len() > room {
            return Err(CapacityError::Orders.into());
        }
        let mut last = self.orders.as_ref().len();
        let kept = self.gather(agent, |orders, order| {
            last = last.saturating_sub(1);
            if let Some(place) = orders.get_mut(last) {
                *place = order;
            }
        });
        let replaced = self.ecm.replace(fleet, agent, motion);
        if replaced.is_ok() && self.ecm.len() <= room {
            self.spread(agent, kept, |_| RegionPrecedence::EMPTY);
            return Ok(saved);
        }
        if replaced.is_ok() {
            self.put_back(fleet, agent, before)?;
        }
        self.spread_saved(agent, kept, saved);
        replaced?;
        Err(CapacityError::Orders.into())
    }

    /// Undoes an exchange.
    fn restore<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        before: Motion<'m, S>,
        saved: usize,
    ) -> Result<(), AdmissionError> {
        let kept = self.gather(agent, |_, _| {});
        self.put_back(fleet, agent, before)?;
        self.spread_saved(agent, kept, saved);
        Ok(())
    }

    /// Gives an agent the motion from before. Its regions fit, as they did before. If they did not, the
    /// table would be empty: it must not answer with what it does not have.
    fn put_back<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        before: Motion<'m, S>,
    ) -> Result<(), EcmError> {
        let outcome = self.ecm.replace(fleet, agent, before);
        if outcome.is_err() {
            self.ecm.clear();
            if let Some(place) = fleet.get_mut(agent) {
                *place = before;
            }
        }
        outcome
    }

    fn spread_saved(&mut self, agent: usize, kept: usize, saved: usize) {
        let mut next = self.orders.as_ref().len().saturating_sub(saved);
        self.spread(agent, kept, |orders| {
            let order = orders.get(next).copied().unwrap_or_default();
            next = next.saturating_add(1);
            order
        });
    }

    /// Chooses orders for all regions of an agent: the preferred ones where both are possible.
    fn choose(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        agent: usize,
        width: S,
        mut prefer: impl FnMut(&RegionRef<'_, S>) -> PassingState,
    ) -> Result<(), AdmissionError> {
        for (place, order) in (0..self.ecm.len()).zip(self.orders.as_mut()) {
            if !self.ecm.agents_at(place).is_some_and(|agents| agents.contains(&agent)) {
                continue;
            }
            let Some(region) = self.ecm.at(fleet, place, agent) else { continue };
            let by = region.other();
            let [own, their] = [agent, by].map(|agent| Progress::of(progress, agent));
            if region.is_over(progress) {
                *order = RegionPrecedence::new(&region, PassingState::Over, S::ZERO);
                continue;
            }
            let second = can_wait(&region, &own, &their, width);
            let first = can_wait(&region.clone().swapped(), &their, &own, width);
            let (pass, open) = match (first, second) {
                (true, true) => (prefer(&region), true),
                (true, false) => (PassingState::First, false),
                (false, true) => (PassingState::Second, false),
                (false, false) => return Err(AdmissionError::Blocked { agent, by }),
            };
            let pass = if pass == PassingState::First { PassingState::First } else { PassingState::Second };
            *order = with_room(&region, pass, open, &own, &their);
        }
        Ok(())
    }

    /// Checks the orders, and reverses some orders of the agent while it would wait for ever.
    fn repair(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        agent: usize,
        tolerances: CheckTolerances<S>,
        reaches: &mut [CheckState<S>],
    ) -> Result<(), AdmissionError> {
        loop {
            let found = self.check(fleet, progress, tolerances, reaches);
            let reach = reaches.get(agent).copied().unwrap_or_default();
            if !matches!(found, Err(AdmissionError::Stuck { .. })) {
                return found;
            }
            if !reach.is_stuck() {
                // The agent arrives, so it is in no other agent's way: agents that are stuck would be stuck without it.
                return Ok(());
            }
            let Some(place) = self.culprit(agent, tolerances.gain, reaches) else {
                return Err(self.stuck(agent, reach));
            };
            self.turn(fleet, progress, agent, place);
        }
    }

    /// An order of the agent that keeps some agent stuck and can be reversed: preferably one where the agent goes
    /// first, otherwise one where it is stuck itself.
    fn culprit(&self, agent: usize, gain: S, reaches: &[CheckState<S>]) -> Option<usize> {
        let holds = |pass: PassingState| {
            self.places(agent).find_map(|(place, agents, order)| {
                let held = if pass == PassingState::First { other(agents, agent) } else { agent };
                let held = reaches.get(held).filter(|reach| reach.is_stuck())?;
                let counts = order.open && order.pass_of(agent, agents) == pass && order.hold <= held.at + gain;
                counts.then_some(place)
            })
        };
        holds(PassingState::First).or_else(|| holds(PassingState::Second))
    }

    fn turn(&mut self, fleet: &[Motion<'_, S>], progress: &[Progress<S>], agent: usize, place: usize) {
        let Some(region) = self.ecm.at(fleet, place, agent) else { return };
        let [own, their] = [agent, region.other()].map(|agent| Progress::of(progress, agent));
        if let (Some(order), Some(agents)) = (self.orders.as_mut().get_mut(place), self.ecm.agents_at(place)) {
            *order = with_room(&region, order.pass_of(agent, agents).swapped(), false, &own, &their);
        }
    }
}

/// The order of a region whose ego is first or second, counted from where both agents are now.
fn with_room<S: Scalar>(
    region: &RegionRef<'_, S>,
    pass: PassingState,
    open: bool,
    own: &Progress<S>,
    their: &Progress<S>,
) -> RegionPrecedence<S> {
    let since = if pass == PassingState::First { their.at.lo } else { own.at.lo };
    RegionPrecedence { open, ..RegionPrecedence::new(region, pass, since) }
}

/// Whether the ego of a region can let the other agent go first: it can stop before the part that the other one has
/// still to pass, and its path does not lead into a part that the other one never leaves.
fn can_wait<S: Scalar>(region: &RegionRef<'_, S>, own: &Progress<S>, their: &Progress<S>, width: S) -> bool {
    if !region.hold(own.at.lo, their.at.lo).allows(own.furthest()) {
        return false;
    }
    let other_end = region.other_motion().path().length();
    let last = (other_end - width).max(their.at.lo).min(other_end);
    region.hold(own.at.lo, last).allows(region.ego_motion().path().length())
}

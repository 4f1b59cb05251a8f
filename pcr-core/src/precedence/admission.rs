//! Admission of new paths: chooses orders with which their agents can finish, and that keep no other agent from
//! finishing.
//!
//! For each region of a new path where both orders are possible, the caller says which agent goes first. If an
//! agent with a new path would then wait for ever, orders that keep an agent stuck are reversed, one after the other,
//! each at most once. If it can finish, it keeps no other agent from that: an agent goes first only in regions that it
//! leaves. Choosing orders is NP-hard in general. Hence paths that are refused may be possible, but those that are
//! admitted are safe and free of deadlock.
//!
//! Paths of several agents are admitted together or not at all: all of them are exchanged before any order is chosen, so
//! each agent may end where another one stands that goes on (docs/theory/joint.md).

use crate::ecm::EcmEntry;
use crate::error::{EcmError, MismatchError};
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

impl<S: Scalar> PathProposal<'_, S> {
    /// Exchanges its progress for the one that is stored for its agent.
    fn exchange_progress(&mut self, progress: &mut [Progress<S>]) {
        if let Some(place) = progress.get_mut(self.agent) {
            core::mem::swap(place, &mut self.progress);
        }
    }
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
        self.admit_all(fleet, progress, &mut [mission], tolerances, reaches, prefer)
    }

    /// Gives several agents new paths at once, or none of them: agents that move up together, each to where the next one
    /// stands. With the orders that are chosen all of them can finish, and so can every agent that could if they were not
    /// there. The orders between all other agents stay as they are.
    ///
    /// The paths in `fleet`, the entries in `progress` and those in `proposals` are exchanged, so `proposals` has what the
    /// agents had before; on an error all three are as they were. `prefer` is called as by [`PrecedenceTable::admit`]. The ego of
    /// a region of two agents with new paths is the one that comes first in `proposals`.
    ///
    /// Agents that follow one another around a circle gain little in each sweep of the check. A coarse
    /// [`CheckTolerances::gain`] therefore refuses circles that are nearly full.
    ///
    /// Storage: as many additional orders as the agents have regions with their old paths. Cost: that of
    /// [`Ecm::replace`](crate::Ecm::replace) for each path, two to four holds for each region of the new paths, and at most one check
    /// more than these have regions.
    ///
    /// # Errors
    /// As [`PrecedenceTable::admit`], and [`AdmissionError::Repeated`] for two paths of one agent.
    ///
    /// ```
    /// use pcr_core::{
    ///     AdmissionError, CheckState, CheckTolerances, EcmEntry, Limits, Motion, PassingState, Path, PathProposal, Piece, Point, Pose,
    ///     PrecedenceTable, Profile, Progress, Radians, RegionPrecedence,
    /// };
    /// // Three robots stand at the corners of a triangle of 4 m, and each is to go to the next corner.
    /// let corners = [(0.0, 0.0), (4.0, 0.0), (2.0, 3.464)];
    /// let side = |k: usize| {
    ///     let heading = Radians(k as f64 * core::f64::consts::TAU / 3.0);
    ///     Path::<f64, 1>::starting_at(Pose { position: Point::new(corners[k].0, corners[k].1), heading })
    /// };
    /// let stands = [side(0)?, side(1)?, side(2)?];
    /// let sides = [side(0)?.line(4.0)?, side(1)?.line(4.0)?, side(2)?.line(4.0)?];
    /// let standing = Profile::<f64, 1>::standing();
    /// let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    /// let stand = |k: usize| Motion::new(stands[k].as_path(), standing.as_profile(), 0.25, 0.0);
    /// let motion = |k: usize| Motion::new(sides[k].as_path(), profile.as_profile(), 0.25, 0.0);
    /// let mission = |agent| Ok::<_, pcr_core::InvalidInput>(PathProposal { agent, motion: motion(agent)?, progress: Progress::at_rest(0.0) });
    ///
    /// let mut fleet = [stand(0)?, stand(1)?, stand(2)?];
    /// let mut progress = [Progress::at_rest(0.0); 3];
    /// let mut orders = PrecedenceTable::build([EcmEntry::EMPTY; 8], [Piece::EMPTY; 16], [RegionPrecedence::EMPTY; 16], &fleet)?;
    /// let (tolerances, mut reaches) = (CheckTolerances { width: 0.01, gain: 0.001 }, [CheckState::EMPTY; 3]);
    /// // None of them can go alone, but all of them together.
    /// let alone = orders.admit(&mut fleet, &mut progress, mission(0)?, tolerances, &mut reaches, |_| PassingState::First);
    /// assert_eq!(alone, Err(AdmissionError::Blocked { agent: 0, by: 1 }));
    /// let mut all = [mission(0)?, mission(1)?, mission(2)?];
    /// orders.admit_all(&mut fleet, &mut progress, &mut all, tolerances, &mut reaches, |_| PassingState::First)?;
    /// assert_eq!(fleet[2].path().length(), 4.0);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn admit_all<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        progress: &mut [Progress<S>],
        proposals: &mut [PathProposal<'m, S>],
        tolerances: CheckTolerances<S>,
        reaches: &mut [CheckState<S>],
        mut prefer: impl FnMut(&RegionRef<'_, S>) -> PassingState,
    ) -> Result<(), AdmissionError> {
        let tolerances = tolerances.limited();
        self.ecm.holds_all(fleet)?;
        for (count, &PathProposal { agent, .. }) in (0..proposals.len()).zip(&*proposals) {
            if agent >= fleet.len().min(progress.len()) {
                return Err(MismatchError::NoSuchAgent(agent).into());
            }
            if proposals.iter().take(count).any(|earlier| earlier.agent == agent) {
                return Err(AdmissionError::Repeated(agent));
            }
        }
        let (mut exchanged, mut low) = (0_usize, self.orders.as_ref().len());
        let mut found = Ok(());
        for proposal in proposals.iter_mut() {
            let Some(&before) = fleet.get(proposal.agent) else { break };
            match self.exchange(fleet, proposal.agent, proposal.motion, low) {
                Ok(saved) => {
                    (exchanged, low) = (exchanged.saturating_add(1), low.saturating_sub(saved));
                    proposal.motion = before;
                    proposal.exchange_progress(progress);
                }
                Err(error) => {
                    found = Err(error.into());
                    break;
                }
            }
        }
        for (count, proposal) in (0..proposals.len()).zip(&*proposals) {
            let earlier = |other: usize| proposals.iter().take(count).any(|earlier| earlier.agent == other);
            found = found
                .and_then(|()| self.choose(fleet, progress, proposal.agent, tolerances.width, earlier, &mut prefer));
        }
        found = found.and_then(|()| self.repair(fleet, progress, proposals, tolerances, reaches));
        if found.is_err() {
            let mut restored = Ok(());
            for proposal in proposals.iter_mut().take(exchanged).rev() {
                let Some(place) = fleet.get_mut(proposal.agent) else { continue };
                let (before, motion) = (proposal.motion, *place);
                match restored {
                    Ok(()) => restored = self.restore(fleet, proposal.agent, before, &mut low),
                    // The table is empty.
                    Err(_) => *place = before,
                }
                proposal.motion = motion;
                proposal.exchange_progress(progress);
            }
            restored?;
        }
        found
    }

    /// Gives an agent a new path, or the first of `shorter` that can be admitted: beginnings of the path, the longest first,
    /// each up to a place where the agent can stand, for example behind one that stands on its way. Returns the number of
    /// paths that were refused before: 0 if the whole path was admitted.
    ///
    /// The path that is granted keeps what [`PrecedenceTable::admit`] promises: the agent gets to its end, and no other agent is
    /// kept from its own. Whether the agent gets further from there depends on the site (docs/theory/joint.md).
    ///
    /// Storage: that of [`PrecedenceTable::admit`]. Cost: that of [`PrecedenceTable::admit`] for each path that is tried.
    ///
    /// # Errors
    /// As [`PrecedenceTable::admit`], with the reason why the whole path was refused; everything is then unchanged.
    ///
    /// ```
    /// use pcr_core::{
    ///     CheckState, CheckTolerances, EcmEntry, Limits, Motion, PassingState, Path, PathProposal, Piece, Point, Pose, PrecedenceTable,
    ///     Profile, Progress, Radians, RegionPrecedence,
    /// };
    /// let at = |x| Pose { position: Point::new(x, 0.0), heading: Radians(0.0) };
    /// // A lane with places at 0, 2, 4 and 6 m; another robot stands at 4 m.
    /// let lane = Path::<f64, 3>::starting_at(at(0.0))?.line(2.0)?.line(2.0)?.line(2.0)?;
    /// let (short, waits, stands) = (Path::<f64, 1>::starting_at(at(0.0))?.line(2.0)?, Path::<f64, 1>::starting_at(at(0.0))?, Path::<f64, 1>::starting_at(at(4.0))?);
    /// let (standing, limits) = (Profile::<f64, 1>::standing(), Limits { speed: 1.0, acceleration: 1.0 });
    /// let (whole, first) = (Profile::rest_to_rest(6.0, limits)?, Profile::rest_to_rest(2.0, limits)?);
    /// let mut fleet =
    ///     [Motion::new(waits.as_path(), standing.as_profile(), 0.25, 0.0)?, Motion::new(stands.as_path(), standing.as_profile(), 0.25, 0.0)?];
    /// let mut progress = [Progress::at_rest(0.0); 2];
    /// let mut orders = PrecedenceTable::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 8], [RegionPrecedence::EMPTY; 8], &fleet)?;
    /// let mission = PathProposal { agent: 0, motion: Motion::new(lane.as_path(), whole.as_profile(), 0.25, 0.0)?, progress: progress[0] };
    /// let shorter = [Motion::new(short.as_path(), first.as_profile(), 0.25, 0.0)?];
    /// let (tolerances, mut reaches) = (CheckTolerances { width: 0.01, gain: 0.001 }, [CheckState::EMPTY; 2]);
    /// let granted = orders.admit_longest(&mut fleet, &mut progress, mission, &shorter, tolerances, &mut reaches, |_| PassingState::Second)?;
    /// assert_eq!((granted, fleet[0].path().length()), (1, 2.0));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[expect(clippy::too_many_arguments, reason = "the storage and the fleet belong to the caller")]
    pub fn admit_longest<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        progress: &mut [Progress<S>],
        mission: PathProposal<'m, S>,
        shorter: &[Motion<'m, S>],
        tolerances: CheckTolerances<S>,
        reaches: &mut [CheckState<S>],
        mut prefer: impl FnMut(&RegionRef<'_, S>) -> PassingState,
    ) -> Result<usize, AdmissionError> {
        let mut refused = None;
        for (count, &motion) in (0..=shorter.len()).zip(core::iter::once(&mission.motion).chain(shorter)) {
            let part = PathProposal { motion, ..mission };
            match self.admit(fleet, progress, part, tolerances, reaches, &mut prefer) {
                Ok(()) => return Ok(count),
                Err(
                    error @ (AdmissionError::Blocked { .. }
                    | AdmissionError::Stuck { .. }
                    | AdmissionError::Late { .. }),
                ) => refused = refused.or(Some(error)),
                Err(error) => return Err(error),
            }
        }
        Err(refused.unwrap_or(MismatchError::NoSuchAgent(mission.agent).into()))
    }

    /// Replaces the path of an agent and leaves all its regions undecided. The orders between the other agents stay as
    /// they are. Like [`PrecedenceTable::admit`], it needs room for as many additional orders as the agent has regions.
    ///
    /// # Errors
    /// [`CapacityError`](crate::CapacityError) and [`MismatchError`]; everything is then unchanged, except in the rare case of
    /// [`Ecm::replace`](crate::Ecm::replace) in which the table is empty.
    pub fn replace<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<(), EcmError> {
        self.ecm.holds_all(fleet)?;
        let end = self.orders.as_ref().len();
        self.exchange(fleet, agent, motion, end).map(drop)
    }

    /// Replaces the path. The old orders of the agent are kept in the storage before `end`, the last one first. Returns
    /// the number of these orders.
    fn exchange<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
        end: usize,
    ) -> Result<usize, EcmError> {
        let saved = self.count(agent);
        let room = end.saturating_sub(saved);
        let Some(&before) = fleet.get(agent) else { return Err(MismatchError::NoSuchAgent(agent).into()) };
        // The orders behind `end` are in use, too.
        let others = self.orders.as_ref().len().saturating_sub(room);
        if self.ecm.len() > room {
            return Err(self.lacks_orders(self.ecm.len().saturating_add(others)).into());
        }
        let mut last = end;
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
        let full = self.lacks_orders(self.ecm.len().saturating_add(others));
        if replaced.is_ok() {
            self.put_back(fleet, agent, before)?;
        }
        self.spread_saved(agent, kept, room);
        replaced?;
        Err(full.into())
    }

    /// The number of regions of an agent.
    fn count(&self, agent: usize) -> usize {
        self.places(agent).fold(0_usize, |count, _| count.saturating_add(1))
    }

    /// Undoes the last exchange, whose old orders are kept from `low` on. `low` is then where those of the exchange before it
    /// are kept: an agent has as many regions as it had before.
    fn restore<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        before: Motion<'m, S>,
        low: &mut usize,
    ) -> Result<(), AdmissionError> {
        let kept = self.gather(agent, |_, _| {});
        self.put_back(fleet, agent, before)?;
        self.spread_saved(agent, kept, *low);
        *low = low.saturating_add(self.count(agent));
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

    /// Moves orders to the indices of their regions. Those of the agent are kept from `next` on.
    fn spread_saved(&mut self, agent: usize, kept: usize, mut next: usize) {
        self.spread(agent, kept, |orders| {
            let order = orders.get(next).copied().unwrap_or_default();
            next = next.saturating_add(1);
            order
        });
    }

    /// Chooses orders for all regions of an agent but those with `earlier` agents: the preferred ones where both are possible.
    fn choose(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        agent: usize,
        width: S,
        earlier: impl Fn(usize) -> bool,
        prefer: &mut impl FnMut(&RegionRef<'_, S>) -> PassingState,
    ) -> Result<(), AdmissionError> {
        for (place, order) in (0..self.ecm.len()).zip(self.orders.as_mut()) {
            if !self.ecm.agents_at(place).is_some_and(|agents| agents.contains(&agent)) {
                continue;
            }
            let Some(region) = self.ecm.at(fleet, place, agent) else { continue };
            let by = region.other();
            if earlier(by) {
                continue;
            }
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

    /// Checks the orders, and reverses some orders of the agents with new paths while one of these would wait for ever.
    fn repair(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        proposals: &[PathProposal<'_, S>],
        tolerances: CheckTolerances<S>,
        reaches: &mut [CheckState<S>],
    ) -> Result<(), AdmissionError> {
        loop {
            let found = self.check(fleet, progress, tolerances, reaches);
            if !matches!(found, Err(AdmissionError::Stuck { .. })) {
                return found;
            }
            let reach = |agent: usize| reaches.get(agent).copied().unwrap_or_default();
            let Some(PathProposal { agent: stuck, .. }) = proposals.iter().find(|it| reach(it.agent).is_stuck()) else {
                // They all arrive, so they are in no other agent's way: agents that are stuck would be stuck without them.
                return Ok(());
            };
            let Some((agent, place)) = self.culprit(proposals, tolerances.gain, reaches) else {
                return Err(self.stuck(*stuck, reach(*stuck)));
            };
            self.turn(fleet, progress, agent, place);
        }
    }

    /// An order of an agent with a new path that keeps some agent stuck and can be reversed: preferably one where the agent
    /// with the new path goes first, otherwise one where it is stuck itself.
    fn culprit(&self, proposals: &[PathProposal<'_, S>], gain: S, reaches: &[CheckState<S>]) -> Option<(usize, usize)> {
        let holds = |agent: usize, pass: PassingState| {
            self.places(agent).find_map(|(place, agents, order)| {
                let held = if pass == PassingState::First { other(agents, agent) } else { agent };
                let held = reaches.get(held).filter(|reach| reach.is_stuck())?;
                let counts = order.open && order.pass_of(agent, agents) == pass && order.hold <= held.at + gain;
                counts.then_some((agent, place))
            })
        };
        let of = |pass: PassingState| proposals.iter().find_map(|it| holds(it.agent, pass));
        of(PassingState::First).or_else(|| of(PassingState::Second))
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

//! A fleet in the memory of the caller, in safe Rust.

use super::number::{S, angle, inner};
use super::types::{PcrAgent, PcrMemory};
use crate::memory::{Arena, Stack, both, values};
use crate::status::{PCR_LEFT, PCR_LINE, PCR_RIGHT, PcrStatus, given};
use pcr_core::{
    AdmissionError, CapacityError, CheckState, CheckTolerances, Ecm, EcmEntry, EcmError, Interval, Limits,
    MismatchError, Motion, PassingState, PathProposal, PathRef, Phase, Piece, PlanError, Point, Pose, PrecedenceTable,
    Profile, ProfileRef, Progress, RegionPrecedence, RegionRef, Scalar, Segment, TurnSide, excess, plan_delays,
};

/// The table of regions of a fleet, in the memory of the caller.
pub(super) type Regions = Ecm<S, &'static mut [EcmEntry], &'static mut [Piece<S>]>;
/// The same, with orders.
pub(super) type Ordered =
    PrecedenceTable<S, &'static mut [EcmEntry], &'static mut [Piece<S>], &'static mut [RegionPrecedence<S>]>;

/// The table of a fleet; it has orders if there is memory for them.
enum Table {
    Regions(Regions),
    Ordered(Ordered),
}

impl Table {
    fn fill(&mut self, fleet: &[Motion<'static, S>]) -> Result<(), CapacityError> {
        match self {
            Self::Regions(table) => table.fill(fleet),
            Self::Ordered(table) => table.fill(fleet),
        }
    }

    fn fill_row(&mut self, fleet: &[Motion<'static, S>], agent: usize) -> Result<(), EcmError> {
        match self {
            Self::Regions(table) => table.fill_row(fleet, agent),
            Self::Ordered(table) => table.fill_row(fleet, agent),
        }
    }

    fn replace(
        &mut self,
        fleet: &mut [Motion<'static, S>],
        agent: usize,
        motion: Motion<'static, S>,
    ) -> Result<(), EcmError> {
        match self {
            Self::Regions(table) => table.replace(fleet, agent, motion),
            Self::Ordered(table) => table.replace(fleet, agent, motion),
        }
    }

    fn erase(&mut self, fleet: &[Motion<'static, S>], agent: usize) -> Result<(), MismatchError> {
        match self {
            Self::Regions(table) => table.erase(fleet, agent),
            Self::Ordered(table) => table.erase(fleet, agent),
        }
    }

    /// Empties a table that does not belong to the fleet any more. A later fleet may have the same paths again, but its
    /// agents are not where those were whose orders it has.
    fn clear(&mut self) {
        match self {
            Self::Regions(table) => table.clear(),
            Self::Ordered(table) => table.clear(),
        }
    }
}

/// Agents, and the table of their regions.
pub(crate) struct Fleet {
    /// Segments of all agents, without gaps, in the order of the agents.
    segments: Arena<Segment<S>>,
    phases: Arena<Phase<S>>,
    motions: Stack<Motion<'static, S>>,
    table: Table,
    /// Progress of the agents, and room for a check: as many entries as motions, or none without orders.
    progress: Stack<Progress<S>>,
    reaches: &'static mut [CheckState<S>],
}

impl Fleet {
    pub(super) fn new(memory: &PcrMemory) -> Result<Self, PcrStatus> {
        let zero = S::ZERO;
        let origin = Segment::standing(Pose { position: Point::new(zero, zero), heading: angle(Default::default()) })?;
        let rest = Phase::starting_at(zero, zero, zero)?;
        let segments = given(Stack::new(memory.segments, memory.segment_count))?;
        let phases = given(Stack::new(memory.phases, memory.phase_count))?;
        let motions = given(Stack::new(memory.motions, memory.motion_count))?;
        let entries = given(Stack::new(memory.entries, memory.entry_count))?;
        let pieces = given(Stack::new(memory.pieces, memory.piece_count))?;
        let orders = given(Stack::new(memory.orders, memory.order_count))?;
        let robots = if memory.order_count == 0 { 0 } else { memory.motion_count };
        let (progress, reaches) = given(both(memory.robots, robots))?;
        // Nothing is refused from here on: a fleet that has this memory already is overwritten only now.
        let (entries, pieces) = (entries.filled(EcmEntry::EMPTY), pieces.filled(Piece::EMPTY));
        let table = if memory.order_count == 0 {
            Table::Regions(Ecm::new(entries, pieces))
        } else {
            Table::Ordered(PrecedenceTable::new(entries, pieces, orders.filled(RegionPrecedence::EMPTY)))
        };
        let reaches = reaches.filled(CheckState::EMPTY);
        let (segments, phases) = (Arena::new(segments, origin), Arena::new(phases, rest));
        Ok(Self { segments, phases, motions, table, progress, reaches })
    }

    pub(super) fn motions(&self) -> &[Motion<'static, S>] {
        self.motions.values()
    }

    /// Two agents, not one and the same.
    pub(super) fn two(&self, ego: usize, other: usize) -> Result<[&Motion<'static, S>; 2], PcrStatus> {
        if ego == other { Err(PcrStatus::NoSuchAgent) } else { Ok([self.motion(ego)?, self.motion(other)?]) }
    }

    pub(super) fn motion(&self, agent: usize) -> Result<&Motion<'static, S>, PcrStatus> {
        self.motions().get(agent).ok_or(PcrStatus::NoSuchAgent)
    }

    pub(super) fn table(&self) -> &Regions {
        match &self.table {
            Table::Regions(table) => table,
            Table::Ordered(table) => table.ecm(),
        }
    }

    /// The orders, and the progress of all agents.
    pub(super) fn ordered(&self) -> Result<(&Ordered, &[Progress<S>]), PcrStatus> {
        match &self.table {
            Table::Regions(_) => Err(PcrStatus::NoOrders),
            Table::Ordered(table) => Ok((table, self.progress.values())),
        }
    }

    /// The same, mutable, with the motions and room for a check.
    pub(super) fn ordered_mut(&mut self) -> Result<OrderedMut<'_>, PcrStatus> {
        match &mut self.table {
            Table::Regions(_) => Err(PcrStatus::NoOrders),
            Table::Ordered(orders) => Ok(OrderedMut {
                orders,
                motions: self.motions.values_mut(),
                progress: self.progress.values_mut(),
                reaches: self.reaches,
            }),
        }
    }

    /// The interval from the first start to the last arrival.
    pub(super) fn duration(&self) -> Interval<S> {
        Motion::span(self.motions())
    }

    pub(super) fn add(&mut self, agent: &PcrAgent) -> Result<(), PcrStatus> {
        let motion = self.placed(agent)?;
        if !self.motions.push(motion) {
            return Err(PcrStatus::NoRoom);
        }
        // There are as many entries as motions; none without orders.
        let _ = self.progress.push(Progress::default());
        self.take(&motion);
        Ok(())
    }

    /// Builds the motion of an agent in free memory. The caller takes that memory once nothing can fail any more.
    fn placed(&mut self, agent: &PcrAgent) -> Result<Motion<'static, S>, PcrStatus> {
        let segments = place(agent, self.segments.free())?;
        let path = PathRef::new(self.segments.next(segments))?;
        let phases = profile(agent, path.length(), self.phases.free())?;
        Ok(Motion::new(path, ProfileRef::new(self.phases.next(phases))?, inner(agent.radius), inner(agent.start))?)
    }

    fn take(&mut self, motion: &Motion<'static, S>) {
        self.segments.take(motion.path().segments().len());
        self.phases.take(motion.profile().phases().len());
    }

    /// Replaces an agent. If the table of all pairs was built, it is so afterwards.
    pub(super) fn replace(&mut self, index: usize, agent: &PcrAgent) -> Result<(), PcrStatus> {
        let before = *self.motion(index)?;
        let motion = self.placed(agent)?;
        match self.table.replace(self.motions.values_mut(), index, motion) {
            Err(EcmError::Full(full)) => return Err(full.into()),
            Ok(()) => {}
            // The table was not built before, or has one row only, which does not belong to the new fleet.
            Err(_) => {
                *self.motions.get_mut(index).ok_or(PcrStatus::NoSuchAgent)? = motion;
                self.table.clear();
            }
        }
        if let Some(progress) = self.progress.get_mut(index) {
            *progress = Progress::default();
        }
        self.take(&motion);
        self.close(&before)
    }

    /// Gives an agent a new path with orders, like [`PrecedenceTable::admit`].
    pub(super) fn admit(
        &mut self,
        agent: usize,
        by: &PcrAgent,
        progress: Progress<S>,
        tolerances: CheckTolerances<S>,
        prefer: impl FnMut(&RegionRef<'_, S>) -> PassingState,
    ) -> Result<(), (PcrStatus, Option<AdmissionError>)> {
        let silent = |status| (status, None);
        let before = *self.motion(agent).map_err(silent)?;
        let motion = self.placed(by).map_err(silent)?;
        let progress = on_path(progress, &motion).map_err(silent)?;
        let OrderedMut { orders, motions, progress: all, reaches } = self.ordered_mut().map_err(silent)?;
        let mission = PathProposal { agent, motion, progress };
        orders
            .admit(motions, all, mission, tolerances, reaches, prefer)
            .map_err(|refused| (refused.into(), Some(refused)))?;
        self.take(&motion);
        self.close(&before).map_err(silent)
    }

    /// Removes an agent; the number of every agent behind it decreases by one. If the table of all pairs was built, it is
    /// so afterwards.
    pub(super) fn remove(&mut self, index: usize) -> Result<(), PcrStatus> {
        let gone = *self.motion(index)?;
        if self.table.erase(self.motions.values(), index).is_err() {
            // It did not belong to the fleet before, or has one row only.
            self.table.clear();
        }
        self.motions.remove(index);
        self.progress.remove(index);
        self.close(&gone)
    }

    /// Closes the gap that a motion leaves: the parts behind it move down, one after the other, so that each is read
    /// before it is overwritten.
    fn close(&mut self, gone: &Motion<'static, S>) -> Result<(), PcrStatus> {
        let (path, profile) = (gone.path().segments(), gone.profile().phases());
        let mut to = [self.segments.place(path), self.phases.place(profile)];
        let mut from = [to[0].saturating_add(path.len()), to[1].saturating_add(profile.len())];
        let (motions, segments, phases) = (&mut self.motions, &mut self.segments, &mut self.phases);
        let next = |motion: &&mut Motion<'static, S>, segments: &Arena<_>, from| {
            segments.place(motion.path().segments()) == from
        };
        while let Some(motion) = motions.values_mut().iter_mut().find(|motion| next(motion, segments, from[0])) {
            let counts = [motion.path().segments().len(), motion.profile().phases().len()];
            let path = PathRef::new(segments.moved(from[0], to[0], counts[0]))?;
            let profile = ProfileRef::new(phases.moved(from[1], to[1], counts[1]))?;
            *motion = Motion::new(path, profile, motion.radius(), motion.time().lo)?;
            for kind in 0..2 {
                from[kind] = from[kind].saturating_add(counts[kind]);
                to[kind] = to[kind].saturating_add(counts[kind]);
            }
        }
        segments.give_back(to[0]);
        phases.give_back(to[1]);
        Ok(())
    }

    /// Computes the table again.
    pub(super) fn build(&mut self) -> Result<(), PcrStatus> {
        Ok(self.table.fill(self.motions.values())?)
    }

    /// Computes the row of one agent only.
    pub(super) fn build_row(&mut self, agent: usize) -> Result<(), PcrStatus> {
        Ok(self.table.fill_row(self.motions.values(), agent)?)
    }

    pub(super) fn delay(&mut self, agent: usize, delay: S) -> Result<(), PcrStatus> {
        let motion = self.motions.get_mut(agent).ok_or(PcrStatus::NoSuchAgent)?;
        *motion = motion.delayed(delay)?;
        Ok(())
    }

    /// Delays the starts so that no agents collide; `room` is memory for a plan. The fleet is unchanged if there is no
    /// plan.
    pub(super) fn plan(
        &mut self,
        mut room: Stack<Motion<'static, S>>,
        order: &mut [usize],
    ) -> Result<(), (PcrStatus, Option<PlanError>)> {
        if !self.motions().iter().all(|&motion| room.push(motion)) {
            return Err((PcrStatus::NoRoom, None));
        }
        plan_delays(self.table(), self.motions.values(), room.values_mut(), order).map_err(
            |unsolved| match unsolved {
                PlanError::Table(mismatch) => (mismatch.into(), None),
                PlanError::Full(_) => (PcrStatus::NoRoom, None),
                PlanError::NotOnce(_) | PlanError::NoSuchAgent(_) => (PcrStatus::BadOrder, None),
                unsolved => (PcrStatus::NoPlan, Some(unsolved)),
            },
        )?;
        self.motions.values_mut().iter_mut().zip(room.values()).for_each(|(motion, planned)| *motion = *planned);
        Ok(())
    }
}

/// Orders, and the data that are needed to change them.
pub(super) struct OrderedMut<'a> {
    pub(super) orders: &'a mut Ordered,
    pub(super) motions: &'a mut [Motion<'static, S>],
    pub(super) progress: &'a mut [Progress<S>],
    pub(super) reaches: &'a mut [CheckState<S>],
}

/// Refuses progress beyond the end of the path, which would give way to all others. A length that is off by a rounding
/// means that end.
pub(super) fn on_path(progress: Progress<S>, own: &Motion<'_, S>) -> Result<Progress<S>, PcrStatus> {
    let end = own.path().length() + excess(own, own);
    if progress.at.lo <= end { Ok(progress) } else { Err(PcrStatus::OutOfRange) }
}

/// Builds the path of an agent in the first slots; returns the number of slots.
fn place(agent: &PcrAgent, slots: &mut [Segment<S>]) -> Result<usize, PcrStatus> {
    let legs = given(values(agent.legs, agent.leg_count))?;
    let position = Point::new(inner(agent.x), inner(agent.y));
    let origin = Segment::standing(Pose { position, heading: angle(agent.heading) })?;
    *slots.first_mut().ok_or(PcrStatus::NoRoom)? = origin;
    let (mut last, mut count) = (origin, 0);
    for leg in legs {
        let next = match leg.curve {
            PCR_LINE => last.then_line(inner(leg.length))?,
            PCR_LEFT => last.then_arc(inner(leg.radius), TurnSide::Left, inner(leg.length))?,
            PCR_RIGHT => last.then_arc(inner(leg.radius), TurnSide::Right, inner(leg.length))?,
            _ => return Err(PcrStatus::NoSuchCurve),
        };
        if next.length() > S::ZERO {
            *slots.get_mut(count).ok_or(PcrStatus::NoRoom)? = next;
            (last, count) = (next, count + 1);
        }
    }
    Ok(count.max(1))
}

/// Builds the profile of an agent in the first slots; returns the number of slots.
fn profile(agent: &PcrAgent, length: S, slots: &mut [Phase<S>]) -> Result<usize, PcrStatus> {
    let stretches = given(values(agent.stretches, agent.stretch_count))?;
    let mut count = 0;
    let mut push = |phase| {
        *slots.get_mut(count).ok_or(PcrStatus::NoRoom)? = phase;
        count += 1;
        Ok::<(), PcrStatus>(())
    };
    if stretches.is_empty() {
        let limits = Limits { speed: inner(agent.speed), acceleration: inner(agent.acceleration) };
        for &phase in Profile::rest_to_rest(length, limits)?.as_profile().phases() {
            push(phase)?;
        }
    }
    let mut last: Option<Phase<S>> = None;
    for stretch in stretches {
        let next = match last {
            None => Phase::starting_at(inner(agent.speed), inner(stretch.duration), inner(stretch.acceleration))?,
            Some(last) => last.then(inner(stretch.duration), inner(stretch.acceleration))?,
        };
        push(next)?;
        last = Some(next);
    }
    Ok(count)
}

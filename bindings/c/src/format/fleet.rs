//! A fleet in the memory of the caller, in safe Rust.

use super::number::{HALF_TURN, Real, S, angle, inner};
use super::types::{PcrAgent, PcrMemory, PcrPathSegment};
use crate::memory::{Arena, Stack, both, values};
use crate::status::{
    PCR_LEFT, PCR_LINE, PCR_PIVOT_LEFT, PCR_PIVOT_RIGHT, PCR_REVERSE, PCR_RIGHT, PcrInputError, PcrInputList,
    PcrStatus, field, given,
};
use core::ffi::CStr;
use pcr_core::{
    AdmissionError, CapacityError, CheckState, CheckTolerances, Corner, Ecm, EcmEntry, EcmError, Interval,
    InvalidInput, Limits, MismatchError, Motion, Outline, OutlineRef, PassingState, PathProposal, PathRef, Phase,
    Piece, PlanError, Point, Pose, PrecedenceTable, Profile, ProfileRef, Progress, RegionPrecedence, RegionRef, Scalar,
    Segment, TurnSide, Vector, excess, plan_delays,
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

/// Why an agent was refused.
#[derive(Clone, Copy)]
pub(super) struct Fault {
    status: PcrStatus,
    list: PcrInputList,
    index: usize,
    field: &'static CStr,
}

impl Fault {
    const NONE: Self = Self { status: PcrStatus::Ok, list: PcrInputList::Agent, index: 0, field: c"" };

    /// Returns the fault as one of an entry of a list.
    fn at(self, list: PcrInputList, index: usize) -> Self {
        Self { list, index, ..self }
    }
}

impl From<PcrStatus> for Fault {
    fn from(status: PcrStatus) -> Self {
        Self { status, ..Self::NONE }
    }
}

impl From<InvalidInput> for Fault {
    fn from(invalid: InvalidInput) -> Self {
        Self { field: field(invalid), ..Self::from(PcrStatus::from(invalid)) }
    }
}

impl From<Fault> for PcrInputError {
    fn from(fault: Fault) -> Self {
        Self { status: fault.status, list: fault.list, index: fault.index, field: fault.field.as_ptr() }
    }
}

/// Agents, and the table of their regions.
pub(crate) struct Fleet {
    /// Segments of all agents, without gaps, in the order of the agents.
    segments: Arena<Segment<S>>,
    phases: Arena<Phase<S>>,
    corners: Arena<Corner<S>>,
    motions: Stack<Motion<'static, S>>,
    table: Table,
    /// Progress of the agents, and room for a check: as many entries as motions, or none without orders.
    progress: Stack<Progress<S>>,
    reaches: &'static mut [CheckState<S>],
    /// Why the last agent was refused that was given to the fleet.
    fault: Fault,
}

impl Fleet {
    pub(super) fn new(memory: &PcrMemory) -> Result<Self, PcrStatus> {
        let zero = S::ZERO;
        let origin = Segment::standing(Pose { position: Point::new(zero, zero), heading: angle(Default::default()) })?;
        let rest = Phase::starting_at(zero, zero, zero)?;
        let segments = given(Stack::new(memory.segments, memory.segment_count))?;
        let phases = given(Stack::new(memory.phases, memory.phase_count))?;
        let corners = given(Stack::new(memory.corners, memory.corner_count))?;
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
        let corners = Arena::new(corners, Corner::CENTRE);
        Ok(Self { segments, phases, corners, motions, table, progress, reaches, fault: Fault::NONE })
    }

    /// Copies the fleet into other memory: agents, table, orders and progress.
    pub(super) fn copied(&self, memory: &PcrMemory) -> Result<Self, PcrStatus> {
        let mut new = Self::new(memory)?;
        for own in self.motions() {
            let path = PathRef::new(new.segments.copied(own.path().segments()).ok_or(PcrStatus::NoRoom)?)?;
            let profile = ProfileRef::new(new.phases.copied(own.profile().phases()).ok_or(PcrStatus::NoRoom)?)?;
            let corners = new.corners.copied(own.outline().corners()).ok_or(PcrStatus::NoRoom)?;
            let outline = OutlineRef::new(corners, own.outline().radius())?;
            let copy = motion(path, profile, outline, own.time().lo)?;
            if !new.motions.push(copy) {
                return Err(PcrStatus::NoRoom);
            }
            new.take(&copy);
        }
        match (&mut new.table, &self.table) {
            (Table::Regions(new), Table::Regions(own)) => new.copy_from(own)?,
            (Table::Ordered(new), Table::Ordered(own)) => new.copy_from(own)?,
            (Table::Regions(_), Table::Ordered(_)) => return Err(PcrStatus::NoOrders),
            // There is memory for orders now, and no order yet: the table is built again.
            (Table::Ordered(_), Table::Regions(_)) => {}
        }
        for index in 0..self.motions().len() {
            let progress = self.progress.values().get(index).copied().unwrap_or_default();
            let _ = new.progress.push(progress);
        }
        Ok(new)
    }

    /// Why the last agent was refused.
    pub(super) fn fault(&self) -> Fault {
        self.fault
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
            self.fault = PcrStatus::NoRoom.into();
            return Err(PcrStatus::NoRoom);
        }
        // There are as many entries as motions; none without orders.
        let _ = self.progress.push(Progress::default());
        self.take(&motion);
        Ok(())
    }

    /// Builds the motion of an agent in free memory. The caller takes that memory once nothing can fail any more.
    fn placed(&mut self, agent: &PcrAgent) -> Result<Motion<'static, S>, PcrStatus> {
        let placed = self.built(agent);
        self.fault = placed.as_ref().err().copied().unwrap_or(Fault::NONE);
        placed.map_err(|fault| fault.status)
    }

    fn built(&mut self, agent: &PcrAgent) -> Result<Motion<'static, S>, Fault> {
        let segments = place(agent, self.segments.free())?;
        let path = PathRef::new(self.segments.next(segments))?;
        let phases = profile(agent, path.length(), self.phases.free())?;
        let profile = ProfileRef::new(self.phases.next(phases))?;
        let corners = corners(agent, self.corners.free())?;
        let outline = OutlineRef::new(self.corners.next(corners), inner(agent.radius))?;
        Ok(motion(path, profile, outline, inner(agent.start))?)
    }

    fn take(&mut self, motion: &Motion<'static, S>) {
        self.segments.take(motion.path().segments().len());
        self.phases.take(motion.profile().phases().len());
        self.corners.take(motion.outline().corners().len());
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
        let (path, profile, corners) =
            (gone.path().segments(), gone.profile().phases(), gone.outline().corners().len());
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
            let outline = match motion.outline().corners() {
                [] => motion.outline(),
                own => {
                    let at = self.corners.place(own);
                    let own = self.corners.moved(at, at.saturating_sub(corners), own.len());
                    OutlineRef::new(own, motion.outline().radius())?
                }
            };
            *motion = self::motion(path, profile, outline, motion.time().lo)?;
            for kind in 0..2 {
                from[kind] = from[kind].saturating_add(counts[kind]);
                to[kind] = to[kind].saturating_add(counts[kind]);
            }
        }
        segments.give_back(to[0]);
        phases.give_back(to[1]);
        self.corners.give_back(self.corners.len().saturating_sub(corners));
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
fn place(agent: &PcrAgent, slots: &mut [Segment<S>]) -> Result<usize, Fault> {
    let legs = given(values(agent.legs, agent.leg_count))?;
    let position = Point::new(inner(agent.x), inner(agent.y));
    let mut last = Segment::standing(Pose { position, heading: angle(agent.heading) })?;
    if agent.facing != Real::default() && agent.corner_count > 0 {
        last = last.facing(angle(agent.facing))?;
    }
    *slots.first_mut().ok_or(PcrStatus::NoRoom)? = last;
    let mut path = PathInSlots { slots, count: 0, last, has_heading: agent.corner_count > 0, reversed: false };
    for (index, leg) in legs.iter().enumerate() {
        path.push(leg).map_err(|fault| fault.at(PcrInputList::Legs, index))?;
    }
    Ok(path.count.max(1))
}

/// A path that is built in memory of the caller, one leg after the other.
struct PathInSlots<'a> {
    slots: &'a mut [Segment<S>],
    count: usize,
    last: Segment<S>,
    /// Whether the agent is no disc, so that its heading counts.
    has_heading: bool,
    /// Whether the gear changes before the next segment.
    reversed: bool,
}

impl PathInSlots<'_> {
    fn push(&mut self, leg: &PcrPathSegment) -> Result<(), Fault> {
        let (length, radius) = (inner(leg.length), inner(leg.radius));
        if leg.curve == PCR_REVERSE {
            self.reversed = !self.reversed;
            return Ok(());
        }
        // The segment before a change of gear ends with the new direction of travel.
        let before = if self.reversed { self.last.turned(angle(HALF_TURN))? } else { self.last };
        let mut next = match leg.curve {
            PCR_LINE => before.then_line(length)?,
            PCR_LEFT => before.then_arc(radius, TurnSide::Left, length)?,
            PCR_RIGHT => before.then_arc(radius, TurnSide::Right, length)?,
            PCR_PIVOT_LEFT => before.then_pivot(radius, TurnSide::Left, length)?,
            PCR_PIVOT_RIGHT => before.then_pivot(radius, TurnSide::Right, length)?,
            _ => return Err(PcrStatus::NoSuchCurve.into()),
        };
        if next.length() > S::ZERO {
            if core::mem::take(&mut self.reversed) {
                if self.has_heading {
                    next = next.facing_opposite()?;
                }
                if let Some(last) = self.count.checked_sub(1) {
                    *self.slots.get_mut(last).ok_or(PcrStatus::NoRoom)? = before;
                }
            }
            *self.slots.get_mut(self.count).ok_or(PcrStatus::NoRoom)? = next;
            (self.last, self.count) = (next, self.count.saturating_add(1));
        }
        Ok(())
    }
}

/// Checks that a number is valid in the format.
pub(super) fn number(value: Real) -> Result<S, PcrStatus> {
    let value = inner(value);
    match value {
        _ if !Scalar::is_finite(value) => Err(PcrStatus::NonFinite),
        _ if !(-S::LIMIT..=S::LIMIT).contains(&value) => Err(PcrStatus::OutOfRange),
        _ => Ok(value),
    }
}

/// Builds the corners of an agent in the first slots; returns the number of slots.
fn corners(agent: &PcrAgent, slots: &mut [Corner<S>]) -> Result<usize, Fault> {
    let given = given(values(agent.corners, agent.corner_count))?;
    if given.is_empty() {
        return Ok(0);
    }
    for (index, corner) in given.iter().enumerate() {
        let number = |value, field| number(value).map_err(|status| Fault { field, ..status.into() });
        let checked = number(corner.x, c"x").and_then(|_| number(corner.y, c"y"));
        checked.map_err(|fault| fault.at(PcrInputList::Corners, index))?;
    }
    let corners = given.iter().map(|corner| Vector { x: inner(corner.x), y: inner(corner.y) });
    let outline = Outline::<S, 16>::polygon(corners, inner(agent.radius))?;
    let corners = outline.as_outline().corners();
    slots.get_mut(..corners.len()).ok_or(PcrStatus::NoRoom)?.copy_from_slice(corners);
    Ok(corners.len())
}

fn motion(
    path: PathRef<'static, S>,
    profile: ProfileRef<'static, S>,
    outline: OutlineRef<'static, S>,
    start: S,
) -> Result<Motion<'static, S>, InvalidInput> {
    #[cfg(feature = "outlines")]
    return Motion::with_outline(path, profile, outline, start);
    #[cfg(not(feature = "outlines"))]
    if outline.corners().is_empty() {
        Motion::new(path, profile, outline.radius(), start)
    } else {
        Err(InvalidInput::NeedsOutlines)
    }
}

/// Builds the profile of an agent in the first slots; returns the number of slots.
fn profile(agent: &PcrAgent, length: S, slots: &mut [Phase<S>]) -> Result<usize, Fault> {
    let stretches = given(values(agent.stretches, agent.stretch_count))?;
    let mut count = 0;
    let mut push = |phase| {
        *slots.get_mut(count).ok_or(PcrStatus::NoRoom)? = phase;
        count += 1;
        Ok::<(), Fault>(())
    };
    if stretches.is_empty() {
        let limits = Limits { speed: inner(agent.speed), acceleration: inner(agent.acceleration) };
        for &phase in Profile::rest_to_rest(length, limits)?.as_profile().phases() {
            push(phase)?;
        }
    }
    let mut last: Option<Phase<S>> = None;
    for (index, stretch) in stretches.iter().enumerate() {
        let (duration, acceleration) = (inner(stretch.duration), inner(stretch.acceleration));
        let next = match last {
            None => Phase::starting_at(inner(agent.speed), duration, acceleration),
            Some(last) => last.then(duration, acceleration),
        };
        let at = |fault: Fault| fault.at(PcrInputList::Stretches, index);
        let next = next.map_err(|invalid| at(invalid.into()))?;
        push(next).map_err(at)?;
        last = Some(next);
    }
    Ok(count)
}

//! A fleet in the caller's memory, in safe Rust.

use crate::memory::{Arena, Stack, values};
use crate::types::{PCR_LEFT, PCR_LINE, PCR_RIGHT, PcrAgent, PcrMemory, PcrStatus};
use pcr_core::{
    Ecm, Interval, Limits, Motion, PathRef, Phase, Piece, Point, Pose, Profile, ProfileRef, Radians, Region, Segment,
    Turn, Unchanged, Unsolved, plan_delays,
};

/// Agents, and the table of their regions.
pub(crate) struct Fleet {
    /// Of all agents, without gaps, and in the same order.
    segments: Arena<Segment<f32>>,
    phases: Arena<Phase<f32>>,
    motions: Stack<Motion<'static, f32>>,
    table: Ecm<f32, &'static mut [Region], &'static mut [Piece<f32>]>,
}

impl Fleet {
    pub(crate) fn new(memory: &PcrMemory) -> Result<Self, PcrStatus> {
        let origin = Segment::standing(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) })?;
        let rest = Phase::starting_at(0.0, 0.0, 0.0)?;
        let segments = Stack::new(memory.segments, memory.segment_count).ok_or(PcrStatus::Null)?;
        let phases = Stack::new(memory.phases, memory.phase_count).ok_or(PcrStatus::Null)?;
        let motions = Stack::new(memory.motions, memory.motion_count).ok_or(PcrStatus::Null)?;
        let entries = Stack::new(memory.entries, memory.entry_count).ok_or(PcrStatus::Null)?;
        let pieces = Stack::new(memory.pieces, memory.piece_count).ok_or(PcrStatus::Null)?;
        let table = Ecm::new(entries.filled(Region::EMPTY), pieces.filled(Piece::EMPTY));
        let (segments, phases) = (Arena::new(segments, origin), Arena::new(phases, rest));
        Ok(Self { segments, phases, motions, table })
    }

    pub(crate) fn motions(&self) -> &[Motion<'static, f32>] {
        self.motions.values()
    }

    pub(crate) fn motion(&self, agent: usize) -> Result<&Motion<'static, f32>, PcrStatus> {
        self.motions().get(agent).ok_or(PcrStatus::NoSuchAgent)
    }

    pub(crate) fn table(&self) -> &Ecm<f32, &'static mut [Region], &'static mut [Piece<f32>]> {
        &self.table
    }

    /// From the first start to the last arrival.
    pub(crate) fn duration(&self) -> Interval<f32> {
        let times = self.motions().iter().map(Motion::time);
        times.reduce(Interval::hull).unwrap_or_default()
    }

    pub(crate) fn add(&mut self, agent: &PcrAgent) -> Result<(), PcrStatus> {
        let motion = self.placed(agent)?;
        if !self.motions.push(motion) {
            return Err(PcrStatus::NoRoom);
        }
        self.take(&motion);
        Ok(())
    }

    /// The motion of an agent in free memory, which is taken once nothing can go wrong any more.
    fn placed(&mut self, agent: &PcrAgent) -> Result<Motion<'static, f32>, PcrStatus> {
        let segments = place(agent, self.segments.free())?;
        let path = PathRef::new(self.segments.next(segments))?;
        let phases = profile(agent, path.length(), self.phases.free())?;
        Ok(Motion::new(path, ProfileRef::new(self.phases.next(phases))?, agent.radius, agent.start)?)
    }

    fn take(&mut self, motion: &Motion<'static, f32>) {
        self.segments.take(motion.path().segments().len());
        self.phases.take(motion.profile().phases().len());
    }

    /// Another agent in the place of one; a table that was complete is so afterwards.
    pub(crate) fn replace(&mut self, index: usize, agent: &PcrAgent) -> Result<(), PcrStatus> {
        let before = *self.motion(index)?;
        let motion = self.placed(agent)?;
        match self.table.replace(self.motions.values_mut(), index, motion) {
            Err(Unchanged::Full(full)) => return Err(full.into()),
            Ok(()) => {}
            // It was not complete before.
            Err(_) => *self.motions.get_mut(index).ok_or(PcrStatus::NoSuchAgent)? = motion,
        }
        self.take(&motion);
        self.close(&before)
    }

    /// Closes the gap that a motion leaves: those behind it move down, one after the other, so that each is read before
    /// anything is written there.
    fn close(&mut self, gone: &Motion<'static, f32>) -> Result<(), PcrStatus> {
        let (path, profile) = (gone.path().segments(), gone.profile().phases());
        let mut to = [self.segments.place(path), self.phases.place(profile)];
        let mut from = [to[0].saturating_add(path.len()), to[1].saturating_add(profile.len())];
        let (motions, segments, phases) = (&mut self.motions, &mut self.segments, &mut self.phases);
        let next = |motion: &&mut Motion<'static, f32>, segments: &Arena<_>, from| {
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

    /// Computes the table anew.
    pub(crate) fn build(&mut self) -> Result<(), PcrStatus> {
        Ok(self.table.fill(self.motions.values())?)
    }

    pub(crate) fn delay(&mut self, agent: usize, delay: f32) -> Result<(), PcrStatus> {
        let motion = self.motions.get_mut(agent).ok_or(PcrStatus::NoSuchAgent)?;
        *motion = motion.delayed(delay)?;
        Ok(())
    }

    /// Delays the starts so that nobody collides; `room` is for a plan. The fleet is as before where there is none.
    pub(crate) fn plan(
        &mut self,
        mut room: Stack<Motion<'static, f32>>,
        order: &mut [usize],
    ) -> Result<(), (PcrStatus, Option<Unsolved>)> {
        let agents = self.motions().len();
        let listed =
            |agent: usize| order.iter().filter(|&&other| other == agent).nth(1).is_none() && order.contains(&agent);
        if order.len() != agents || !(0..agents).all(listed) {
            return Err((PcrStatus::BadOrder, None));
        }
        if !self.motions().iter().all(|&motion| room.push(motion)) {
            return Err((PcrStatus::NoRoom, None));
        }
        plan_delays(&self.table, self.motions.values(), room.values_mut(), order).map_err(
            |unsolved| match unsolved {
                Unsolved::Table(mismatch) => (mismatch.into(), None),
                unsolved => (PcrStatus::NoPlan, Some(unsolved)),
            },
        )?;
        self.motions.values_mut().iter_mut().zip(room.values()).for_each(|(motion, planned)| *motion = *planned);
        Ok(())
    }
}

/// Places the path of an agent in the first of these slots; how many it takes.
fn place(agent: &PcrAgent, slots: &mut [Segment<f32>]) -> Result<usize, PcrStatus> {
    let legs = values(agent.legs, agent.leg_count).ok_or(PcrStatus::Null)?;
    let position = Point::new(agent.x, agent.y);
    let origin = Segment::standing(Pose { position, heading: Radians(agent.heading) })?;
    *slots.first_mut().ok_or(PcrStatus::NoRoom)? = origin;
    let (mut last, mut count) = (origin, 0);
    for leg in legs {
        let next = match leg.curve {
            PCR_LINE => last.then_line(leg.length)?,
            PCR_LEFT => last.then_arc(leg.radius, Turn::Left, leg.length)?,
            PCR_RIGHT => last.then_arc(leg.radius, Turn::Right, leg.length)?,
            _ => return Err(PcrStatus::NoSuchCurve),
        };
        if next.length() > 0.0 {
            *slots.get_mut(count).ok_or(PcrStatus::NoRoom)? = next;
            (last, count) = (next, count + 1);
        }
    }
    Ok(count.max(1))
}

/// The profile of an agent in the first of these slots; how many it takes.
fn profile(agent: &PcrAgent, length: f32, slots: &mut [Phase<f32>]) -> Result<usize, PcrStatus> {
    let stretches = values(agent.stretches, agent.stretch_count).ok_or(PcrStatus::Null)?;
    let mut count = 0;
    let mut push = |phase| {
        *slots.get_mut(count).ok_or(PcrStatus::NoRoom)? = phase;
        count += 1;
        Ok::<(), PcrStatus>(())
    };
    if stretches.is_empty() {
        let limits = Limits { speed: agent.speed, acceleration: agent.acceleration };
        for &phase in Profile::rest_to_rest(length, limits)?.as_profile().phases() {
            push(phase)?;
        }
    }
    let mut last: Option<Phase<f32>> = None;
    for stretch in stretches {
        let next = match last {
            None => Phase::starting_at(agent.speed, stretch.duration, stretch.acceleration)?,
            Some(last) => last.then(stretch.duration, stretch.acceleration)?,
        };
        push(next)?;
        last = Some(next);
    }
    Ok(count)
}

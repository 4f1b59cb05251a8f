//! A fleet in the caller's memory, in safe Rust.

use crate::memory::{Stack, values};
use crate::types::{PCR_LEFT, PCR_LINE, PCR_RIGHT, PcrAgent, PcrMemory, PcrStatus};
use core::mem::take;
use pcr_core::{
    Ecm, Interval, Invalid, Limits, Motion, PathRef, Phase, Piece, Point, Pose, Profile, ProfileRef, Radians, Region,
    Segment, Turn,
};

/// Agents, and the table of their regions.
pub(crate) struct Fleet {
    /// What no agent has taken yet.
    segments: &'static mut [Segment<f32>],
    phases: &'static mut [Phase<f32>],
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
        Ok(Self { segments: segments.filled(origin), phases: phases.filled(rest), motions, table })
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
        // Into free slots, which are taken once nothing can go wrong any more.
        let segments = place(agent, self.segments)?;
        let path = self.segments.get(..segments).unwrap_or_default();
        let phases = profile(agent, PathRef::new(path)?.length(), self.phases)?;
        motion(agent, path, self.phases.get(..phases).unwrap_or_default())?;
        if self.motions.is_full() {
            return Err(PcrStatus::NoRoom);
        }
        let (path, free) = take(&mut self.segments).split_at_mut_checked(segments).unwrap_or_default();
        self.segments = free;
        let (profile, free) = take(&mut self.phases).split_at_mut_checked(phases).unwrap_or_default();
        self.phases = free;
        self.motions.push(motion(agent, path, profile)?);
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
}

fn motion<'a>(
    agent: &PcrAgent,
    path: &'a [Segment<f32>],
    profile: &'a [Phase<f32>],
) -> Result<Motion<'a, f32>, Invalid> {
    Motion::new(PathRef::new(path)?, ProfileRef::new(profile)?, agent.radius, agent.start)
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

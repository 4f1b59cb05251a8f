//! The fleet, its table, and its answers as rows of numbers.

use crate::agents::{Agents, Input};
use crate::limits::AGENTS;
use crate::message::Fault;
use heapless::Vec;
use pcr_core::{
    Ecm, EcmEntry, Encounter, Interval, MismatchError, Motion, MovementAuthority, Piece, PrecedenceTable, Progress,
    RegionPrecedence, plan_delays,
};

/// Largest number of `f64` in an answer.
pub const ROOM: usize = 1 << 16;
const REGIONS: usize = 2048;
const PIECES: usize = 8192;

/// An answer: rows of numbers, all of the same length.
#[derive(Debug)]
pub struct Rows {
    numbers: [f64; ROOM],
    used: usize,
}

impl Rows {
    /// An empty answer.
    pub const EMPTY: Self = Self { numbers: [0.0; ROOM], used: 0 };

    /// The numbers.
    pub fn numbers(&self) -> &[f64] {
        self.numbers.get(..self.used).unwrap_or_default()
    }

    fn push<const N: usize>(&mut self, row: [f64; N]) -> Result<(), Fault> {
        let end = self.used.saturating_add(N);
        self.numbers.get_mut(self.used..end).ok_or(Fault::Rows)?.copy_from_slice(&row);
        self.used = end;
        Ok(())
    }
}

/// Memory for the agents and the tables. It is filled at run time, so that it takes no room in the module file.
#[derive(Debug)]
pub struct Memory {
    agents: Agents,
    regions: [Vec<EcmEntry, REGIONS>; 2],
    pieces: [Vec<Piece<f64>, PIECES>; 2],
    orders: Vec<RegionPrecedence<f64>, REGIONS>,
}

impl Memory {
    /// Memory that is not filled yet.
    pub const NEW: Self = Self {
        agents: Agents::NONE,
        regions: [Vec::new(), Vec::new()],
        pieces: [Vec::new(), Vec::new()],
        orders: Vec::new(),
    };
}

fn filled<T: Clone, const N: usize>(room: &mut Vec<T, N>, empty: T) -> &mut [T] {
    // The capacity is the length, so this cannot fail.
    let _ = room.resize(N, empty);
    room
}

/// `times` times, from `from` on in steps of `step`, by their places.
fn steps(from: f64, step: f64, times: usize) -> Result<impl Fn(usize) -> f64, Fault> {
    let time = move |place: usize| from + step * place as f64;
    // The last one is the largest in magnitude, or else the first one is.
    if step.is_finite() && [0, times.saturating_sub(1)].into_iter().all(|place| time(place).is_finite()) {
        Ok(time)
    } else {
        Err(Fault::Question("the time"))
    }
}

/// Passing orders, with memory of their own.
type Passing<'s> = PrecedenceTable<f64, &'s mut [EcmEntry], &'s mut [Piece<f64>], &'s mut [RegionPrecedence<f64>]>;

/// A fleet with its tables.
#[derive(Debug)]
pub struct Fleet<'s> {
    agents: &'s mut Agents,
    table: Ecm<f64, &'s mut [EcmEntry], &'s mut [Piece<f64>]>,
    orders: Passing<'s>,
}

impl<'s> Fleet<'s> {
    /// A fleet without agents.
    pub fn new(memory: &'s mut Memory) -> Self {
        let [regions, others] = memory.regions.each_mut().map(|room| filled(room, EcmEntry::EMPTY));
        let [pieces, parts] = memory.pieces.each_mut().map(|room| filled(room, Piece::EMPTY));
        let orders = PrecedenceTable::new(others, parts, filled(&mut memory.orders, RegionPrecedence::EMPTY));
        Self { agents: &mut memory.agents, table: Ecm::new(regions, pieces), orders }
    }

    /// Reads the first `count` agents, and computes all their regions. Returns the number of agents.
    ///
    /// # Errors
    /// [`Fault`]; queries are then errors until another fleet is built.
    pub fn build(&mut self, input: &Input, count: usize) -> Result<usize, Fault> {
        self.agents.read(input, count)?;
        let built = self.table.fill(&self.agents.motions()?);
        if built.is_err() {
            self.clear();
        }
        built?;
        Ok(self.table.len())
    }

    /// Removes all agents: queries are errors until another fleet is built.
    pub fn clear(&mut self) {
        self.agents.clear();
    }

    /// All regions, in both directions of each pair: ego, other, range of times, range of lengths of the ego, range of
    /// lengths of the other; 1 if the region begins while the other stands at its start, 1 if it ends while the other
    /// stands at its end.
    ///
    /// # Errors
    /// [`Fault::Rows`].
    pub fn regions(&mut self, rows: &mut Rows) -> Result<usize, Fault> {
        let motions = self.agents.motions()?;
        rows.used = 0;
        let mut count = 0_usize;
        for region in self.table.regions(&motions)? {
            let (t, l, s) = (region.time(), region.length(), region.other_length());
            let (ego, other) = (region.ego() as f64, region.other() as f64);
            let [start, end] =
                [region.is_open_at_start(), region.is_open_at_end()].map(|open| f64::from(u8::from(open)));
            rows.push([ego, other, t.lo, t.hi, l.lo, l.hi, s.lo, s.hi, start, end])?;
            count = count.saturating_add(1);
        }
        Ok(count)
    }

    /// The collision map of an agent at `times` times, from `from` on in steps of `step`: index of the time, other
    /// agent, and the least and largest length of the ego that the other agent forbids then.
    ///
    /// # Errors
    /// [`Fault::Mismatch`] if there is no such agent, [`Fault::Question`], [`Fault::Rows`].
    pub fn map(&mut self, rows: &mut Rows, ego: usize, from: f64, step: f64, times: usize) -> Result<usize, Fault> {
        let time_of = steps(from, step, times)?;
        let motions = self.agents.motions()?;
        rows.used = 0;
        let mut count = 0_usize;
        for region in self.table.row(&motions, ego)? {
            // Not only at the times of the region: the other forbids the same lengths while it stands before and after.
            for place in 0..times {
                for slice in region.slice_at(time_of(place)) {
                    rows.push([place as f64, region.other() as f64, slice.lo, slice.hi])?;
                    count = count.saturating_add(1);
                }
            }
        }
        Ok(count)
    }

    /// The conflicts of all pairs: both agents, interval of time, depth, 1 if they only touch, lengths of the first
    /// agent, lengths of the second.
    ///
    /// # Errors
    /// [`Fault::Rows`].
    pub fn conflicts(&mut self, rows: &mut Rows) -> Result<usize, Fault> {
        let motions = self.agents.motions()?;
        rows.used = 0;
        let (span, mut count) = (Motion::span(&motions), 0_usize);
        for (first, a) in (0..motions.len()).zip(&motions) {
            for (second, b) in (0..motions.len()).zip(&motions).skip(first.saturating_add(1)) {
                for met in Encounter::new(a, b).conflicts(span) {
                    let (t, l, s) = (met.time, met.length, met.other_length);
                    let touching = f64::from(u8::from(met.touching));
                    let ends = [l.lo, l.hi, s.lo, s.hi];
                    rows.push([
                        first as f64,
                        second as f64,
                        t.lo,
                        t.hi,
                        met.depth,
                        touching,
                        ends[0],
                        ends[1],
                        ends[2],
                        ends[3],
                    ])?;
                    count = count.saturating_add(1);
                }
            }
        }
        Ok(count)
    }

    /// The places of all agents at a time: x, y, heading, travelled length, length of the path, arrival.
    ///
    /// # Errors
    /// [`Fault::Question`].
    pub fn places(&mut self, rows: &mut Rows, time: f64) -> Result<usize, Fault> {
        if !time.is_finite() {
            return Err(Fault::Question("the time"));
        }
        let motions = self.agents.motions()?;
        rows.used = 0;
        for motion in &motions {
            let length = motion.length_at(time);
            let pose = motion.path().pose_at(length);
            let (position, end) = (pose.position, motion.path().length());
            rows.push([position.x, position.y, pose.heading.0, length, end, motion.time().hi])?;
        }
        Ok(motions.len())
    }

    /// The travelled length of an agent at `times` times, from `from` on in steps of `step`.
    ///
    /// # Errors
    /// [`Fault::Mismatch`] if there is no such agent, [`Fault::Question`], [`Fault::Rows`].
    pub fn track(&mut self, rows: &mut Rows, ego: usize, from: f64, step: f64, times: usize) -> Result<usize, Fault> {
        let time_of = steps(from, step, times)?;
        let motions = self.agents.motions()?;
        let motion = motions.get(ego).ok_or(Fault::Mismatch(MismatchError::NoSuchAgent(ego)))?;
        rows.used = 0;
        for place in 0..times {
            rows.push([motion.length_at(time_of(place))])?;
        }
        Ok(times)
    }

    /// Start delays without conflicts, one number for each agent \[s\]: each agent starts as early as those before it
    /// allow.
    ///
    /// # Errors
    /// [`Fault::Unsolved`].
    pub fn plan(&mut self, rows: &mut Rows) -> Result<usize, Fault> {
        let motions = self.agents.motions()?;
        let mut larger = motions.clone();
        for (place, agent) in larger.iter_mut().zip(0_usize..) {
            *place = place.for_plan().map_err(Fault::of_agent(agent))?;
        }
        let mut order: Vec<usize, AGENTS> = (0..larger.len()).collect();
        let mut planned = larger.clone();
        let filled = self.table.fill(&larger);
        let found = filled.map(|()| plan_delays(&self.table, &larger, &mut planned, &mut order));
        // The table is computed again for discs of the true radii; it fitted before.
        self.table.fill(&motions)?;
        found??;
        rows.used = 0;
        for (later, motion) in planned.iter().zip(&motions) {
            rows.push([later.time().lo - motion.time().lo])?;
        }
        Ok(motions.len())
    }

    /// How far each agent may go if all keep the order in which their motions pass one another, and the others are
    /// where they are at this time; infinite if no agent is in its way.
    ///
    /// # Errors
    /// [`Fault::Refused`] if motions collide.
    pub fn holds(&mut self, rows: &mut Rows, time: f64) -> Result<usize, Fault> {
        if !time.is_finite() {
            return Err(Fault::Question("the time"));
        }
        let motions = self.agents.motions()?;
        self.orders.fill(&motions)?;
        self.orders.as_planned(&motions)?;
        let mut places: Vec<Progress<f64>, AGENTS> =
            motions.iter().map(|motion| Progress::at_rest(motion.length_at(time))).collect();
        self.orders.passed(&places);
        rows.used = 0;
        for agent in 0..motions.len() {
            let hold = match self.orders.hold(&motions, agent, &places)? {
                MovementAuthority::Free => f64::INFINITY,
                MovementAuthority::At(length) => length,
                MovementAuthority::Inside => places.get_mut(agent).map_or(0.0, |place| place.at.lo),
            };
            rows.push([hold])?;
        }
        Ok(motions.len())
    }

    /// The interval from the first start to the last arrival \[s\].
    ///
    /// # Errors
    /// [`Fault::NotBuilt`].
    pub fn span(&self) -> Result<Interval<f64>, Fault> {
        Ok(Motion::span(&self.agents.motions()?))
    }
}

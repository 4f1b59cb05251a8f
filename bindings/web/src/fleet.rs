//! The fleet, its table, and the answers as rows of numbers.

use crate::agents::{AGENTS, Agents, Input};
use crate::message::Fault;
use heapless::Vec;
use pcr_core::{Ecm, Encounter, Hold, Interval, Mismatch, Motion, Order, Orders, Piece, Progress, Region, plan_delays};

/// Numbers of an answer, at most.
pub const ROOM: usize = 1 << 16;
const REGIONS: usize = 2048;
const PIECES: usize = 8192;

/// An answer: numbers of rows of one length.
#[derive(Debug)]
pub struct Rows {
    numbers: [f64; ROOM],
    used: usize,
}

impl Rows {
    /// No answer.
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

/// The memory of the agents and the tables. Empty at first, so that a module does not have to carry what it begins with.
#[derive(Debug)]
pub struct Memory {
    agents: Agents,
    regions: [Vec<Region, REGIONS>; 2],
    pieces: [Vec<Piece<f64>, PIECES>; 2],
    orders: Vec<Order<f64>, REGIONS>,
}

impl Memory {
    /// Without contents.
    pub const NEW: Self = Self {
        agents: Agents::NONE,
        regions: [Vec::new(), Vec::new()],
        pieces: [Vec::new(), Vec::new()],
        orders: Vec::new(),
    };
}

fn filled<T: Clone, const N: usize>(room: &mut Vec<T, N>, empty: T) -> &mut [T] {
    // It is as long as it can be: nothing to refuse.
    let _ = room.resize(N, empty);
    room
}

/// Who passes whom, in memory of its own.
type Passing<'s> = Orders<f64, &'s mut [Region], &'s mut [Piece<f64>], &'s mut [Order<f64>]>;

/// A fleet with its tables.
#[derive(Debug)]
pub struct Fleet<'s> {
    agents: &'s mut Agents,
    table: Ecm<f64, &'s mut [Region], &'s mut [Piece<f64>]>,
    orders: Passing<'s>,
}

impl<'s> Fleet<'s> {
    /// No agents.
    pub fn new(memory: &'s mut Memory) -> Self {
        let [regions, others] = memory.regions.each_mut().map(|room| filled(room, Region::EMPTY));
        let [pieces, parts] = memory.pieces.each_mut().map(|room| filled(room, Piece::EMPTY));
        let orders = Orders::new(others, parts, filled(&mut memory.orders, Order::EMPTY));
        Self { agents: &mut memory.agents, table: Ecm::new(regions, pieces), orders }
    }

    /// Reads the first so many agents, and computes all their regions. Returns how many there are.
    ///
    /// # Errors
    /// [`Fault`]; there are no answers then, until another one is built.
    pub fn build(&mut self, input: &Input, count: usize) -> Result<usize, Fault> {
        self.agents.read(input, count)?;
        let built = self.table.fill(&self.agents.motions()?);
        if built.is_err() {
            self.agents.clear();
        }
        built?;
        Ok(self.table.len())
    }

    /// All regions, both directions of each pair: ego, other, first and last time, least and largest length of the ego, and of the
    /// other.
    ///
    /// # Errors
    /// [`Fault::Rows`].
    pub fn regions(&mut self, rows: &mut Rows) -> Result<usize, Fault> {
        let motions = self.agents.motions()?;
        rows.used = 0;
        let mut count = 0_usize;
        for region in self.table.regions(&motions)? {
            let (t, l, s) = (region.time(), region.length(), region.other_length());
            rows.push([region.ego() as f64, region.other() as f64, t.lo, t.hi, l.lo, l.hi, s.lo, s.hi])?;
            count = count.saturating_add(1);
        }
        Ok(count)
    }

    /// The collision map of an agent at so many times from the first on: number of the time, other agent, least and largest
    /// length of the ego that the other forbids then.
    ///
    /// # Errors
    /// [`Fault::Mismatch`] for another agent, [`Fault::Question`], [`Fault::Rows`].
    pub fn map(&mut self, rows: &mut Rows, ego: usize, from: f64, step: f64, times: usize) -> Result<usize, Fault> {
        if !(from.is_finite() && step.is_finite()) {
            return Err(Fault::Question("the time"));
        }
        let motions = self.agents.motions()?;
        rows.used = 0;
        let mut count = 0_usize;
        for region in self.table.row(&motions, ego)? {
            let seen = region.time();
            for place in 0..times {
                let time = from + step * place as f64;
                if !seen.contains(time) {
                    continue;
                }
                for slice in region.slice_at(time) {
                    rows.push([place as f64, region.other() as f64, slice.lo, slice.hi])?;
                    count = count.saturating_add(1);
                }
            }
        }
        Ok(count)
    }

    /// The conflicts of all pairs: both agents, first and last time, depth, 1 if they but touch, lengths of the first, of the
    /// second.
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

    /// Where all agents are at a time: x, y, heading, travelled length, length of the path, arrival.
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

    /// How far an agent has travelled at so many times from the first on.
    ///
    /// # Errors
    /// [`Fault::Mismatch`] for another agent, [`Fault::Question`], [`Fault::Rows`].
    pub fn track(&mut self, rows: &mut Rows, ego: usize, from: f64, step: f64, times: usize) -> Result<usize, Fault> {
        if !(from.is_finite() && step.is_finite()) {
            return Err(Fault::Question("the time"));
        }
        let motions = self.agents.motions()?;
        let motion = motions.get(ego).ok_or(Fault::Mismatch(Mismatch::NoSuchAgent(ego)))?;
        rows.used = 0;
        for place in 0..times {
            rows.push([motion.length_at(from + step * place as f64)])?;
        }
        Ok(times)
    }

    /// Start delays without conflicts, a number an agent \[s\]: each as early as those before it allow.
    ///
    /// # Errors
    /// [`Fault::Unsolved`].
    pub fn plan(&mut self, rows: &mut Rows) -> Result<usize, Fault> {
        let motions = self.agents.motions()?;
        let mut larger = motions.clone();
        for (place, agent) in larger.iter_mut().zip(0_usize..) {
            *place = place.for_plan().map_err(Fault::of_agent(agent))?;
        }
        self.table.fill(&larger)?;
        let mut order: Vec<usize, AGENTS> = (0..larger.len()).collect();
        let mut planned = larger.clone();
        let found = plan_delays(&self.table, &larger, &mut planned, &mut order);
        // The table is that of the discs as they are again: it held them before.
        self.table.fill(&motions)?;
        found?;
        rows.used = 0;
        for (later, motion) in planned.iter().zip(&motions) {
            rows.push([later.time().lo - motion.time().lo])?;
        }
        Ok(motions.len())
    }

    /// How far each agent may go at a time if all keep the order in which their motions pass, the others being where they are
    /// then: infinite where nobody is in its way.
    ///
    /// # Errors
    /// [`Fault::Refused`] where motions meet.
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
                Hold::Free => f64::INFINITY,
                Hold::At(length) => length,
                Hold::Inside => places.get_mut(agent).map_or(0.0, |place| place.at.lo),
            };
            rows.push([hold])?;
        }
        Ok(motions.len())
    }

    /// From the first start to the last arrival \[s\].
    ///
    /// # Errors
    /// [`Fault::NotBuilt`].
    pub fn span(&self) -> Result<Interval<f64>, Fault> {
        Ok(Motion::span(&self.agents.motions()?))
    }
}

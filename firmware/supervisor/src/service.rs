//! The supervisor without the line: keeps a fleet and its table, and answers requests.

use crate::agent::{Agent, MAX_STEPS, Step};
use crate::message::{
    Answer, ConflictRecord, Edition, PieceRecord, Refusal, RegionRecord, Request, Terms, short, text,
};
use crate::number::Number;
use crate::table::Table;
use core::cell::RefCell;
use heapless::Vec;
use pcr_core::{
    Ecm, EcmEntry, EcmError, FleetMotions, FleetStorage, Interval, InvalidInput, Limits, Motion, Piece, Point, Pose,
    StagedAgent, earliest_start,
};

pub use crate::table::Regions;

/// Receives answers; a closure can be used.
pub trait Replies<S: Number> {
    /// Receives the next answer.
    fn send(&mut self, answer: Answer<S>);

    /// Called during long computations: after one agent against all before it, one pair of agents, or one region of a
    /// replan. Feed the watchdog here, and after every answer. docs/guide/firmware.md has the number of instructions between
    /// two calls.
    fn pause(&mut self) {}
}

impl<S: Number, F: FnMut(Answer<S>)> Replies<S> for F {
    fn send(&mut self, answer: Answer<S>) {
        self(answer);
    }
}

/// A fleet and its table, meant to be a `static`: at most `A` agents with `N` segments in total (including those of a
/// new agent while it replaces an old one), `R` regions and `P` pieces. It has passing orders if the table is a
/// [`Traffic`](crate::Traffic).
#[derive(Debug)]
pub struct Service<S: Number, const A: usize, const N: usize, const R: usize, const P: usize, T = Regions<S, R, P>> {
    fleet: FleetStorage<'static, S, A, N>,
    /// Limits of the agents, which are sent with their paths.
    limits: Vec<Limits<S>, A>,
    table: T,
    /// `None` if there is none, because a reference to nothing is not zero.
    built_in: Option<&'static [Agent<S, &'static [Step<S>]>]>,
}

impl<S: Number, const A: usize, const N: usize, const R: usize, const P: usize> Service<S, A, N, R, P> {
    /// A supervisor without agents and orders, and a fleet that can be loaded.
    pub const fn new(built_in: &'static [Agent<S, &'static [Step<S>]>]) -> Self {
        Self::with(Ecm::new([EcmEntry::EMPTY; R], [Piece::EMPTY; P]), built_in)
    }
}

impl<S: Number, T, const A: usize, const N: usize, const R: usize, const P: usize> Service<S, A, N, R, P, T> {
    /// A supervisor without agents, with a fleet that can be loaded and this table. Without such a fleet and with an empty table it is all zeros,
    /// so a `static` takes no flash for it; [`Service::build_in`] gives it the fleet when the program starts.
    pub const fn with(table: T, built_in: &'static [Agent<S, &'static [Step<S>]>]) -> Self {
        // A row has at most this many records, and each record has an index of 16 bits.
        const { assert!(R + P + A < u16::MAX as usize, "places are sent in 16 bits") };
        let built_in = if built_in.is_empty() { None } else { Some(built_in) };
        Self { fleet: FleetStorage::new(), limits: Vec::new(), table, built_in }
    }
}

impl<S, T, const A: usize, const N: usize, const R: usize, const P: usize> Service<S, A, N, R, P, T>
where
    S: Number,
    T: Table<S, R, P>,
{
    /// Puts a fleet in the place of the one that can be loaded.
    pub fn build_in(&mut self, fleet: &'static [Agent<S, &'static [Step<S>]>]) {
        self.built_in = Some(fleet);
    }

    // The functions that it calls are not inlined, so that their stacks do not add up.
    /// Answers a request: calls [`Replies::send`] for each answer. `next` is the sequence number for the answer to a
    /// greeting.
    pub fn answer(&mut self, request: Request<S>, next: u16, mut replies: impl Replies<S>) {
        let outcome = match request {
            Request::Hello => Ok(Answer::Hello {
                format: text(S::NAME),
                agents: short(A),
                segments: short(N),
                regions: short(R),
                pieces: short(P),
                next,
            }),
            Request::Clear => {
                self.clear();
                Ok(Answer::Done)
            }
            // While robots are under way, the fleet must stay as they were told.
            Request::Add(_)
            | Request::Load
            | Request::Replan { .. }
            | Request::Replace { .. }
            | Request::Remove { .. }
            | Request::Order(_)
                if self.table.is_running() =>
            {
                Err(Refusal::Running)
            }
            Request::Add(agent) => self.add(&agent),
            Request::Load => self.load(&mut replies),
            Request::Compute => self.compute(&mut replies),
            Request::Row { ego } => self.row(usize::from(ego), &mut replies),
            Request::Conflicts => self.conflicts(&mut replies),
            Request::Replan { agent } => {
                self.replan(usize::from(agent), &mut replies).map(|time| Answer::Replanned { agent, time })
            }
            Request::Replace { agent, with } => self.replace(usize::from(agent), &with),
            Request::Remove { agent } => self.remove(usize::from(agent)),
            Request::Order(terms) => self.order(terms),
            Request::Report { agent, edition, at } => {
                self.report(usize::from(agent), edition, at, &mut |each| replies.send(each))
            }
            Request::Orders { agent } => self.orders(usize::from(agent), &mut |each| replies.send(each)),
            Request::Admit { agent, heading, limits, path } => self.admit(usize::from(agent), heading, limits, path),
        };
        replies.send(outcome.unwrap_or_else(Answer::Refused));
    }

    fn clear(&mut self) {
        self.table.clear();
        self.fleet.clear();
        self.limits.clear();
    }

    fn agents(&self) -> Answer<S> {
        Answer::Fleet { agents: short(self.fleet.len()) }
    }

    #[inline(never)]
    fn add<Q: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, Q>) -> Result<Answer<S>, Refusal> {
        let index = self.fleet.len();
        agent.add_to(&mut self.fleet).map_err(|invalid| Refusal::agent(index, invalid))?;
        // There is room for as many limits as agents.
        self.limits.push(agent.limits).map_err(|_| Refusal::agent(index, InvalidInput::Full("agent")))?;
        Ok(self.agents())
    }

    #[inline(never)]
    fn load(&mut self, replies: &mut impl Replies<S>) -> Result<Answer<S>, Refusal> {
        self.clear();
        let built_in = self.built_in.unwrap_or_default();
        let loaded = built_in.iter().try_for_each(|agent| {
            replies.pause();
            self.add(agent).map(drop)
        });
        if loaded.is_err() {
            self.clear();
        }
        loaded.map(|()| self.agents())
    }

    #[inline(never)]
    fn replace(&mut self, index: usize, agent: &Agent<S>) -> Result<Answer<S>, Refusal> {
        let staged = agent.stage(&mut self.fleet).map_err(|invalid| Refusal::agent(index, invalid))?;
        let mut motions = FleetMotions::new();
        put(staged.storage(), &mut motions);
        let replaced = self.table.replace(&mut motions, index, staged.motion());
        drop(motions);
        staged.replace(index).map_err(|rejected| Refusal::change(index, rejected))?;
        set(&mut self.limits, index, agent.limits);
        // The new fleet has no table: there was none before, or the regions do not fit. The old one goes, so that it is not taken for
        // that of a fleet whose paths are those again.
        if replaced.is_err() {
            self.table.clear();
        }
        Ok(self.agents())
    }

    #[inline(never)]
    fn remove(&mut self, index: usize) -> Result<Answer<S>, Refusal> {
        let mut motions = FleetMotions::new();
        put(&self.fleet, &mut motions);
        let erased = self.table.erase(&motions, index);
        drop(motions);
        self.fleet.remove(index).map_err(|rejected| Refusal::change(index, rejected))?;
        for place in index..self.limits.len() {
            if let Some(&next) = self.limits.get(place.saturating_add(1)) {
                set(&mut self.limits, place, next);
            }
        }
        self.limits.pop();
        // It did not belong to the fleet before.
        if erased.is_err() {
            self.table.clear();
        }
        Ok(self.agents())
    }

    /// Computes the table, unless it is that of the fleet already.
    #[inline(never)]
    fn compute(&mut self, replies: &mut impl Replies<S>) -> Result<Answer<S>, Refusal> {
        let mut motions = FleetMotions::new();
        put(&self.fleet, &mut motions);
        if self.table.regions().regions(&motions).is_err() {
            build(&mut self.table, &motions, replies)
                .map_err(|error| needed(&mut self.table, &motions, error, replies))?;
        }
        let table = self.table.regions();
        Ok(Answer::Computed { regions: short(table.len()), pieces: short(table.pieces()) })
    }

    #[inline(never)]
    fn order(&mut self, terms: Terms<S>) -> Result<Answer<S>, Refusal> {
        let mut motions = FleetMotions::new();
        put(&self.fleet, &mut motions);
        self.table.order(&motions, terms).map(Answer::Edition)
    }

    #[inline(never)]
    fn report(
        &mut self,
        agent: usize,
        edition: Edition,
        at: Interval<S>,
        send: &mut impl FnMut(Answer<S>),
    ) -> Result<Answer<S>, Refusal> {
        let mut motions = FleetMotions::new();
        put(&self.fleet, &mut motions);
        self.table.report(&motions, agent, edition, at, send)
    }

    #[inline(never)]
    fn orders(&self, agent: usize, send: &mut impl FnMut(Answer<S>)) -> Result<Answer<S>, Refusal> {
        let mut motions = FleetMotions::new();
        put(&self.fleet, &mut motions);
        let with = |agent: usize| {
            let (motion, limits) = motions.get(agent).zip(self.limits.get(agent)).ok_or(no_such_agent(agent))?;
            Agent::of(motion, *limits).map_err(|invalid| Refusal::agent(agent, invalid))
        };
        self.table.orders(&motions, agent, with, send)
    }

    /// A path that begins at the end of the robot's present path.
    #[inline(never)]
    fn admit(
        &mut self,
        index: usize,
        heading: S::Angle,
        limits: Limits<S>,
        path: Vec<Step<S>, MAX_STEPS>,
    ) -> Result<Answer<S>, Refusal> {
        let (radius, start_time, position) = self.end_of(index)?;
        let agent = Agent { radius, start_time, limits, start: Pose { position, heading }, path };
        let staged = agent.stage(&mut self.fleet).map_err(|invalid| Refusal::agent(index, invalid))?;
        let edition = exchange(&mut self.table, index, &staged)?;
        staged.replace(index).map_err(|rejected| Refusal::change(index, rejected))?;
        set(&mut self.limits, index, limits);
        Ok(Answer::Edition(edition))
    }

    /// Radius and start time of a robot that is at the end of its path, and where that is.
    #[inline(never)]
    fn end_of(&self, index: usize) -> Result<(S, S, Point<S>), Refusal> {
        let mut motions = FleetMotions::new();
        put(&self.fleet, &mut motions);
        self.table.arrived(&motions, index)?;
        let before = motions.get(index).ok_or(no_such_agent(index))?;
        Ok((before.radius(), before.time().lo, before.path().point_at(before.path().length())))
    }

    /// Writes the motions of the fleet to a list; refuses if the fleet has no such agent.
    fn put_of<'a>(&'a self, agent: usize, motions: &mut FleetMotions<'a, S, A>) -> Result<(), Refusal> {
        if agent >= self.fleet.len() {
            return Err(no_such_agent(agent));
        }
        put(&self.fleet, motions);
        Ok(())
    }

    /// The interval of the agent's new motion.
    #[inline(never)]
    fn replan(&mut self, agent: usize, replies: &mut impl Replies<S>) -> Result<Interval<S>, Refusal> {
        let mut motions = FleetMotions::new();
        self.put_of(agent, &mut motions)?;
        // The regions are iterated several times, so the iterator is cloned.
        let replies = RefCell::new(replies);
        let row = self.table.regions().row(&motions, agent)?.inspect(|_| {
            if let Ok(mut replies) = replies.try_borrow_mut() {
                replies.pause();
            }
        });
        let delay = earliest_start(row, S::ZERO).ok_or(Refusal::NoPlan)?;
        drop(motions);
        // The table depends on paths only, so it stays as it is.
        self.fleet.delay(agent, delay).map_err(|rejected| Refusal::change(agent, rejected))
    }

    #[inline(never)]
    fn row(&self, ego: usize, replies: &mut impl Replies<S>) -> Result<Answer<S>, Refusal> {
        let mut motions = FleetMotions::new();
        self.put_of(ego, &mut motions)?;
        let mut count = 0_u16;
        for region in self.table.regions().row(&motions, ego)? {
            replies.send(Answer::Region(RegionRecord::of(&region)));
            region.pieces().for_each(|piece| replies.send(Answer::Piece(PieceRecord::of(&piece))));
            count = count.saturating_add(1);
        }
        Ok(Answer::End { count })
    }

    #[inline(never)]
    fn conflicts(&self, replies: &mut impl Replies<S>) -> Result<Answer<S>, Refusal> {
        let mut motions = FleetMotions::new();
        put(&self.fleet, &mut motions);
        let mut count = 0_u16;
        for first in 0..motions.len() {
            for second in first.saturating_add(1)..motions.len() {
                if let Some(conflict) = ConflictRecord::first(&motions, [first, second])? {
                    replies.send(Answer::Conflict(conflict));
                    count = count.saturating_add(1);
                }
                replies.pause();
            }
        }
        Ok(Answer::End { count })
    }
}

fn no_such_agent(agent: usize) -> Refusal {
    Refusal::NoSuchAgent { agent: short(agent) }
}

fn set<S>(limits: &mut [Limits<S>], agent: usize, to: Limits<S>) {
    if let Some(place) = limits.get_mut(agent) {
        *place = to;
    }
}

// Not inlined: its copies of a motion would stay on the stack while the caller works with the motions.
#[inline(never)]
fn put<'a, S: Number, const A: usize, const N: usize>(
    fleet: &'a FleetStorage<'_, S, A, N>,
    motions: &mut FleetMotions<'a, S, A>,
) {
    motions.fill(fleet);
}

/// Tries the new path of a robot in the table.
#[inline(never)]
fn exchange<S: Number, const A: usize, const N: usize, const R: usize, const P: usize>(
    table: &mut impl Table<S, R, P>,
    index: usize,
    staged: &StagedAgent<'_, '_, S, A, N, 3>,
) -> Result<Edition, Refusal> {
    let mut motions = FleetMotions::new();
    put(staged.storage(), &mut motions);
    table.admit(&mut motions, index, staged.motion())
}

/// Computes the table of a fleet, one agent at a time. If there is no room, it is empty afterwards.
fn build<S: Number, const R: usize, const P: usize>(
    table: &mut impl Table<S, R, P>,
    fleet: &[Motion<'_, S>],
    replies: &mut impl Replies<S>,
) -> Result<(), EcmError> {
    table.clear();
    for agent in 0..fleet.len() {
        let inserted = table.insert(fleet.get(..=agent).unwrap_or_default(), agent);
        if inserted.is_err() {
            table.clear();
            return inserted;
        }
        replies.pause();
    }
    Ok(())
}

/// The number of regions and pieces that the fleet needs, counted pair by pair in the table that is too small for all
/// of them.
#[inline(never)]
fn needed<S: Number, const R: usize, const P: usize>(
    table: &mut impl Table<S, R, P>,
    fleet: &[Motion<'_, S>],
    error: EcmError,
    replies: &mut impl Replies<S>,
) -> Refusal {
    let [mut regions, mut pieces] = [0_usize; 2];
    for (agent, first) in fleet.iter().enumerate() {
        for second in fleet.iter().skip(agent.saturating_add(1)) {
            // The table is too small for two agents, or no table is large enough.
            let Ok(pair) = table.needed(&[*first, *second]) else { return error.into() };
            regions = regions.saturating_add(pair.regions);
            pieces = pieces.saturating_add(pair.pieces);
            replies.pause();
        }
    }
    Refusal::Needs { regions: short(regions), pieces: short(pieces) }
}

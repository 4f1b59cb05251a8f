//! The supervisor itself: keeps a fleet and its table, and answers requests.

use crate::agent::{Agent, Step};
use crate::fleet::{Motions, Store};
use crate::message::{Answer, ConflictRecord, PieceRecord, Refusal, RegionRecord, Request, short, text};
use crate::number::Number;
use pcr_core::{Ecm, Full, Interval, Motion, Piece, Region, earliest_start};

/// A fleet and its table, made to be a `static`: at most `A` agents with `N` segments in all, those of an agent that comes
/// in the place of another one included while both are there, `R` regions and `P` pieces of them.
#[derive(Debug)]
pub struct Service<S: Number, const A: usize, const N: usize, const R: usize, const P: usize> {
    fleet: Store<S, A, N>,
    table: Ecm<S, [Region; R], [Piece<S>; P]>,
    /// Whether the table is that of the fleet.
    computed: bool,
    built_in: &'static [Agent<S, &'static [Step<S>]>],
}

impl<S: Number, const A: usize, const N: usize, const R: usize, const P: usize> Service<S, A, N, R, P> {
    /// No agents yet, and a fleet to load.
    pub const fn new(built_in: &'static [Agent<S, &'static [Step<S>]>]) -> Self {
        // A row is all of it at most, and each record of it has its place in 16 bits.
        const { assert!(R + P < u16::MAX as usize, "places are sent in 16 bits") };
        let table = Ecm::new([Region::EMPTY; R], [Piece::EMPTY; P]);
        Self { fleet: Store::new(), table, computed: false, built_in }
    }

    // What it calls is not inlined: the stack of the one would lie under that of the other.
    /// Answers a request: one call of `send` for each answer. `next` is the sequence number that a greeting tells.
    pub fn answer(&mut self, request: Request<S>, next: u16, mut send: impl FnMut(Answer<S>)) {
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
            Request::Add(agent) => self.add(&agent),
            Request::Load => self.load(),
            Request::Compute => self.compute(),
            Request::Row { ego } => self.row(usize::from(ego), &mut send),
            Request::Conflicts => self.conflicts(&mut send),
            Request::Replan { agent } => self.replan(usize::from(agent)).map(|time| Answer::Replanned { agent, time }),
            Request::Replace { agent, with } => self.replace(usize::from(agent), &with),
            Request::Remove { agent } => self.remove(usize::from(agent)),
        };
        send(outcome.unwrap_or_else(Answer::Refused));
    }

    fn clear(&mut self) {
        self.computed = false;
        self.table.clear();
        self.fleet.clear();
    }

    /// What is told of a fleet that has changed.
    fn changed(&mut self) -> Answer<S> {
        self.computed = false;
        Answer::Fleet { agents: short(self.fleet.len()) }
    }

    #[inline(never)]
    fn add<Q: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, Q>) -> Result<Answer<S>, Refusal> {
        let index = self.fleet.len();
        self.fleet.add(agent).map_err(|invalid| Refusal::agent(index, invalid))?;
        Ok(self.changed())
    }

    #[inline(never)]
    fn load(&mut self) -> Result<Answer<S>, Refusal> {
        self.clear();
        let built_in = self.built_in;
        let loaded = built_in.iter().try_for_each(|agent| self.add(agent).map(drop));
        if loaded.is_err() {
            self.clear();
        }
        loaded.map(|()| self.changed())
    }

    #[inline(never)]
    fn replace(&mut self, index: usize, agent: &Agent<S>) -> Result<Answer<S>, Refusal> {
        self.fleet.replace(index, agent).map_err(|rejected| Refusal::change(index, rejected))?;
        Ok(self.changed())
    }

    #[inline(never)]
    fn remove(&mut self, index: usize) -> Result<Answer<S>, Refusal> {
        self.fleet.remove(index).map_err(|rejected| Refusal::change(index, rejected))?;
        Ok(self.changed())
    }

    #[inline(never)]
    fn compute(&mut self) -> Result<Answer<S>, Refusal> {
        self.computed = false;
        let mut motions = Motions::new();
        put(&self.fleet, &mut motions)?;
        fill(&mut self.table, &motions)?;
        drop(motions);
        self.computed = true;
        Ok(Answer::Computed { regions: short(self.table.len()), pieces: short(self.table.pieces()) })
    }

    /// Puts the motions of the fleet, whose table there is and that has this agent, where they are to be.
    fn put_computed<'a>(&'a self, agent: usize, motions: &mut Motions<'a, S, A>) -> Result<(), Refusal> {
        if agent >= self.fleet.len() {
            return Err(Refusal::NoSuchAgent { agent: short(agent) });
        }
        if !self.computed {
            return Err(Refusal::NotComputed);
        }
        put(&self.fleet, motions)
    }

    /// When the agent moves now.
    #[inline(never)]
    fn replan(&mut self, agent: usize) -> Result<Interval<S>, Refusal> {
        let mut motions = Motions::new();
        self.put_computed(agent, &mut motions)?;
        let delay = earliest_start(self.table.row(&motions, agent)?, S::ZERO).ok_or(Refusal::NoPlan)?;
        drop(motions);
        // The table is of paths: it stays as it is.
        self.fleet.delay(agent, delay).map_err(|rejected| Refusal::change(agent, rejected))
    }

    #[inline(never)]
    fn row(&self, ego: usize, send: &mut impl FnMut(Answer<S>)) -> Result<Answer<S>, Refusal> {
        let mut motions = Motions::new();
        self.put_computed(ego, &mut motions)?;
        let mut count = 0_u16;
        for region in self.table.row(&motions, ego)? {
            send(Answer::Region(RegionRecord::of(&region)));
            region.pieces().for_each(|piece| send(Answer::Piece(PieceRecord::of(&piece))));
            count = count.saturating_add(1);
        }
        Ok(Answer::End { count })
    }

    #[inline(never)]
    fn conflicts(&self, send: &mut impl FnMut(Answer<S>)) -> Result<Answer<S>, Refusal> {
        let mut motions = Motions::new();
        put(&self.fleet, &mut motions)?;
        let mut count = 0_u16;
        for first in 0..motions.len() {
            for second in first.saturating_add(1)..motions.len() {
                if let Some(conflict) = ConflictRecord::first(&motions, [first, second])? {
                    send(Answer::Conflict(conflict));
                    count = count.saturating_add(1);
                }
            }
        }
        Ok(Answer::End { count })
    }
}

/// Puts the motions of a fleet where they are to be. What is returned would lie on the stack more than once.
fn put<'a, S: Number, const A: usize, const N: usize>(
    fleet: &'a Store<S, A, N>,
    motions: &mut Motions<'a, S, A>,
) -> Result<(), Refusal> {
    fleet.put_motions(motions).map_err(|invalid| Refusal::agent(fleet.len(), invalid))
}

// By itself, with a stack of its own.
#[inline(never)]
fn fill<S: Number, const R: usize, const P: usize>(
    table: &mut Ecm<S, [Region; R], [Piece<S>; P]>,
    fleet: &[Motion<'_, S>],
) -> Result<(), Full> {
    table.fill(fleet)
}

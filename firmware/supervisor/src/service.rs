//! The supervisor itself: keeps a fleet and its table, and answers requests.

use crate::agent::{Agent, Step};
use crate::fleet::Store;
use crate::message::{Answer, ConflictRecord, PieceRecord, Refusal, RegionRecord, Request, short, text};
use crate::number::Number;
use crate::scenario::{AGENTS, PIECES, REGIONS, SEGMENTS};
use pcr_core::{Ecm, Interval, Piece, Region, earliest_start};

/// A fleet and its table, made to be a `static`.
#[derive(Debug)]
pub struct Service<S: Number> {
    fleet: Store<S, AGENTS, SEGMENTS>,
    table: Ecm<S, [Region; REGIONS], [Piece<S>; PIECES]>,
    /// Whether the table is that of the fleet.
    computed: bool,
    built_in: &'static [Agent<S, &'static [Step<S>]>],
}

impl<S: Number> Service<S> {
    /// No agents yet, and a fleet to load.
    pub const fn new(built_in: &'static [Agent<S, &'static [Step<S>]>]) -> Self {
        let table = Ecm::new([Region::EMPTY; REGIONS], [Piece::EMPTY; PIECES]);
        Self { fleet: Store::new(), table, computed: false, built_in }
    }

    /// Answers a request: one call of `send` for each answer.
    pub fn answer(&mut self, request: Request<S>, mut send: impl FnMut(Answer<S>)) {
        match request {
            Request::Hello => send(Answer::Hello {
                format: text(S::NAME),
                agents: short(AGENTS),
                segments: short(SEGMENTS),
                regions: short(REGIONS),
                pieces: short(PIECES),
            }),
            Request::Clear => {
                self.clear();
                send(Answer::Done);
            }
            Request::Add(agent) => send(self.add(&agent)),
            Request::Load => {
                self.clear();
                let built_in = self.built_in.iter();
                let added = built_in.map(|agent| self.add(agent)).last();
                send(added.unwrap_or(Answer::Done));
            }
            Request::Compute => send(match self.compute() {
                Ok(()) => Answer::Computed { regions: short(self.table.len()), pieces: short(self.table.pieces()) },
                Err(refusal) => Answer::Refused(refusal),
            }),
            Request::Row { ego } => self.row(usize::from(ego), send),
            Request::Conflicts => self.conflicts(send),
            Request::Replan { agent } => send(match self.replan(agent) {
                Ok(time) => Answer::Replanned { agent, time },
                Err(refusal) => Answer::Refused(refusal),
            }),
        }
    }

    fn clear(&mut self) {
        self.empty_table();
        self.fleet.clear();
    }

    fn empty_table(&mut self) {
        self.computed = false;
        self.table.clear();
    }

    fn add<P: AsRef<[Step<S>]>>(&mut self, agent: &Agent<S, P>) -> Answer<S> {
        match self.fleet.add(agent) {
            Ok(_) => {
                self.computed = false;
                Answer::Added { agents: short(self.fleet.len()) }
            }
            Err(invalid) => Answer::Refused(invalid.into()),
        }
    }

    fn compute(&mut self) -> Result<(), Refusal> {
        self.empty_table();
        let motions = self.fleet.motions();
        let outcome = self.table.fill(&motions);
        drop(motions);
        self.computed = outcome.is_ok();
        Ok(outcome?)
    }

    /// When the agent moves now.
    fn replan(&mut self, agent: u16) -> Result<Interval<S>, Refusal> {
        if !self.computed {
            self.compute()?;
        }
        let (agent, motions) = (usize::from(agent), self.fleet.motions());
        let motion = motions.get(agent).ok_or(Refusal::NoSuchAgent)?;
        let delay = earliest_start(self.table.row(&motions, agent)?, S::ZERO).ok_or(Refusal::NoPlan)?;
        let time = motion.delayed(delay)?.time();
        drop(motions);
        // The table is of paths: it stays as it is.
        self.fleet.delay(agent, delay);
        Ok(time)
    }

    fn row(&self, ego: usize, mut send: impl FnMut(Answer<S>)) {
        let motions = self.fleet.motions();
        let regions = match self.table.row(&motions, ego) {
            Ok(regions) => regions,
            Err(mismatch) => return send(Answer::Refused(mismatch.into())),
        };
        let mut count = 0_u16;
        for region in regions {
            send(Answer::Region(RegionRecord::of(&region)));
            region.pieces().for_each(|piece| send(Answer::Piece(PieceRecord::of(&piece))));
            count = count.saturating_add(1);
        }
        send(Answer::End { count });
    }

    fn conflicts(&self, mut send: impl FnMut(Answer<S>)) {
        let motions = self.fleet.motions();
        let agents = 0..motions.len();
        let mut count = 0_u16;
        for pair in
            agents.clone().flat_map(|first| agents.clone().skip_while(move |&k| k <= first).map(move |k| [first, k]))
        {
            if let Some(conflict) = ConflictRecord::first(&motions, pair) {
                send(Answer::Conflict(conflict));
                count = count.saturating_add(1);
            }
        }
        send(Answer::End { count });
    }
}

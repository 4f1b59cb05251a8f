//! The state of a robot: its orders, and how far the robots before it have come. From that it computes how far it may
//! go, ten times a second or more often. It needs no clock, and messages may be lost.
//!
//! ```text
//! loop {
//!     briefing.begin(own);                               // Request::Orders, answer by answer
//!     briefing.take(&answer)?;
//!     fleet.fill(briefing.paths())?;
//!     robot.brief(&briefing, &fleet, at)?;
//!     loop {
//!         robot.hear(&briefing, &answer);                // Answer::Place, Answer::Go
//!         let hold = robot.hold(&fleet);                 // brake so that you stay there
//!     }                                                  // until Refusal::Edition
//! }
//! ```
//!
//! While the robot asks for new orders, the last hold that it computed stays valid.
//!
//! A robot that was restarted has forgotten how far it has come. If its path was begun, [`Robot::brief`] says so
//! ([`Unclear::Begun`]): it stays where it is until it knows its place on the path that it was told, calls
//! [`Robot::resume`], and is briefed again.

use crate::message::{Answer, Edition};
use crate::number::Number;
use crate::table::Ordered;
use heapless::Vec;
use pcr_core::{
    CapacityError, EcmEntry, EcmError, FleetStorage, Interval, InvalidInput, MismatchError, Motion, MovementAuthority,
    PassingState, Piece, PrecedenceTable, Progress, RegionPrecedence, Scalar,
};

/// The orders of one robot as they are received: the paths of at most `A` robots, including its own, with `N` segments
/// in total, and at most `R` regions that it has with the others.
#[derive(Debug)]
pub struct Briefing<S: Number, const A: usize, const N: usize, const R: usize> {
    /// The robot.
    agent: Option<u16>,
    /// Edition of the answers received so far.
    edition: Option<Edition>,
    /// From the last answer: the number of the edition in which the robot got its path, and what is known of its place.
    path: Option<(u16, Interval<S>)>,
    /// Indices of the robots, in increasing order, and their paths.
    members: Vec<u16, A>,
    paths: FleetStorage<'static, S, A, N>,
    passings: Vec<Passing<S>, R>,
}

#[derive(Clone, Copy, Debug)]
struct Passing<S> {
    other: u16,
    pass: PassingState,
    from: S,
}

impl<S: Number, const A: usize, const N: usize, const R: usize> Default for Briefing<S, A, N, R> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Number, const A: usize, const N: usize, const R: usize> Briefing<S, A, N, R> {
    /// An empty briefing for no robot; see [`Briefing::begin`]. It is all zeros, so a `static` takes no flash for it.
    pub const fn new() -> Self {
        Self {
            agent: None,
            edition: None,
            path: None,
            members: Vec::new(),
            paths: FleetStorage::new(),
            passings: Vec::new(),
        }
    }

    /// Removes everything, and begins a briefing for the robot with this index.
    pub fn begin(&mut self, agent: u16) {
        (self.agent, self.edition, self.path) = (Some(agent), None, None);
        self.members.clear();
        self.paths.clear();
        self.passings.clear();
    }

    /// Processes the answers to [`Request::Orders`](crate::Request::Orders), one after the other; other answers are
    /// ignored.
    ///
    /// # Errors
    /// [`Unclear`] if an answer does not fit, has an invalid path, or belongs to another edition than those before it,
    /// because orders have changed meanwhile. Then begin the briefing anew and ask again.
    pub fn take(&mut self, answer: &Answer<S>) -> Result<(), Unclear> {
        match *answer {
            Answer::Member { agent, edition, ref with } => {
                self.is_of(edition)?;
                with.add_to(&mut self.paths)?;
                self.members.push(agent).map_err(|_| InvalidInput::Full("agent"))?;
            }
            Answer::Passing { other, edition, pass, from } => {
                self.is_of(edition)?;
                let passing = Passing { other, pass, from };
                self.passings.push(passing).map_err(|_| InvalidInput::Full("order"))?;
            }
            Answer::Orders { agent, edition, path, at } if self.agent == Some(agent) => {
                self.is_of(edition)?;
                self.path = Some((path, at));
            }
            _ => {}
        }
        Ok(())
    }

    fn is_of(&mut self, edition: Edition) -> Result<(), Unclear> {
        if *self.edition.get_or_insert(edition) == edition { Ok(()) } else { Err(Unclear::Disagreement) }
    }

    /// Storage of the paths of all robots, sorted by index.
    pub fn paths(&self) -> &FleetStorage<'static, S, A, N> {
        &self.paths
    }

    /// Edition of the orders, edition in which the robot got its path, and what is known of its place.
    fn complete(&self) -> Result<(Edition, Edition, Interval<S>), Unclear> {
        let (edition, (path, at)) = self.edition.zip(self.path).ok_or(Unclear::Disagreement)?;
        Ok((edition, Edition { number: path, ..edition }, at))
    }

    fn place_of(&self, agent: u16) -> Option<usize> {
        self.members.iter().position(|&member| member == agent)
    }
}

/// Why a robot does not accept orders. It then stays at its last hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unclear {
    /// There is no room for its regions.
    Full(CapacityError),
    /// The paths are not those of the briefing, or its own path is not among them.
    Mismatch(MismatchError),
    /// The answers belong to different editions or are not complete, or the robot computes other regions than those that
    /// were sent.
    Disagreement,
    /// There are too many robots or orders, or a path is invalid.
    Invalid(InvalidInput),
    /// The path of the orders was begun, but not by this robot as far as it knows: it was restarted since then, or
    /// another one has its index. [`Robot::resume`].
    Begun,
}

impl From<InvalidInput> for Unclear {
    fn from(invalid: InvalidInput) -> Self {
        Self::Invalid(invalid)
    }
}

impl From<EcmError> for Unclear {
    fn from(error: EcmError) -> Self {
        match error {
            EcmError::Full(full) => Self::Full(full),
            EcmError::Mismatch(mismatch) => Self::Mismatch(mismatch),
        }
    }
}

impl From<MismatchError> for Unclear {
    fn from(mismatch: MismatchError) -> Self {
        Self::Mismatch(mismatch)
    }
}

/// The orders of one robot, meant to be a `static`: with at most `A` robots, including its own, and `R` regions in `P`
/// pieces.
#[derive(Debug)]
pub struct Robot<S: Number, const A: usize, const R: usize, const P: usize> {
    orders: Ordered<S, R, P, R>,
    progress: [Progress<S>; A],
    /// Its own index among them.
    own: usize,
    edition: Edition,
    /// Edition in which the robot got its path.
    path: Edition,
    /// The furthest length that it was given, and the furthest hold that it has computed \[m\].
    sent: S,
    hold: S,
}

impl<S: Number, const A: usize, const R: usize, const P: usize> Default for Robot<S, A, R, P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Number, const A: usize, const R: usize, const P: usize> Robot<S, A, R, P> {
    /// A robot without orders, which stays where it is.
    pub const fn new() -> Self {
        let orders = PrecedenceTable::new([EcmEntry::EMPTY; R], [Piece::EMPTY; P], [RegionPrecedence::EMPTY; R]);
        let nowhere = Progress { at: Interval { lo: S::ZERO, hi: S::ZERO }, stop: S::ZERO };
        let edition = Edition { run: 0, number: 0 };
        Self { orders, progress: [nowhere; A], own: 0, edition, path: edition, sent: S::ZERO, hold: S::ZERO }
    }

    /// Edition of its orders.
    pub fn edition(&self) -> Edition {
        self.edition
    }

    /// Index of the robot in the fleet of its briefing.
    pub fn own(&self) -> usize {
        self.own
    }

    /// Says that the robot is on the path of these orders, after [`Unclear::Begun`]. Its place there must have been
    /// found without what it has forgotten, as by landmarks; it is `at` for the next [`Robot::brief`].
    ///
    /// # Errors
    /// [`Unclear::Disagreement`] if the answers are not complete.
    pub fn resume<const N: usize>(&mut self, briefing: &Briefing<S, A, N, R>) -> Result<(), Unclear> {
        (_, self.path, _) = briefing.complete()?;
        (self.sent, self.hold) = (S::ZERO, S::ZERO);
        Ok(())
    }

    /// Accepts orders that are complete, up to [`Answer::Orders`]. `at` is the robot's place on the path that it had
    /// before, or on which it resumes \[m\]; of a place that is known as a range, the lower end. Returns whether its path
    /// has changed; it is then at the start of the new one.
    ///
    /// Cost: that of [`Orders::fill_row`].
    ///
    /// # Errors
    /// [`Unclear`]; the robot then has no orders, and stays where it is.
    #[inline(never)]
    pub fn brief<const N: usize>(
        &mut self,
        briefing: &Briefing<S, A, N, R>,
        fleet: &[Motion<'_, S>],
        at: S,
    ) -> Result<bool, Unclear> {
        self.edition = Edition::default();
        let (edition, path, known) = briefing.complete()?;
        let changed = path != self.path;
        if changed && known.hi > S::ZERO {
            return Err(Unclear::Begun);
        }
        // 0 on a path that was not begun.
        let at = Scalar::min(Scalar::max(S::ZERO, at), known.hi);
        // A briefing that was not begun is of no edition either.
        let agent = briefing.agent.ok_or(Unclear::Disagreement)?;
        self.own = briefing.place_of(agent).ok_or(MismatchError::NoSuchAgent(agent.into()))?;
        self.orders.fill_row(fleet, self.own)?;
        let mut told = briefing.passings.iter();
        for place in 0..self.orders.ecm().len() {
            let told = told.next().ok_or(Unclear::Disagreement)?;
            let (other, from) = {
                let mut row = self.orders.row(fleet, self.own)?;
                let (_, region, _) = row.nth(place).ok_or(Unclear::Disagreement)?;
                (region.other(), region.length().lo)
            };
            if briefing.place_of(told.other) != Some(other) || told.from != from {
                return Err(Unclear::Disagreement);
            }
            self.orders.decide_at(fleet, place, self.own, told.pass, at)?;
        }
        if told.next().is_some() {
            return Err(Unclear::Disagreement);
        }
        self.progress = [Progress::default(); A];
        if changed {
            (self.sent, self.hold) = (S::ZERO, S::ZERO);
        }
        // It may stay where it resumes.
        self.hold = Scalar::max(self.hold, at);
        (self.edition, self.path) = (edition, path);
        Ok(changed)
    }

    /// Processes the place of another robot ([`Answer::Place`]), or how far the robot may go itself ([`Answer::Go`]).
    /// Answers of other editions are ignored; late and repeated ones change nothing.
    pub fn hear<const N: usize>(&mut self, briefing: &Briefing<S, A, N, R>, answer: &Answer<S>) {
        match *answer {
            Answer::Place { agent, edition, at } if edition == self.edition => {
                let place = briefing.place_of(agent).and_then(|place| self.progress.get_mut(place));
                if let Some(known) = place.filter(|known| at > known.at.lo) {
                    *known = Progress::at_rest(at);
                }
            }
            Answer::Go { agent, edition, to }
                if edition == self.edition && Some(agent) == briefing.agent && to > self.sent =>
            {
                self.sent = to;
            }
            _ => {}
        }
    }

    /// How far the robot may go \[m\]; it has to brake so that it does not exceed this. It never decreases on the same
    /// path.
    #[inline(never)]
    pub fn hold(&mut self, fleet: &[Motion<'_, S>]) -> S {
        let hold = self.orders.hold_before(fleet, self.own, &self.progress, MovementAuthority::At(self.sent));
        if let Ok(MovementAuthority::At(hold)) = hold
            && self.edition != Edition::default()
            && hold > self.hold
        {
            self.hold = hold;
        }
        self.hold
    }
}

//! What a robot knows: its orders, and how far those before it have come. From that it computes how far it may go, ten times a
//! second or more often, without a clock and whatever was lost on the line.
//!
//! ```text
//! loop {
//!     briefing.clear();                                  // Request::Orders, answer by answer
//!     briefing.take(&answer)?;
//!     let fleet = briefing.motions()?;
//!     robot.brief(&briefing, &fleet, edition, path, at)?; // Answer::Orders
//!     loop {
//!         robot.hear(&briefing, &answer);                // Answer::Place, Answer::Go
//!         let hold = robot.hold(&fleet);                 // brake so that you stay there
//!     }                                                  // until Refusal::Edition
//! }
//! ```
//!
//! While it asks for new orders, the last hold that it computed counts.

use crate::fleet::{Motions, Store};
use crate::message::{Answer, Edition};
use crate::number::Number;
use heapless::Vec;
use pcr_core::{Full, Hold, Interval, Invalid, Mismatch, Motion, Order, Orders, Pass, Piece, Progress, Region};

/// The orders of one robot as they are sent: paths of at most `A` robots, its own included, with `N` segments in all, and at most
/// `R` regions that it has with them.
#[derive(Debug)]
pub struct Briefing<S: Number, const A: usize, const N: usize, const R: usize> {
    agent: u16,
    /// Of all that was heard.
    edition: Option<Edition>,
    /// Indices of the robots, in increasing order, and their paths.
    members: Vec<u16, A>,
    paths: Store<S, A, N>,
    passings: Vec<Passing<S>, R>,
}

#[derive(Clone, Copy, Debug)]
struct Passing<S> {
    other: u16,
    pass: Pass,
    from: S,
}

impl<S: Number, const A: usize, const N: usize, const R: usize> Briefing<S, A, N, R> {
    /// Of a robot of this index, nothing heard yet.
    pub const fn new(agent: u16) -> Self {
        Self { agent, edition: None, members: Vec::new(), paths: Store::new(), passings: Vec::new() }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.edition = None;
        self.members.clear();
        self.paths.clear();
        self.passings.clear();
    }

    /// Takes one answer to [`Request::Orders`](crate::Request::Orders) after the other; others are passed over.
    ///
    /// # Errors
    /// [`Unclear`]: what does not fit, is no path, or belongs to other orders than what was heard before: they have changed
    /// meanwhile. All is to be cleared and asked for anew then.
    pub fn take(&mut self, answer: &Answer<S>) -> Result<(), Unclear> {
        match *answer {
            Answer::Member { agent, edition, ref with } => {
                self.is_of(edition)?;
                self.paths.add(with)?;
                self.members.push(agent).map_err(|_| Invalid::Full("agent"))?;
            }
            Answer::Passing { other, edition, pass, from } => {
                self.is_of(edition)?;
                let passing = Passing { other, pass, from };
                self.passings.push(passing).map_err(|_| Invalid::Full("order"))?;
            }
            _ => {}
        }
        Ok(())
    }

    fn is_of(&mut self, edition: Edition) -> Result<(), Unclear> {
        if *self.edition.get_or_insert(edition) == edition { Ok(()) } else { Err(Unclear::Disagreement) }
    }

    /// What the orders are about: the paths of all, in the order of their indices.
    ///
    /// # Errors
    /// As [`Store::motions`].
    pub fn motions(&self) -> Result<Motions<'_, S, A>, Invalid> {
        self.paths.motions()
    }

    fn place_of(&self, agent: u16) -> Option<usize> {
        self.members.iter().position(|&member| member == agent)
    }
}

/// Why a robot does not take orders: it stays where its last hold is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unclear {
    /// There is no room for its regions.
    Full(Full),
    /// The paths are not those of the briefing, or its own is not among them.
    Mismatch(Mismatch),
    /// What it was told belongs to different orders, or it computes other regions than it was told of.
    Disagreement,
    /// A robot or an order does not fit, or its path is none.
    Invalid(Invalid),
}

impl From<Invalid> for Unclear {
    fn from(invalid: Invalid) -> Self {
        Self::Invalid(invalid)
    }
}

impl From<Full> for Unclear {
    fn from(full: Full) -> Self {
        Self::Full(full)
    }
}

impl From<Mismatch> for Unclear {
    fn from(mismatch: Mismatch) -> Self {
        Self::Mismatch(mismatch)
    }
}

/// The orders of one robot, made to be a `static`: with at most `A` robots, its own included, `R` regions in `P` pieces.
#[derive(Debug)]
pub struct Robot<S: Number, const A: usize, const R: usize, const P: usize> {
    orders: Orders<S, [Region; R], [Piece<S>; P], [Order<S>; R]>,
    progress: [Progress<S>; A],
    /// Its place among them.
    own: usize,
    edition: Edition,
    /// That in which it got its path.
    path: Edition,
    /// The furthest that it was sent, and the furthest hold that it has computed \[m\].
    sent: S,
    hold: S,
}

impl<S: Number, const A: usize, const R: usize, const P: usize> Default for Robot<S, A, R, P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Number, const A: usize, const R: usize, const P: usize> Robot<S, A, R, P> {
    /// No orders yet: it stays.
    pub const fn new() -> Self {
        let orders = Orders::new([Region::EMPTY; R], [Piece::EMPTY; P], [Order::EMPTY; R]);
        let nowhere = Progress { at: Interval { lo: S::ZERO, hi: S::ZERO }, stop: S::ZERO };
        let edition = Edition { run: 0, number: 0 };
        Self { orders, progress: [nowhere; A], own: 0, edition, path: edition, sent: S::ZERO, hold: S::ZERO }
    }

    /// Which orders it has.
    pub fn edition(&self) -> Edition {
        self.edition
    }

    /// Its own place in the fleet of its briefing.
    pub fn own(&self) -> usize {
        self.own
    }

    /// Takes orders that are complete ([`Answer::Orders`]); `at` is where it is on the path that it has had \[m\]. Tells whether
    /// its path is another one than before: then it is at its start.
    ///
    /// Cost: that of [`Orders::fill_row`].
    ///
    /// # Errors
    /// [`Unclear`]; it has no orders then, and stays.
    #[inline(never)]
    pub fn brief<const N: usize>(
        &mut self,
        briefing: &Briefing<S, A, N, R>,
        fleet: &[Motion<'_, S>],
        edition: Edition,
        path: u16,
        at: S,
    ) -> Result<bool, Unclear> {
        let path = Edition { number: path, ..edition };
        let changed = path != self.path;
        let at = if changed { S::ZERO } else { at };
        if briefing.edition != Some(edition) {
            return Err(Unclear::Disagreement);
        }
        self.own = briefing.place_of(briefing.agent).ok_or(Mismatch::NoSuchAgent(usize::from(briefing.agent)))?;
        self.edition = Edition::default();
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
        (self.edition, self.path) = (edition, path);
        Ok(changed)
    }

    /// Takes in where another robot is ([`Answer::Place`]), and how far it is sent itself ([`Answer::Go`]). What belongs to other
    /// orders is passed over; what comes late or twice changes nothing.
    pub fn hear<const N: usize>(&mut self, briefing: &Briefing<S, A, N, R>, answer: &Answer<S>) {
        match *answer {
            Answer::Place { agent, edition, at } if edition == self.edition => {
                let place = briefing.place_of(agent).and_then(|place| self.progress.get_mut(place));
                if let Some(known) = place.filter(|known| at > known.at.lo) {
                    *known = Progress::at_rest(at);
                }
            }
            Answer::Go { agent, edition, to }
                if edition == self.edition && agent == briefing.agent && to > self.sent =>
            {
                self.sent = to;
            }
            _ => {}
        }
    }

    /// How far it may go \[m\]: it has to brake so that it stays there. It never decreases on the same path.
    #[inline(never)]
    pub fn hold(&mut self, fleet: &[Motion<'_, S>]) -> S {
        let hold = self.orders.hold_before(fleet, self.own, &self.progress, Hold::At(self.sent));
        if let Ok(Hold::At(hold)) = hold
            && self.edition != Edition::default()
            && hold > self.hold
        {
            self.hold = hold;
        }
        self.hold
    }
}

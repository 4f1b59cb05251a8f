//! Robots under way: which one passes first, how far each one has come, and how far it was sent.
//!
//! Robots keep their orders even if messages are lost, late or repeated:
//!
//! - The part that a robot has passed only grows. So an old report is refused or changes nothing, and a hold that is
//!   computed from old places is too low, never too high.
//! - The length to which a robot was sent ([`Answer::Go`]) only grows, too, and the robot never goes further. It is the
//!   upper end of the robot's place, which needs no clock. So a robot that gets a new path passes second wherever
//!   another robot may already be on the way. It is sent with the orders, so that a robot that was restarted on the way
//!   does not take itself to be at the start.
//! - Reports and places carry the edition of the orders. Those about another path have another edition, and are
//!   dropped.

use crate::agent::Agent;
use crate::message::{Answer, Edition, Refusal, Terms, short};
use crate::number::Number;
use crate::table::{Ordered, Regions, Table};
use pcr_core::{
    CapacityError, CheckState, CheckTolerances, EcmCapacity, EcmEntry, EcmError, Interval, MismatchError, Motion,
    PassingState, PathProposal, Piece, PrecedenceTable, Progress, RegionPrecedence, Scalar,
};

/// A table for at most `A` robots, with at most `R` regions in `P` pieces and `O` orders. It needs as many orders as
/// regions, and as many more as a robot has that gets a new path.
#[derive(Debug)]
pub struct Traffic<S: Number, const A: usize, const R: usize, const P: usize, const O: usize> {
    orders: Ordered<S, R, P, O>,
    robots: [Robot<S>; A],
    edition: Edition,
    terms: Terms<S>,
    running: bool,
}

/// The progress of a robot.
#[derive(Clone, Copy, Debug)]
struct Robot<S> {
    /// The length that it has reached at least, and the length to which it was sent.
    at: Interval<S>,
    /// Number of the edition in which it got its path.
    path: u16,
}

impl<S: Number, const A: usize, const R: usize, const P: usize, const O: usize> Traffic<S, A, R, P, O> {
    /// A table without a fleet.
    pub const fn new() -> Self {
        let orders = PrecedenceTable::new([EcmEntry::EMPTY; R], [Piece::EMPTY; P], [RegionPrecedence::EMPTY; O]);
        let at = Interval { lo: S::ZERO, hi: S::ZERO };
        let terms = Terms { run: 0, horizon: S::ZERO, width: S::ZERO };
        let edition = Edition { run: 0, number: 0 };
        Self { orders, robots: [Robot { at, path: 0 }; A], edition, terms, running: false }
    }

    fn robot(&self, agent: usize) -> Result<&Robot<S>, Refusal> {
        if !self.running {
            return Err(Refusal::NotRunning);
        }
        self.robots.get(agent).ok_or(Refusal::NoSuchAgent { agent: short(agent) })
    }

    /// The progress of all robots; the length to which a robot was sent counts as the furthest place at which it can
    /// stop.
    fn progress(&self) -> [Progress<S>; A] {
        self.robots.map(|robot| Progress { at: robot.at, stop: robot.at.hi })
    }

    fn tolerances(&self) -> CheckTolerances<S> {
        // About a millimetre.
        let gain = (0..10).fold(S::ONE, |gain, _| gain.half());
        CheckTolerances { width: self.terms.width, gain }
    }
}

impl<S: Number, const A: usize, const R: usize, const P: usize, const O: usize> Default for Traffic<S, A, R, P, O> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Number, const A: usize, const R: usize, const P: usize, const O: usize> Table<S, R, P>
    for Traffic<S, A, R, P, O>
{
    fn regions(&self) -> &Regions<S, R, P> {
        self.orders.ecm()
    }

    #[inline(never)]
    fn insert(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), EcmError> {
        self.orders.insert(fleet, agent)
    }

    #[inline(never)]
    fn replace<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<(), EcmError> {
        // Robots are not under way: there are no orders to be kept, and so no room for them is needed.
        self.orders.remove(fleet, agent)?;
        if let Some(place) = fleet.get_mut(agent) {
            *place = motion;
        }
        self.orders.insert(fleet, agent)
    }

    #[inline(never)]
    fn erase(&mut self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), MismatchError> {
        self.orders.erase(fleet, agent)
    }

    #[inline(never)]
    fn needed(&mut self, fleet: &[Motion<'_, S>]) -> Result<EcmCapacity, CapacityError> {
        self.running = false;
        self.orders.needed(fleet)
    }

    fn clear(&mut self) {
        self.running = false;
        self.orders.clear();
    }

    fn is_running(&self) -> bool {
        self.running
    }

    #[inline(never)]
    fn order(&mut self, fleet: &[Motion<'_, S>], terms: Terms<S>) -> Result<Edition, Refusal> {
        let possible = |value: S, least: S| Scalar::is_finite(value) && value >= least && value <= S::LIMIT;
        let used = [0, self.edition.run].contains(&terms.run);
        if used || !possible(terms.horizon, S::LEAST) || !possible(terms.width, S::ZERO) {
            return Err(Refusal::Terms);
        }
        self.orders.as_planned(fleet)?;
        let at = Interval::new(S::ZERO, S::ZERO);
        (self.robots, self.terms) = ([Robot { at, path: 1 }; A], terms);
        let (progress, tolerances) = (self.progress(), self.tolerances());
        self.orders.check(fleet, &progress, tolerances, &mut [CheckState::EMPTY; A])?;
        (self.edition, self.running) = (Edition { run: terms.run, number: 1 }, true);
        Ok(self.edition)
    }

    #[inline(never)]
    fn report(
        &mut self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        edition: Edition,
        at: Interval<S>,
        send: &mut impl FnMut(Answer<S>),
    ) -> Result<Answer<S>, Refusal> {
        let known = self.robot(agent)?.at;
        if edition != self.edition {
            return Err(Refusal::Edition(self.edition));
        }
        let end = fleet.get(agent).ok_or(Refusal::NoSuchAgent { agent: short(agent) })?.path().length();
        // This test also refuses NaN.
        if !(S::ZERO <= at.lo && at.lo <= at.hi && at.hi <= known.hi) {
            return Err(Refusal::Beyond { agent: short(agent) });
        }
        // It does not go back: nobody is told how far to go who has lost his place.
        if at.hi < known.lo - self.terms.width {
            return Err(Refusal::Behind { agent: short(agent) });
        }
        let lo = Scalar::max(known.lo, at.lo);
        let to = Scalar::max(known.hi, Scalar::min(lo + self.terms.horizon, end));
        if let Some(robot) = self.robots.get_mut(agent) {
            robot.at = Interval::new(lo, to);
        }
        let mut last = None;
        for (_, region, pass) in self.orders.row(fleet, agent)? {
            let other = region.other();
            if pass == PassingState::Second && last != Some(other) {
                let at = self.robot(other)?.at.lo;
                send(Answer::Place { agent: short(other), edition, at });
                last = Some(other);
            }
        }
        Ok(Answer::Go { agent: short(agent), edition, to })
    }

    #[inline(never)]
    fn orders(
        &self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        with: impl Fn(usize) -> Result<Agent<S>, Refusal>,
        send: &mut impl FnMut(Answer<S>),
    ) -> Result<Answer<S>, Refusal> {
        let (Robot { at, path }, edition) = (*self.robot(agent)?, self.edition);
        let partners = || Ok::<_, Refusal>(self.orders.row(fleet, agent)?.map(|(_, region, _)| region.other()));
        let mut next = 0_usize;
        for other in partners()?
            .filter(|&other| other < agent)
            .chain(core::iter::once(agent))
            .chain(partners()?.filter(|&other| other > agent))
        {
            if other >= next {
                send(Answer::Member { agent: short(other), edition, with: with(other)? });
                next = other.saturating_add(1);
            }
        }
        for (_, region, pass) in self.orders.row(fleet, agent)? {
            send(Answer::Passing { other: short(region.other()), edition, pass, from: region.length().lo });
        }
        Ok(Answer::Orders { agent: short(agent), edition, path, at })
    }

    fn arrived(&self, fleet: &[Motion<'_, S>], agent: usize) -> Result<(), Refusal> {
        let at = self.robot(agent)?.at.lo;
        let motion = fleet.get(agent).ok_or(Refusal::NoSuchAgent { agent: short(agent) })?;
        if at < motion.path().length() { Err(Refusal::NotThere { agent: short(agent) }) } else { Ok(()) }
    }

    #[inline(never)]
    fn admit<'m>(
        &mut self,
        fleet: &mut [Motion<'m, S>],
        agent: usize,
        motion: Motion<'m, S>,
    ) -> Result<Edition, Refusal> {
        // Numbers of editions are not used twice.
        let number = self.edition.number.checked_add(1).ok_or(Refusal::Terms)?;
        let (mut progress, tolerances) = (self.progress(), self.tolerances());
        let zero = Progress::at_rest(S::ZERO);
        let mission = PathProposal { agent, motion, progress: zero };
        self.orders
            .admit(fleet, &mut progress, mission, tolerances, &mut [CheckState::EMPTY; A], |_| PassingState::Second)?;
        if let Some(robot) = self.robots.get_mut(agent) {
            *robot = Robot { at: zero.at, path: number };
        }
        self.edition.number = number;
        Ok(self.edition)
    }
}

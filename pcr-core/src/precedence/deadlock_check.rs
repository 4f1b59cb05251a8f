//! Checks that all agents can finish: computes the least fixed point above their present places.
//!
//! The function F moves every agent as far as its holds allow while the others stay where they are. F is monotone.
//! Agents that keep the orders stay below the least fixed point of F above their present places. It is reached by
//! moving agents in any order. If it is the end of all paths, all agents arrive, in whatever order they move and
//! however late they are; if it is not, no schedule lets all of them arrive (docs/theory/precedence.md).

use crate::ecm::EcmEntry;
use crate::error::CapacityError;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::precedence::authority::MovementAuthority;
use crate::precedence::entry::{PassingState, Progress, RegionPrecedence, other};
use crate::precedence::error::AdmissionError;
use crate::precedence::table::PrecedenceTable;
use crate::scalar::Scalar;

/// Parameters of a check.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CheckTolerances<S> {
    /// Uncertainty of places \[m\]: when an agent stands, the known lower end of its place may be behind it by up to
    /// this. It is known to have left a region only when it is further than this beyond the end of the region. Negative
    /// values count as 0.
    pub width: S,
    /// A gain below this \[m\] does not count as progress, because agents that follow one another around a circle may
    /// gain less and less. The number of sweeps of a check is at most the length of all paths divided by this. With 0
    /// every advance counts. Negative values count as 0.
    pub gain: S,
}

impl<S: Scalar> CheckTolerances<S> {
    /// Neither below 0 nor too large to be added to a length.
    pub(super) fn limited(self) -> Self {
        let limited = |length: S| S::ZERO.max(length).min(S::LIMIT);
        Self { width: limited(self.width), gain: limited(self.gain) }
    }
}

/// The state of an agent in a check.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CheckState<S> {
    /// How far the agent has come \[m\].
    pub(super) at: S,
    /// How far the agent can come in the next step \[m\].
    pub(super) next: S,
    /// End of its path \[m\].
    pub(super) end: S,
    /// Whether the agent has gained since its orders were last evaluated.
    pub(super) moved: bool,
}

impl<S: Scalar> CheckState<S> {
    /// An unused entry, to fill a storage with.
    pub const EMPTY: Self = Self { at: S::ZERO, next: S::ZERO, end: S::ZERO, moved: false };

    /// Whether the agent cannot reach the end of its path.
    pub(super) fn is_stuck(&self) -> bool {
        self.at < self.end
    }
}

impl<S: Scalar> Default for CheckState<S> {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl<S, R, P, O> PrecedenceTable<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[EcmEntry]>,
    P: AsRef<[Piece<S>]>,
    O: AsRef<[RegionPrecedence<S>]> + AsMut<[RegionPrecedence<S>]>,
{
    /// Checks that every agent can reach the end of its path from its present place without breaking an order. Then all
    /// agents arrive, whatever their delays, if none stops for ever. Otherwise some agent waits for ever however they
    /// move, unless orders or paths are changed. The answer is the same for places that are out of date.
    ///
    /// `reaches` needs one entry for each agent; its contents do not matter.
    ///
    /// Cost: one sweep over the regions for each time that an agent has to wait for another one. A sweep evaluates the
    /// orders ([`RegionRef::hold`](crate::RegionRef::hold)) whose first agent has gained.
    ///
    /// # Errors
    /// [`AdmissionError::Stuck`] names one agent that would wait for ever. [`AdmissionError::Late`] names one that is beyond its hold
    /// by more than the least gain. [`CapacityError::Reaches`] if there are too few entries; [`MismatchError`](crate::MismatchError) for
    /// another fleet or a table of one row only.
    pub fn check(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        tolerances: CheckTolerances<S>,
        reaches: &mut [CheckState<S>],
    ) -> Result<(), AdmissionError> {
        self.ecm.holds_all(fleet)?;
        let (needed, capacity) = (fleet.len(), reaches.len());
        let reaches = reaches.get_mut(..needed).ok_or(CapacityError::Reaches { needed, capacity })?;
        let tolerances = tolerances.limited();
        for ((reach, motion), agent) in reaches.iter_mut().zip(fleet).zip(0..) {
            let end = motion.path().length();
            // A place that is NaN is taken as the start.
            let at = S::ZERO.max(Progress::of(progress, agent).known()).min(end);
            *reach = CheckState { at, next: end, end, moved: true };
        }
        self.orders.as_mut().iter_mut().take(self.ecm.len()).for_each(|order| order.hold = -S::LIMIT);
        while self.sweep(fleet, progress, tolerances, reaches)? {
            let mut gained = false;
            for reach in reaches.iter_mut() {
                let gain = reach.next - reach.at;
                reach.moved = gain > S::ZERO && (gain >= tolerances.gain || reach.next >= reach.end);
                if reach.moved {
                    (reach.at, gained) = (reach.next, true);
                }
                reach.next = reach.end;
            }
            if !gained {
                break;
            }
        }
        let Some(agent) = reaches.iter().position(CheckState::is_stuck) else { return Ok(()) };
        Err(self.stuck(agent, reaches.get(agent).copied().unwrap_or_default()))
    }

    /// Updates the holds whose first agents have gained, and lowers `next` of every agent to them. Returns whether any
    /// agent has not reached its end.
    fn sweep(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        tolerances: CheckTolerances<S>,
        reaches: &mut [CheckState<S>],
    ) -> Result<bool, AdmissionError> {
        for (place, order) in (0..self.ecm.len()).zip(self.orders.as_mut()) {
            let Some(agents) = self.ecm.agents_at(place) else { continue };
            let (first, second) = match order.pass {
                PassingState::First => (agents[0], agents[1]),
                PassingState::Second => (agents[1], agents[0]),
                PassingState::Over => continue,
                PassingState::Undecided => {
                    // Neither agent passes it, unless one has passed it already.
                    for agent in agents {
                        let hold = self.ecm.at(fleet, place, agent).map(|region| region.hold_undecided(progress));
                        if let Some(reach) = reaches.get_mut(agent) {
                            reach.next = reach.next.min(length(hold.unwrap_or(MovementAuthority::Inside)));
                        }
                    }
                    continue;
                }
            };
            let Some(reach) = reaches.get(first).copied() else { continue };
            if reach.moved {
                let left = (reach.at - tolerances.width).max(Progress::of(progress, first).known());
                let region = if left > order.exit { None } else { self.ecm.at(fleet, place, second) };
                let hold = length(region.map_or(MovementAuthority::Free, |region| region.hold(order.since, left)));
                // Holds do not decrease, whatever rounding does.
                order.hold = order.hold.max(hold);
            }
            let Some(reach) = reaches.get_mut(second) else { continue };
            if reach.at > order.hold + tolerances.gain {
                return Err(AdmissionError::Late { agent: second, by: first, place });
            }
            reach.next = reach.next.min(order.hold);
        }
        Ok(reaches.iter().any(CheckState::is_stuck))
    }

    /// The agent that keeps this one from going on.
    pub(super) fn stuck(&self, agent: usize, reach: CheckState<S>) -> AdmissionError {
        let mut nearest: Option<(S, usize, usize)> = None;
        for (place, agents, order) in self.places(agent) {
            let hold = match order.pass_of(agent, agents) {
                PassingState::Second => order.hold,
                PassingState::Undecided => reach.at,
                PassingState::First | PassingState::Over => continue,
            };
            if nearest.is_none_or(|(least, ..)| hold < least) {
                nearest = Some((hold, other(agents, agent), place));
            }
        }
        let (_, by, place) = nearest.unwrap_or((reach.at, agent, self.ecm.len()));
        AdmissionError::Stuck { agent, by, place }
    }
}

/// A hold as a length: beyond the end of all paths if free, before their start if inside.
fn length<S: Scalar>(hold: MovementAuthority<S>) -> S {
    match hold {
        MovementAuthority::Free => S::LIMIT,
        MovementAuthority::At(hold) => hold,
        MovementAuthority::Inside => -S::LIMIT,
    }
}

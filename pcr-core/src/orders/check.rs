//! Whether everybody can finish: the least fixed point above where all are now.
//!
//! F takes every agent as far as its holds allow, the others being where they are. It is monotone, and whoever keeps the
//! orders stays below its least fixed point above the present places, which is reached by raising agents in any order. So all
//! arrive, in whatever order and however late, if that fixed point is the end of all paths, and nobody can arrange it if it is
//! not (docs/theory.md).

use crate::ecm::Region;
use crate::error::Full;
use crate::motion::Motion;
use crate::orders::hold::Hold;
use crate::orders::order::{Order, Pass, Progress};
use crate::orders::refused::Refused;
use crate::orders::table::Orders;
use crate::pieces::Piece;
use crate::scalar::Scalar;

/// What a check takes into account.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tolerances<S> {
    /// So far the lower end of an agent's place may be behind it when it stands \[m\]: it is known to have left a region only
    /// when it is further than that behind it.
    pub width: S,
    /// Less way than this \[m\] is no progress: where agents follow one another around a circle they may gain less and less.
    /// It bounds the check at the length of all paths over this many sweeps.
    pub gain: S,
}

/// How far a check has come with an agent.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reach<S> {
    /// Where it has got to \[m\].
    pub(super) at: S,
    /// Where it can get to \[m\].
    pub(super) next: S,
    /// End of its path \[m\].
    pub(super) end: S,
    /// Whether it has gained since its orders were looked at.
    pub(super) moved: bool,
}

impl<S: Scalar> Reach<S> {
    /// To fill a storage with.
    pub const EMPTY: Self = Self { at: S::ZERO, next: S::ZERO, end: S::ZERO, moved: false };

    /// Whether it does not get to the end of its path.
    pub(super) fn is_stuck(&self) -> bool {
        self.at < self.end
    }
}

impl<S: Scalar> Default for Reach<S> {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl<S, R, P, O> Orders<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[Region]>,
    P: AsRef<[Piece<S>]>,
    O: AsRef<[Order<S>]> + AsMut<[Order<S>]>,
{
    /// Whether everybody can get to the end of its path, from where all are now, without breaking an order. Then everybody
    /// will, if nobody stops for ever, whatever the delays; else nobody can avoid that somebody waits for ever, but by
    /// other orders or paths. Old places do not change the answer.
    ///
    /// `reaches` needs a place an agent; what is in it does not matter.
    ///
    /// Cost: a sweep over the regions for each time that somebody has to wait for somebody, in which each order is evaluated
    /// whose first agent has gained ([`RegionRef::hold`](crate::RegionRef::hold)).
    ///
    /// # Errors
    /// [`Refused::Stuck`] names one agent that would wait for ever, [`Refused::Late`] one that is beyond its hold, by more
    /// than the least gain; [`Full::Reaches`] for too few places; [`Mismatch`](crate::Mismatch) for another fleet or the row of one agent only.
    pub fn check(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        tolerances: Tolerances<S>,
        reaches: &mut [Reach<S>],
    ) -> Result<(), Refused> {
        self.ecm.holds_all(fleet)?;
        let reaches = reaches.get_mut(..fleet.len()).ok_or(Full::Reaches)?;
        for ((reach, motion), agent) in reaches.iter_mut().zip(fleet).zip(0..) {
            let end = motion.path().length();
            // What is no number may be the start.
            let at = S::ZERO.max(progress.get(agent).copied().unwrap_or_default().at.lo).min(end);
            *reach = Reach { at, next: end, end, moved: true };
        }
        while self.sweep(fleet, progress, tolerances, reaches)? {
            let mut gained = false;
            for reach in reaches.iter_mut() {
                let gain = reach.next - reach.at;
                reach.moved = gain >= tolerances.gain || (gain > S::ZERO && reach.next >= reach.end);
                if reach.moved {
                    (reach.at, gained) = (reach.next, true);
                }
                reach.next = reach.end;
            }
            if !gained {
                break;
            }
        }
        let Some(agent) = reaches.iter().position(Reach::is_stuck) else { return Ok(()) };
        Err(self.stuck(agent, reaches.get(agent).copied().unwrap_or_default()))
    }

    /// Brings the holds up to date whose first agents have gained, and takes everybody's `next` down to them. Returns
    /// whether there is anybody left who is not at its end.
    fn sweep(
        &mut self,
        fleet: &[Motion<'_, S>],
        progress: &[Progress<S>],
        tolerances: Tolerances<S>,
        reaches: &mut [Reach<S>],
    ) -> Result<bool, Refused> {
        for (place, order) in (0..self.ecm.len()).zip(self.orders.as_mut()) {
            let Some(agents) = self.ecm.agents_at(place) else { continue };
            let (first, second) = match order.pass {
                Pass::First => (agents[0], agents[1]),
                Pass::Second => (agents[1], agents[0]),
                Pass::Over => continue,
                Pass::Undecided => {
                    // Nobody passes it.
                    for agent in agents {
                        let hold = self.ecm.at(fleet, place, agent).map(|region| region.hold(S::ZERO, S::ZERO));
                        if let Some(reach) = reaches.get_mut(agent) {
                            reach.next = reach.next.min(length(hold.unwrap_or(Hold::Inside)));
                        }
                    }
                    continue;
                }
            };
            let Some(reach) = reaches.get(first).copied() else { continue };
            if reach.moved {
                let known = progress.get(first).copied().unwrap_or_default().at.lo;
                let left = (reach.at - tolerances.width).max(known);
                let region = if left > order.exit { None } else { self.ecm.at(fleet, place, second) };
                order.hold = length(region.map_or(Hold::Free, |region| region.hold(order.since, left)));
            }
            let Some(reach) = reaches.get_mut(second) else { continue };
            if reach.at > order.hold + tolerances.gain {
                return Err(Refused::Late { agent: second, by: first, place });
            }
            reach.next = reach.next.min(order.hold);
        }
        Ok(reaches.iter().any(Reach::is_stuck))
    }

    /// Who keeps an agent from going on.
    fn stuck(&self, agent: usize, reach: Reach<S>) -> Refused {
        let mut nearest: Option<(S, usize, usize)> = None;
        for (place, agents, order) in self.places(agent) {
            let hold = match order.pass_of(agent, agents) {
                Pass::Second => order.hold,
                Pass::Undecided => reach.at,
                Pass::First | Pass::Over => continue,
            };
            if nearest.is_none_or(|(least, ..)| hold < least) {
                let by = if agents[0] == agent { agents[1] } else { agents[0] };
                nearest = Some((hold, by, place));
            }
        }
        let (_, by, place) = nearest.unwrap_or((reach.at, agent, self.ecm.len()));
        Refused::Stuck { agent, by, place }
    }
}

/// A hold as a length beyond all paths or before them.
fn length<S: Scalar>(hold: Hold<S>) -> S {
    match hold {
        Hold::Free => S::LIMIT,
        Hold::At(hold) => hold,
        Hold::Inside => -S::LIMIT,
    }
}

//! Reading orders out of the table: for which agent an agent waits, and the list of decisions that reproduces the
//! orders.

use crate::ecm::EcmEntry;
use crate::error::MismatchError;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::precedence::authority::MovementAuthority;
use crate::precedence::entry::{PassingState, Progress, RegionPrecedence, other};
use crate::precedence::table::PrecedenceTable;
use crate::scalar::Scalar;

/// An order that was decided. [`PrecedenceTable::decide_at`] restores it in a table of the same fleet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PrecedenceDecision<S> {
    /// Index of the region in the table.
    pub place: usize,
    /// Agents of the region, lower index first.
    pub agents: [usize; 2],
    /// The order in which the agent with the lower index passes the region.
    pub pass: PassingState,
    /// Length of the second agent from which on the region counts \[m\].
    pub since: S,
}

impl<S, R, P, O> PrecedenceTable<S, R, P, O>
where
    S: Scalar,
    R: AsRef<[EcmEntry]>,
    P: AsRef<[Piece<S>]>,
    O: AsRef<[RegionPrecedence<S>]>,
{
    /// The hold of an agent, as [`PrecedenceTable::hold`], and the agent for which it waits there; `None` if the hold is free.
    ///
    /// # Errors
    /// As [`PrecedenceTable::row`].
    ///
    /// ```
    /// use pcr_core::{MovementAuthority, Motion, RegionPrecedence, PrecedenceTable, Path, Piece, Point, Pose, Profile, Progress, Radians, EcmEntry};
    /// let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    /// let paths = [Path::<f64, 1>::starting_at(pose(-2.0, 0.0, 0.0))?.line(4.0)?, Path::starting_at(pose(0.0, 0.0, 0.0))?];
    /// let profiles = [Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?, Profile::standing()];
    /// let motion = |k: usize| Motion::new(paths[k].as_path(), profiles[k].as_profile(), 0.25, 0.0);
    /// let fleet = [motion(0)?, motion(1)?];
    /// // Nothing is decided: it stays before the one that stands.
    /// let orders = PrecedenceTable::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], [RegionPrecedence::EMPTY; 4], &fleet)?;
    /// let (hold, by) = orders.wait(&fleet, 0, &[Progress::at_rest(0.0); 2])?;
    /// assert!(matches!(hold, MovementAuthority::At(hold) if (hold - 1.5).abs() < 1e-9) && by == Some(1));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn wait(
        &self,
        fleet: &[Motion<'_, S>],
        agent: usize,
        progress: &[Progress<S>],
    ) -> Result<(MovementAuthority<S>, Option<usize>), MismatchError> {
        let (hold, place) = self.nearest(fleet, agent, progress, MovementAuthority::Free)?;
        let agents = place.and_then(|place| self.ecm.agents_at(place));
        Ok((hold, agents.map(|agents| other(agents, agent))))
    }

    /// All orders, sorted by pair; those of one pair are in the order of the table. O(regions).
    pub fn decisions(&self) -> impl Iterator<Item = PrecedenceDecision<S>> {
        self.all().map(|(place, agents, order)| PrecedenceDecision {
            place,
            agents,
            pass: order.pass,
            since: order.since,
        })
    }
}

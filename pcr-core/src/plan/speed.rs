//! Speed plans: when and how fast an agent goes along its path so that it arrives early and meets no region.
//!
//! The path stays as it is, the speed is planned (path-velocity decomposition, Kant and Zucker 1986). The motions are
//! those of `lattice`; time is not divided at all: for every border of cells and every speed there the set of times at
//! which the agent can be there is computed, a few intervals. A motion over a cell that begins at time τ passes each slab
//! of it in an interval that moves with τ, so that every window in which a slab is blocked takes an interval out of
//! the τ that are possible. At rest an agent can wait until its place is blocked. The first time at the goal, from which on
//! it is free for good, leads back to the start.
//!
//! What is lost against all motions under the limits: stops and changes of speed are at borders of cells, and a slab is
//! blocked as a whole. Of the latter the last step wins back what it can: it moves all that comes after a wait to an
//! earlier time, up to a contact.

use crate::error::Invalid;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::plan::lattice::{Drive, LEVELS, Lattice};
use crate::plan::search::{Search, stands};
use crate::plan::times::Times;
use crate::profile::Profile;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// A border of two cells of the path, or one of its ends: a place of the storage of [`plan_speed`].
#[derive(Clone, Debug)]
pub struct Station<S> {
    /// Length along the path \[m\].
    pub(super) length: S,
    /// When the agent can be here with each speed \[s\].
    pub(super) reached: [Times<S>; LEVELS],
    /// Place of the speed that was chosen.
    pub(super) level: usize,
    /// When the agent goes on from here \[s\].
    pub(super) leaves: S,
}

#[cfg(feature = "defmt")]
impl<S: Scalar + defmt::Format> defmt::Format for Station<S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "station at {} m, left at {} s", self.length, self.leaves);
    }
}

impl<S: Scalar> Station<S> {
    /// A free place.
    pub const EMPTY: Self =
        Self { length: S::ZERO, reached: [const { Times::NONE }; LEVELS], level: 0, leaves: S::ZERO };

    /// The times at a speed. At the ends of the path there is one speed only, in any place.
    pub(super) fn reached(&self, level: usize) -> Option<&Times<S>> {
        self.reached.get(level).or(self.reached.first())
    }

    pub(super) fn reached_mut(&mut self, level: usize) -> Option<&mut Times<S>> {
        if level < LEVELS { self.reached.get_mut(level) } else { self.reached.first_mut() }
    }

    pub(super) fn clear(&mut self) {
        self.reached.iter_mut().for_each(Times::clear);
    }
}

impl<S: Scalar> Default for Station<S> {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// A speed profile and the time at which it begins.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedPlan<S: Scalar, const N: usize> {
    /// When the agent sets off \[s\].
    pub start: S,
    /// How it moves then.
    pub profile: Profile<S, N>,
}

impl<S: Scalar, const N: usize> SpeedPlan<S, N> {
    /// When the agent arrives \[s\].
    pub fn end(&self) -> S {
        self.start + self.profile.as_profile().duration()
    }
}

/// Why there is no speed plan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum NoSpeedPlan<S> {
    /// This agent is met while the ego stands at its start, before it may set off; or as it sets off, if it is in motion.
    AtStart(usize),
    /// The goal is never free for good because of this agent.
    AtGoal(usize),
    /// No motion leads further than about this length \[m\], because of this agent.
    Beyond {
        /// Length along the path \[m\].
        length: S,
        /// Index of the other agent in the fleet.
        other: usize,
    },
    /// The drive is not valid, the speeds at the ends are too far apart for the path, there are too few stations, the
    /// profile has too few phases, or it takes longer than the format can tell.
    Invalid(Invalid),
}

impl<S> From<Invalid> for NoSpeedPlan<S> {
    fn from(invalid: Invalid) -> Self {
        Self::Invalid(invalid)
    }
}

// The length is not told: what writes floating point can panic, for all that a linker knows.
impl<S> core::fmt::Display for NoSpeedPlan<S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::AtStart(other) => write!(f, "agent {other} of the fleet is met at the start"),
            Self::AtGoal(other) => write!(f, "agent {other} of the fleet blocks the goal for good"),
            Self::Beyond { other, .. } => write!(f, "agent {other} of the fleet blocks the way on"),
            Self::Invalid(invalid) => write!(f, "{invalid}"),
        }
    }
}

impl<S: core::fmt::Debug> core::error::Error for NoSpeedPlan<S> {}

/// The earliest arrival of an agent along its path that meets none of the regions: those of its row in the table, or of
/// some of the others, each of whom moves as its motion says. Path, radius and earliest start are those of `ego`; its
/// profile does not matter. Before the start it stands, unless the drive says that it is in motion, and after
/// the end it stands for good.
///
/// Among the motions that stop and change their speed at borders of cells only (at most as many cells as there
/// are stations less one, at least 8) and for which a quarter of a cell is blocked as a whole, the plan is the one that
/// arrives first; what can be gained by leaving earlier after a wait is gained. `docs/theory.md` compares with a fine
/// dynamic program over length, speed and time. A set of more than 8 separate intervals of times at one
/// border and speed loses the last but one.
///
/// The plan is checked by [`first_conflict`](crate::first_conflict): no overlap is deeper than [`Encounter::tolerance`](crate::Encounter::tolerance). Plan with a radius that
/// is larger by that, so that agents of the true radii do not even touch.
///
/// Cost: for each region a few hundred operations a slab on its length, a few for each window of a slab and two speeds,
/// and about 20 searches for contacts a wait.
///
/// # Errors
/// [`NoSpeedPlan`].
///
/// ```
/// use pcr_core::{Drive, Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, Region, SpeedPlan, Station};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let limits = Limits { speed: 1.0, acceleration: 0.5 };
/// let profile = Profile::rest_to_rest(4.0, limits)?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([Region::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// let mut stations = [const { Station::EMPTY }; 32];
/// let drive = Drive::rest_to_rest(limits);
/// let plan: SpeedPlan<f64, 8> = pcr_core::plan_speed(&fleet[0], drive, ecm.row(&fleet, 0)?, &mut stations)?;
/// let planned = Motion::new(paths[0].as_path(), plan.profile.as_profile(), 0.25, plan.start)?;
/// // It passes behind the other one, R √2 / v later.
/// assert!((planned.time().hi - fleet[0].time().hi - 0.5 * 2.0_f64.sqrt()).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn plan_speed<'a, S: Scalar, const N: usize>(
    ego: &Motion<'_, S>,
    drive: Drive<S>,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    stations: &mut [Station<S>],
) -> Result<SpeedPlan<S, N>, NoSpeedPlan<S>> {
    let (from, length) = (ego.time().lo, ego.path().length());
    if length <= S::ZERO {
        stands(&regions, S::ZERO, Interval::new(-S::LIMIT, S::LIMIT))?;
        return Ok(SpeedPlan { start: from, profile: Profile::standing() });
    }
    let lattice = Lattice::new(length, drive, stations.len().saturating_sub(1))?;
    let search = Search { lattice, regions, length };
    let used = search.lattice.cells().fold(1_usize, |count, _| count.saturating_add(1));
    let stations = stations.get_mut(..used).ok_or(Invalid::Full("station"))?;
    search.begin(from, stations)?;
    let free = search.free_from()?;
    search.reach(stations)?;
    let arrival = search.arrive(stations, free)?;
    search.trace(arrival, stations)?;
    let mut plan = search.profile(stations)?;
    search.check(ego, &plan)?;
    // Contacts are those of agents in time.
    if !search.regions.clone().any(|region| region.is_uncertain()) {
        search.tighten(ego, &mut plan)?;
        search.check(ego, &plan)?;
    }
    Ok(plan)
}

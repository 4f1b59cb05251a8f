//! Speed plans: when and how fast an agent moves along its path so that it arrives early and meets no region.
//!
//! The path is fixed and the speed is planned (path-velocity decomposition, Kant and Zucker 1986). The motions are
//! those of `lattice`. Time is not discretized: for every border of cells and every speed there, the planner computes
//! the set of times at which the agent can be there, as a few intervals. A motion over a cell that begins at time τ is
//! in each slab of the cell during an interval that is shifted by τ, so every window in which a slab is blocked removes
//! an interval from the possible τ. At rest an agent can wait until its place is blocked. The plan is traced back to
//! the start from the earliest time at the goal after which the goal stays free.
//!
//! Compared with all motions under the limits, the plan loses time because stops and changes of speed are at borders of
//! cells, and because a slab is blocked as a whole. The last step regains some of the latter: it shifts everything
//! after a wait to an earlier time, until there is a contact.

use crate::error::{InvalidInput, MismatchError};
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::plan::constraint::Constraint;
use crate::plan::lattice::SpeedLattice;
use crate::plan::limits::SpeedPlanLimits;
use crate::plan::result::{SpeedPlan, SpeedPlanError};
use crate::plan::search::{SpeedSearch, stands};
use crate::plan::search_node::SearchNode;
use crate::plan::speed_limit::CappedLattice;
use crate::plan::uniform_lattice::UniformLattice;
use crate::profile::Profile;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// The earliest arrival of an agent along its path that meets none of the regions and respects the constraints. Pass
/// the regions of its row in the table, or those with some of the other agents; the other agents move as their motions
/// say. Path, radius and earliest start are taken from `ego`; its profile does not matter. Before the start the agent
/// stands, unless the drive says that it is already moving; after the end it stands for good.
///
/// The plan is the earliest among the motions that stop and change their speed at borders of cells only (the number of
/// cells is at most the number of stations minus one, and at least 8), where a quarter of a cell is blocked as a whole.
/// Then waits are shortened as far as possible. `docs/theory/queries.md` compares the result with a fine dynamic program over
/// length, speed and time. If the set of times at one border and speed has more than 8 separate intervals, the last but
/// one is dropped.
///
/// The plan is checked by [`first_conflict`](crate::first_conflict): no overlap is deeper than
/// [`Encounter::tolerance`](crate::Encounter::tolerance). Plan with a radius that is larger by that, so that agents of
/// the true radii do not even touch.
///
/// Cost: for each region a few hundred operations for each slab on its length, a few for each window of a slab and pair
/// of speeds, and about 20 searches for contacts for each wait.
///
/// # Errors
/// [`SpeedPlanError`].
///
/// ```
/// use pcr_core::{SpeedPlanLimits, Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry, SpeedPlan, SearchNode};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let limits = Limits { speed: 1.0, acceleration: 0.5 };
/// let profile = Profile::rest_to_rest(4.0, limits)?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// let mut stations = [const { SearchNode::EMPTY }; 32];
/// let drive = SpeedPlanLimits::rest_to_rest(limits);
/// let plan: SpeedPlan<f64, 8> = pcr_core::plan_speed(&fleet[0], drive, ecm.row(&fleet, 0)?, &[], &mut stations)?;
/// let planned = Motion::new(paths[0].as_path(), plan.profile.as_profile(), 0.25, plan.start)?;
/// // It passes behind the other one, R √2 / v later.
/// assert!((planned.time().hi - fleet[0].time().hi - 0.5 * 2.0_f64.sqrt()).abs() < 1e-6);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn plan_speed<'a, S: Scalar, const N: usize>(
    ego: &Motion<'_, S>,
    drive: SpeedPlanLimits<S>,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    constraints: &[Constraint<S>],
    stations: &mut [SearchNode<S>],
) -> Result<SpeedPlan<S, N>, SpeedPlanError<S>> {
    let lattice = |most| UniformLattice::new(ego.path().length(), drive, most);
    plan(ego, lattice, regions, constraints, stations)
}

/// The earliest arrival of an agent that is nowhere faster than its motion `ego`: [`plan_speed`] with another set of
/// motions. It is for limits that differ along the path, such as a lower speed on some edges of a roadmap or turns in
/// place: `ego` is then the fastest motion under them.
///
/// Accelerations and decelerations are at most the least one that `ego` has between the same two stops. Where `ego`
/// stands, the agent stands at least as long. Speeds at the start and the end are those of `ego`.
///
/// The plan is the earliest among the motions that stop and change their speed at borders of cells only, which are parts
/// of the phases of `ego` (at least one for each). The motion of `ego` with a later start is one of these. Everything else
/// is as for [`plan_speed`].
///
/// # Errors
/// [`SpeedPlanError`].
///
/// ```
/// use pcr_core::{Ecm, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry, SpeedPlan, SearchNode};
/// let east = Pose { position: Point::new(-4.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(2.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(8.0)?, Path::starting_at(north)?.line(4.0)?];
/// // 1 m/s on the first half, 0.5 m/s on the second one.
/// let slower = Profile::<f64, 5>::from_pieces(0.0, [(1.0, 1.0), (3.125, 0.0), (0.5, -1.0), (7.75, 0.0), (0.5, -1.0)])?;
/// let crosses = Profile::<f64, 5>::from_pieces(0.0, [(5.0, 0.0), (1.0, 1.0), (3.0, 0.0), (1.0, -1.0)])?;
/// let motion = |path, profile| Motion::new(path, profile, 0.25, 0.0);
/// let fleet = [
///     motion(paths[0].as_path(), slower.as_profile())?,
///     motion(paths[1].as_path(), crosses.as_profile())?,
/// ];
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// let mut stations = [const { SearchNode::EMPTY }; 65];
/// let plan: SpeedPlan<f64, 32> = pcr_core::plan_speed_below(&fleet[0], ecm.row(&fleet, 0)?, &[], &mut stations)?;
/// let speeds = plan.profile.as_profile();
/// assert!(speeds.top_speed() <= 1.0 && speeds.speed_at(speeds.first_time_at(5.0)) <= 0.5);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn plan_speed_below<'a, S: Scalar, const N: usize>(
    ego: &Motion<'_, S>,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    constraints: &[Constraint<S>],
    stations: &mut [SearchNode<S>],
) -> Result<SpeedPlan<S, N>, SpeedPlanError<S>> {
    let lattice = |most| CappedLattice::new(ego.profile(), ego.path().length(), most);
    plan(ego, lattice, regions, constraints, stations)
}

/// The earliest of the motions of a lattice, which is made for a largest number of cells.
fn plan<'a, S: Scalar, L: SpeedLattice<S>, const N: usize>(
    ego: &Motion<'_, S>,
    lattice: impl FnOnce(usize) -> Result<L, InvalidInput>,
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    constraints: &[Constraint<S>],
    stations: &mut [SearchNode<S>],
) -> Result<SpeedPlan<S, N>, SpeedPlanError<S>> {
    let (from, length) = (ego.time().lo, ego.path().length());
    constraints.iter().try_for_each(Constraint::checked)?;
    if regions.clone().any(|region| !ego.is_within(region.ego_motion())) {
        return Err(MismatchError::OtherFleet.into());
    }
    if length <= S::ZERO {
        stands(&regions, S::ZERO, Interval::new(-S::LIMIT, S::LIMIT))?;
        if constraints.iter().any(|constraint| constraint.is_broken_by(ego, from)) {
            return Err(SpeedPlanError::Constrained { length: S::ZERO });
        }
        return Ok(SpeedPlan { start: from, profile: Profile::standing() });
    }
    let lattice = lattice(stations.len().saturating_sub(1))?;
    let search = SpeedSearch { lattice, regions, constraints, from, length };
    let used = search.lattice.cells().fold(1_usize, |count, _| count.saturating_add(1));
    let stations = stations.get_mut(..used).ok_or(InvalidInput::Full("station"))?;
    search.begin(from, stations)?;
    let free = search.free_from()?;
    search.reach(stations)?;
    let arrival = search.arrive(stations, free)?;
    search.trace(arrival, stations)?;
    let mut plan = search.profile(stations)?;
    search.check(ego, &plan)?;
    // Searches for contacts do not consider lateness.
    if !search.regions.clone().any(|region| region.is_uncertain()) {
        search.tighten(ego, &mut plan)?;
        search.check(ego, &plan)?;
    }
    Ok(plan)
}

//! The regions of two agents, without a table.

use crate::error::CapacityError;
use crate::motion::Motion;
use crate::pair::AgentPair;
use crate::piece_store::{Piece, PieceList, PieceStore};
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Calls `found` with each region of two agents. The first agent is the ego; the indices are 0 and 1. The regions are
/// those that a table of the two agents would hold. `storage` needs room for the pieces of the pair and is overwritten;
/// nothing in it is kept.
///
/// Meant for solvers and for millions of pairs: it avoids the bookkeeping that [`Ecm`](crate::Ecm) does for its fleet.
///
/// Cost: that of one pair in a table.
///
/// ```
/// use pcr_core::{Motion, Path, Piece, Point, Pose, Profile, Radians, overlaps};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let (east, north) = (motion(paths[0].as_path())?, motion(paths[1].as_path())?);
///
/// let (mut storage, mut delays) = ([Piece::EMPTY; 4], None);
/// overlaps(&east, &north, &mut storage, |region| delays = Some(region.forbidden_delays()))?;
/// assert!((delays.unwrap().hi - 0.5 * 2.0_f64.sqrt()).abs() < 1e-8);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// # Errors
/// [`CapacityError::Pieces`] if the storage is too small, [`CapacityError::Pair`] if no storage is large enough; `found` was not called
/// then.
pub fn overlaps<S: Scalar>(
    first: &Motion<'_, S>,
    second: &Motion<'_, S>,
    storage: &mut [Piece<S>],
    mut found: impl FnMut(&RegionRef<'_, S>),
) -> Result<(), CapacityError> {
    if !first.swept().meets(second.swept()) {
        return Ok(());
    }
    let (pair, mut pieces) = (AgentPair::new(first, second), PieceStore::new(storage));
    pair.find(&mut pieces).map_err(|full| if pieces.pair_is_full() { CapacityError::Pair([0, 1]) } else { full })?;
    while let Some(head) = pieces.take_region() {
        found(&RegionRef::new(pair, PieceList::new(pieces.slots(), head), [0, 1], false));
    }
    Ok(())
}

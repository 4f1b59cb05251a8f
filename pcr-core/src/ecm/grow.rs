//! Tables of a host, whose storage grows with what is found.

extern crate std;

use crate::ecm::{Ecm, Region};
use crate::error::Full;
use crate::motion::Motion;
use crate::pieces::Piece;
use crate::scalar::Scalar;
use std::collections::TryReserveError;
use std::vec::Vec;

impl<S: Scalar> Ecm<S, Vec<Region>, Vec<Piece<S>>> {
    /// The table of a whole fleet, as [`Ecm::build`], in vectors that grow until all regions have room (feature `std`).
    ///
    /// Cost: at most twice that of [`Ecm::build`], as a table that does not fit is begun again with twice the room. It begins with
    /// that for 16 regions and 32 pieces an agent, more than the fleets of `docs/evaluation.md` need.
    ///
    /// # Errors
    /// [`Full::Pair`] and [`Full::Agents`], which no storage helps; [`Full::Regions`] and [`Full::Pieces`] where there is no more
    /// memory.
    pub fn grown(fleet: &[Motion<'_, S>]) -> Result<Self, Full> {
        let room = fleet.len().saturating_add(1).saturating_mul(16);
        let mut ecm = Self::new(Vec::new(), Vec::new());
        lengthened(&mut ecm.regions, room, Region::EMPTY).map_err(|_| Full::Regions)?;
        lengthened(ecm.pieces.storage(), room.saturating_mul(2), Piece::EMPTY).map_err(|_| Full::Pieces)?;
        while let Err(full) = ecm.fill(fleet) {
            ecm.grow(full)?;
        }
        Ok(ecm)
    }

    /// Twice the room for what was full. The regions stay. After it, try again what failed (feature `std`):
    ///
    /// ```
    /// # use pcr_core::{Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, Region, Unchanged};
    /// # let pose = |y, heading| Pose { position: Point::new(-2.0, y), heading: Radians(heading) };
    /// # let paths = [Path::<f64, 1>::starting_at(pose(0.0, 0.0))?.line(4.0)?, Path::starting_at(pose(0.1, 0.0))?.line(4.0)?];
    /// # let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    /// # let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
    /// # let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
    /// let mut ecm = Ecm::new(vec![], vec![]);
    /// ecm.insert(&fleet[..1], 0)?;
    /// while let Err(unchanged) = ecm.insert(&fleet, 1) {
    ///     match unchanged {
    ///         Unchanged::Full(full) => ecm.grow(full)?,
    ///         Unchanged::Mismatch(mismatch) => return Err(mismatch.into()),
    ///     }
    /// }
    /// assert_eq!(ecm.len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What no storage helps, as it came: all but [`Full::Regions`] and [`Full::Pieces`], and those where there is no more memory.
    pub fn grow(&mut self, full: Full) -> Result<(), Full> {
        let twice = |room: usize| room.saturating_add(1).saturating_mul(2);
        let (regions, pieces) = (twice(self.regions.len()), twice(self.pieces.storage().len()));
        match full {
            Full::Regions => lengthened(&mut self.regions, regions, Region::EMPTY),
            Full::Pieces => lengthened(self.pieces.storage(), pieces, Piece::EMPTY),
            _ => return Err(full),
        }
        .map_err(|_| full)
    }
}

/// A storage of this length, if there is memory for it: a failed allocation would end the program.
fn lengthened<T: Clone>(storage: &mut Vec<T>, room: usize, empty: T) -> Result<(), TryReserveError> {
    storage.try_reserve_exact(room.saturating_sub(storage.len()))?;
    storage.resize(room, empty);
    Ok(())
}

//! Tables on a host, whose storage grows as needed.

extern crate alloc;

use crate::ecm::{Ecm, EcmEntry};
use crate::error::CapacityError;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::scalar::Scalar;
use alloc::collections::TryReserveError;
use alloc::vec::Vec;

impl<S: Scalar> Ecm<S, Vec<EcmEntry>, Vec<Piece<S>>> {
    /// Computes the table of a whole fleet, like [`Ecm::build`], in vectors that grow until all regions fit (feature
    /// `alloc`).
    ///
    /// Cost: at most twice that of [`Ecm::build`], because a table that does not fit is computed again with twice the
    /// room. The first attempt has room for 16 regions and 32 pieces for each agent, more than the fleets of
    /// `docs/maintain/evaluation.md` (in the repository) need.
    ///
    /// # Errors
    /// [`CapacityError::Pair`] and [`CapacityError::Agents`], which more storage does not help; [`CapacityError::Regions`] and [`CapacityError::Pieces`] if
    /// the allocation of memory fails.
    pub fn grown(fleet: &[Motion<'_, S>]) -> Result<Self, CapacityError> {
        let room = fleet.len().saturating_add(1).saturating_mul(16);
        let mut ecm = Self::new(Vec::new(), Vec::new());
        let pieces = room.saturating_mul(2);
        lengthened(&mut ecm.regions, room, EcmEntry::EMPTY)
            .map_err(|_| CapacityError::Regions { needed: room, capacity: 0 })?;
        lengthened(ecm.pieces.storage(), pieces, Piece::EMPTY)
            .map_err(|_| CapacityError::Pieces { needed: pieces, capacity: 0 })?;
        while let Err(full) = ecm.fill(fleet) {
            ecm.grow(full)?;
        }
        Ok(ecm)
    }

    /// Doubles the storage that was full, or gives it what was needed if that is more. The regions stay. Afterwards repeat the call that failed (feature `alloc`):
    ///
    /// ```
    /// # use pcr_core::{Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry, EcmError};
    /// # let pose = |y, heading| Pose { position: Point::new(-2.0, y), heading: Radians(heading) };
    /// # let paths = [Path::<f64, 1>::starting_at(pose(0.0, 0.0))?.line(4.0)?, Path::starting_at(pose(0.1, 0.0))?.line(4.0)?];
    /// # let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    /// # let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
    /// # let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
    /// let mut ecm = Ecm::new(vec![], vec![]);
    /// ecm.insert(&fleet[..1], 0)?;
    /// while let Err(error) = ecm.insert(&fleet, 1) {
    ///     match error {
    ///         EcmError::Full(full) => ecm.grow(full)?,
    ///         EcmError::Mismatch(mismatch) => return Err(mismatch.into()),
    ///     }
    /// }
    /// assert_eq!(ecm.len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns `full` itself if more storage does not help (all variants but [`CapacityError::Regions`] and [`CapacityError::Pieces`]),
    /// or if the allocation of memory fails.
    pub fn grow(&mut self, full: CapacityError) -> Result<(), CapacityError> {
        let twice = |room: usize| room.saturating_add(1).saturating_mul(2);
        let (regions, pieces) = (twice(self.regions.len()), twice(self.pieces.storage().len()));
        match full {
            CapacityError::Regions { needed, .. } => {
                lengthened(&mut self.regions, regions.max(needed), EcmEntry::EMPTY)
            }
            CapacityError::Pieces { needed, .. } => lengthened(self.pieces.storage(), pieces.max(needed), Piece::EMPTY),
            _ => return Err(full),
        }
        .map_err(|_| full)
    }
}

/// Extends a storage to this length if there is memory for it; a failed allocation would abort the program.
fn lengthened<T: Clone>(storage: &mut Vec<T>, room: usize, empty: T) -> Result<(), TryReserveError> {
    storage.try_reserve_exact(room.saturating_sub(storage.len()))?;
    storage.resize(room, empty);
    Ok(())
}

//! Orders on a host, whose storage grows as needed.

extern crate alloc;

use crate::ecm::{Ecm, EcmEntry};
use crate::error::CapacityError;
use crate::motion::Motion;
use crate::piece_store::Piece;
use crate::precedence::entry::RegionPrecedence;
use crate::precedence::table::PrecedenceTable;
use crate::scalar::Scalar;
use alloc::vec::Vec;

impl<S: Scalar> PrecedenceTable<S, Vec<EcmEntry>, Vec<Piece<S>>, Vec<RegionPrecedence<S>>> {
    /// Computes the table of a whole fleet, with no order decided, like [`PrecedenceTable::build`], in vectors that grow until all
    /// regions fit (feature `alloc`).
    ///
    /// Cost: that of [`Ecm::grown`], and one [`RegionPrecedence`] for each region.
    ///
    /// # Errors
    /// As [`Ecm::grown`]; [`CapacityError::Orders`] if the allocation of memory fails.
    ///
    /// ```
    /// use pcr_core::{Motion, PrecedenceTable, Path, Point, Pose, Profile, Radians};
    /// let stands = Path::<f64, 1>::starting_at(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) })?;
    /// let profile = Profile::<f64, 1>::standing();
    /// let fleet = [Motion::new(stands.as_path(), profile.as_profile(), 0.25, 0.0)?; 3];
    /// assert_eq!(PrecedenceTable::grown(&fleet)?.decisions().count(), 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn grown(fleet: &[Motion<'_, S>]) -> Result<Self, CapacityError> {
        let (ecm, mut orders) = (Ecm::grown(fleet)?, Vec::new());
        let full = CapacityError::Orders { needed: ecm.len(), capacity: 0 };
        orders.try_reserve_exact(ecm.len()).map_err(|_| full)?;
        orders.resize(ecm.len(), RegionPrecedence::EMPTY);
        Ok(Self { ecm, orders })
    }

    /// Doubles the storage that was full, or gives it what was needed if that is more, like [`Ecm::grow`](crate::Ecm::grow). The regions and orders stay. Afterwards
    /// repeat the call that failed (feature `alloc`).
    ///
    /// # Errors
    /// Returns `full` itself if more storage does not help, or if the allocation of memory fails.
    ///
    /// ```
    /// use pcr_core::{Motion, PrecedenceTable, Path, Point, Pose, Profile, Radians, EcmError};
    /// let stands = Path::<f64, 1>::starting_at(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) })?;
    /// let profile = Profile::<f64, 1>::standing();
    /// let fleet = [Motion::new(stands.as_path(), profile.as_profile(), 0.25, 0.0)?; 2];
    /// let mut orders = PrecedenceTable::new(vec![], vec![], vec![]);
    /// orders.insert(&fleet[..1], 0)?;
    /// while let Err(error) = orders.insert(&fleet, 1) {
    ///     match error {
    ///         EcmError::Full(full) => orders.grow(full)?,
    ///         EcmError::Mismatch(mismatch) => return Err(mismatch.into()),
    ///     }
    /// }
    /// assert_eq!(orders.decisions().count(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn grow(&mut self, full: CapacityError) -> Result<(), CapacityError> {
        let CapacityError::Orders { needed, .. } = full else { return self.ecm.grow(full) };
        let len = self.orders.len();
        let room = len.saturating_add(1).max(needed.saturating_sub(len));
        self.orders.try_reserve_exact(room).map_err(|_| full)?;
        self.orders.resize(self.orders.len().saturating_add(room), RegionPrecedence::EMPTY);
        Ok(())
    }
}

//! Stopping distances: an agent keeps a hold if it can stop before it.

use crate::error::{InvalidInput, in_range, not_negative, positive};
use crate::scalar::{Scalar, Wide};

/// How an agent brakes: at a constant deceleration, after a reaction time during which it may continue at its speed.
///
/// ```
/// use pcr_core::BrakingModel;
/// let brakes = BrakingModel::new(0.5, 0.1)?; // 0.5 m/s² after 0.1 s
/// assert!((brakes.distance(1.0) - 1.1_f64).abs() < 1e-12);
/// assert!((brakes.speed(1.1) - 1.0_f64).abs() < 1e-12);
/// # Ok::<(), pcr_core::InvalidInput>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BrakingModel<S> {
    deceleration: S,
    reaction: S,
    /// Speed that the agent would lose in the reaction time if it were braking \[m/s\].
    lost: S,
}

impl<S: Scalar> BrakingModel<S> {
    /// Deceleration \[m/s²\], and reaction time \[s\]: the time between two control steps plus the delay until a
    /// command takes effect.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`] (also for their product), [`InvalidInput::NonPositive`] (deceleration),
    /// [`InvalidInput::Negative`] (reaction time).
    pub fn new(deceleration: S, reaction: S) -> Result<Self, InvalidInput> {
        positive(deceleration, "deceleration")?;
        not_negative(reaction, "reaction time")?;
        let lost = in_range(deceleration.times(reaction).narrow(), "speed lost in the reaction time")?;
        Ok(Self { deceleration, reaction, lost })
    }

    /// Stopping distance from a speed \[m/s\], rounded up \[m\]: `v τ + v² / 2a`. A speed beyond [`Scalar::LIMIT`] is
    /// taken as that, and so is a speed that is no number; a distance beyond it may be too short, but is beyond it as well. 0 if the
    /// speed is not above 0.
    pub fn distance(&self, speed: S) -> S {
        let speed = if speed <= S::LIMIT { S::ZERO.max(speed) } else { S::LIMIT };
        let ramp = speed.portion(speed, self.deceleration.double());
        let way = speed.times(self.reaction).narrow() + ramp;
        // The slack is added to every speed above 0, because the distance itself rounds to 0 for the lowest speeds.
        if speed > S::ZERO { way + S::slack(way + speed) } else { way }
    }

    /// The largest speed \[m/s\] from which this distance \[m\] is enough to stop, rounded down: its
    /// [`BrakingModel::distance`] is at most that distance, except for rounding. 0 if the distance is not above 0, as NaN is
    /// not.
    pub fn speed(&self, distance: S) -> S {
        let distance = S::ZERO.max(distance).min(S::LIMIT);
        if distance <= S::ZERO {
            return S::ZERO;
        }
        let squares = self.deceleration.times(distance).double();
        let root = (squares + self.lost.times(self.lost)).sqrt();
        let speed = S::difference(root, self.lost, squares);
        (speed - S::slack(root)).max(S::ZERO)
    }
}

//! The limits of a speed plan.

use crate::motion::Motion;
use crate::profile::{Limits, Phase};
use crate::scalar::Scalar;

/// The limits of an agent's speed plan, and the speeds at both ends of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedPlanLimits<S> {
    /// Largest speed and acceleration.
    pub limits: Limits<S>,
    /// Speed at the start of the path \[m/s\]. An agent that is already moving there cannot wait.
    pub start: S,
    /// Speed at the end of the path \[m/s\].
    pub goal: S,
}

impl<S: Scalar> SpeedPlanLimits<S> {
    /// A drive that begins and ends at rest.
    pub const fn rest_to_rest(limits: Limits<S>) -> Self {
        Self { limits, start: S::ZERO, goal: S::ZERO }
    }

    /// The drive of a motion: its largest speed and acceleration, and its speeds at the start and the end. `None` if the
    /// motion is slower on its way than these alone allow, by more than the [tolerance](Scalar::tolerance). There is a
    /// reason for that which a drive cannot hold: it turns in place or waits there, or a lower limit holds on a part of
    /// the path.
    ///
    /// ```
    /// use pcr_core::{SpeedPlanLimits, Limits, Motion, Path, Point, Pose, Profile, Radians};
    /// let pose = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// let path = Path::<f64, 1>::starting_at(pose)?.line(4.0)?;
    /// let limits = Limits { speed: 1.0, acceleration: 1.0 };
    /// let fastest = Profile::<f64, 3>::rest_to_rest(4.0, limits)?;
    /// let motion = Motion::new(path.as_path(), fastest.as_profile(), 0.25, 0.0)?;
    /// assert_eq!(SpeedPlanLimits::of(&motion), Some(SpeedPlanLimits::rest_to_rest(limits)));
    ///
    /// // It stops after 2 m, for 3 s.
    /// let stop = [(1.0, 1.0), (1.0, 0.0), (1.0, -1.0), (3.0, 0.0), (1.0, 1.0), (1.0, 0.0), (1.0, -1.0)];
    /// let stops = Profile::<f64, 7>::from_pieces(0.0, stop)?;
    /// assert_eq!(SpeedPlanLimits::of(&motion.with_profile(stops.as_profile(), 0.0)?), None);
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn of(motion: &Motion<'_, S>) -> Option<Self> {
        let phases = motion.profile().phases();
        let accelerations = phases.iter().map(|phase| phase.acceleration().abs());
        let limits = Limits { speed: motion.profile().top_speed(), acceleration: accelerations.fold(S::ZERO, S::max) };
        if !is_fastest(phases, limits) {
            return None;
        }
        let [start, _] = phases.first().map_or([S::ZERO; 2], Phase::speed);
        let [_, goal] = phases.last().map_or([S::ZERO; 2], Phase::speed);
        Some(Self { limits, start, goal })
    }
}

/// Whether phases speed up, go on at the largest speed and slow down, in this order, and each as fast as the limits allow.
fn is_fastest<S: Scalar>(phases: &[Phase<S>], limits: Limits<S>) -> bool {
    let reaches = |value: S, limit: S| value >= limit - S::tolerance(limit);
    let mut last = RampStage::Up;
    phases.iter().filter(|phase| phase.time().length() > S::ZERO).all(|phase| {
        let (speed, acceleration) = (phase.speed(), phase.acceleration());
        let (stage, fully) = if acceleration > S::ZERO {
            (RampStage::Up, reaches(acceleration, limits.acceleration))
        } else if acceleration < S::ZERO {
            (RampStage::Down, reaches(-acceleration, limits.acceleration))
        } else {
            (RampStage::Top, speed.into_iter().all(|speed| reaches(speed, limits.speed)))
        };
        let in_order = last <= stage;
        last = stage;
        in_order && fully
    })
}

/// The parts of the fastest motion, in their order.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum RampStage {
    Up,
    Top,
    Down,
}

//! Results of speed planning.

use crate::error::{InvalidInput, MismatchError};
use crate::profile::Profile;
use crate::scalar::Scalar;

/// A speed profile and the time at which it begins.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedPlan<S: Scalar, const N: usize> {
    /// Time at which the agent sets off \[s\].
    pub start: S,
    /// Speed profile of the motion.
    pub profile: Profile<S, N>,
}

impl<S: Scalar, const N: usize> SpeedPlan<S, N> {
    /// Time at which the agent arrives \[s\].
    pub fn end(&self) -> S {
        self.start + self.profile.as_profile().duration()
    }
}

/// Why there is no speed plan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SpeedPlanError<S> {
    /// This agent hits the ego while that stands at its start and may not set off yet, or, if the ego is already
    /// moving, as it sets off.
    AtStart(usize),
    /// The goal is never free for good because of this agent.
    AtGoal(usize),
    /// No motion gets further than about this length \[m\], because of an agent.
    Beyond {
        /// Length along the path \[m\].
        length: S,
        /// Index of the other agent in the fleet.
        other: usize,
    },
    /// No motion gets further than about this length \[m\], because of a constraint.
    Constrained {
        /// Length along the path \[m\].
        length: S,
    },
    /// The drive or a constraint is invalid, the speeds at the ends are too far apart for the path, there are too few
    /// stations, the profile has too few phases, or the plan takes longer than the format can represent.
    Invalid(InvalidInput),
    /// A region is not one of the ego, or of a smaller disc on its path.
    Mismatch(MismatchError),
}

impl<S> From<MismatchError> for SpeedPlanError<S> {
    fn from(mismatch: MismatchError) -> Self {
        Self::Mismatch(mismatch)
    }
}

impl<S> From<InvalidInput> for SpeedPlanError<S> {
    fn from(invalid: InvalidInput) -> Self {
        Self::Invalid(invalid)
    }
}

// The length is not printed, because the formatting of floating-point numbers contains code that can panic.
impl<S> core::fmt::Display for SpeedPlanError<S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::AtStart(other) => write!(f, "agent {other} of the fleet is met at the start"),
            Self::AtGoal(other) => write!(f, "agent {other} of the fleet blocks the goal for good"),
            Self::Beyond { other, .. } => write!(f, "agent {other} of the fleet blocks the way on"),
            Self::Constrained { .. } => f.write_str("a constraint blocks the way on"),
            Self::Invalid(invalid) => write!(f, "{invalid}"),
            Self::Mismatch(mismatch) => write!(f, "{mismatch}"),
        }
    }
}

impl<S: core::fmt::Debug> core::error::Error for SpeedPlanError<S> {}

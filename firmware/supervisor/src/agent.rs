//! An agent as it is stored in constants and sent in frames.

use heapless::Vec;
use pcr_core::{Curve, FleetStorage, InvalidInput, Limits, Motion, Pose, Scalar, StagedAgent};
use serde::{Deserialize, Serialize};

/// Largest number of lines and arcs in the path of one agent.
pub const MAX_STEPS: usize = 8;

/// A line or an arc of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step<S> {
    /// Shape.
    pub curve: Curve<S>,
    /// Length \[m\].
    pub length: S,
}

/// An agent that drives along its path from rest to rest. `P` holds the steps: a list in a message, a slice in a
/// constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(
    serialize = "S: Serialize, S::Angle: Serialize, P: Serialize",
    deserialize = "S: Deserialize<'de>, S::Angle: Deserialize<'de>, P: Deserialize<'de>"
))]
pub struct Agent<S: Scalar, P = Vec<Step<S>, MAX_STEPS>> {
    /// Radius of the disc \[m\].
    pub radius: S,
    /// Time at which the agent sets off \[s\].
    pub start_time: S,
    /// Largest speed and acceleration.
    pub limits: Limits<S>,
    /// Pose in which the agent sets off.
    pub start: Pose<S>,
    /// Its path.
    pub path: P,
}

impl<S: Scalar, P: AsRef<[Step<S>]>> Agent<S, P> {
    /// Builds the agent in the storage of a fleet.
    ///
    /// # Errors
    /// The errors of the constructors of its path, its profile and its motion; [`InvalidInput::Full`] if there is no room.
    pub fn stage<'f, 'o, const A: usize, const N: usize>(
        &self,
        fleet: &'f mut FleetStorage<'o, S, A, N>,
    ) -> Result<StagedAgent<'f, 'o, S, A, N, 3>, InvalidInput> {
        let mut steps = self.path.as_ref().iter();
        let path = steps.try_fold(fleet.start_at(self.start)?, |path, step| path.segment(step.curve, step.length))?;
        path.rest_to_rest(self.limits)?.disc(self.radius, self.start_time)
    }

    /// Adds the agent to a fleet, and returns its index.
    ///
    /// # Errors
    /// As [`Agent::stage`].
    pub fn add_to<const A: usize, const N: usize>(
        &self,
        fleet: &mut FleetStorage<'_, S, A, N>,
    ) -> Result<usize, InvalidInput> {
        self.stage(fleet)?.add()
    }
}

impl<S: Scalar> Agent<S> {
    /// The agent with this motion and these limits, as it was received: its path is computed from the same bits.
    ///
    /// # Errors
    /// [`InvalidInput::Full`] if the path has more lines and arcs than a message can hold.
    pub fn of(motion: &Motion<'_, S>, limits: Limits<S>) -> Result<Self, InvalidInput> {
        let segments = motion.path().segments();
        let first = segments.first().ok_or(InvalidInput::Full("segment"))?;
        let start = Pose { position: first.point_at(S::ZERO), heading: first.heading_at(S::ZERO) };
        let mut path = Vec::new();
        // A path without lines and arcs is a segment without a length.
        for segment in segments {
            let step = Step { curve: segment.curve(), length: segment.length() };
            path.push(step).map_err(|_| InvalidInput::Full("step"))?;
        }
        Ok(Self { radius: motion.radius(), start_time: motion.time().lo, limits, start, path })
    }
}

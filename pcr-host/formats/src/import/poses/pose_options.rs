//! What may have happened between two poses.

use super::super::ImportError;
#[cfg(feature = "clap")]
use super::super::vehicle::{not_negative, positive};

/// How to read records of what ran, and plans with times.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args), command(next_help_heading = super::super::HEADING))]
pub struct PoseOptions {
    /// Straight between poses to within (poses)
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", value_parser = not_negative))]
    pub deviation: Option<f64>,
    /// Any way between poses, no faster (poses)
    #[cfg_attr(feature = "clap", arg(long, value_name = "M/S", value_parser = positive))]
    pub top_speed: Option<f64>,
    /// Longest time between joined poses (poses)
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", value_parser = positive))]
    pub gap: Option<f64>,
    /// Time between two states (results of db-CBS)
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", value_parser = positive))]
    pub step: Option<f64>,
    /// Numbers in place of names (poses)
    #[cfg_attr(feature = "clap", arg(long))]
    pub anonymous: bool,
}

/// Where an agent may be between two of its poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BetweenPoses {
    /// No farther from the straight line at constant speed than this \[m\].
    Straight(f64),
    /// Wherever it gets from one pose and to the next at this speed \[m/s\]: within an ellipse.
    TopSpeed(f64),
}

impl PoseOptions {
    /// The options that are given, as on the command line.
    pub fn given(&self) -> Vec<&'static str> {
        let all = [
            ("--deviation", self.deviation.is_some()),
            ("--top-speed", self.top_speed.is_some()),
            ("--gap", self.gap.is_some()),
            ("--step", self.step.is_some()),
            ("--anonymous", self.anonymous),
        ];
        all.into_iter().filter(|(_, given)| *given).map(|(option, _)| option).collect()
    }

    pub(super) fn refuse_useless(&self, has_steps: bool) -> Result<(), ImportError> {
        if self.step.is_some() && !has_steps {
            return Err(ImportError::new("--step has no effect: the file has its own times"));
        }
        match (self.deviation, self.top_speed) {
            (Some(_), Some(_)) => Err(ImportError::new("give --deviation or --top-speed, not both")),
            _ => Ok(()),
        }
    }

    /// Returns the bound on where agents are between two poses, if an option gives one.
    pub(super) fn between(&self) -> Option<BetweenPoses> {
        self.deviation.map(BetweenPoses::Straight).or(self.top_speed.map(BetweenPoses::TopSpeed))
    }
}

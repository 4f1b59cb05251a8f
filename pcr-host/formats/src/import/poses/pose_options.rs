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
    /// Turns no faster between poses (poses)
    #[cfg_attr(feature = "clap", arg(long, value_name = "RAD/S", value_parser = positive))]
    pub top_rotation: Option<f64>,
    /// Longest time between joined poses (poses)
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", value_parser = positive))]
    pub gap: Option<f64>,
    /// Time between two states (results of db-CBS)
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", value_parser = positive))]
    pub step: Option<f64>,
    /// Topics of this name only (bags of ROS 2)
    #[cfg_attr(feature = "clap", arg(long = "topic", value_name = "NAME"))]
    pub topics: Vec<String>,
    /// Numbers in place of names (poses)
    #[cfg_attr(feature = "clap", arg(long))]
    pub anonymous: bool,
}

/// Where an agent may be between two of its poses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BetweenPoses {
    /// No point of it is farther than this from where it is if it goes straight at constant speed and turns steadily by the shorter way \[m\].
    Straight(f64),
    /// Wherever it gets from one pose and to the next.
    TopSpeed {
        /// At this speed: within an ellipse \[m/s\].
        speed: f64,
        /// Turning at this rate; 0 for discs, of which it does not matter \[rad/s\].
        rotation: f64,
    },
}

impl PoseOptions {
    /// The options that are given, as on the command line.
    pub fn given(&self) -> Vec<&'static str> {
        let all = [
            ("--deviation", self.deviation.is_some()),
            ("--top-speed", self.top_speed.is_some()),
            ("--top-rotation", self.top_rotation.is_some()),
            ("--gap", self.gap.is_some()),
            ("--step", self.step.is_some()),
            ("--topic", !self.topics.is_empty()),
            ("--anonymous", self.anonymous),
        ];
        all.into_iter().filter(|(_, given)| *given).map(|(option, _)| option).collect()
    }

    pub(super) fn refuse_useless(&self, has_steps: bool, has_topics: bool) -> Result<(), ImportError> {
        if self.step.is_some() && !has_steps {
            return Err(ImportError::new("--step has no effect: the file has its own times"));
        }
        if !self.topics.is_empty() && !has_topics {
            return Err(ImportError::new("--topic has no effect: it is for bags of ROS 2"));
        }
        match (self.deviation, self.top_speed) {
            (Some(_), Some(_)) => Err(ImportError::new("give --deviation or --top-speed, not both")),
            _ => Ok(()),
        }
    }

    /// Refuses what does not fit vehicles that have outlines, or have none.
    pub(super) fn refuse_turns(&self, has_outlines: bool) -> Result<(), ImportError> {
        match (self.top_rotation, self.top_speed, has_outlines) {
            (None, Some(_), true) => Err(ImportError::new(
                "how fast vehicles turn between two poses, on which their outlines depend, is not in the file; give --top-rotation",
            )),
            (Some(_), Some(_), true) | (None, ..) => Ok(()),
            (Some(_), None, _) => Err(ImportError::new("--top-rotation has no effect without --top-speed")),
            (Some(_), Some(_), false) => {
                Err(ImportError::new("--top-rotation has no effect: it is for outlines, and discs have no heading"))
            }
        }
    }

    /// Returns the bound on where agents are between two poses, if an option gives one.
    pub(super) fn between(&self) -> Option<BetweenPoses> {
        let rotation = self.top_rotation.unwrap_or_default();
        let top_speed = self.top_speed.map(|speed| BetweenPoses::TopSpeed { speed, rotation });
        self.deviation.map(BetweenPoses::Straight).or(top_speed)
    }
}

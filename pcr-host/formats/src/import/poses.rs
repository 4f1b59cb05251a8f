//! Records of what ran, and plans of others, as poses at times.
//!
//! ```text
//! pose_options    what may have happened between two poses            PoseOptions, BetweenPoses
//! pose_log        tracks of agents, ordered by time                   PoseLog, PoseTrack, TimedPose
//! message_log     messages of VDA 5050 as mosquitto_sub prints them
//! schedule        plans of libMultiRobotPlanning (YAML)
//! trajectories    results of db-CBS (YAML)
//! configurations  results of LaCAM (text)
//! pose_table      tables with the columns id, t, x, y (CSV)
//! bag             bags of ROS 2 (MCAP), with the feature `bags`
//! ```

#[cfg(feature = "bags")]
mod bag;
mod configurations;
mod message_log;
mod pose_log;
mod pose_options;
mod pose_table;
mod schedule;
#[cfg(test)]
mod tests;
mod trajectories;

pub use pose_log::{HeldTime, PoseLog, PoseTrack, TimedPose};
pub use pose_options::{BetweenPoses, PoseOptions};

use super::{ImportError, ImportOptions, Warnings, given, is_empty};
use crate::byte_order_mark::unmarked;
use crate::footprint::Footprint;
use crate::yaml::YamlDocument;
use pose_log::PoseLogBuilder;

/// Files of timed poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PoseFormat {
    Messages,
    Schedule,
    Trajectories,
    Configurations,
    Table,
}

impl PoseFormat {
    fn detect(text: &str) -> Option<Self> {
        /// Lines before the key of the poses: statistics, and numbers about the search.
        const HEAD: usize = 200;
        let text = unmarked(text);
        let first = text.lines().find(|line| !line.trim().is_empty())?;
        // Other formats begin like this.
        if first.trim_start().starts_with(['{', '[', '<']) {
            return None;
        }
        let has = |key: &str| text.lines().take(HEAD).any(|line| line.trim_end() == key);
        match () {
            () if message_log::is_line(first) => Some(Self::Messages),
            () if pose_table::is_header(first) => Some(Self::Table),
            () if has("solution=") => Some(Self::Configurations),
            () if has("schedule:") => Some(Self::Schedule),
            () if has("result:") => Some(Self::Trajectories),
            () => None,
        }
    }
}

/// Whether a text holds poses at times.
pub(super) fn are_in(text: &str) -> bool {
    PoseFormat::detect(text).is_some()
}

/// The first bytes of a bag of ROS 2 that is read.
#[cfg(feature = "bags")]
pub(crate) const BAG: &[u8] = bag::records::MAGIC;

/// Reads the poses in a bag of ROS 2 (MCAP).
///
/// # Errors
/// As [`poses`], also where the bag was cut, is damaged, or has poses of one vehicle on several topics.
#[cfg(feature = "bags")]
pub fn poses_in_bag(
    source: &mut dyn std::io::Read,
    options: &ImportOptions,
    pose_options: &PoseOptions,
    warnings: &mut Warnings,
) -> Result<PoseLog, ImportError> {
    pose_options.refuse_useless(false, true)?;
    let mut log = builder(options, pose_options, warnings)?;
    bag::read(source, pose_options, &mut log, warnings)?;
    log.finish(warnings)
}

/// What collects the poses of agents of this size.
fn builder<'o>(
    options: &ImportOptions,
    pose_options: &'o PoseOptions,
    warnings: &mut Warnings,
) -> Result<PoseLogBuilder<'o>, ImportError> {
    let fleet = given(options, warnings)?;
    warnings.use_option("fleet");
    // A radius that is given is meant.
    let footprint = fleet.footprint.filter(|_| options.radius.is_none());
    pose_options.refuse_turns(footprint.is_some())?;
    let radius = footprint.as_ref().map(Footprint::circumscribed_radius);
    Ok(PoseLogBuilder::new(pose_options, options.radius.or(radius).or(fleet.radius), footprint))
}

/// Reads the poses in a text.
///
/// # Errors
/// [`ImportError`] where the text is no record and no plan that is known, is damaged or contradicts itself, or where the radius of an agent,
/// or what happens between its poses, is neither in the text nor given.
pub fn poses(
    text: &str,
    options: &ImportOptions,
    pose_options: &PoseOptions,
    warnings: &mut Warnings,
) -> Result<PoseLog, ImportError> {
    if is_empty(text) {
        return Err(ImportError::new("empty"));
    }
    let Some(format) = PoseFormat::detect(text) else {
        let known = "messages of VDA 5050 as mosquitto_sub prints them, schedule: (libMultiRobotPlanning), result: (db-CBS), solution= (LaCAM) \
                     or a table with a header such as id,t,x,y";
        return Err(ImportError::new(format!("no poses with times; known are {known}")));
    };
    pose_options.refuse_useless(format == PoseFormat::Trajectories, false)?;
    let mut log = builder(options, pose_options, warnings)?;
    let text = unmarked(text);
    match format {
        PoseFormat::Messages => message_log::read(text, &mut log, warnings)?,
        PoseFormat::Table => pose_table::read(text, &mut log, warnings)?,
        PoseFormat::Configurations => configurations::read(text, &mut log)?,
        PoseFormat::Schedule | PoseFormat::Trajectories => {
            let document = YamlDocument::read(text).map_err(ImportError::of_yaml)?;
            let root = document.value().map_err(ImportError::of_yaml)?;
            if format == PoseFormat::Schedule {
                schedule::read(&root, &mut log, warnings)?;
            } else {
                trajectories::read(&root, pose_options, &mut log, warnings)?;
            }
        }
    }
    log.finish(warnings)
}

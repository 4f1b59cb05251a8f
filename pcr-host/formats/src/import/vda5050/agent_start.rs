//! When the agents of several messages begin.

use super::super::ImportError;
use super::super::json_access::JsonObject;
use super::super::timestamp::Timestamp;
use crate::scenario::Agent;

/// When an agent begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AgentStart {
    /// It stands, whenever.
    Never,
    /// It moves, and it is not said from when on.
    Unsaid,
    /// It says when.
    At(Timestamp),
}

/// Gives agents their times since that of the first one that has one.
pub(super) fn set(agents: &mut [Agent], begins: &[(String, AgentStart)]) -> Result<(), ImportError> {
    let mut all = begins.iter();
    let origin =
        all.find_map(|(name, begin)| if let AgentStart::At(time) = begin { Some((name, *time)) } else { None });
    let Some((stamped, origin)) = origin else { return Ok(()) };
    for (agent, (name, begin)) in agents.iter_mut().zip(begins) {
        match begin {
            AgentStart::Never => {}
            AgentStart::At(time) => agent.t_start = time.since(origin),
            AgentStart::Unsaid => {
                let problem = "it does not say when it begins, and cannot be read together with what does";
                return Err(ImportError::new(format!("{name}: {problem}: {stamped}")));
            }
        }
    }
    Ok(())
}

/// A time stamp.
pub(super) fn stamp(object: &JsonObject<'_>, field: &str) -> Result<Timestamp, ImportError> {
    match object.text(field)? {
        None => Err(object.missing(field)),
        Some(text) => {
            Timestamp::read(text).ok_or_else(|| object.field_error(field, format_args!("{text:?} is not a time stamp")))
        }
    }
}

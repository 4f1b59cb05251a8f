//! When the agents of several messages begin.

use super::super::ImportError;
use super::super::stamp::Stamp;
use super::super::value::Object;
use crate::scenario::Agent;

/// When an agent begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Begin {
    /// It stands, whenever.
    Never,
    /// It moves, and it is not said from when on.
    Unsaid,
    /// It says when.
    At(Stamp),
}

/// Gives agents their times since that of the first one that has one.
pub(super) fn set(agents: &mut [Agent], begins: &[(String, Begin)]) -> Result<(), ImportError> {
    let mut all = begins.iter();
    let origin = all.find_map(|(name, begin)| if let Begin::At(time) = begin { Some((name, *time)) } else { None });
    let Some((stamped, origin)) = origin else { return Ok(()) };
    for (agent, (name, begin)) in agents.iter_mut().zip(begins) {
        match begin {
            Begin::Never => {}
            Begin::At(time) => agent.t_start = time.since(origin),
            Begin::Unsaid => {
                let problem = "it does not say when it begins, and cannot be read together with what does";
                return Err(ImportError::new(format!("{name}: {problem}: {stamped}")));
            }
        }
    }
    Ok(())
}

/// A time stamp.
pub(super) fn stamp(object: &Object<'_>, field: &str) -> Result<Stamp, ImportError> {
    match object.text(field)? {
        None => Err(object.missing(field)),
        Some(text) => Stamp::read(text)
            .ok_or_else(|| ImportError::new(format!("{}, {field}: {text:?} is not a time stamp", object.name))),
    }
}

//! Numbers of elements, which models up to version 0.0.2 may have.

use super::version::ModelVersion;
use pcr_formats::import::ImportError;
use roxmltree::Node;

/// The numbers that a model has not used; none where it numbers nothing.
pub(super) struct Ids(Option<u64>);

impl Ids {
    /// Those beyond the largest number of a model, leaving out elements that go.
    ///
    /// # Errors
    /// An `id` that is no whole number.
    pub(super) fn of<'a, 'i>(
        model: Node<'a, 'i>,
        version: ModelVersion,
        goes: impl Fn(Node<'a, 'i>) -> bool,
    ) -> Result<Self, ImportError> {
        if version > ModelVersion::V002 {
            return Ok(Self(None));
        }
        let ids = model.descendants().filter(|element| !goes(*element)).filter_map(|element| element.attribute("id"));
        let number = |id: &str| {
            let problem = || ImportError::new(format!("id: {id:?} where a whole number is expected"));
            id.trim().parse::<u32>().map(u64::from).map_err(|_| problem())
        };
        let largest = ids.map(number).collect::<Result<Vec<_>, _>>()?.into_iter().max();
        Ok(Self(largest.map(|largest| largest + 1)))
    }

    /// The next one.
    pub(super) fn next(&mut self) -> Option<u64> {
        let next = self.0?;
        self.0 = Some(next + 1);
        Some(next)
    }

    /// The attribute of a new element, with a blank before it.
    pub(super) fn attribute(&mut self) -> String {
        self.next().map_or_else(String::new, |id| format!(" id=\"{id}\""))
    }
}

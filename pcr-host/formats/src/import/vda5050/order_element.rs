//! Nodes and edges of an order or a state, in the order of travel.

use super::super::json_access::JsonObject;
use super::super::keys::Keys;
use super::super::{ImportError, Warnings, vehicle_heading};
use super::keys::NODE_POSITION;
use crate::json::JsonNode;

/// A node or an edge.
pub(super) struct OrderElement<'j> {
    pub(super) object: JsonObject<'j>,
    sequence: f64,
    pub(super) released: bool,
}

impl<'j> OrderElement<'j> {
    fn new(
        list: &JsonObject<'j>,
        what: &str,
        place: usize,
        value: &'j JsonNode<'j>,
        id: &str,
    ) -> Result<Self, ImportError> {
        let object = JsonObject::new(format!("{}, {what} {}", list.name, place + 1), value)?;
        let name = object.text(id)?.ok_or_else(|| object.missing(id))?;
        let object = object.called(format!("{}, {what} {name}", list.name));
        let released = object.flag("released")?.ok_or_else(|| object.missing("released"))?;
        Ok(Self { sequence: object.required("sequenceId")?, released, object })
    }

    /// Where a node is, if it says so.
    pub(super) fn position(&self) -> Result<Option<[f64; 2]>, ImportError> {
        self.object.object("nodePosition")?.map(|position| position.point()).transpose()
    }

    /// Which way the vehicle faces at a node, if it says so \[rad\].
    pub(super) fn theta(&self) -> Result<Option<f64>, ImportError> {
        self.object.object("nodePosition")?.map_or(Ok(None), |position| vehicle_heading::theta(&position))
    }
}

/// Returns the nodes or the edges of an order or a state, in the order of travel.
pub(super) fn parts<'j>(
    of: &JsonObject<'j>,
    list: &str,
    what: &str,
    id: &str,
) -> Result<Vec<OrderElement<'j>>, ImportError> {
    let values = of.list(list)?.iter().enumerate();
    let mut parts =
        values.map(|(k, value)| OrderElement::new(of, what, k, value, id)).collect::<Result<Vec<_>, _>>()?;
    parts.sort_by(|a, b| a.sequence.total_cmp(&b.sequence));
    // Which of two comes first could not be told.
    let again = parts.iter().zip(parts.iter().skip(1)).find(|(before, after)| before.sequence == after.sequence);
    if let Some((_, again)) = again {
        return Err(again.object.field_error("sequenceId", format_args!("{} is there twice", again.sequence)));
    }
    Ok(parts)
}

/// Checks the keys of nodes or edges, and of the positions of nodes.
pub(super) fn check(parts: &[OrderElement<'_>], keys: &Keys, warnings: &mut Warnings) -> Result<(), ImportError> {
    for part in parts {
        keys.check(&part.object, warnings)?;
        if let Some(position) = part.object.object("nodePosition")? {
            NODE_POSITION.check(&position, warnings)?;
        }
    }
    Ok(())
}

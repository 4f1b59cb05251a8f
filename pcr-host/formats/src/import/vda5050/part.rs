//! Nodes and edges of an order or a state, in the order of travel.

use super::super::keys::Keys;
use super::super::value::Object;
use super::super::{ImportError, Warnings};
use super::keys::NODE_POSITION;
use serde_json::Value;

/// A node or an edge.
pub(super) struct Part<'j> {
    pub(super) object: Object<'j>,
    /// Its `sequenceId`, where it has one.
    sequence: Option<f64>,
    pub(super) released: bool,
}

impl<'j> Part<'j> {
    fn new(list: &Object<'j>, what: &str, place: usize, value: &'j Value, id: &str) -> Result<Self, ImportError> {
        let object = Object::new(format!("{}, {what} {}", list.name, place + 1), value)?;
        let name = object.text(id)?.ok_or_else(|| object.missing(id))?;
        let object = object.called(format!("{}, {what} {name}", list.name));
        let released = object.flag("released")?.unwrap_or(true);
        Ok(Self { sequence: object.number("sequenceId")?, released, object })
    }

    /// Where a node is, if it says so.
    pub(super) fn position(&self) -> Result<Option<[f64; 2]>, ImportError> {
        self.object.object("nodePosition")?.map(|position| position.point()).transpose()
    }

    /// Which way the vehicle faces at a node, if it says so \[rad\].
    pub(super) fn theta(&self) -> Result<Option<f64>, ImportError> {
        self.object.object("nodePosition")?.map_or(Ok(None), |position| position.number("theta"))
    }
}

/// The nodes or the edges of an order or a state. Without numbers the lists are in the order of travel.
pub(super) fn parts<'j>(of: &Object<'j>, list: &str, what: &str, id: &str) -> Result<Vec<Part<'j>>, ImportError> {
    let values = of.list(list)?.iter().enumerate();
    let mut parts = values.map(|(k, value)| Part::new(of, what, k, value, id)).collect::<Result<Vec<_>, _>>()?;
    if parts.iter().all(|part| part.sequence.is_none()) {
        return Ok(parts);
    }
    if let Some(part) = parts.iter().find(|part| part.sequence.is_none()) {
        return Err(part.object.missing("sequenceId"));
    }
    parts.sort_by(|a, b| a.sequence.unwrap_or_default().total_cmp(&b.sequence.unwrap_or_default()));
    // Which of two comes first could not be told.
    let again = parts.iter().zip(parts.iter().skip(1)).find(|(before, after)| before.sequence == after.sequence);
    if let Some((_, again)) = again {
        let number = again.sequence.unwrap_or_default();
        return Err(ImportError::new(format!("{}, sequenceId: {number} is there twice", again.object.name)));
    }
    Ok(parts)
}

/// Checks the keys of nodes or edges, and of the positions of nodes.
pub(super) fn check(parts: &[Part<'_>], keys: &Keys, warnings: &mut Warnings) -> Result<(), ImportError> {
    for part in parts {
        keys.check(&part.object, warnings)?;
        if let Some(position) = part.object.object("nodePosition")? {
            NODE_POSITION.check(&position, warnings)?;
        }
    }
    Ok(())
}

/// Checks that numbers go on from node to edge to node: where one is missing, a part of the way is.
pub(super) fn go_on(nodes: &[Part<'_>], edges: &[Part<'_>]) -> Result<(), ImportError> {
    let parts: Vec<&Part<'_>> = alternating(nodes, edges).collect();
    if parts.iter().all(|part| part.sequence.is_none()) {
        return Ok(());
    }
    let mut expected = None;
    for part in parts {
        let number = part.sequence.ok_or_else(|| part.object.missing("sequenceId"))?;
        if let Some(expected) = expected.filter(|expected| *expected != number) {
            let problem = format!("{number} where {expected} is expected, as they count from node to edge to node");
            return Err(ImportError::new(format!("{}, sequenceId: {problem}", part.object.name)));
        }
        expected = Some(number + 1.0);
    }
    Ok(())
}

/// The nodes with the edges between them.
fn alternating<'p, 'j>(nodes: &'p [Part<'j>], edges: &'p [Part<'j>]) -> impl Iterator<Item = &'p Part<'j>> {
    let edges = edges.iter().map(Some).chain([None]);
    nodes.iter().zip(edges).flat_map(|(node, edge)| [Some(node), edge]).flatten()
}

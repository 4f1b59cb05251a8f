//! How models up to version 0.0.3 say in the visual layout where points, paths and blocks are drawn.
//!
//! openTCS 5 reads no model of these versions in which one of them lacks such an element while others have one.

use super::{elements, escaped};
use crate::text_edits::{TextEdits, ending, indent};
use roxmltree::Node;
use std::collections::HashMap;

/// The elements of the visual layout for things of the model, by the names of these.
pub(super) struct Visual<'a, 'i> {
    of: HashMap<&'a str, Node<'a, 'i>>,
    last: Option<Node<'a, 'i>>,
}

impl<'a, 'i> Visual<'a, 'i> {
    pub(super) fn of(model: Node<'a, 'i>) -> Self {
        let all = || elements(model, "visualLayout").flat_map(|visual| elements(visual, "modelLayoutElement"));
        let named = |element: Node<'a, 'i>| Some((element.attribute("visualizedObjectName")?, element));
        Self { of: all().filter_map(named).collect(), last: all().last() }
    }

    /// The element of a thing.
    pub(super) fn element(&self, name: &str) -> Option<Node<'a, 'i>> {
        self.of.get(name).copied()
    }

    /// What an element says under a name.
    pub(super) fn value(element: Node<'a, '_>, name: &str) -> Option<&'a str> {
        let mut properties = elements(element, "property");
        properties.find(|property| property.attribute("name") == Some(name))?.attribute("value").map(str::trim)
    }

    /// A new element.
    pub(super) fn new_element(name: &str, layer: &str, values: &[(&str, String)]) -> String {
        let values = values.iter().map(|(name, value)| format!("<property name=\"{name}\" value=\"{value}\"/>"));
        let values = values.collect::<String>();
        let (name, layer) = (escaped(name), escaped(layer));
        format!("<modelLayoutElement visualizedObjectName=\"{name}\" layer=\"{layer}\">{values}</modelLayoutElement>")
    }

    /// Adds elements behind the others, if there are any.
    pub(super) fn add(&self, text: &str, offset: usize, added: &[String], edits: &mut TextEdits) {
        let Some(last) = self.last else { return };
        let margin = indent(text, last.range().start + offset).unwrap_or("        ");
        let end = ending(text);
        let added = added.iter().map(|element| format!("{end}{margin}{element}")).collect::<String>();
        edits.insert(last.range().end + offset, added);
    }
}

//! Lenient reading of XML: attributes as numbers, and messages that name the element.

use super::{ImportError, WarningCode, Warnings};
use crate::byte_order_mark::unmarked;
use crate::scenario::LIMIT;
use roxmltree::{Document, Node};

/// Deepest nesting of elements that is read: the parser recurses.
const DEPTH: usize = 200;

/// The document in a text; a byte order mark at its start is skipped.
pub(super) fn parse(text: &str) -> Result<Document<'_>, ImportError> {
    let text = unmarked(text);
    let mut depth = 0_usize;
    for tag in tags(text) {
        let closes = tag.starts_with("</");
        depth = if closes { depth.saturating_sub(1) } else { depth + usize::from(!tag.ends_with("/>")) };
        if depth > DEPTH {
            return Err(ImportError::new(format!("not XML that is read: nested deeper than {DEPTH} elements")));
        }
    }
    Document::parse(text).map_err(|error| ImportError::of_xml(text, &error))
}

/// The tags of a text, without comments, instructions and what is quoted as text. Ends where a tag has no end.
fn tags(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        loop {
            rest = rest.get(rest.find('<')?..)?;
            let other = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"), ("<!", ">")];
            if let Some((begin, end)) = other.into_iter().find(|(begin, _)| rest.starts_with(begin)) {
                let inner = rest.get(begin.len()..)?;
                rest = inner.get(inner.find(end)? + end.len()..)?;
                continue;
            }
            let mut quote = None;
            let end = rest.char_indices().find(|&(_, c)| match quote {
                Some(open) => {
                    quote = Some(open).filter(|&open| open != c);
                    false
                }
                None if matches!(c, '"' | '\'') => {
                    quote = Some(c);
                    false
                }
                None => c == '>',
            });
            let (tag, behind) = rest.split_at_checked(end?.0 + 1)?;
            rest = behind;
            return Some(tag);
        }
    })
}

/// The name of the first element of a text, where it begins like XML.
pub(super) fn root_of(text: &str) -> Option<&str> {
    let mut rest = unmarked(text).trim_start();
    loop {
        let (skipped, end) = match rest {
            _ if rest.starts_with("<?") => (2, "?>"),
            _ if rest.starts_with("<!--") => (4, "-->"),
            _ if rest.starts_with("<!DOCTYPE") => (9, if is_short(rest) { ">" } else { "]>" }),
            _ => break,
        };
        let end = rest.get(skipped..)?.find(end)? + skipped + end.len();
        rest = rest.get(end..)?.trim_start();
    }
    let name = rest.strip_prefix('<')?;
    name.split(|c: char| c.is_whitespace() || c == '>' || c == '/').next()
}

/// Whether a document type declaration has no declarations of its own, in brackets.
fn is_short(declaration: &str) -> bool {
    declaration.find('>').is_none_or(|end| !declaration[..end].contains('['))
}

/// All text within an element: comments and other elements may cut it into pieces.
pub(super) fn content(node: Node<'_, '_>) -> String {
    node.descendants().filter(Node::is_text).filter_map(|piece| piece.text()).collect()
}

/// An attribute as a number, where it is there.
pub(super) fn optional(node: Node<'_, '_>, name: &str, attribute: &str) -> Result<Option<f64>, ImportError> {
    node.attribute(attribute).map(|_| number(node, name, attribute)).transpose()
}

/// An attribute as a number.
pub(super) fn number(node: Node<'_, '_>, name: &str, attribute: &str) -> Result<f64, ImportError> {
    let text = node.attribute(attribute).ok_or_else(|| ImportError::new(format!("{name}, {attribute}: missing")))?;
    match text.trim().parse::<f64>() {
        Ok(number) if number.abs() <= LIMIT => Ok(number),
        _ => {
            let text: String = text.chars().take(40).collect();
            Err(ImportError::new(format!("{name}, {attribute}: {text:?} where a number up to {LIMIT:e} is expected")))
        }
    }
}

/// Elements for what others add, whatever that is called: of OpenDRIVE and of GraphML.
const FOREIGN: [&str; 4] = ["userData", "include", "dataQuality", "data"];

/// Elements that are called like what is read below `home`, in any case of the letters, and are not there: below something else, or
/// in another case. With what says so.
pub(super) fn astray<'a, 'i>(
    home: Node<'a, 'i>,
    names: &'static [&'static str],
) -> impl Iterator<Item = (Node<'a, 'i>, String)> {
    let elements = home.document().root_element().descendants();
    let namespace = home.tag_name().namespace();
    let is_foreign = move |element: Node<'_, '_>| {
        let (name, own) = (element.tag_name().name(), element.tag_name().namespace());
        own != namespace || FOREIGN.contains(&name)
    };
    elements.filter(move |element| *element != home && element.is_element()).filter_map(move |element| {
        if element.ancestors().filter(Node::is_element).any(is_foreign) {
            return None;
        }
        let own = element.tag_name().name();
        let name = names.iter().find(|name| name.eq_ignore_ascii_case(own))?;
        if element.parent() == Some(home) && *name == own {
            return None;
        }
        let id = ["name", "id", "number"]
            .iter()
            .filter_map(|attribute| element.attribute(*attribute))
            .find(|id| !id.is_empty())
            .map_or_else(String::new, |id| format!(" {id}"));
        let parent = element.parent().map_or("", |parent| parent.tag_name().name());
        let home = home.tag_name().name();
        Some((element, format!("{own}{id}, in {parent}: what is read is {name} in {home}")))
    })
}

/// Loses such elements.
pub(super) fn lose_astray(home: Node<'_, '_>, names: &'static [&'static str], warnings: &mut Warnings) {
    astray(home, names).for_each(|(_, problem)| warnings.lose(format_args!("{problem}")));
}

/// Says which elements are not known, and hence not read.
pub(super) fn warn_of_unknown(home: Node<'_, '_>, known: &[&str], warnings: &mut Warnings) {
    for element in home.children().filter(Node::is_element) {
        let own = element.tag_name().name();
        if !known.contains(&own) {
            warnings.add(
                WarningCode::UnknownKey,
                own,
                format!("not known in {}, and not read", home.tag_name().name()),
            );
        }
    }
}

/// Says which attributes of these elements are not known, and hence not read. Attributes of other namespaces are none of the format.
pub(super) fn warn_of_unknown_attributes(home: Node<'_, '_>, known: &[(&str, &[&str])], warnings: &mut Warnings) {
    for element in home.descendants().filter(Node::is_element) {
        let own = element.tag_name().name();
        let Some((_, known)) = known.iter().find(|(name, _)| *name == own) else { continue };
        for attribute in element.attributes().filter(|attribute| attribute.namespace().is_none()) {
            let attribute = attribute.name();
            if !known.contains(&attribute) {
                let name = element.attribute("name").map_or_else(|| own.to_owned(), |name| format!("{own} {name}"));
                warnings.add(
                    WarningCode::UnknownKey,
                    name,
                    format!("its attribute {attribute} is not known, and not read"),
                );
            }
        }
    }
}

/// The children of an element of this name.
pub(super) fn children<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

/// The first child of this name.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Option<Node<'a, 'i>> {
    children(node, name).next()
}

/// The only child of this name, if there is one.
pub(super) fn only<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Result<Option<Node<'a, 'i>>, ImportError> {
    let mut children = children(node, name);
    match (children.next(), children.next()) {
        (_, Some(_)) => {
            let parent = node.tag_name().name();
            Err(ImportError::new(format!("{parent}, {name}: there are several; one is expected")))
        }
        (only, None) => Ok(only),
    }
}

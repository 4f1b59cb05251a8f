//! Replaces spans of bytes in a text and keeps everything else.

use std::ops::Range;

/// Changes that have not been made yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct TextEdits(Vec<(Range<usize>, String)>);

impl TextEdits {
    /// Puts a text in the place of a span.
    pub(crate) fn replace(&mut self, span: Range<usize>, text: impl Into<String>) {
        self.0.push((span, text.into()));
    }

    /// Puts a text before a byte; after what was put there before.
    pub(crate) fn insert(&mut self, at: usize, text: impl Into<String>) {
        self.replace(at..at, text);
    }

    /// The text with all changes. Spans do not overlap.
    pub(crate) fn apply(mut self, text: &str) -> String {
        self.0.sort_by_key(|(span, _)| (span.start, span.end));
        let mut whole = String::with_capacity(text.len());
        let mut done = 0;
        for (span, new) in self.0 {
            whole.push_str(&text[done..span.start]);
            whole.push_str(&new);
            done = span.end;
        }
        whole.push_str(&text[done..]);
        whole
    }
}

/// The blanks at the start of the line of a byte, if there is nothing else before it.
pub(crate) fn indent(text: &str, at: usize) -> Option<&str> {
    let line = &text[text[..at].rfind('\n').map_or(0, |end| end + 1)..at];
    line.chars().all(char::is_whitespace).then_some(line)
}

/// How lines end in a text.
pub(crate) fn ending(text: &str) -> &'static str {
    if text.contains("\r\n") { "\r\n" } else { "\n" }
}

/// How many characters are before a byte in its line.
pub(crate) fn column(text: &str, at: usize) -> usize {
    let line = &text[text[..at].rfind('\n').map_or(0, |end| end + 1)..at];
    line.trim_start_matches('\u{feff}').chars().count()
}

/// The end of a line, where nothing but blanks and a comment of YAML is left of it; else the same place.
pub(crate) fn rest_of_line(text: &str, at: usize) -> usize {
    let line = text[at..].split(['\n', '\r']).next().unwrap_or_default();
    let rest = line.trim_start();
    if rest.is_empty() || (rest.starts_with('#') && rest.len() < line.len()) { at + line.len() } else { at }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_in_lines_are_told() {
        let text = "\u{feff}é: 1 # one\r\n  - 2, # three\r\nx#y";
        assert_eq!((ending(text), ending("a\nb")), ("\r\n", "\n"));
        let at = |what: &str| text.find(what).unwrap();
        assert_eq!([column(text, at("1")), column(text, at("- 2")), column(text, at("x"))], [3, 2, 0]);
        assert_eq!(rest_of_line(text, at(" # one")), at("\r\n"));
        assert_eq!(rest_of_line(text, at(", # three")), at(", # three"));
        assert_eq!(rest_of_line(text, at("#y")), at("#y"));
        assert_eq!(rest_of_line(text, text.len()), text.len());
    }
}

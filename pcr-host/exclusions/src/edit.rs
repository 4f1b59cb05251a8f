//! Changes of a text at spans of bytes; everything else is kept as it is.

use std::ops::Range;

/// Changes that have not been made yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edits(Vec<(Range<usize>, String)>);

impl Edits {
    /// Puts a text in the place of a span.
    pub(crate) fn replace(&mut self, span: Range<usize>, text: impl Into<String>) {
        self.0.push((span, text.into()));
    }

    /// Puts a text before a byte; after what was put there before.
    pub(crate) fn insert(&mut self, at: usize, text: impl Into<String>) {
        self.replace(at..at, text);
    }

    /// The text with all changes. Spans do not overlap.
    pub(crate) fn made(mut self, text: &str) -> String {
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

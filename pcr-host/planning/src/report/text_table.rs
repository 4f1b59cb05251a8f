//! Text in aligned columns.

use std::io::{self, Write};
use unicode_width::UnicodeWidthStr;

/// Rows of cells, each column as wide as its widest cell.
pub struct TextTable {
    widths: Vec<usize>,
    left: Vec<bool>,
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// With these titles; a title that begins with `<` is that of a column that is set to the left.
    pub fn new(titles: &[&str]) -> Self {
        let left = titles.iter().map(|title| title.starts_with('<')).collect();
        let mut columns = Self { widths: vec![0; titles.len()], left, rows: Vec::new() };
        columns.row(titles.iter().map(|title| title.trim_start_matches('<').to_owned()).collect());
        columns
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        for (width, cell) in self.widths.iter_mut().zip(&cells) {
            *width = (*width).max(cell.width());
        }
        self.rows.push(cells);
    }

    /// Writes them as text.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for row in &self.rows {
            let mut line = String::new();
            for ((cell, &width), &left) in row.iter().zip(&self.widths).zip(&self.left) {
                // Not by `{cell:>width$}`, which counts characters: some are two columns wide, and accents none.
                let blanks = " ".repeat(width.saturating_sub(cell.width()));
                let [before, after] = if left { ["", &blanks] } else { [&blanks, ""] };
                line.extend(["  ", before, cell, after]);
            }
            writeln!(out, "{}", line.trim_end())?;
        }
        Ok(())
    }

    /// Writes the table as one of Markdown.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_markdown(&self, out: &mut dyn Write) -> io::Result<()> {
        for (k, row) in self.rows.iter().enumerate() {
            writeln!(out, "| {} |", row.join(" | "))?;
            if k == 0 {
                let rules: Vec<&str> = self.left.iter().map(|&left| if left { "---" } else { "---:" }).collect();
                writeln!(out, "|{}|", rules.join("|"))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_by_what_is_seen() {
        let mut columns = TextTable::new(&["id", "<name", "t"]);
        for name in ["机器人", "e\u{301}", "AGV-7"] {
            columns.row(vec!["1".into(), name.into(), "0.5".into()]);
        }
        let mut text = Vec::new();
        columns.write(&mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert_eq!(text, "  id  name      t\n   1  机器人  0.5\n   1  e\u{301}       0.5\n   1  AGV-7   0.5\n");
    }
}

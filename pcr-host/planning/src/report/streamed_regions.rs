//! Prints the regions of large fleets like [`csv`](super::csv) and [`json`](super::json), but without holding all of
//! them in memory.

use super::{csv_rows, json};
use crate::failure::ComputationError;
use crate::fleet::HostScalar;
use crate::regions::{ProgressFn, RegionEntry, RegionJob};
use std::io::{self, Write};

/// Why an answer was not printed, or not to its end.
#[derive(Debug)]
pub enum OutputError {
    /// There is none.
    Failure(ComputationError),
    /// The output cannot be written.
    Output(io::Error),
}

impl<F: Into<ComputationError>> From<F> for OutputError {
    fn from(failure: F) -> Self {
        Self::Failure(failure.into())
    }
}

impl From<io::Error> for OutputError {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// A line a region, as [`csv`](super::csv).
///
/// # Errors
/// Errors of the writer, and [`ComputationError`]: then some lines are printed already.
pub fn sheet_csv<S: HostScalar>(
    sheet: &RegionJob<'_, S>,
    told: ProgressFn<'_>,
    out: &mut dyn Write,
) -> Result<(), OutputError> {
    let head = sheet.head()?;
    for margin in [false].into_iter().chain(head.margin_regions.is_some().then_some(true)) {
        let lines = |row: Vec<RegionEntry>| {
            let mut text = Vec::new();
            csv_rows(&head.name, &head.labels, &row, margin, &mut text).map(|()| text)
        };
        sheet.each(margin, told, lines, |text| Ok::<(), OutputError>(out.write_all(&text?)?))?;
    }
    Ok(())
}

/// One line of JSON, as [`json`](super::json).
///
/// # Errors
/// As [`sheet_csv`]; the line then has no end.
pub fn sheet_json<S: HostScalar>(
    sheet: &RegionJob<'_, S>,
    told: ProgressFn<'_>,
    out: &mut dyn Write,
) -> Result<(), OutputError> {
    let mut text = Vec::new();
    json(&sheet.head()?, &mut text)?;
    let mut rest = String::from_utf8(text).map_err(io::Error::other)?;
    // Where the lists are empty in the head. In a text its quotes would be escaped.
    for (list, margin) in [(r#""regions":[]"#, false), (r#""margin_regions":[]"#, true)] {
        let Some(place) = rest.find(list) else { continue };
        let after = rest.split_off(place + list.len() - 1);
        out.write_all(rest.as_bytes())?;
        let mut first = true;
        let elements = |row: Vec<RegionEntry>| serde_json::to_vec(&row);
        sheet.each(margin, told, elements, |text| {
            let text = text.map_err(io::Error::from)?;
            // Without the brackets.
            let inner = text.get(1..text.len() - 1).unwrap_or_default();
            if !inner.is_empty() {
                out.write_all(if first { b"" } else { b"," })?;
                out.write_all(inner)?;
                first = false;
            }
            Ok::<(), OutputError>(())
        })?;
        rest = after;
    }
    Ok(out.write_all(rest.as_bytes())?)
}

//! The records of a file, whether it is JSON Lines or CSV: named values, each with its place.

use super::MissionFileError;
use crate::byte_order_mark::unmarked;
use crate::json::{self, JsonData, JsonNode, Position};
use crate::scenario::{LONGEST_LABEL, label};
use std::borrow::Cow;

/// A value of a record.
#[derive(Clone, Debug)]
enum RecordValue<'t> {
    Json(JsonNode<'t>),
    /// The text of a cell that is not empty.
    Cell(String),
}

/// A line of a file.
#[derive(Clone, Debug)]
pub(super) struct Record<'t> {
    /// Where it begins.
    pub(super) position: Position,
    /// Its values with their names and places, without those that are left out.
    fields: Vec<(Cow<'t, str>, Position, RecordValue<'t>)>,
}

/// The records of a text.
pub(super) fn parse(text: &str) -> Result<Vec<Record<'_>>, MissionFileError> {
    let begin = unmarked(text).trim_start();
    if begin.starts_with(['{', '[']) { json_lines(text) } else { csv(text) }
}

fn json_lines(text: &str) -> Result<Vec<Record<'_>>, MissionFileError> {
    let mut records = Vec::new();
    for node in json::parse_sequence(text) {
        let node = node.map_err(|error| MissionFileError { position: error.position, problem: error.problem })?;
        let position = node.position;
        let JsonData::Object(members) = node.data else {
            let problem = "a vehicle, mission, closure or breakdown is expected, an object on each line";
            return Err(MissionFileError { position, problem: problem.into() });
        };
        let fields = members.into_iter().filter(|(_, value)| !value.is_null());
        let fields = fields.map(|(name, value)| (name, value.position, RecordValue::Json(value)));
        records.push(Record { position, fields: fields.collect() });
    }
    Ok(records)
}

fn csv(text: &str) -> Result<Vec<Record<'_>>, MissionFileError> {
    let lines = (1..).zip(unmarked(text).lines()).filter(|(_, line)| !line.trim().is_empty());
    let mut rows = lines.map(|(line, text)| cells(line, text));
    let Some(header) = rows.next().transpose()? else { return Ok(Vec::new()) };
    for (k, (name, position)) in header.iter().enumerate() {
        if header[..k].iter().any(|other| other.0 == *name) {
            return Err(MissionFileError { position: *position, problem: format!("the column {name} is there twice") });
        }
    }
    let record = |row: Result<Vec<(String, Position)>, MissionFileError>| {
        let row = row?;
        if let Some((_, position)) = row.get(header.len()) {
            let problem = format!("{} cells, and {} columns", row.len(), header.len());
            return Err(MissionFileError { position: *position, problem });
        }
        let position = row.first().map_or(Position::START, |cell| cell.1);
        let fields = header.iter().zip(row).filter(|(_, (cell, _))| !cell.is_empty());
        let fields =
            fields.map(|((name, _), (cell, position))| (Cow::Owned(name.clone()), position, RecordValue::Cell(cell)));
        Ok(Record { position, fields: fields.collect() })
    };
    rows.map(record).collect()
}

/// The cells of a line of CSV with their places, without space around them; quoted ones may hold commas, and quotes twice.
fn cells(line: u32, text: &str) -> Result<Vec<(String, Position)>, MissionFileError> {
    let mut found = Vec::new();
    let (mut cell, mut begin, mut is_quoted, mut was_quoted) = (String::new(), 1, false, false);
    let mut letters = (1..).zip(text.chars()).peekable();
    let at = |column: u32| Position { line, column };
    while let Some((column, letter)) = letters.next() {
        match letter {
            '"' if is_quoted && letters.next_if(|next| next.1 == '"').is_some() => cell.push('"'),
            '"' if is_quoted => is_quoted = false,
            '"' if cell.trim().is_empty() && !was_quoted => {
                cell.clear();
                (is_quoted, was_quoted) = (true, true);
            }
            '"' => {
                let problem = "a quote within a cell; quote the whole cell, and write quotes in it twice";
                return Err(MissionFileError { position: at(column), problem: problem.into() });
            }
            ',' if !is_quoted => {
                found.push((cell.trim().to_owned(), at(begin)));
                (cell, begin, was_quoted) = (String::new(), column + 1, false);
            }
            letter => cell.push(letter),
        }
    }
    if is_quoted {
        return Err(MissionFileError { position: at(begin), problem: "a quote that does not end on its line".into() });
    }
    found.push((cell.trim().to_owned(), at(begin)));
    Ok(found)
}

impl Record<'_> {
    fn get(&self, name: &str) -> Option<(Position, &RecordValue<'_>)> {
        self.fields.iter().find(|field| field.0 == name).map(|field| (field.1, &field.2))
    }

    /// The error of a field.
    pub(super) fn wrong(&self, name: &str, problem: String) -> MissionFileError {
        let position = self.get(name).map_or(self.position, |field| field.0);
        MissionFileError { position, problem: format!("{name}: {problem}") }
    }

    /// The error of a field that is not there.
    pub(super) fn missing(&self, name: &str) -> MissionFileError {
        MissionFileError { position: self.position, problem: format!("{name} is missing") }
    }

    /// Refuses fields that a record of this kind does not have.
    pub(super) fn refuse_unknown(&self, known: &[&str], kind: &str) -> Result<(), MissionFileError> {
        let unknown = self.fields.iter().find(|field| !known.contains(&field.0.as_ref()));
        match unknown {
            None => Ok(()),
            Some((name, position, _)) => {
                let problem = format!("unknown key {name}; a {kind} has {}", known.join(", "));
                Err(MissionFileError { position: *position, problem })
            }
        }
    }

    /// A text, or a number as it is written, with its place.
    pub(super) fn text(&self, name: &str) -> Result<Option<(String, Position)>, MissionFileError> {
        let Some((position, value)) = self.get(name) else { return Ok(None) };
        let text = match value {
            RecordValue::Cell(text) => text.clone(),
            RecordValue::Json(node) => {
                named(node).ok_or_else(|| self.wrong(name, "a text or a number is expected".into()))?
            }
        };
        Ok(Some((text, position)))
    }

    /// A text that has to be there.
    pub(super) fn required(&self, name: &str) -> Result<(String, Position), MissionFileError> {
        self.text(name)?.ok_or_else(|| self.missing(name))
    }

    /// A name of its own, which can be printed.
    pub(super) fn name(&self, name: &str) -> Result<String, MissionFileError> {
        let (text, _) = self.required(name)?;
        if text.is_empty() || label(&text) != text {
            let problem = format!("printable text of 1 to {LONGEST_LABEL} characters is expected");
            return Err(self.wrong(name, problem));
        }
        Ok(text)
    }

    /// Texts or numbers; in CSV with `;` between them.
    pub(super) fn list(&self, name: &str) -> Result<Vec<(String, Position)>, MissionFileError> {
        let Some((position, value)) = self.get(name) else { return Ok(Vec::new()) };
        let expected = || self.wrong(name, "a list of texts or numbers is expected".into());
        match value {
            RecordValue::Cell(text) => Ok(text.split(';').map(|part| (part.trim().to_owned(), position)).collect()),
            RecordValue::Json(node) => {
                let elements = node.as_array().ok_or_else(expected)?.iter();
                elements.map(|element| Ok((named(element).ok_or_else(expected)?, element.position))).collect()
            }
        }
    }

    /// A number in a range.
    pub(super) fn number(&self, name: &str, least: f64, most: f64) -> Result<Option<f64>, MissionFileError> {
        let Some((_, value)) = self.get(name) else { return Ok(None) };
        let number = match value {
            RecordValue::Cell(text) => text.parse::<f64>().ok(),
            RecordValue::Json(node) => node.as_f64(),
        };
        let number = number.filter(|number| (least..=most).contains(number));
        number.map(Some).ok_or_else(|| self.wrong(name, format!("a number from {least:e} to {most:e} is expected")))
    }

    /// A whole number.
    pub(super) fn integer(&self, name: &str) -> Result<Option<i64>, MissionFileError> {
        /// Largest one, either way.
        const MOST: i64 = 1_000_000;
        let Some((_, value)) = self.get(name) else { return Ok(None) };
        let number = match value {
            RecordValue::Cell(text) => text.parse::<i64>().ok(),
            RecordValue::Json(node) => match &node.data {
                JsonData::Number(text) => text.parse::<i64>().ok(),
                _ => None,
            },
        };
        let number = number.filter(|number| number.abs() <= MOST);
        number.map(Some).ok_or_else(|| self.wrong(name, format!("a whole number from -{MOST} to {MOST} is expected")))
    }

    /// The corners of a footprint, ahead and left \[m\]: `{ "polygon": [ { "ahead": 0.8, "left": 0.4 }, ... ] }`, in CSV
    /// `0.8 0.4; ...`.
    pub(super) fn polygon(&self, name: &str) -> Result<Option<Vec<[f64; 2]>>, MissionFileError> {
        let Some((_, value)) = self.get(name) else { return Ok(None) };
        let expected = |what: &str| self.wrong(name, what.into());
        let corners: Option<Vec<[f64; 2]>> = match value {
            RecordValue::Cell(text) => {
                let corner = |corner: &str| {
                    let numbers: Vec<f64> =
                        corner.split_whitespace().filter_map(|number| number.parse().ok()).collect();
                    <[f64; 2]>::try_from(numbers).ok().filter(|corner| corner.iter().all(|number| number.is_finite()))
                };
                text.split(';').map(corner).collect()
            }
            RecordValue::Json(node) => {
                let corner = |corner: &JsonNode<'_>| {
                    let both = [corner.get("ahead")?.as_f64()?, corner.get("left")?.as_f64()?];
                    (corner.members().len() == 2).then_some(both)
                };
                let is_known = node.members().iter().all(|(key, _)| key == "polygon");
                let polygon = node.get("polygon").and_then(JsonNode::as_array).filter(|_| is_known);
                polygon.and_then(|corners| corners.iter().map(corner).collect())
            }
        };
        let what = "{ \"polygon\": [ { \"ahead\": M, \"left\": M }, ... ] } is expected, in CSV `AHEAD LEFT; ...`";
        corners.map(Some).ok_or_else(|| expected(what))
    }
}

/// A text, or a number as it is written.
fn named(node: &JsonNode<'_>) -> Option<String> {
    match &node.data {
        JsonData::Text(text) => Some(text.to_string()),
        JsonData::Number(text) => Some(text.to_string()),
        _ => None,
    }
}

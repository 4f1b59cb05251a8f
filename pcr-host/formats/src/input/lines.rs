//! Scenarios one after the other: one in each line (JSON Lines), or over several lines as in files.

use super::InputError;
use crate::answer_files;
use crate::byte_order_mark::{unmarked, without_mark};
use crate::import::InputFormat;
use crate::scenario::Scenario;
use std::collections::VecDeque;
use std::io::BufRead;
use std::path::Path;

/// A scenario that came in.
#[derive(Clone, Debug, PartialEq)]
pub struct InputScenario {
    /// Where it begins, counted from 1, blank lines included.
    pub number: usize,
    /// Whether it begins as a scenario does, whatever comes then.
    pub is_json: bool,
    /// The scenario, or the name as far as it could be read and what is wrong.
    pub scenario: Result<Scenario, (String, String)>,
}

/// The scenarios that a reader gives, one at a time as they come in.
///
/// A line that holds a whole JSON value, or what can be none, is answered before the next one is read. Where a value goes on, so does the
/// reading, up to its end; but not into a line that is a scenario by itself, as what came before it can only be damaged.
#[derive(Debug)]
pub struct ScenarioStream<R> {
    reader: R,
    number: usize,
    /// A line that is read already.
    ahead: Option<Vec<u8>>,
    /// Values that were looked at already, with the numbers of their first lines.
    seen: VecDeque<(usize, Vec<u8>)>,
}

impl<R: BufRead> ScenarioStream<R> {
    /// The scenarios that `reader` gives.
    pub fn new(reader: R) -> Self {
        Self { reader, number: 0, ahead: None, seen: VecDeque::new() }
    }

    /// The whole text, if what comes first is of another format, or of none that has lines: then all of it is one file.
    ///
    /// # Errors
    /// [`InputError`] where it cannot be read.
    pub fn foreign(&mut self) -> Result<Option<String>, InputError> {
        let Some(first) = self.value()? else { return Ok(None) };
        let mut begin = String::from_utf8_lossy(&first.1).into_owned();
        self.seen.push_back(first);
        // Plans on grids may begin with how many agents there are.
        if unmarked(&begin).trim().parse::<u32>().is_ok()
            && let Some(second) = self.value()?
        {
            begin += &String::from_utf8_lossy(&second.1);
            self.seen.push_back(second);
        }
        let is_markup = unmarked(&begin).trim_start().starts_with('<');
        if !is_markup && InputFormat::detect(Path::new("-"), &begin).is_none() {
            return Ok(None);
        }
        let mut text: Vec<u8> = self.seen.drain(..).flat_map(|(_, value)| value).collect();
        text.extend(self.ahead.take().unwrap_or_default());
        self.reader.read_to_end(&mut text).map_err(|error| InputError::Unreadable(None, error))?;
        String::from_utf8(text).map(Some).map_err(|_| InputError::NotText(None))
    }

    /// The next line; nothing at the end.
    fn line(&mut self) -> Result<Option<Vec<u8>>, InputError> {
        if let Some(line) = self.ahead.take() {
            return Ok(Some(line));
        }
        let mut bytes = Vec::new();
        match self.reader.read_until(b'\n', &mut bytes) {
            Ok(0) => Ok(None),
            Ok(_) => Ok(Some(bytes)),
            Err(error) => Err(InputError::Unreadable(None, error)),
        }
    }

    /// The text of the next value with the number of its first line.
    fn value(&mut self) -> Result<Option<(usize, Vec<u8>)>, InputError> {
        let blank = |line: &[u8]| without_mark(line).trim_ascii().is_empty();
        let mut text = loop {
            let Some(line) = self.line()? else { return Ok(None) };
            self.number += 1;
            if !blank(&line) {
                break line;
            }
        };
        let number = self.number;
        let mut nesting = JsonDepth::default();
        nesting.read(&text);
        while nesting.is_open() {
            let Some(next) = self.line()? else { break };
            if is_scenario(&next) {
                self.ahead = Some(next);
                break;
            }
            self.number += 1;
            nesting.read(&next);
            text.extend(next);
        }
        Ok(Some((number, text)))
    }
}

/// How deep in arrays and objects a text is.
#[derive(Debug, Default)]
struct JsonDepth {
    depth: usize,
    /// An array or object was closed that was not open.
    broken: bool,
}

impl JsonDepth {
    /// Reads a line on. No string goes beyond its line.
    fn read(&mut self, line: &[u8]) {
        let (mut quoted, mut escaped) = (false, false);
        for byte in line {
            match byte {
                _ if escaped => escaped = false,
                b'\\' if quoted => escaped = true,
                b'"' => quoted = !quoted,
                _ if quoted => {}
                b'{' | b'[' => self.depth += 1,
                b'}' | b']' if self.depth == 0 => self.broken = true,
                b'}' | b']' => self.depth -= 1,
                _ => {}
            }
        }
        self.broken |= quoted;
    }

    fn is_open(&self) -> bool {
        self.depth > 0 && !self.broken
    }
}

/// Whether a line is a scenario by itself, as far as that can be seen without reading it.
fn is_scenario(line: &[u8]) -> bool {
    let text = line.trim_ascii();
    let mut nesting = JsonDepth::default();
    let names_agents = || str::from_utf8(text).is_ok_and(answer_files::has_agents);
    text.starts_with(b"{") && text.ends_with(b"}") && names_agents() && {
        nesting.read(text);
        !nesting.is_open()
    }
}

fn scenario(number: usize, bytes: Vec<u8>) -> Result<Scenario, (String, String)> {
    let Ok(text) = String::from_utf8(bytes) else {
        return Err((String::new(), format!("line {number}: not text in UTF-8")));
    };
    Scenario::from_json(&text).map_err(|error| {
        let line = number + error.line() - 1;
        let column = error.column().map_or_else(String::new, |column| format!(", column {column}"));
        let problem = match InputFormat::detect(Path::new("-"), &text) {
            Some(format) => format!(": no scenario; it looks like {format}, which is read with --from {format}"),
            None => format!("{column}: {error}"),
        };
        (error.scenario().to_owned(), format!("line {line}{problem}"))
    })
}

impl<R: BufRead> Iterator for ScenarioStream<R> {
    type Item = Result<InputScenario, InputError>;

    fn next(&mut self) -> Option<Self::Item> {
        let value = self.seen.pop_front().map_or_else(|| self.value(), |seen| Ok(Some(seen)));
        match value {
            Ok(None) => None,
            Ok(Some((number, text))) => {
                let is_json = without_mark(&text).trim_ascii_start().starts_with(b"{");
                Some(Ok(InputScenario { number, is_json, scenario: scenario(number, text) }))
            }
            Err(error) => Some(Err(error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First lines, and names or problems.
    fn read(text: &str) -> Vec<(usize, Result<String, String>)> {
        let named =
            |line: InputScenario| (line.number, line.scenario.map(|it| it.name).map_err(|(_, problem)| problem));
        ScenarioStream::new(text.as_bytes()).map(|line| named(line.unwrap())).collect()
    }

    fn ok(number: usize, name: &str) -> (usize, Result<String, String>) {
        (number, Ok(name.to_owned()))
    }

    #[test]
    fn values_may_take_a_line_or_several() {
        let text =
            "\u{feff}{\"name\": \"a\",\r\n \"agents\": [\r\n]}\r\n\n{\"name\": \"b}{\\\"\", \"agents\": []}\n[\n";
        let lines = read(text);
        assert_eq!(lines[..2], [ok(1, "a"), ok(5, "b}{\"")]);
        assert!(lines[2].1.as_ref().unwrap_err().starts_with("line 7, column 1: the text ends where"), "{lines:?}");
        assert_eq!(lines.len(), 3);
    }

    #[test]
    fn a_damaged_line_costs_no_other_one() {
        let good = "{\"name\": \"good\", \"agents\": []}";
        for damaged in ["{\"name\": \"bad\", \"agents\": [", "{\"agents", "]", "}{", "{", "nonsense", "{\"a\": \"\\\"}"]
        {
            let lines = read(&format!("{damaged}\n{good}\n{good}"));
            assert_eq!((lines.len(), lines[0].1.is_err()), (3, true), "{damaged}: {lines:?}");
            assert_eq!(lines[1..], [ok(2, "good"), ok(3, "good")], "{damaged}");
        }
    }

    #[test]
    fn faults_are_in_the_line_where_they_are() {
        let lines = read("{\"agents\": [],\n \"units\": 5 }\n{\"agents\": 1}");
        assert_eq!(
            lines[0].1,
            Err("line 2, column 11: units: unknown key; known are format, version, name, angles, agents, warnings"
                .to_owned())
        );
        assert_eq!(lines[1], (3, Err("line 3, column 12: agents: 1 where an array is expected".to_owned())));
    }

    #[test]
    fn a_text_of_another_format_is_one_file() {
        for text in [
            "{\"orderId\": \"x\",\n \"nodes\": [],\n \"edges\": []}\n{\"orderId\": \"y\"}\n",
            "\n<?xml version=\"1.0\"?>\n<root>\n</root>\n",
            "<html>\n",
            "2\nAgent 0: (1,2)->(1,3)->\nAgent 1: (2,2)->\n",
            "\u{feff}2\nAgent 0: (1,2)->(1,3)->\nAgent 1: (2,2)->\n",
        ] {
            let mut lines = ScenarioStream::new(text.as_bytes());
            let foreign = lines.foreign().unwrap();
            assert_eq!(foreign.as_deref(), Some(text.trim_start_matches('\n')), "{text}");
            assert!(lines.next().is_none());
        }
        // What is looked at is read all the same, and nothing more of it.
        for text in ["{\"agents\": [\n]}\n{\"agents\": []}", "7\n8\n", "nonsense\n{\"agents\": []}\n", "\n"] {
            let mut lines = ScenarioStream::new(text.as_bytes());
            assert_eq!(lines.foreign().unwrap(), None, "{text}");
            let read: Vec<InputScenario> = lines.map(|line| line.unwrap()).collect();
            let plain: Vec<InputScenario> = ScenarioStream::new(text.as_bytes()).map(|line| line.unwrap()).collect();
            assert_eq!(read, plain, "{text}");
        }
    }

    #[test]
    fn other_formats_are_named() {
        let lines = read("{\"orderId\": \"x\",\n \"nodes\": [], \"edges\": []}");
        let expected = "line 1: no scenario; it looks like vda5050, which is read with --from vda5050";
        assert_eq!(lines, [(1, Err(expected.to_owned()))]);
    }
}

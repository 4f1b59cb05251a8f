//! The JSON examples of the documents are what the tool prints, shortened: the line before such a block names the command and ends with
//! `prints:`. `UPDATE=1 cargo test -p pcr-host --test tool examples` writes them anew.

use crate::console::{prints, sandbox, top};
use std::fs;

/// Width of a line of an example.
const WIDTH: usize = 140;

/// Longest list that is shown whole, and how many entries of a longer one are shown.
const WHOLE: usize = 3;
const SHOWN: usize = 2;

/// Longest text that is shown whole.
const TEXT: usize = 90;

/// What differs from run to run: such numbers are not compared.
const MEASURED: [&str; 5] = ["ms", "ratio", "rounds", "mean_ms", "longest_ms"];

/// A JSON value as it is written, in the order of the text.
enum Json {
    /// A number, a text, or a word.
    Word(String),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

/// Reads what the tool has written, which is JSON without spaces.
struct Reader<'a>(&'a str);

impl Reader<'_> {
    fn take(&mut self, length: usize) -> String {
        let (taken, rest) = self.0.split_at(length);
        self.0 = rest;
        taken.to_owned()
    }

    /// Whether the next character is this one, which is taken then.
    fn has(&mut self, character: char) -> bool {
        let has = self.0.starts_with(character);
        if has {
            self.take(1);
        }
        has
    }

    fn word(&mut self) -> String {
        if !self.0.starts_with('"') {
            return self.take(self.0.find([',', ']', '}']).unwrap_or(self.0.len()));
        }
        let mut escaped = false;
        let ends = |(_, character): &(usize, char)| {
            let is_end = *character == '"' && !escaped;
            escaped = *character == '\\' && !escaped;
            is_end
        };
        let (end, _) = self.0.char_indices().skip(1).find(ends).unwrap();
        self.take(end + 1)
    }

    fn value(&mut self) -> Json {
        if self.has('[') {
            let mut list = Vec::new();
            while !self.has(']') {
                list.push(self.value());
                self.has(',');
            }
            Json::List(list)
        } else if self.has('{') {
            let mut object = Vec::new();
            while !self.has('}') {
                let key = self.word();
                assert!(self.has(':'));
                object.push((key, self.value()));
                self.has(',');
            }
            Json::Object(object)
        } else {
            Json::Word(short(self.word()))
        }
    }
}

/// Numbers with four digits behind the point, small ones with two in all; texts up to a length.
fn short(word: String) -> String {
    if word.starts_with('"') {
        return match word.char_indices().nth(TEXT) {
            Some((end, _)) => format!("{}...\"", &word[..end]),
            None => word,
        };
    }
    match word.parse::<f64>() {
        Ok(number) if word.contains(['.', 'e']) => {
            if number != 0.0 && number.abs() < 1e-3 {
                return format!("{number:.1e}");
            }
            let text = format!("{number:.4}");
            let text = text.trim_end_matches('0');
            if text.ends_with('.') { format!("{text}0") } else { text.to_owned() }
        }
        _ => word,
    }
}

/// The entries of a list or an object as they are shown: with their keys, and none for what is left out.
type Entries<'a> = Vec<(String, Option<&'a Json>)>;

impl Json {
    /// Its entries as they are shown, with their keys, between these brackets.
    fn entries(&self) -> Option<(Entries<'_>, [char; 2])> {
        match self {
            Self::Word(_) => None,
            Self::List(list) => {
                let shown = if list.len() > WHOLE { SHOWN } else { list.len() };
                let mut entries: Vec<_> = list.iter().take(shown).map(|value| (String::new(), Some(value))).collect();
                entries.extend((shown < list.len()).then(|| ("...".to_owned(), None)));
                Some((entries, ['[', ']']))
            }
            Self::Object(object) => {
                Some((object.iter().map(|(key, value)| (format!("{key}: "), Some(value))).collect(), ['{', '}']))
            }
        }
    }

    fn line(&self) -> String {
        let (entries, [open, close]) = match (self, self.entries()) {
            (Self::Word(word), _) => return word.clone(),
            (_, Some(entries)) => entries,
            (_, None) => unreachable!(),
        };
        let entry =
            |(key, value): &(String, Option<&Self>)| format!("{key}{}", value.map_or(String::new(), Self::line));
        let all: Vec<String> = entries.iter().map(entry).collect();
        let is_flat = !matches!(self, Self::Object(_)) && !all.iter().any(|entry| entry.starts_with('{'));
        let space = if is_flat || all.is_empty() { "" } else { " " };
        format!("{open}{space}{}{space}{close}", all.join(", "))
    }

    /// The value from a column on, in lines as full as they may be.
    fn write(&self, column: usize, after: usize, out: &mut String) {
        let line = self.line();
        let Some((entries, [open, close])) = self.entries().filter(|_| column + line.chars().count() + after > WIDTH)
        else {
            out.push_str(&line);
            return;
        };
        let indent = column + 2;
        out.extend([open, ' ']);
        let (mut at, mut broken) = (indent, false);
        let last = entries.len().saturating_sub(1);
        for (place, (key, value)) in entries.iter().enumerate() {
            let whole = format!("{key}{}", value.map_or(String::new(), Self::line));
            let end = if place == last { 2 + after } else { 1 };
            if place > 0 {
                out.push(',');
                if broken || at + 2 + whole.chars().count() + end > WIDTH {
                    out.push_str(&format!("\n{}", " ".repeat(indent)));
                    at = indent;
                } else {
                    out.push(' ');
                    at += 1;
                }
            }
            let before = out.len();
            out.push_str(key);
            if let Some(value) = value {
                value.write(at + key.chars().count(), end, out);
            }
            broken = out[before..].contains('\n');
            at = out.lines().last().unwrap_or_default().chars().count();
        }
        out.extend([' ', close]);
    }
}

/// The example that belongs to an answer of the tool.
fn example(answer: &str) -> String {
    let mut text = String::new();
    Reader(answer.trim_end()).value().write(0, 0, &mut text);
    text + "\n"
}

/// The same without what differs from run to run.
fn compared(example: &str) -> String {
    let mut text = example.split_whitespace().collect::<Vec<_>>().join(" ");
    for key in MEASURED {
        let key = format!("\"{key}\": ");
        let parts: Vec<&str> = text.split(key.as_str()).collect();
        let rest = |part: &&str| part.trim_start_matches(|c: char| c.is_ascii_digit() || ".e-".contains(c)).to_owned();
        let others: Vec<String> = parts.iter().skip(1).map(rest).collect();
        text = std::iter::once(parts[0].to_owned()).chain(others).collect::<Vec<_>>().join(&key);
    }
    text
}

/// The command that a line names, if what it prints stands below.
fn command(line: &str) -> Option<&str> {
    let (before, _) = line.strip_suffix("` prints:")?.split_at_checked(line.len() - "` prints:".len())?;
    Some(&before[before.rfind('`')? + 1..])
}

/// Compares the examples of a document; returns how many there are.
fn follow(document: &str) -> usize {
    let path = top().join(document);
    let text = fs::read_to_string(&path).unwrap();
    let folder = sandbox(&format!("examples/{document}"));
    let (mut written, mut count, mut wrong) = (text.clone(), 0, String::new());
    let parts: Vec<&str> = text.split("```json\n").collect();
    for pair in parts.windows(2) {
        let Some(command) = pair[0].trim_end().lines().last().and_then(command) else { continue };
        let says = pair[1].split("```").next().unwrap();
        let now = example(&prints(&format!("{command} 2>/dev/null"), &folder).0);
        count += 1;
        if compared(says) != compared(&now) {
            wrong += &format!("$ {command}\n{now}\n");
            written = written.replacen(says, &now, 1);
        }
    }
    if std::env::var_os("UPDATE").is_some() {
        fs::write(path, written).unwrap();
    } else {
        assert!(wrong.is_empty(), "{document} shows something else than the tool prints:\n{wrong}");
    }
    count
}

#[test]
fn examples_of_answers_are_answers() {
    assert!(follow("docs/reference/formats.md") >= 5);
    assert!(follow("docs/guide/locks.md") >= 1);
    assert!(follow("docs/guide/traffic.md") >= 1);
}

#[test]
fn examples_are_shortened() {
    let answer = r#"{"a":[1,2.00004,1.5e-7],"b":[1,2,3,4],"c":"a \" b","d":{},"ms":1.25}"#;
    let text = example(answer);
    assert_eq!(text, "{ \"a\": [1, 2.0, 1.5e-7], \"b\": [1, 2, ...], \"c\": \"a \\\" b\", \"d\": {}, \"ms\": 1.25 }\n");
    assert_eq!(compared(&text), compared(&text.replace("1.25", "7.5e-3")));
    assert_ne!(compared(&text), compared(&text.replace("2.0", "2.1")));
    assert_eq!(command("So `pcr check x --json` prints:"), Some("pcr check x --json"));
}

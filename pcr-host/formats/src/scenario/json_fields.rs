//! Fields of a scenario, and errors that name them.

use crate::json::{JsonData, JsonMember, JsonNode, Position, QUOTED};
use std::fmt;

/// Largest magnitude of a number in a scenario, in its unit, and of the length and the duration of a path.
///
/// It leaves room for coordinates of a map projection and for seconds since 1970. Results are exact to some 10⁻¹⁵ of
/// the largest coordinate or time, hence to 10⁻⁵ at the limit. Number formats other than `f64` may allow less.
pub const LIMIT: f64 = 1e10;

/// Why a scenario was refused: agent, segment, field, value and what is allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioError {
    pub(super) scenario: String,
    line: usize,
    /// `None` where the scenario is in no text.
    column: Option<usize>,
    /// Boxed, because errors are returned by value everywhere.
    about: Box<ErrorLocation>,
    message: String,
}

/// The place of a fault.
#[derive(Clone, Debug, PartialEq)]
struct ErrorLocation {
    agent: Option<String>,
    part: Option<(&'static str, usize)>,
    field: Option<String>,
}

impl ScenarioError {
    /// The agent that it is about, as messages name it: "agent 7".
    pub fn agent(&self) -> Option<&str> {
        self.about.agent.as_deref()
    }

    /// "segment" or "piece", and which one, counted from 1.
    pub fn part(&self) -> Option<(&'static str, usize)> {
        self.about.part
    }

    /// The field.
    pub fn field(&self) -> Option<&str> {
        self.about.field.as_deref()
    }

    /// Line of the text, counted from 1. It is not part of the message.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Character in the line, counted from 1; `None` where the scenario was no text. It is not part of the message.
    pub fn column(&self) -> Option<usize> {
        self.column
    }

    /// The same about a value that is in no text.
    pub(super) fn in_no_text(self) -> Self {
        Self { column: None, ..self }
    }

    /// Name of the scenario, empty if it was not readable or not given.
    pub fn scenario(&self) -> &str {
        &self.scenario
    }
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ScenarioError {}

/// The present place in a scenario.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct DecodeLocation<'n> {
    /// Its number, or its place in the file where it has none.
    pub(super) agent: Option<&'n str>,
    /// Segment of the path or piece of the profile, counted from 1.
    pub(super) part: Option<(&'static str, usize)>,
}

impl<'n> DecodeLocation<'n> {
    /// The error at this place; `field` is empty where the place as a whole is meant.
    pub(super) fn error(self, at: Position, field: &str, problem: impl fmt::Display) -> ScenarioError {
        let place = self.called(field);
        let colon = if place.is_empty() { "" } else { ": " };
        let message = format!("{place}{colon}{problem}");
        let field = Some(field.to_owned()).filter(|field| !field.is_empty());
        let about = ErrorLocation { agent: self.agent.map(str::to_owned), part: self.part, field };
        ScenarioError {
            scenario: String::new(),
            line: at.line as usize,
            column: Some(at.column as usize),
            about: Box::new(about),
            message,
        }
    }

    /// Agent, part and field, as far as there are any.
    fn called(self, field: &str) -> String {
        let part = self.part.map(|(part, number)| format!("{part} {number}"));
        let field = Some(field).filter(|field| !field.is_empty());
        let place: Vec<&str> = [self.agent, part.as_deref(), field].into_iter().flatten().collect();
        place.join(", ")
    }

    pub(super) fn part(self, name: &'static str, index: usize) -> Self {
        Self { part: Some((name, index + 1)), ..self }
    }

    /// The fields of an object that has no others than these.
    pub(super) fn fields(self, json: &'n JsonNode<'_>, known: &[&str]) -> Result<ObjectFields<'n>, ScenarioError> {
        self.fields_inside(json, "", known)
    }

    /// The same for an object within the one that the place names; `inside` precedes its fields in messages.
    fn fields_inside(
        self,
        json: &'n JsonNode<'_>,
        inside: &'static str,
        known: &[&str],
    ) -> Result<ObjectFields<'n>, ScenarioError> {
        let JsonData::Object(members) = &json.data else {
            return Err(self.error(json.position, "", format!("{} where an object is expected", brief(json))));
        };
        let fields = ObjectFields { location: self, inside, position: json.position, members };
        for (index, (key, value)) in members.iter().enumerate() {
            if !known.contains(&&**key) {
                let problem = format!("unknown key; known are {}", known.join(", "));
                return Err(fields.error(value.position, &shortened(key), problem));
            }
            // At most as many steps as there are known keys before one of them is given twice.
            if members.iter().take(index).any(|(before, _)| before == key) {
                return Err(fields.error(value.position, key, "given twice"));
            }
        }
        Ok(fields)
    }
}

/// The members of an object whose keys are known.
pub(super) struct ObjectFields<'j> {
    pub(super) location: DecodeLocation<'j>,
    /// Text that precedes its fields in messages.
    inside: &'static str,
    pub(super) position: Position,
    members: &'j [JsonMember<'j>],
}

impl<'j> ObjectFields<'j> {
    pub(super) fn error(&self, at: Position, field: &str, problem: impl fmt::Display) -> ScenarioError {
        self.location.error(at, &format!("{}{field}", self.inside), problem)
    }

    /// The error about a field, at its place if it is given.
    pub(super) fn refused(&self, field: &str, problem: impl fmt::Display) -> ScenarioError {
        self.error(self.get(field).map_or(self.position, |json| json.position), field, problem)
    }

    /// A field as messages name it, with its agent and its part.
    pub(super) fn called(&self, field: &str) -> String {
        self.location.called(&format!("{}{field}", self.inside))
    }

    pub(super) fn get(&self, field: &str) -> Option<&'j JsonNode<'j>> {
        self.members.iter().find(|(key, _)| key == field).map(|(_, value)| value)
    }

    pub(super) fn required(&self, field: &str) -> Result<&'j JsonNode<'j>, ScenarioError> {
        self.get(field).ok_or_else(|| self.error(self.position, field, "missing"))
    }

    pub(super) fn unexpected(&self, field: &str, found: &JsonNode<'_>, expected: &str) -> ScenarioError {
        self.error(found.position, field, format!("{} where {expected} is expected", brief(found)))
    }

    pub(super) fn array(&self, field: &str) -> Result<&'j [JsonNode<'j>], ScenarioError> {
        let found = self.required(field)?;
        match &found.data {
            JsonData::Array(elements) => Ok(elements),
            _ => Err(self.unexpected(field, found, "an array")),
        }
    }

    pub(super) fn object(
        &self,
        field: &str,
        inside: &'static str,
        known: &[&str],
    ) -> Result<ObjectFields<'j>, ScenarioError> {
        let found = self.required(field)?;
        match &found.data {
            JsonData::Object(_) => self.location.fields_inside(found, inside, known),
            _ => Err(self.unexpected(field, found, "an object")),
        }
    }

    pub(super) fn number(&self, field: &str, range: NumberRange) -> Result<f64, ScenarioError> {
        let found = self.required(field)?;
        let JsonData::Number(text) = &found.data else {
            return Err(self.unexpected(field, found, "a number"));
        };
        // A number of the grammar always parses; what is too large becomes infinite, and is then refused.
        match text.parse::<f64>() {
            Ok(number) if range.allows(number) => Ok(number),
            _ => {
                let problem = format!("{} is out of range; allowed is {range}", shortened(text));
                Err(self.error(found.position, field, problem))
            }
        }
    }
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("{}...", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}

/// A number as messages give it: short, and exact.
pub fn figure(number: f64) -> String {
    let plain = number == 0.0 || (1e-3..1e6).contains(&number.abs());
    if plain { number.to_string() } else { format!("{number:e}") }
}

/// A value as messages quote it.
pub(super) fn brief(json: &JsonNode<'_>) -> String {
    match &json.data {
        JsonData::Null => "null".into(),
        JsonData::Bool(value) => value.to_string(),
        JsonData::Number(text) => shortened(text),
        JsonData::Text(text) => format!("{:?}", shortened(text)),
        JsonData::Array(_) => "an array".into(),
        JsonData::Object(_) => "an object".into(),
    }
}

/// The allowed range of a number. NaN is in no range.
#[derive(Clone, Copy)]
pub(super) enum NumberRange {
    Any,
    NotNegative,
    Positive,
}

impl NumberRange {
    fn allows(self, number: f64) -> bool {
        let sign = match self {
            Self::Any => true,
            Self::NotNegative => number >= 0.0,
            Self::Positive => number > 0.0,
        };
        sign && number.abs() <= LIMIT
    }
}

impl fmt::Display for NumberRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Any => write!(f, "-{LIMIT:e} to {LIMIT:e}"),
            Self::NotNegative => write!(f, "0 to {LIMIT:e}"),
            Self::Positive => write!(f, "above 0, up to {LIMIT:e}"),
        }
    }
}

/// A whole number from 0, which many programs write as a fraction (`1.0`), as far as fractions tell whole numbers apart.
pub(super) fn parse_integer(text: &str) -> Option<u64> {
    const MOST: f64 = (1_u64 << 53) as f64;
    let of_fraction = || {
        let number: f64 = text.parse().ok()?;
        // What is too small for a fraction is none.
        let is_zero =
            || !text.split(['e', 'E']).next().unwrap_or_default().contains(|digit| ('1'..='9').contains(&digit));
        let is_whole = number.fract() == 0.0 && (0.0..MOST).contains(&number) && (number != 0.0 || is_zero());
        is_whole.then_some(number as u64)
    };
    text.parse().ok().or_else(of_fraction)
}

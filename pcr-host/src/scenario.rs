//! Scenario files: agents with their paths and motions, as JSON.
//!
//! Decoded by hand from the JSON tree, so that every refusal names the agent, the segment, the field, the value and
//! what is allowed there.

use serde_json::{Map, Value};
use std::collections::HashSet;
use std::fmt;

/// A fleet as a file describes it. SI units, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Name, empty if the file gives none.
    pub name: String,
    /// The agents, in the order of the file.
    pub agents: Vec<Agent>,
}

/// One agent.
#[derive(Clone, Debug, PartialEq)]
pub struct Agent {
    /// Number, unique in its scenario.
    pub id: u64,
    /// Radius of the disc \[m\].
    pub radius: f64,
    /// When it sets off \[s\].
    pub t_start: f64,
    /// Abscissa \[m\], ordinate \[m\] and heading \[rad\] at the start of the path.
    pub start: [f64; 3],
    /// The path.
    pub path: Vec<PathSegment>,
    /// How it moves along it.
    pub motion: MotionSpec,
}

/// A line or an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathSegment {
    /// Straight, with its length \[m\].
    Line {
        /// \[m\]
        length: f64,
    },
    /// Circular.
    Arc {
        /// \[m\]
        radius: f64,
        /// \[rad\], left positive.
        sweep: f64,
    },
}

impl PathSegment {
    /// Length \[m\].
    pub fn length(&self) -> f64 {
        match *self {
            Self::Line { length } => length,
            Self::Arc { radius, sweep } => radius * sweep.abs(),
        }
    }

    /// Letter of the paper's path structure.
    pub fn letter(&self) -> char {
        match self {
            Self::Line { .. } => 'S',
            Self::Arc { .. } => 'A',
        }
    }
}

/// Speed over time.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionSpec {
    /// From rest to rest in the least time under these limits.
    RestToRest {
        /// \[m/s\]
        v_max: f64,
        /// \[m/s²\]
        a_max: f64,
    },
    /// A speed at the start, then constant accelerations.
    Profile {
        /// \[m/s\]
        v0: f64,
        /// Duration \[s\] and acceleration \[m/s²\] of each piece.
        pieces: Vec<(f64, f64)>,
    },
}

/// Relative difference between the travelled length and the length of the path that is still scaled away.
pub const LENGTH_TOLERANCE: f64 = 1e-6;

/// Why a scenario was refused.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioError {
    /// Number of the agent, or its place in the file (counted from 1) where it has none.
    agent: Option<String>,
    /// Segment of the path or piece of the profile, counted from 1.
    part: Option<(&'static str, usize)>,
    field: String,
    problem: String,
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(agent) = &self.agent {
            write!(f, "{agent}, ")?;
        }
        if let Some((part, number)) = self.part {
            write!(f, "{part} {number}, ")?;
        }
        if !self.field.is_empty() {
            write!(f, "{}: ", self.field)?;
        }
        f.write_str(&self.problem)
    }
}

impl std::error::Error for ScenarioError {}

/// Where in the file we are.
#[derive(Clone, Debug, Default)]
struct Place {
    agent: Option<String>,
    part: Option<(&'static str, usize)>,
}

impl Place {
    fn error(&self, field: impl Into<String>, problem: impl Into<String>) -> ScenarioError {
        ScenarioError { agent: self.agent.clone(), part: self.part, field: field.into(), problem: problem.into() }
    }

    fn object<'v>(
        &self,
        value: &'v Value,
        field: &str,
        known: &[&str],
    ) -> Result<&'v Map<String, Value>, ScenarioError> {
        let object = value
            .as_object()
            .ok_or_else(|| self.error(field, format!("{} where an object is expected", brief(value))))?;
        match object.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => Err(self.error(key, format!("unknown key; known are {}", known.join(", ")))),
            None => Ok(object),
        }
    }

    fn array<'v>(&self, object: &'v Map<String, Value>, field: &str) -> Result<&'v [Value], ScenarioError> {
        let value = object.get(field).ok_or_else(|| self.error(field, "missing"))?;
        let array = value.as_array().map(Vec::as_slice);
        array.ok_or_else(|| self.error(field, format!("{} where an array is expected", brief(value))))
    }

    fn number(&self, object: &Map<String, Value>, field: &str, range: Range) -> Result<f64, ScenarioError> {
        let value = object.get(field).ok_or_else(|| self.error(field, "missing"))?;
        let number =
            value.as_f64().ok_or_else(|| self.error(field, format!("{} where a number is expected", brief(value))))?;
        if range.allows(number) {
            Ok(number)
        } else {
            Err(self.error(field, format!("{number} is not allowed here; allowed is {range}")))
        }
    }
}

fn brief(value: &Value) -> String {
    match value {
        Value::Null => "null".into(),
        Value::Bool(value) => value.to_string(),
        Value::Number(value) => value.to_string(),
        Value::String(value) => format!("{:?}", value.chars().take(40).collect::<String>()),
        Value::Array(_) => "an array".into(),
        Value::Object(_) => "an object".into(),
    }
}

/// What a number may be.
#[derive(Clone, Copy)]
enum Range {
    Any,
    NotNegative,
    Positive,
}

impl Range {
    /// Magnitude that every number format of the tool can hold.
    const LIMIT: f64 = 1e6;

    fn allows(self, number: f64) -> bool {
        let sign = match self {
            Self::Any => true,
            Self::NotNegative => number >= 0.0,
            Self::Positive => number > 0.0,
        };
        sign && number.abs() <= Self::LIMIT
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Any => write!(f, "-{0:e} to {0:e}", Self::LIMIT),
            Self::NotNegative => write!(f, "0 to {:e}", Self::LIMIT),
            Self::Positive => write!(f, "above 0, up to {:e}", Self::LIMIT),
        }
    }
}

impl Scenario {
    /// The scenario in a JSON text.
    ///
    /// # Errors
    /// [`ScenarioError`], naming agent, segment, field, value and what is allowed there.
    pub fn from_json(text: &str) -> Result<Self, ScenarioError> {
        let value: Value = serde_json::from_str(text)
            .map_err(|error| Place::default().error("", format!("not valid JSON: {error}")))?;
        Self::from_value(&value)
    }

    /// The scenario in a JSON value.
    ///
    /// # Errors
    /// As [`Scenario::from_json`].
    pub fn from_value(value: &Value) -> Result<Self, ScenarioError> {
        let place = Place::default();
        let object = place.object(value, "scenario", &["name", "agents"])?;
        let name = match object.get("name") {
            None => String::new(),
            Some(Value::String(name)) => name.clone(),
            Some(other) => return Err(place.error("name", format!("{} where a string is expected", brief(other)))),
        };
        let agents = place.array(object, "agents")?;
        let agents: Vec<Agent> =
            agents.iter().enumerate().map(|(k, agent)| Agent::from_value(agent, k + 1)).collect::<Result<_, _>>()?;
        let mut ids = HashSet::new();
        if let Some(twice) = agents.iter().find(|agent| !ids.insert(agent.id)) {
            let place = Place { agent: Some(format!("agent {}", twice.id)), part: None };
            return Err(place.error("id", "given to two agents"));
        }
        Ok(Self { name, agents })
    }
}

impl Agent {
    fn from_value(value: &Value, number: usize) -> Result<Self, ScenarioError> {
        let mut place = Place { agent: Some(format!("agent at place {number}")), part: None };
        let known = ["id", "radius", "v_max", "a_max", "t_start", "start", "path", "profile"];
        let id = value.get("id").and_then(Value::as_u64);
        if let Some(id) = id {
            place.agent = Some(format!("agent {id}"));
        }
        let object = place.object(value, "", &known)?;
        let id = id.ok_or_else(|| match object.get("id") {
            None => place.error("id", "missing"),
            Some(other) => place.error("id", format!("{} where a whole number from 0 is expected", brief(other))),
        })?;
        let radius = place.number(object, "radius", Range::Positive)?;
        let t_start = if object.contains_key("t_start") { place.number(object, "t_start", Range::Any)? } else { 0.0 };
        let start = object.get("start").ok_or_else(|| place.error("start", "missing"))?;
        let start = place.object(start, "start", &["x", "y", "heading"])?;
        let coordinate = |field| {
            place
                .number(start, field, Range::Any)
                .map_err(|error| ScenarioError { field: format!("start.{field}"), ..error })
        };
        let start = [coordinate("x")?, coordinate("y")?, coordinate("heading")?];
        let path = place.array(object, "path")?;
        let path = path.iter().enumerate().map(|(k, segment)| {
            PathSegment::from_value(segment, &Place { part: Some(("segment", k + 1)), ..place.clone() })
        });
        let path: Vec<PathSegment> = path.collect::<Result<_, _>>()?;
        let length: f64 = path.iter().map(PathSegment::length).sum();
        if length > Range::LIMIT {
            return Err(place.error("path", format!("{length} m long; allowed is up to {:e}", Range::LIMIT)));
        }
        let profile = object.get("profile");
        let limit = |field| match (object.contains_key(field), profile.is_some()) {
            (false, true) => Ok(f64::NAN),
            _ => place.number(object, field, Range::Positive),
        };
        let (v_max, a_max) = (limit("v_max")?, limit("a_max")?);
        let motion = match profile {
            None => MotionSpec::RestToRest { v_max, a_max },
            Some(profile) => MotionSpec::from_value(profile, length, &place)?,
        };
        Ok(Self { id, radius, t_start, start, path, motion })
    }

    /// Length of the path \[m\].
    pub fn length(&self) -> f64 {
        self.path.iter().map(PathSegment::length).sum()
    }

    /// The paper's path structure: a letter a segment.
    pub fn structure(&self) -> String {
        self.path.iter().map(PathSegment::letter).collect()
    }

    /// Heading at a travelled length \[rad\], accumulated along the arcs and not reduced to one turn.
    pub fn heading_at(&self, length: f64) -> f64 {
        let (mut heading, mut rest) = (self.start[2], length);
        for segment in &self.path {
            if let PathSegment::Arc { radius, sweep } = *segment {
                heading += (rest / radius).clamp(0.0, sweep.abs()).copysign(sweep);
            }
            rest = (rest - segment.length()).max(0.0);
        }
        heading
    }
}

impl PathSegment {
    fn from_value(value: &Value, place: &Place) -> Result<Self, ScenarioError> {
        let kind = value.get("kind");
        match kind.and_then(Value::as_str) {
            Some("line") => {
                let object = place.object(value, "", &["kind", "length"])?;
                Ok(Self::Line { length: place.number(object, "length", Range::NotNegative)? })
            }
            Some("arc") => {
                let object = place.object(value, "", &["kind", "radius", "sweep"])?;
                let radius = place.number(object, "radius", Range::Positive)?;
                Ok(Self::Arc { radius, sweep: place.number(object, "sweep", Range::Any)? })
            }
            _ => {
                let given = kind.map_or("missing".into(), brief);
                place.object(value, "", &["kind", "length", "radius", "sweep"])?;
                Err(place.error("kind", format!("{given}; allowed is \"line\" or \"arc\"")))
            }
        }
    }
}

impl MotionSpec {
    /// A profile, scaled onto the length of the path.
    fn from_value(value: &Value, length: f64, place: &Place) -> Result<Self, ScenarioError> {
        let object = place.object(value, "profile", &["v0", "pieces"])?;
        let v0 = place.number(object, "v0", Range::NotNegative)?;
        let (mut speed, mut fastest, mut travelled) = (v0, v0, 0.0);
        let mut pieces = Vec::new();
        for (k, piece) in place.array(object, "pieces")?.iter().enumerate() {
            let place = Place { part: Some(("profile piece", k + 1)), ..place.clone() };
            let piece = place.object(piece, "", &["duration", "accel"])?;
            let duration = place.number(piece, "duration", Range::NotNegative)?;
            let accel = place.number(piece, "accel", Range::Any)?;
            let after = speed + accel * duration;
            if after < -1e-9 * f64::max(1.0, fastest) {
                return Err(
                    place.error("accel", format!("{accel} brings the speed to {after} m/s; allowed is 0 and above"))
                );
            }
            // What is left of a stop after rounding is no speed.
            let after = if after.abs() < 1e-12 * fastest { 0.0 } else { after.max(0.0) };
            let accel = if duration > 0.0 { (after - speed) / duration } else { 0.0 };
            travelled += 0.5 * (speed + after) * duration;
            pieces.push((duration, accel));
            (speed, fastest) = (after, fastest.max(after));
        }
        if (travelled - length).abs() > LENGTH_TOLERANCE * length {
            let problem = format!(
                "travels {travelled} m on a path of {length} m; allowed is a relative difference of {LENGTH_TOLERANCE:e}"
            );
            return Err(place.error("profile", problem));
        }
        let scale = if travelled > 0.0 { length / travelled } else { 1.0 };
        for (_, accel) in &mut pieces {
            *accel *= scale;
        }
        Ok(Self::Profile { v0: v0 * scale, pieces })
    }
}

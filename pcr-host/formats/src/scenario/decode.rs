//! Decodes a scenario from JSON: the meaning of each field, and conditions between fields.

use super::agent_name::AgentName;
use super::angles::{AngleField, Doubts, RADIANS, UNIT};
use super::facing;
use super::file_version::{KNOWN_VERSIONS, STEADY, TURNS, VERSION, VersionFaults};
use super::json_fields::{
    DecodeLocation, LIMIT, NumberRange, ObjectFields, ScenarioError, brief, figure, parse_integer,
};
use super::labels;
use super::outline::{loads, outline};
use super::path_decode::path;
use super::round_trip::{RoundTripProfile, speed_after};
use super::{Agent, MotionPiece, MotionSpec, PathSegment, Scenario};
use super::{old_turns, turns};
use crate::answer_files;
use crate::byte_order_mark::unmarked;
use crate::json::{self, JsonData, JsonNode, Position};
use crate::warning::WarningCode;
use serde_json::Value;
use std::collections::HashSet;
use std::fmt;

/// Fields of a scenario file.
const FIELDS: [&str; 6] = ["format", "version", "name", UNIT, "agents", "warnings"];

/// Relative difference between the travelled length and the length of the path that is still scaled away: what the library takes, 2⁻²⁰.
pub const LENGTH_TOLERANCE: f64 = 1.0 / (1_u64 << -pcr_core::LENGTH_TOLERANCE_LOG2) as f64;

/// Name of the format.
pub(super) const FORMAT: &str = "pcr-scenario";
impl Scenario {
    /// The scenario in a JSON text; a byte order mark at its start is skipped.
    ///
    /// # Errors
    /// [`ScenarioError`], naming agent, segment, field, value and what is allowed there, with line and column.
    pub fn from_json(text: &str) -> Result<Self, ScenarioError> {
        let text = unmarked(text);
        if text.trim().is_empty() {
            return Err(DecodeLocation::default().error(
                Position { line: 1, column: 1 },
                "",
                "empty; a scenario is an object with a list of agents",
            ));
        }
        // Agent by agent: the tree of a large fleet would take many times the memory of its text.
        let mut agents = AgentsVisitor::default();
        let json = json::parse_listing(text, "agents", &mut |agent| agents.add(&agent))
            .map_err(|error| DecodeLocation::default().error(error.position, "", error.problem))?;
        Self::decode(&json, agents)
    }

    /// The scenario in a JSON value.
    ///
    /// # Errors
    /// As [`Scenario::from_json`].
    pub fn from_value(value: &Value) -> Result<Self, ScenarioError> {
        let (json, mut agents) = (JsonNode::from_value(value.clone(), Position::START), AgentsVisitor::default());
        if let JsonData::Object(members) = &json.data
            && let Some((_, JsonNode { data: JsonData::Array(list), .. })) =
                members.iter().find(|(key, _)| key == "agents")
        {
            list.iter().for_each(|agent| agents.add(agent));
        }
        Self::decode(&json, agents).map_err(ScenarioError::in_no_text)
    }

    /// The content of a file beside its agents, with the agents.
    fn decode(json: &JsonNode<'_>, agents: AgentsVisitor) -> Result<Self, ScenarioError> {
        let name = match &json.data {
            JsonData::Object(members) => members.iter().find(|(key, _)| key == "name"),
            _ => None,
        };
        let name = match name {
            Some((_, JsonNode { data: JsonData::Text(name), .. })) => name.to_string(),
            _ => String::new(),
        };
        let doubts = agents.doubts.warnings();
        match Self::agents(json, agents).and_then(|agents| Ok((agents, Self::warnings(json, doubts)?))) {
            Ok((agents, warnings)) => Ok(Self { name, agents, warnings }),
            Err(mut error) => {
                error.scenario = name;
                Err(error)
            }
        }
    }

    /// The warnings in the file, and those about its angles unless it declares their unit.
    fn warnings(json: &JsonNode<'_>, doubts: Vec<String>) -> Result<Vec<String>, ScenarioError> {
        let fields = DecodeLocation::default().fields(json, &FIELDS)?;
        let doubts = match fields.get(UNIT).map(|unit| (unit, &unit.data)) {
            None => doubts,
            Some((_, JsonData::Text(unit))) if unit == RADIANS => Vec::new(),
            Some((unit, _)) => {
                let expected = format!("\"{RADIANS}\" (degrees have keys of their own, such as heading_deg)");
                return Err(fields.unexpected(UNIT, unit, &expected));
            }
        };
        if fields.get("warnings").is_none() {
            return Ok(doubts);
        }
        let text = |warning: &JsonNode<'_>| match &warning.data {
            JsonData::Text(text) => Ok(WarningCode::coded(text.to_string())),
            _ => Err(fields.unexpected("warnings", warning, "a list of strings")),
        };
        let mut warnings: Vec<String> = fields.array("warnings")?.iter().map(text).collect::<Result<_, _>>()?;
        let new: Vec<String> = doubts.into_iter().filter(|doubt| !warnings.contains(doubt)).collect();
        warnings.extend(new);
        Ok(warnings)
    }

    fn agents(json: &JsonNode<'_>, agents: AgentsVisitor) -> Result<Vec<Agent>, ScenarioError> {
        is_scenario(json)?;
        let fields = DecodeLocation::default().fields(json, &FIELDS)?;
        let version = match fields.get("version").map(|version| (version, &version.data)) {
            None => VERSION,
            Some((given, JsonData::Number(version))) => match parse_integer(version) {
                Some(version @ VERSION..=STEADY) => version,
                _ => return Err(fields.unexpected("version", given, KNOWN_VERSIONS)),
            },
            Some((given, _)) => return Err(fields.unexpected("version", given, KNOWN_VERSIONS)),
        };
        agents.versions.check(version)?;
        match fields.get("name").map(|name| (name, &name.data)) {
            None => {}
            Some((given, JsonData::Text(name))) => {
                if let Some(fault) = labels::fault(name) {
                    return Err(fields.error(given.position, "name", fault));
                }
            }
            Some((name, _)) => return Err(fields.unexpected("name", name, "a string")),
        }
        fields.array("agents")?;
        agents.fault.map_or(Ok(agents.all), Err)
    }
}

/// Refuses files of another format, before one of their keys is refused as unknown, and the line in place of a plan that there is not.
fn is_scenario(json: &JsonNode<'_>) -> Result<(), ScenarioError> {
    let JsonData::Object(members) = &json.data else { return Ok(()) };
    let member = |key: &str| members.iter().find(|(name, _)| name == key).map(|(_, value)| (value, &value.data));
    match member("format") {
        None => {}
        Some((_, JsonData::Text(format))) if format == FORMAT => {}
        Some((given, format)) => {
            let answer = if let JsonData::Text(format) = format { answer_files::described(format) } else { None };
            return Err(match answer {
                Some(answer) => {
                    DecodeLocation::default().error(given.position, "", format!("{answer}; a scenario is expected"))
                }
                None => {
                    let problem = format!("{} where \"{FORMAT}\" is expected", brief(given));
                    DecodeLocation::default().error(given.position, "format", problem)
                }
            });
        }
    }
    match (member("agents"), member("error"), member("name")) {
        (None, Some((given, JsonData::Text(why))), Some((_, JsonData::Text(name)))) => {
            Err(DecodeLocation::default().error(given.position, "", format!("{name}: {why}")))
        }
        _ => Ok(()),
    }
}

/// The agents of a file, one after the other as they are read.
#[derive(Default)]
struct AgentsVisitor {
    all: Vec<Agent>,
    ids: HashSet<u64>,
    texts: HashSet<String>,
    /// Whether ids are texts.
    all_texts: Option<bool>,
    doubts: Doubts,
    /// The error of the first agent that is refused; later agents are not read.
    fault: Option<ScenarioError>,
    versions: VersionFaults,
}

impl AgentsVisitor {
    fn add(&mut self, json: &JsonNode<'_>) {
        if self.fault.is_none()
            && let Err(fault) = self.decode(json)
        {
            self.fault = Some(fault);
        }
    }

    fn decode(&mut self, json: &JsonNode<'_>) -> Result<(), ScenarioError> {
        let (agent, text) = Agent::decode(json, self.all.len(), &mut self.doubts, &mut self.versions)?;
        let refused = |problem: &dyn fmt::Display| {
            let called = format!("agent {}", agent.display_name());
            let at = json.get("id").map_or(json.position, |id| id.position);
            Err(DecodeLocation { agent: Some(&called), part: None }.error(at, "id", problem))
        };
        if text && !self.texts.insert(agent.label.clone()) {
            return refused(&format_args!("{:?} is given to two agents", agent.label));
        }
        if *self.all_texts.get_or_insert(text) != text {
            return refused(&"some ids are numbers and others texts; give numbers to all, and texts as labels");
        }
        if !self.ids.insert(agent.id) {
            return refused(&format_args!("{} is given to two agents", agent.id));
        }
        self.all.push(agent);
        Ok(())
    }
}

impl Agent {
    /// The agent at a place, and whether its id is a text.
    fn decode(
        json: &JsonNode<'_>,
        index: usize,
        doubts: &mut Doubts,
        versions: &mut VersionFaults,
    ) -> Result<(Self, bool), ScenarioError> {
        const KNOWN: [&str; 16] = [
            "id",
            "label",
            "radius",
            "footprint",
            "loads",
            "margin",
            "v_max",
            "a_max",
            "turn_v_max",
            "turn_v_max_deg",
            "turn_a_max",
            "turn_a_max_deg",
            "t_start",
            "start",
            "path",
            "profile",
        ];
        let name = AgentName::of(json, index);
        let called = name.called(index);
        let place = DecodeLocation { agent: Some(&called), part: None };
        let fields = place.fields(json, &KNOWN)?;
        let id = name.checked(&fields)?;
        let (radius, footprint) = outline(&fields, place)?;
        let margin = fields.get("margin").map_or(Ok(0.0), |_| fields.number("margin", NumberRange::NotNegative))?;
        let t_start = fields.get("t_start").map_or(Ok(0.0), |_| fields.number("t_start", NumberRange::Any))?;
        let start = fields.object("start", "start.", &["x", "y", "heading", "heading_deg"])?;
        let start = [
            start.number("x", NumberRange::Any)?,
            start.number("y", NumberRange::Any)?,
            doubts.angle(&start, AngleField::Heading)?,
        ];
        let mut path = path(&fields, place, doubts, versions)?;
        let motion = motion(&fields, &mut path, doubts, versions)?;
        let places: Vec<usize> = (0..path.len()).filter(|place| !facing::changes(&path[*place])).collect();
        let mut loads = loads(&fields, places.len())?;
        for load in &mut loads {
            let [first, last] = load.segments.map(|segment| places[segment]);
            // The vehicle has the load already where its facing changes before it.
            let before = first.checked_sub(1).filter(|before| facing::changes(&path[*before]));
            load.segments = [before.unwrap_or(first), last];
        }
        let AgentName { label, is_text, .. } = name;
        let agent = Self { id, label, radius, footprint, loads, margin, t_start, start, path, motion };
        agent.ends_in_time(&fields)?;
        if let Some((segment, speed)) = agent.speed_at_change() {
            let problem = format!(
                "{} m/s at the end of segment {}; allowed is 0, because the gear or facing changes there",
                figure(speed),
                segment + 1
            );
            return Err(fields.refused("profile", problem));
        }
        Ok((agent, is_text))
    }

    /// Refuses motions that end too late.
    fn ends_in_time(&self, fields: &ObjectFields<'_>) -> Result<(), ScenarioError> {
        let (duration, t_start) = (self.duration(), self.t_start);
        if duration <= LIMIT && (t_start + duration).abs() <= LIMIT {
            return Ok(());
        }
        let field = if fields.get("profile").is_some() {
            "profile"
        } else if duration > LIMIT {
            "v_max, a_max"
        } else {
            "t_start"
        };
        let [takes, from] = [duration, t_start].map(figure);
        let problem = format!("the motion takes {takes} s from {from} s; allowed is up to {LIMIT:e} s");
        Err(fields.refused(field, problem))
    }
}

/// The profile that is given, or from rest to rest, or with turns in place.
fn motion(
    fields: &ObjectFields<'_>,
    path: &mut [PathSegment],
    doubts: &mut Doubts,
    versions: &mut VersionFaults,
) -> Result<MotionSpec, ScenarioError> {
    let moves = fields.get("profile").is_none();
    let limit = |field| match fields.get(field) {
        None if !moves => Ok(None),
        _ => fields.number(field, NumberRange::Positive).map(Some),
    };
    let turns = moves && path.iter().any(|segment| matches!(segment, PathSegment::Turn { .. }));
    let mut of_turns = |limit: AngleField| match limit.is_in(fields) || turns {
        false => Ok(0.0),
        true => doubts.angle(fields, limit),
    };
    let of_turns = [of_turns(AngleField::TurnSpeed)?, of_turns(AngleField::TurnAcceleration)?];
    let profile = |pieces| MotionSpec::Profile { v0: 0.0, pieces };
    Ok(match (limit("v_max")?, limit("a_max")?) {
        (Some(v_max), Some(a_max)) if moves && path.iter().any(facing::changes) => {
            profile(facing::pieces(path, [v_max, a_max], of_turns))
        }
        (Some(v_max), Some(a_max)) if turns => profile(turns::pieces(path, [v_max, a_max], of_turns)),
        (Some(v_max), Some(a_max)) if moves => MotionSpec::RestToRest { v_max, a_max },
        _ => MotionSpec::decode(fields, path, doubts, versions)?,
    })
}

/// Pieces of a profile in a file, with the fields of each, unless they are converted.
struct GivenPieces<'j> {
    /// The profile.
    fields: ObjectFields<'j>,
    pieces: Vec<(MotionPiece, Option<ObjectFields<'j>>)>,
}

impl MotionSpec {
    /// The profile of an agent, scaled onto the length of its path and onto its turns in place.
    fn decode(
        agent: &ObjectFields<'_>,
        path: &mut [PathSegment],
        doubts: &mut Doubts,
        versions: &mut VersionFaults,
    ) -> Result<Self, ScenarioError> {
        let fields = agent.object("profile", "profile.", &["v0", "pieces"])?;
        let mut v0 = fields.number("v0", NumberRange::NotNegative)?;
        let mut pieces = Vec::new();
        for (index, json) in fields.array("pieces")?.iter().enumerate() {
            let place = agent.location.part("profile piece", index);
            let fields = place.fields(json, &["duration", "accel", "turn_accel", "turn_accel_deg"])?;
            let duration = fields.number("duration", NumberRange::NotNegative)?;
            let in_place = AngleField::PieceAcceleration.is_in(&fields);
            let acceleration = if in_place {
                versions.needs_turns(place, json, "turn_accel");
                if fields.get("accel").is_some() {
                    return Err(fields.refused("accel", "given beside turn_accel; a piece has one of the two"));
                }
                doubts.angle(&fields, AngleField::PieceAcceleration)?
            } else {
                fields.number("accel", NumberRange::Any)?
            };
            pieces.push((MotionPiece { duration, acceleration, in_place }, Some(fields)));
        }
        let mut given = GivenPieces { fields, pieces };
        let has_turns = path.iter().any(PathSegment::takes_turning);
        if has_turns && given.pieces.iter().all(|(piece, _)| !piece.in_place) {
            let problem =
                format!("no turn_accel, although the path turns in place; from version {TURNS} on there is one");
            versions.long_turn.get_or_insert_with(|| agent.refused("profile", problem));
            // Scaled onto what was the length of the path.
            let length = path.iter().map(old_turns::length).sum();
            let profile = given.along_path(agent, v0, length)?;
            v0 = profile.v0;
            let converted = old_turns::converted(path, v0, &profile.pieces);
            given.pieces = converted.into_iter().map(|piece| (piece, None)).collect();
        }
        let profile = given.along_path(agent, v0, path.iter().map(PathSegment::length).sum())?;
        let mut along = profile.pieces.into_iter();
        let mut pieces: Vec<MotionPiece> = given.pieces.iter().map(|(piece, _)| *piece).collect();
        for piece in pieces.iter_mut().filter(|piece| !piece.in_place) {
            if let Some((duration, acceleration)) = along.next() {
                *piece = MotionPiece::drive(duration, acceleration);
            }
        }
        if has_turns || pieces.iter().any(|piece| piece.in_place) {
            given.turn(agent, profile.v0, &mut pieces, path)?;
        }
        Ok(Self::Profile { v0: profile.v0, pieces })
    }
}

impl GivenPieces<'_> {
    /// The pieces at these places, from a speed, as they are after they have been written and read.
    fn profile(&self, agent: &ObjectFields<'_>, v0: f64, places: &[usize]) -> Result<RoundTripProfile, ScenarioError> {
        let of = |place: &usize| self.pieces.get(*place).map(|(piece, _)| (piece.duration, piece.acceleration));
        RoundTripProfile::new(v0, places.iter().filter_map(of).collect()).map_err(|(index, after, accel)| {
            let place = places.get(index).and_then(|place| self.pieces.get(*place));
            let in_place = place.is_some_and(|(piece, _)| piece.in_place);
            let (field, unit) = if in_place { ("turn_accel", "rad/s") } else { ("accel", "m/s") };
            let problem =
                format!("{} brings the speed to {} {unit}; allowed is 0 and above", figure(accel), figure(after));
            match place {
                Some((_, Some(fields))) => fields.refused(field, problem),
                _ => agent.error(self.fields.position, "profile", problem),
            }
        })
    }

    /// The pieces along the path, scaled onto its length \[m\].
    fn along_path(&self, agent: &ObjectFields<'_>, v0: f64, length: f64) -> Result<RoundTripProfile, ScenarioError> {
        let places: Vec<usize> = (0..self.pieces.len()).filter(|place| !self.pieces[*place].0.in_place).collect();
        let mut profile = self.profile(agent, v0, &places)?;
        let travelled = profile.travelled;
        if profile.fastest > LIMIT || (travelled - length).abs() > LENGTH_TOLERANCE * length {
            let problem = if profile.fastest > LIMIT {
                format!("reaches {} m/s; allowed is up to {LIMIT:e}", figure(profile.fastest))
            } else {
                format!(
                    "travels {} m on a path of {} m; allowed is a relative difference of {LENGTH_TOLERANCE:.2e}",
                    figure(travelled),
                    figure(length)
                )
            };
            return Err(agent.error(self.fields.position, "profile", problem));
        }
        profile.scale_onto(length);
        Ok(profile)
    }

    /// Scales what turns in place onto the turns of the path. `pieces` are all, and those along the path are final.
    fn turn(
        &self,
        agent: &ObjectFields<'_>,
        v0: f64,
        pieces: &mut [MotionPiece],
        path: &[PathSegment],
    ) -> Result<(), ScenarioError> {
        let refused = |problem: String| agent.error(self.fields.position, "profile", problem);
        let length: f64 = path.iter().map(PathSegment::length).sum();
        let mut before = 0.0;
        // Number in the file, length of the path before it, and angle.
        let mut turns = path.iter().enumerate().filter_map(|(segment, shape)| {
            before += shape.length();
            let file = segment - path.iter().take(segment).filter(|other| facing::changes(other)).count();
            shape.takes_turning().then(|| (file + 1, before, shape.sweep().abs()))
        });
        let (mut speed, mut fastest, mut travelled, mut rotation) = (v0, v0, 0.0, 0.0);
        let mut place = 0;
        while let Some(piece) = pieces.get(place).copied() {
            if !piece.in_place {
                let after = speed_after(speed + piece.acceleration * piece.duration, fastest);
                travelled += 0.5 * (speed + after) * piece.duration;
                (speed, fastest, place) = (after, fastest.max(after), place + 1);
                continue;
            }
            let Some((segment, at, sweep)) = turns.next() else {
                return Err(refused(format!("piece {} turns in place; there is no turn left on the path", place + 1)));
            };
            if speed != 0.0 || (travelled - at).abs() > LENGTH_TOLERANCE * length {
                return Err(refused(format!(
                    "piece {} turns in place at {} m and {} m/s; segment {segment} turns at {} m, where the agent has to stand",
                    place + 1,
                    figure(travelled),
                    figure(speed),
                    figure(at)
                )));
            }
            // The pieces of this turn, between which it may wait.
            let phases = turns::phases(pieces.get(place..).unwrap_or_default(), sweep, rotation);
            let now = phases.last().map_or(rotation, |last| last.after);
            let own = place..place + phases.len();
            place = own.end;
            let own: Vec<usize> = own.filter(|place| pieces.get(*place).is_some_and(|piece| piece.in_place)).collect();
            let mut profile = self.profile(agent, rotation, &own)?;
            if (profile.travelled - sweep).abs() > LENGTH_TOLERANCE * sweep || profile.fastest > LIMIT {
                return Err(refused(format!(
                    "turns by {} rad in place where segment {segment} turns by {} rad; allowed is a relative difference of \
                     {LENGTH_TOLERANCE:.2e}",
                    figure(profile.travelled),
                    figure(sweep)
                )));
            }
            if rotation == 0.0 {
                profile.scale_onto(sweep);
            }
            // As a path, a turn may end under way where the profile ends.
            if now != 0.0 && pieces.get(place).is_some_and(|next| !next.in_place) {
                return Err(refused(format!("still turns with {} rad/s at the end of segment {segment}", figure(now))));
            }
            rotation = now;
            for (place, (duration, acceleration)) in own.into_iter().zip(profile.pieces) {
                if let Some(piece) = pieces.get_mut(place) {
                    *piece = MotionPiece::turn(duration, acceleration);
                }
            }
        }
        turns.next().map_or(Ok(()), |(segment, ..)| {
            Err(refused(format!("does not turn in place on segment {segment}; its pieces of a turn have turn_accel")))
        })
    }
}

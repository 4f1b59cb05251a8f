//! The line protocol: a JSON object on each line, one answer to each request with its `id`, and events for clients that
//! subscribe. The schema is `docs/reference/schema/pcr-serve.schema.json`.

use crate::closed_area::ClosureRequest;
use crate::event::SupervisorEvent;
use crate::line_angles;
use crate::metrics::Census;
use crate::owned_path::StartPose;
use crate::page_layout::PageLayout;
use crate::query::{self, Query};
use crate::request_error::RequestError;
use crate::robot::RobotTraits;
use crate::supervisor::{MissionRequest, PositionReport, Supervisor};
use crate::unanswered_lines::UnansweredLine;
use pcr_formats::unique_keys::UniqueKeysJson;
use serde::Deserialize;
use serde_json::{Map, Value, json};

/// The version of the protocol: requests may name it, answers and events do.
pub const VERSION: u64 = 1;

/// Longer lines are refused \[bytes\].
pub const LONGEST: usize = 1 << 20;

/// What a request asks for. Repeating a request changes nothing.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "verb", rename_all = "snake_case")]
enum Request {
    /// The first line of a connection.
    Hello(Hello),
    /// What the page draws.
    Layout(PageLayout),
    /// A new robot, which stands.
    Add(AddRobot),
    /// A path that leaves the present one at a length.
    Replace(MissionRequest),
    /// A path that begins at the end of the present one.
    Mission(MissionRequest),
    /// A robot is removed.
    Remove(RobotRef),
    /// A robot is away, or no longer.
    Away(AbsenceReport),
    /// An area is closed, or the speed in it is limited.
    Close(ClosureRequest),
    /// An area is open again.
    Open(ClosureRef),
    /// The whole fleet is paused.
    Pause {},
    /// The fleet goes on.
    Resume {},
    /// The position of a robot.
    Position(PositionReport),
    /// A robot is off its path.
    Off(OffPathReport),
    /// A question about the state.
    Query(Query),
    /// Whether the client wants events.
    Watch(Subscription),
}

/// The first line of a connection.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hello {
    /// Proves that the client may read the file with the token.
    #[serde(default)]
    pub token: Option<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AddRobot {
    robot: String,
    start: StartPose,
    abilities: RobotTraits,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RobotRef {
    robot: String,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ClosureRef {
    closure: String,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AbsenceReport {
    robot: String,
    #[serde(default = "yes")]
    away: bool,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OffPathReport {
    robot: String,
    x: f64,
    y: f64,
    /// Age of the message \[s\].
    #[serde(default)]
    age: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Subscription {
    #[serde(default = "yes")]
    events: bool,
}

fn yes() -> bool {
    true
}

/// The result of a line.
#[derive(Debug)]
pub struct LineReply {
    /// Counts the line as one without an answer, until this is dropped.
    pub unanswered: Option<UnansweredLine>,
    /// The answer. It may be sent after the next [`Supervisor::settle`].
    pub answer: Value,
    /// Whether the client wants events from now on; `None`: no change.
    pub watches: Option<bool>,
}

/// A line, read.
#[derive(Debug)]
pub struct RequestLine {
    unanswered: Option<UnansweredLine>,
    id: Value,
    verb: Result<Request, RequestError>,
    has_version: bool,
    is_object: bool,
}

impl RequestLine {
    /// Reads a line. An error in it becomes the answer.
    pub fn read(line: &[u8]) -> Self {
        let mut own =
            Self { unanswered: None, id: Value::Null, verb: Err(malformed("")), has_version: false, is_object: false };
        let value: Result<UniqueKeysJson, _> = serde_json::from_slice(line);
        // JSON that is an error has a name twice, in an object that it is or has in it.
        own.is_object = matches!(&value, Ok(UniqueKeysJson(Value::Object(_))))
            || line.trim_ascii_start().starts_with(b"{") && value.as_ref().is_err_and(|error| error.is_data());
        match value {
            Ok(UniqueKeysJson(Value::Object(object))) => own.verb = own.verb_of(object),
            Ok(_) => own.verb = Err(malformed("it is no JSON object")),
            Err(error) => own.verb = Err(malformed(format!("it is no JSON object: {error}"))),
        }
        own
    }

    /// The request of an object, of which it takes id and version.
    fn verb_of(&mut self, mut object: Map<String, Value>) -> Result<Request, RequestError> {
        let id = object.remove("id").unwrap_or(Value::Null);
        if !(id.is_null() || id.is_string() || id.is_number()) {
            return Err(malformed("id: it has to be a text or a number"));
        }
        // It would come back as another one.
        if id.as_f64().is_some_and(|number| !(id.is_i64() || id.is_u64()) && number.abs() >= (1_u64 << 53) as f64) {
            return Err(malformed("id: a number with so many digits has to be a text"));
        }
        self.id = id;
        match object.remove("pcr") {
            None => {}
            Some(version) if version == VERSION => self.has_version = true,
            Some(version) => {
                return Err(RequestError::Version {
                    why: format!("pcr: the version is {VERSION}, not {version}: use a client of version {VERSION}"),
                });
            }
        }
        line_angles::to_radians(&mut object)?;
        serde_json::from_value(Value::Object(object)).map_err(|error| malformed(error.to_string()))
    }

    /// Returns the line with what counts it as one without an answer.
    pub(crate) fn counted(self, unanswered: UnansweredLine) -> Self {
        Self { unanswered: Some(unanswered), ..self }
    }

    /// Whether the line is a JSON object.
    pub fn is_object(&self) -> bool {
        self.is_object
    }

    /// Returns the hello of a client, which names the version.
    ///
    /// # Errors
    /// [`RequestError::Version`] for another version or none, [`RequestError::NoHello`] for another line.
    pub fn hello(&self) -> Result<&Hello, RequestError> {
        match &self.verb {
            Ok(Request::Hello(_)) if !self.has_version => {
                Err(RequestError::Version { why: format!("hello has to name the version, \"pcr\": {VERSION}") })
            }
            Ok(Request::Hello(hello)) => Ok(hello),
            Err(fault @ RequestError::Version { .. }) => Err(fault.clone()),
            _ => Err(RequestError::NoHello),
        }
    }

    /// Returns the answer that refuses it.
    pub fn refused(&self, fault: RequestError) -> Value {
        answer(self.id.clone(), Err(fault))
    }
}

fn malformed(why: impl Into<String>) -> RequestError {
    RequestError::Malformed { why: why.into() }
}

/// Reads and carries out the request of a line. Ages count from the time `came` \[s\]; the line may have waited since.
pub fn handle(supervisor: &mut Supervisor, line: &[u8], came: f64, now: f64) -> LineReply {
    carry_out(supervisor, RequestLine::read(line), came, now)
}

/// Carries out a request. Ages count from the time `came` \[s\]; the line may have waited since.
pub(crate) fn carry_out(supervisor: &mut Supervisor, request: RequestLine, came: f64, now: f64) -> LineReply {
    let RequestLine { id, verb, unanswered, .. } = request;
    let mut watches = None;
    let done = verb.and_then(|verb| match verb {
        Request::Hello(_) => Ok(json!({ "version": VERSION, "fleet": Census::of(supervisor) })),
        Request::Layout(layout) => supervisor.draw(layout).map(|()| json!({})),
        Request::Add(AddRobot { robot, start, abilities }) => {
            supervisor.add(&robot, abilities, start)?;
            let robot = supervisor.robot(&robot)?;
            let mut added = json!({ "path": robot.path });
            if robot.body.excess() > 0.0 {
                added["hull_excess"] = json!(robot.body.excess());
            }
            Ok(added)
        }
        Request::Replace(proposal) if proposal.after.is_none() => {
            Err(malformed("replace needs `after`: the length of the path from which on it is another one"))
        }
        Request::Replace(proposal) | Request::Mission(proposal) => {
            supervisor.mission(&proposal, now).map(|verdict| json!(verdict))
        }
        Request::Remove(RobotRef { robot }) => supervisor.remove(&robot).map(|there| json!({ "removed": there })),
        Request::Away(AbsenceReport { robot, away }) => {
            supervisor.set_away(&robot, away).map(|keeps_place| json!({ "away": away, "keeps_place": keeps_place }))
        }
        Request::Close(asked) => {
            let area = asked.area(supervisor.layout()).map_err(RequestError::invalid)?;
            supervisor.close(area).map(|impact| json!(impact))
        }
        Request::Open(ClosureRef { closure }) => supervisor.open(&closure).map(|there| json!({ "opened": there })),
        Request::Pause {} => supervisor.pause().map(|impact| json!(impact)),
        Request::Resume {} => supervisor.resume().map(|paused| json!({ "resumed": paused })),
        Request::Position(report) => supervisor.position(&report, came).map(|()| json!({})),
        Request::Off(OffPathReport { robot, x, y, age }) => {
            supervisor.report_off_path(&robot, [x, y], age, came).map(|()| json!({}))
        }
        Request::Query(question) => query::answer(supervisor, &question, now),
        Request::Watch(Subscription { events }) => {
            watches = Some(events);
            Ok(json!({}))
        }
    });
    LineReply { unanswered, answer: answer(id, done), watches }
}

/// The answer to a line longer than [`LONGEST`].
pub fn too_long() -> Value {
    refusal(&RequestError::Malformed { why: format!("a line is {LONGEST} bytes long at most") })
}

/// An error line that answers no particular request.
pub fn refusal(fault: &RequestError) -> Value {
    answer(Value::Null, Err(fault.clone()))
}

/// Replaces an answer whose changes could not be stored in the journal.
pub(crate) fn withdrawn(answer: &Value, fault: &RequestError) -> Value {
    self::answer(answer.get("id").cloned().unwrap_or(Value::Null), Err(fault.clone()))
}

/// An event as a line.
pub fn news(event: &SupervisorEvent) -> Value {
    let mut news = json!(event);
    if let Some(object) = news.as_object_mut() {
        object.insert("pcr".into(), VERSION.into());
    }
    news
}

fn answer(id: Value, done: Result<Value, RequestError>) -> Value {
    match done {
        Ok(value) => json!({ "pcr": VERSION, "id": id, "ok": value }),
        Err(fault) => {
            let mut error = json!(fault);
            if let Some(object) = error.as_object_mut() {
                object.remove("why");
                object.insert("message".into(), fault.to_string().into());
            }
            json!({ "pcr": VERSION, "id": id, "error": error })
        }
    }
}

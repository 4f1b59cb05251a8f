//! The line protocol: a JSON object on each line, one answer to each request with its `id`, and events for clients that
//! subscribe. The schema is `docs/schema/pcr-serve.schema.json`.

use crate::course::Start;
use crate::entry::Layout;
use crate::event::Event;
use crate::fault::Fault;
use crate::query::{self, Question};
use crate::robot::Abilities;
use crate::supervisor::{Proposal, Report, Supervisor};
use pcr_formats::once::Once;
use serde::Deserialize;
use serde_json::{Value, json};

/// The version of the protocol: requests may name it, answers and events do.
pub const VERSION: u64 = 1;

/// Longer lines are refused \[bytes\].
pub const LONGEST: usize = 1 << 20;

/// A request. Repeating a request changes nothing.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "verb", rename_all = "snake_case")]
enum Verb {
    /// What the page draws.
    Layout(Layout),
    /// A new robot, which stands.
    Add(Added),
    /// A path that leaves the present one at a length.
    Replace(Proposal),
    /// A path that begins at the end of the present one.
    Mission(Proposal),
    /// A robot is removed.
    Remove(Named),
    /// The position of a robot.
    Position(Report),
    /// A robot is off its path.
    Off(Off),
    /// A question about the state.
    Query(Question),
    /// Whether the client wants events.
    Watch(Watch),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Added {
    robot: String,
    start: Start,
    abilities: Abilities,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Named {
    robot: String,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Off {
    robot: String,
    x: f64,
    y: f64,
    /// Age of the message \[s\].
    #[serde(default)]
    age: f64,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Watch {
    #[serde(default = "yes")]
    events: bool,
}

fn yes() -> bool {
    true
}

/// The result of a line.
#[derive(Clone, Debug)]
pub struct Reply {
    /// The answer. It may be sent after the next [`Supervisor::settle`].
    pub answer: Value,
    /// Whether the client wants events from now on; `None`: no change.
    pub watches: Option<bool>,
}

/// Carries out the request of a line. Ages count from the time `came` \[s\]; the line may have waited since.
pub fn handle(supervisor: &mut Supervisor, line: &[u8], came: f64, now: f64) -> Reply {
    let (id, verb) = read(line);
    let mut watches = None;
    let done = verb.and_then(|verb| match verb {
        Verb::Layout(layout) => supervisor.draw(layout).map(|()| json!({})),
        Verb::Add(Added { robot, start, abilities }) => {
            supervisor.add(&robot, abilities, start)?;
            let robot = supervisor.robot(&robot)?;
            Ok(json!({ "path": robot.path }))
        }
        Verb::Replace(proposal) if proposal.after.is_none() => Err(Fault::Malformed {
            why: "replace needs `after`: the length of the path from which on it is another one".into(),
        }),
        Verb::Replace(proposal) | Verb::Mission(proposal) => {
            supervisor.mission(&proposal, now).map(|verdict| json!(verdict))
        }
        Verb::Remove(Named { robot }) => supervisor.remove(&robot).map(|there| json!({ "removed": there })),
        Verb::Position(report) => supervisor.position(&report, came).map(|()| json!({})),
        Verb::Off(Off { robot, x, y, age }) => supervisor.off(&robot, [x, y], age, came).map(|()| json!({})),
        Verb::Query(question) => query::answer(supervisor, &question, now),
        Verb::Watch(Watch { events }) => {
            watches = Some(events);
            Ok(json!({}))
        }
    });
    Reply { answer: answer(id, done), watches }
}

/// The answer to a line longer than [`LONGEST`].
pub fn too_long() -> Value {
    refusal(&Fault::Malformed { why: format!("a line is {LONGEST} bytes long at most") })
}

/// An error line that answers no particular request.
pub fn refusal(fault: &Fault) -> Value {
    answer(Value::Null, Err(fault.clone()))
}

/// Replaces an answer whose changes could not be stored in the journal.
pub fn withdrawn(answer: &Value, fault: &Fault) -> Value {
    self::answer(answer.get("id").cloned().unwrap_or(Value::Null), Err(fault.clone()))
}

/// An event as a line.
pub fn news(event: &Event) -> Value {
    let mut news = json!(event);
    if let Some(object) = news.as_object_mut() {
        object.insert("pcr".into(), VERSION.into());
    }
    news
}

fn answer(id: Value, done: Result<Value, Fault>) -> Value {
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

/// The `id` of a line, if it can be read, and its request.
fn read(line: &[u8]) -> (Value, Result<Verb, Fault>) {
    let malformed = |why: String| Fault::Malformed { why };
    let mut object = match serde_json::from_slice(line) {
        Ok(Once(Value::Object(object))) => object,
        Ok(_) => return (Value::Null, Err(malformed("it is no JSON object".into()))),
        Err(error) => return (Value::Null, Err(malformed(format!("it is no JSON object: {error}")))),
    };
    let id = object.remove("id").unwrap_or(Value::Null);
    if !(id.is_null() || id.is_string() || id.is_number()) {
        return (Value::Null, Err(malformed("id: it has to be a text or a number".into())));
    }
    // It would come back as another one.
    if id.as_f64().is_some_and(|number| !(id.is_i64() || id.is_u64()) && number.abs() >= (1_u64 << 53) as f64) {
        return (Value::Null, Err(malformed("id: a number with so many digits has to be a text".into())));
    }
    match object.remove("pcr") {
        None => {}
        Some(version) if version == VERSION => {}
        Some(version) => return (id, Err(malformed(format!("pcr: the version is {VERSION}, not {version}")))),
    }
    (id, serde_json::from_value(Value::Object(object)).map_err(|error| malformed(error.to_string())))
}

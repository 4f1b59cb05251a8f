//! Messages of VDA 5050 as `mosquitto_sub` prints them: `topic payload` (`-v`), or a time before that (`-F '%U %t %p'`, `-F '%I %t %p'`).
//!
//! The pose of a message is of the time stamp in the message, which is of the clock of the vehicle. The time at which it was received
//! tells how far these clocks differ.

use super::super::json_access::JsonObject;
use super::super::{ImportError, WarningCode, Warnings, vda5050};
use super::pose_log::{PoseLogBuilder, PoseTime, RawPose};
use crate::json;
use crate::vda5050::topics::{TopicKind, VehicleId};
use crate::vda5050::version::ProtocolVersion;
use std::collections::HashMap;

/// Difference of clocks that goes without a warning \[s\].
const CLOCK: f64 = 0.1;

/// A line of a log.
struct LogLine<'t> {
    received: Option<PoseTime>,
    topic: &'t str,
    /// The message, and the number of characters before it.
    payload: (&'t str, usize),
}

/// What `mosquitto_sub` prints for a message of no bytes.
const NOTHING: &str = "(null)";

impl<'t> LogLine<'t> {
    /// Nothing for what is no line of a log.
    fn read(line: &'t str) -> Option<Self> {
        let begin = line.find(" {").map(|blank| blank + 1).or_else(|| {
            let begin = line.trim_end().len().checked_sub(NOTHING.len())?;
            (line.get(begin..)?.trim_end() == NOTHING).then_some(begin)
        })?;
        let (head, payload) = (line.get(..begin)?, line.get(begin..)?);
        let (time, topic) = match head.trim().rsplit_once(' ') {
            Some((time, topic)) => (Some(time.trim()), topic),
            None => (None, head.trim()),
        };
        let received = match time {
            Some(text) => Some(PoseTime::number(text).or_else(|| PoseTime::stamp(text))?),
            None => None,
        };
        topic.contains('/').then(|| Self { received, topic, payload: (payload, head.chars().count()) })
    }
}

/// Whether a text begins like a log.
pub(super) fn is_line(line: &str) -> bool {
    LogLine::read(line).is_some_and(|line| TopicKind::of_topic(line.topic).is_some())
}

/// Times of the last messages of a vehicle, and whether it was localized.
#[derive(Default)]
struct VehicleClock {
    /// Time stamps of its last state and its last visualization, and their lines.
    last: HashMap<&'static str, (PoseTime, usize)>,
    /// The least time between the time stamp of a message and its receipt \[s\].
    least_lag: Option<f64>,
    /// Whether its next pose follows the one before.
    is_lost: bool,
    /// Since when it has stood at the end of what was released, and its last state.
    held: Option<PoseTime>,
    last_state: Option<PoseTime>,
}

/// Reads the messages in a text.
pub(super) fn read(text: &str, log: &mut PoseLogBuilder<'_>, warnings: &mut Warnings) -> Result<(), ImportError> {
    log.is_unordered = true;
    let mut clocks: Vec<VehicleClock> = Vec::new();
    for (index, whole) in text.lines().enumerate() {
        let number = index + 1;
        if whole.trim().is_empty() {
            continue;
        }
        let Some(line) = LogLine::read(whole) else {
            let expected =
                "`topic payload` or `time topic payload` is expected, with a time stamp or seconds since 1970";
            return Err(ImportError::at(number, Some(1), expected));
        };
        let kind = match TopicKind::of_topic(line.topic) {
            Some(kind @ (TopicKind::State | TopicKind::Visualization)) => kind,
            Some(_) => continue,
            None => {
                warnings.add(WarningCode::UnreadField, "topics", "some are not of VDA 5050, and not read");
                continue;
            }
        };
        let (payload, before) = line.payload;
        if payload.trim_end() == NOTHING {
            continue;
        }
        // Messages are one line each: their places are those of the line.
        let placed = |error: ImportError| ImportError {
            line: Some(number),
            column: Some(error.column.map_or(1, |column| column + before)),
            ..error
        };
        let value = json::parse_strict(payload).map_err(|error| placed(ImportError::of_json(error)))?;
        let message = JsonObject::new(kind.text(), &value).map_err(placed)?;
        read_message(&line, kind, &message, number, &mut clocks, log, warnings).map_err(placed)?;
    }
    for (agent, clock) in clocks.iter().enumerate() {
        if let (Some(since), Some(last)) = (clock.held, clock.last_state) {
            log.add_held(agent, [since, last]);
        }
    }
    warn_of_clocks(&clocks, log, warnings);
    Ok(())
}

/// Whether a vehicle stands and has nodes ahead, none of which is released; nothing where a state does not tell.
fn is_held(state: &JsonObject<'_>) -> Result<Option<bool>, ImportError> {
    let Some(is_driving) = state.flag("driving")? else { return Ok(None) };
    let mut nodes = Vec::new();
    for node in state.list("nodeStates")? {
        nodes.push(JsonObject::new("node", node)?.flag("released")?);
    }
    Ok(Some(!is_driving && !nodes.is_empty() && nodes.iter().all(|released| *released == Some(false))))
}

fn read_message(
    line: &LogLine<'_>,
    kind: TopicKind,
    message: &JsonObject<'_>,
    number: usize,
    clocks: &mut Vec<VehicleClock>,
    log: &mut PoseLogBuilder<'_>,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let mut levels = line.topic.rsplit('/').skip(1);
    let (serial_number, manufacturer) = (levels.next().unwrap_or_default(), levels.next().unwrap_or_default());
    let vehicle = VehicleId::new(manufacturer, serial_number)
        .map_err(|why| ImportError::new(format!("topic {}: {why}", line.topic)))?;
    for (field, expected) in [("manufacturer", manufacturer), ("serialNumber", serial_number)] {
        if let Some(said) = message.text(field)?
            && said != expected
        {
            return Err(message.field_error(field, format_args!("{said}, and the topic says {expected}")));
        }
    }
    let version = message.text("version")?.unwrap_or_default();
    let agent = log.agent(&vehicle.to_string());
    let name = log.name(agent);
    if ProtocolVersion::parse(version).is_none() {
        warnings.add(WarningCode::UnknownVersion, &name, format!("version {version:?}; read as 2.1 or 3.0"));
    }
    let stamp = message.text("timestamp")?.ok_or_else(|| message.missing("timestamp"))?;
    let time = PoseTime::stamp(stamp)
        .ok_or_else(|| message.field_error("timestamp", format_args!("{stamp:?} is no time stamp of ISO 8601")))?;
    while clocks.len() <= agent {
        clocks.push(VehicleClock::default());
    }
    let Some(clock) = clocks.get_mut(agent) else { return Ok(()) };
    if let Some((last, before)) = clock.last.insert(kind.text(), (time, number))
        && time.since(&last) < 0.0
    {
        let problem = format!("goes back, from that of line {before}: the clock of {name} was set back");
        return Err(message.field_error("timestamp", problem));
    }
    if let Some(received) = line.received {
        let lag = received.since(&time);
        clock.least_lag = Some(clock.least_lag.map_or(lag, |least| least.min(lag)));
    }
    if kind == TopicKind::State {
        clock.last_state = Some(time);
        match (is_held(message)?, clock.held) {
            (Some(true), None) => clock.held = Some(time),
            (Some(false), Some(since)) => {
                clock.held = None;
                log.add_held(agent, [since, time]);
            }
            _ => {}
        }
    }
    let Some(position) = vda5050::position(message)? else { return Ok(()) };
    if message.get("agvPosition").is_some() && message.get("mobileRobotPosition").is_some() {
        return Err(message.error("both agvPosition and mobileRobotPosition"));
    }
    let flag = position.flag("positionInitialized")?.or(position.flag("localized")?);
    let deviation = position.number("deviationRange")?;
    let is_known = flag == Some(true)
        && position.number("localizationScore")?.is_none_or(|score| score > 0.0)
        && deviation.is_none_or(|deviation| deviation >= 0.0);
    if !is_known {
        clock.is_lost = true;
        warnings.add(WarningCode::NotLocalized, &name, "it is not localized for some time, in which nothing is known");
        return Ok(());
    }
    let map = position.text("mapId")?.ok_or_else(|| position.missing("mapId"))?;
    let point = position.point()?;
    let heading = position.number("theta")?;
    let is_joined = !std::mem::take(&mut clock.is_lost);
    let map = log.map(map);
    let error = deviation.unwrap_or(0.0);
    log.add(agent, RawPose { time, point, heading, error, map, is_joined, place: (number, None) })
}

/// Warns of vehicles whose clocks differ from those of the others.
fn warn_of_clocks(clocks: &[VehicleClock], log: &PoseLogBuilder<'_>, warnings: &mut Warnings) {
    let mut lags: Vec<f64> = clocks.iter().filter_map(|clock| clock.least_lag).collect();
    lags.sort_by(f64::total_cmp);
    let Some(middle) = lags.get(lags.len() / 2) else { return };
    for (agent, clock) in clocks.iter().enumerate() {
        let Some(ahead) = clock.least_lag.map(|lag| middle - lag).filter(|ahead| ahead.abs() > CLOCK) else { continue };
        let problem = format!(
            "its messages are received {:.3} s {} after their time stamps than those of others: its clock may be wrong, and so may be its times",
            ahead.abs(),
            if ahead > 0.0 { "sooner" } else { "later" }
        );
        warnings.add(WarningCode::ClockOffset, log.name(agent), problem);
    }
}

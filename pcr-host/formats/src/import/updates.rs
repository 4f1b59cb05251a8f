//! Messages of VDA 5050 about one vehicle: the updates of an order are joined with it.
//!
//! An update begins at a node of the order, by its `sequenceId`, and replaces all that follows there. A message that is
//! sent again counts once. Anything else about the same vehicle would make two of it, and is refused.

use super::ImportError;
use super::value::Object;
use serde_json::Value;

/// Who a message is about: manufacturer and serial number.
fn vehicle(message: &Value) -> Option<[&str; 2]> {
    let text = |field: &str| message.get(field).and_then(Value::as_str).unwrap_or_default();
    Some([text("manufacturer"), text("serialNumber")]).filter(|[_, serial]| !serial.is_empty())
}

/// The messages, of which no two are about one vehicle; in the order of the first ones.
pub(super) fn joined(messages: Vec<Value>) -> Result<Vec<Value>, ImportError> {
    let mut vehicles: Vec<Vec<Value>> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for message in messages {
        let place = vehicle(&message).map(|names| names.map(str::to_owned));
        let place = place.map(|names| *places.entry(names).or_insert(vehicles.len()));
        match place.and_then(|place| vehicles.get_mut(place)) {
            Some(known) => known.push(message),
            None => vehicles.push(vec![message]),
        }
    }
    vehicles.into_iter().map(of_one).collect()
}

/// The one message that several about one vehicle amount to.
fn of_one(mut messages: Vec<Value>) -> Result<Value, ImportError> {
    let update = |message: &Value| Object::new("order", message)?.number("orderUpdateId").map(|id| id.unwrap_or(0.0));
    let mut numbered =
        messages.drain(..).map(|message| Ok((update(&message)?, message))).collect::<Result<Vec<_>, _>>()?;
    numbered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut all = numbered.into_iter();
    let Some((mut number, mut whole)) = all.next() else { return Err(ImportError::new("no message")) };
    for (next, message) in all {
        let [_, serial] = vehicle(&message).unwrap_or_default();
        let order = |message: &Value| message.get("nodes").and(message.get("orderId")).cloned();
        if order(&whole).is_none() || order(&whole) != order(&message) {
            let problem = "several messages are about it; one order with its updates, or one state is expected";
            return Err(ImportError::new(format!("vehicle {serial}: {problem}")));
        }
        let name =
            format!("order {}, update {next}", message.get("orderId").and_then(Value::as_str).unwrap_or_default());
        if next > number {
            extend(&mut whole, &message, &name)?;
        } else if ["nodes", "edges"].iter().any(|list| last(&whole, list) != last(&message, list)) {
            return Err(ImportError::new(format!("{name}: it is there twice, and not the same")));
        }
        number = next;
    }
    Ok(whole)
}

/// The last element of a list, in which a message that is sent again cannot differ from what it was joined with.
fn last<'v>(message: &'v Value, list: &str) -> Option<&'v Value> {
    message.get(list)?.as_array()?.last()
}

/// Replaces what follows from the first node of an update on.
fn extend(order: &mut Value, update: &Value, name: &str) -> Result<(), ImportError> {
    let update = Object::new(name, update)?;
    let wrong = |problem: &str| ImportError::new(format!("{name}: {problem}"));
    let sequence = |part: &Value| part.get("sequenceId").and_then(Value::as_f64);
    let numbers = update.list("nodes")?.iter().map(sequence).collect::<Option<Vec<_>>>();
    let first = numbers.and_then(|numbers| numbers.into_iter().reduce(f64::min));
    let first = first.ok_or_else(|| wrong("it has no nodes with a sequenceId"))?;
    let begins = |part: &&Value| sequence(part) == Some(first);
    let node = |nodes: &[Value]| nodes.iter().find(begins).and_then(|node| node.get("nodeId").cloned());
    let known = order.get("nodes").and_then(Value::as_array).and_then(|nodes| node(nodes));
    if known.is_none() || known != node(update.list("nodes")?) {
        return Err(wrong("the order before it does not have its first node"));
    }
    for list in ["nodes", "edges"] {
        let more = update.list(list)?;
        let Some(parts) = order.get_mut(list).and_then(Value::as_array_mut) else { continue };
        parts.retain(|part| sequence(part).is_none_or(|number| number < first));
        parts.extend(more.iter().cloned());
    }
    Ok(())
}

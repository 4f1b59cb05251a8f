//! Messages of VDA 5050 about one vehicle: the updates of an order are joined with it.
//!
//! An update begins at a node of the order, by its `sequenceId`, and replaces all that follows there. A message that is
//! sent again counts once. Anything else about the same vehicle would make two of it, and is refused.

use super::ImportError;
use super::value::Object;
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// Who a message is about: manufacturer and serial number. Nobody is told apart from others by anything else than texts.
fn vehicle(message: &Value) -> Result<Option<[&str; 2]>, ImportError> {
    let message = Object::new("message", message)?;
    let text = |field: &str| message.text(field).map(Option::unwrap_or_default);
    Ok(Some([text("manufacturer")?, text("serialNumber")?]).filter(|[_, serial]| !serial.is_empty()))
}

/// The messages, of which no two are about one vehicle; in the order of the first ones.
pub(super) fn joined(messages: Vec<Value>) -> Result<Vec<Value>, ImportError> {
    let mut vehicles: Vec<Vec<Value>> = Vec::new();
    let mut places = HashMap::new();
    for message in messages {
        let place = vehicle(&message)?.map(|names| names.map(str::to_owned));
        let place = place.map(|names| *places.entry(names).or_insert(vehicles.len()));
        match place.and_then(|place| vehicles.get_mut(place)) {
            Some(known) => known.push(message),
            None => vehicles.push(vec![message]),
        }
    }
    // Whether these are two vehicles or one is not known.
    let made: HashSet<&String> =
        places.keys().filter(|[maker, _]| !maker.is_empty()).map(|[_, serial]| serial).collect();
    if let Some([_, serial]) = places.keys().find(|[maker, serial]| maker.is_empty() && made.contains(serial)) {
        return Err(ImportError::new(format!("vehicle {serial}: its manufacturer is not in all messages")));
    }
    vehicles.into_iter().map(of_one).collect()
}

/// The one message that several about one vehicle amount to.
fn of_one(messages: Vec<Value>) -> Result<Value, ImportError> {
    let order = |message: &Value| message.get("nodes").and(message.get("orderId")).cloned();
    let all: Vec<_> = messages.iter().map(order).collect();
    if all.len() > 1 && all.iter().any(|order| order.is_none() || *order != all[0]) {
        let serial = messages.first().map_or(Ok(None), vehicle)?.unwrap_or_default()[1];
        let problem = "several messages are about it; one order with its updates, or one state is expected";
        return Err(ImportError::new(format!("vehicle {serial}: {problem}")));
    }
    if all.len() > 1 { with_updates(messages) } else { messages.into_iter().next().ok_or_else(none) }
}

fn none() -> ImportError {
    ImportError::new("there is no message")
}

/// An order with its updates, in any order.
fn with_updates(messages: Vec<Value>) -> Result<Value, ImportError> {
    let number =
        |message: &Value| Object::new("order", message)?.number("orderUpdateId").map(Option::unwrap_or_default);
    let numbers = messages.iter().map(number).collect::<Result<Vec<_>, _>>()?;
    let mut numbered: Vec<(f64, Value)> = numbers.into_iter().zip(messages).collect();
    numbered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut whole = numbered.first().map(|(_, first)| first.clone()).ok_or_else(none)?;
    for pair in numbered.windows(2) {
        let [(before, last), (number, update)] = pair else { continue };
        let id = update.get("orderId").and_then(Value::as_str).unwrap_or_default();
        let name = format!("order {id}, update {number}");
        if number > before {
            extend(&mut whole, update, &name)?;
        } else if ["nodes", "edges"].iter().any(|list| last.get(list) != update.get(list)) {
            return Err(ImportError::new(format!("{name}: it is there twice, and not the same")));
        }
    }
    Ok(whole)
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

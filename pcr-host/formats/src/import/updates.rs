//! Messages of VDA 5050 about one vehicle: an order is joined with its updates, by the rules that vehicles apply
//! ([`OrderState`]).
//!
//! A message that is sent again counts once. An update that a vehicle would refuse is refused: the vehicle goes on with the order that
//! it has, so the file does not say what its sender meant. Anything else about the same vehicle would make two of it, and is refused.

use super::value::Object;
use super::{ImportError, Warnings};
use crate::vda5050::decode::{Refusal, from_value};
use crate::vda5050::order::Order;
use crate::vda5050::order_state::OrderState;
use crate::vda5050::version::Version;
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// Who a message is about: manufacturer and serial number. Nobody is told apart from others by anything else than texts.
fn vehicle(message: &Value) -> Result<Option<[&str; 2]>, ImportError> {
    let message = Object::new("message", message)?;
    let text = |field: &str| message.text(field).map(Option::unwrap_or_default);
    Ok(Some([text("manufacturer")?, text("serialNumber")?]).filter(|[_, serial]| !serial.is_empty()))
}

/// Joins the messages so that no two are about one vehicle; in the order of the first ones. With `--partial` updates that are refused are
/// left out.
pub(super) fn joined(messages: Vec<Value>, warnings: &mut Warnings) -> Result<Vec<Value>, ImportError> {
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
    vehicles.into_iter().map(|messages| of_one(messages, warnings)).collect()
}

/// Joins the messages about one vehicle to one.
fn of_one(messages: Vec<Value>, warnings: &mut Warnings) -> Result<Value, ImportError> {
    let serial = messages.first().map_or(Ok(None), vehicle)?.unwrap_or_default()[1].to_owned();
    if let Some(action) = messages.iter().find_map(halting_action) {
        let problem = format!("{action} is sent to it; where it stops then is not in the file: give its state instead");
        return Err(ImportError::new(format!("vehicle {serial}: {problem}")));
    }
    let order = |message: &Value| message.get("nodes").and(message.get("orderId")).cloned();
    let all: Vec<_> = messages.iter().map(order).collect();
    match all.first() {
        Some(None) if all.len() == 1 => messages.into_iter().next().ok_or_else(none),
        Some(Some(first)) if all.iter().all(|order| order.as_ref() == Some(first)) => with_updates(messages, warnings),
        _ => {
            let problem = "several messages are about it; one order with its updates, or one state is expected";
            Err(ImportError::new(format!("vehicle {serial}: {problem}")))
        }
    }
}

fn none() -> ImportError {
    ImportError::new("there is no message")
}

/// Returns the instant action of a message that ends or halts an order, if it has one.
fn halting_action(message: &Value) -> Option<String> {
    let lists = ["actions", "instantActions"].into_iter().filter_map(|name| message.get(name)?.as_array());
    let types =
        lists.flatten().filter_map(|action| ["actionType", "actionName"].iter().find_map(|name| action.get(*name)));
    types.filter_map(Value::as_str).find(|name| ["cancelOrder", "startPause"].contains(name)).map(str::to_owned)
}

/// Joins an order with its updates, which may be in any order.
fn with_updates(messages: Vec<Value>, warnings: &mut Warnings) -> Result<Value, ImportError> {
    let mut orders = messages.into_iter().map(decoded).collect::<Result<Vec<_>, _>>()?;
    orders.sort_by_key(|(_, order)| order.order_update_id);
    let mut orders = orders.into_iter();
    let (mut whole, first) = orders.next().ok_or_else(none)?;
    let refused =
        |id: &str, update: u64, refusal: &Refusal| ImportError::new(format!("{}, {refusal}", name(id, update)));
    let (id, update) = (first.order_id.clone(), first.order_update_id);
    let major = |order: &Order| Version::of(&order.header.version).map(Version::major);
    let version = major(&first);
    let mut state = OrderState::new(first).map_err(|rejected| refused(&id, update, &rejected.refusal))?;
    for (_, order) in orders {
        let update = order.order_update_id;
        let taken = if major(&order) == version {
            state.update(order).map_err(|rejected| rejected.refusal)
        } else {
            Err(Refusal::new("version", "not that of the order"))
        };
        if let Err(refusal) = taken {
            // A vehicle refuses it, too, and goes on with what it has.
            warnings.lose(refused(&id, update, &refusal));
        }
    }
    let written =
        |list: serde_json::Result<Value>| list.map_err(|error| ImportError::new(format!("order {id}: {error}")));
    let lists = [
        ("nodes", written(serde_json::to_value(&state.nodes))?),
        ("edges", written(serde_json::to_value(&state.edges))?),
    ];
    if let Value::Object(members) = &mut whole {
        members.extend(lists.map(|(name, list)| (name.to_owned(), list)));
    }
    Ok(whole)
}

/// Reads an order, and keeps its tree.
fn decoded(message: Value) -> Result<(Value, Order), ImportError> {
    let order = from_value::<Order>(message.clone()).map_err(|refusal| {
        let id = message.get("orderId").and_then(Value::as_str).unwrap_or_default();
        let update = message.get("orderUpdateId").and_then(Value::as_u64).unwrap_or_default();
        ImportError::new(format!("{}, {refusal}", name(id, update)))
    })?;
    let version = &order.header.version;
    // A message of a test or of a planner may have no header.
    if !version.is_empty() && Version::of(version).is_none() {
        let problem = format!("version: {version:?}; 2.0, 2.1 and 3.0 are read");
        return Err(ImportError::new(format!("{}, {problem}", name(&order.order_id, order.order_update_id))));
    }
    Ok((message, order))
}

/// Returns how messages name an order or an update.
fn name(id: &str, update: u64) -> String {
    if update == 0 { format!("order {id}") } else { format!("order {id}, update {update}") }
}

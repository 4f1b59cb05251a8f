//! Messages of VDA 5050 about one vehicle: an order is joined with its updates, by the rules that vehicles apply
//! ([`OrderState`]).
//!
//! A message that is sent again counts once. An update that a vehicle would refuse is refused: the vehicle goes on with the order that
//! it has, so the file does not say what its sender meant. Anything else about the same vehicle would make two of it, and is refused. A
//! record may begin with an update: then it is not known where its vehicle was before, and a warning says so.

use super::json_access::JsonObject;
use super::{ImportError, WarningCode, Warnings};
use crate::json::{JsonData, JsonNode, Position};
use crate::vda5050::decode::{DecodeError, from_value};
use crate::vda5050::order::Order;
use crate::vda5050::order_state::OrderState;
use crate::vda5050::version::ProtocolVersion;
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// Who a message is about: manufacturer and serial number. Nobody is told apart from others by anything else than texts.
fn vehicle<'j>(message: &'j JsonNode<'j>) -> Result<Option<[&'j str; 2]>, ImportError> {
    let message = JsonObject::new("message", message)?;
    let text = |field: &str| message.text(field).map(Option::unwrap_or_default);
    Ok(Some([text("manufacturer")?, text("serialNumber")?]).filter(|[_, serial]| !serial.is_empty()))
}

/// Joins the messages so that no two are about one vehicle; in the order of the first ones. With `--partial` updates that are refused are
/// left out.
pub(super) fn joined<'t>(
    messages: Vec<JsonNode<'t>>,
    warnings: &mut Warnings,
) -> Result<Vec<JsonNode<'t>>, ImportError> {
    let mut vehicles: Vec<Vec<JsonNode<'t>>> = Vec::new();
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
fn of_one<'t>(messages: Vec<JsonNode<'t>>, warnings: &mut Warnings) -> Result<JsonNode<'t>, ImportError> {
    let serial = messages.first().map_or(Ok(None), vehicle)?.unwrap_or_default()[1].to_owned();
    if let Some(problem) = messages.iter().find_map(other_way) {
        return Err(ImportError::new(format!("vehicle {serial}: {problem}")));
    }
    let order = |message: &JsonNode<'t>| message.get("nodes").and(message.get("orderId")).cloned();
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

/// Says why a vehicle does not travel its order as it is written, if a message that is no order changes that.
fn other_way(message: &JsonNode<'_>) -> Option<String> {
    if message.get("zoneSet").is_some() {
        return Some(
            "a zone set is sent to it, which is not read: in its zones it may be slower, wait or leave its way".into(),
        );
    }
    let lists = ["actions", "instantActions"].into_iter().filter_map(|name| message.get(name)?.as_array());
    let types =
        lists.flatten().filter_map(|action| ["actionType", "actionName"].iter().find_map(|name| action.get(name)));
    types.filter_map(JsonNode::as_str).find_map(|name| match name {
        "cancelOrder" | "startPause" => {
            Some(format!("{name} is sent to it; where it stops then is not in the file: give its state instead"))
        }
        "enableZoneSet" => {
            Some(format!("{name} is sent to it; zones are not read: in them it may be slower, wait or leave its way"))
        }
        _ => None,
    })
}

/// Joins an order with its updates, which may be in any order.
fn with_updates<'t>(messages: Vec<JsonNode<'t>>, warnings: &mut Warnings) -> Result<JsonNode<'t>, ImportError> {
    let is_single = messages.len() == 1;
    let mut orders = messages.into_iter().map(|message| decoded(message, is_single)).collect::<Result<Vec<_>, _>>()?;
    orders.sort_by_key(|(_, order)| order.order_update_id);
    let mut orders = orders.into_iter();
    let (mut whole, first) = orders.next().ok_or_else(none)?;
    // A vehicle that has no order takes those that begin at 0.
    let begins = first.nodes.iter().map(|node| node.sequence_id).min();
    if first.order_update_id > 0 || begins.is_some_and(|begins| begins > 0) {
        let problem = "the order before it is not there; it is read as if the vehicle began at its first node";
        warnings.add(WarningCode::UpdateAlone, name(&first.order_id, first.order_update_id), problem);
    }
    let refused =
        |id: &str, update: u64, refusal: &DecodeError| ImportError::new(format!("{}, {refusal}", name(id, update)));
    let (id, update) = (first.order_id.clone(), first.order_update_id);
    let major = |order: &Order| ProtocolVersion::parse(&order.header.version).map(ProtocolVersion::major);
    let version = major(&first);
    let mut state = OrderState::recorded(first).map_err(|rejected| refused(&id, update, &rejected.refusal))?;
    for (_, order) in orders {
        let update = order.order_update_id;
        let taken = if major(&order) == version {
            state.update(order).map_err(|rejected| rejected.refusal)
        } else {
            Err(DecodeError::new("version", "not that of the order"))
        };
        if let Err(refusal) = taken {
            // A vehicle refuses it, too, and goes on with what it has.
            warnings.lose(refused(&id, update, &refusal));
        }
    }
    if is_single {
        return Ok(whole);
    }
    let written =
        |list: serde_json::Result<Value>| list.map_err(|error| ImportError::new(format!("order {id}: {error}")));
    let lists = [
        ("nodes", written(serde_json::to_value(&state.nodes))?),
        ("edges", written(serde_json::to_value(&state.edges))?),
    ];
    let position = whole.position;
    if let JsonData::Object(members) = &mut whole.data {
        members.retain(|(name, _)| lists.iter().all(|(list, _)| name != list));
        members.extend(lists.map(|(name, list)| (name.into(), JsonNode::from_value(list, position))));
    }
    Ok(whole)
}

/// Reads an order, and keeps its tree. One that is the only message may leave out what tells it apart from others: its number, and its map.
fn decoded(message: JsonNode<'_>, is_single: bool) -> Result<(JsonNode<'_>, Order), ImportError> {
    let refused = |refusal: DecodeError| {
        let id = message.get("orderId").and_then(JsonNode::as_str).unwrap_or_default();
        let update = message.get("orderUpdateId").and_then(JsonNode::as_u64).unwrap_or_default();
        ImportError::in_json(position_of(&message, &refusal.field), format!("{}, {refusal}", name(id, update)))
    };
    let mut whole = message.to_value();
    if is_single {
        let set = |place: &mut Value, field: &str, value: Value| {
            if let Some(missing) = place.as_object_mut().filter(|members| members.get(field).is_none_or(Value::is_null))
            {
                missing.insert(field.to_owned(), value);
            }
        };
        set(&mut whole, "orderUpdateId", 0.into());
        let nodes = whole.get_mut("nodes").and_then(Value::as_array_mut).into_iter().flatten();
        nodes.filter_map(|node| node.get_mut("nodePosition")).for_each(|place| set(place, "mapId", "".into()));
    }
    let order = from_value::<Order>(whole).map_err(refused)?;
    // A message of a test or of a planner may have no header.
    if !order.header.version.is_empty() {
        order.header.edition().map_err(refused)?;
    }
    Ok((message, order))
}

/// Returns where a field such as `nodes[2].nodePosition.x` is in a message, or the innermost object or list on the way to it that is there.
fn position_of(message: &JsonNode<'_>, field: &str) -> Position {
    let mut node = message;
    for part in field.split(['.', '[', ']']).filter(|part| !part.is_empty()) {
        let element = || node.element(part.parse().ok()?);
        let Some(next) = node.get(part).or_else(element) else { break };
        node = next;
    }
    node.position
}

/// Returns how messages name an order or an update.
fn name(id: &str, update: u64) -> String {
    if update == 0 { format!("order {id}") } else { format!("order {id}, update {update}") }
}

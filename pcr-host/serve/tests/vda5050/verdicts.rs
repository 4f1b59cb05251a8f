//! Random orders and updates, valid and damaged ones: the importer, the supervisor and the simulated vehicle take the same ones, refuse the
//! same ones with the same words, and know the same way afterwards.

use crate::pair::{CAN, Pair, key};
use pcr_formats::import::{ImportOptions, InputFormat, Warnings, scenario};
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::state::{ErrorEntry, State};
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_formats::warning::WarningCode;
use pcr_serve::owned_path::StartPose;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// The order as its sender knows it.
struct Sender {
    random: SplitMix64,
    /// Positions of the nodes; node `k` has the sequence number `2 k`.
    places: Vec<[f64; 2]>,
    /// The last node of the base.
    base: usize,
}

impl Sender {
    fn new(seed: u64) -> Self {
        Self { random: SplitMix64(seed), places: vec![[0.0, 0.0]], base: 0 }
    }

    /// The next update, from the end of the base on: with nodes of which some are released, or none.
    fn next(&mut self, update: u64) -> Value {
        let from = self.base;
        self.places.truncate(from + 1);
        for _ in 0..self.random.below(4) {
            let [x, y] = *self.places.last().unwrap();
            let step = 1.0 + self.random.below(3) as f64;
            self.places.push(if self.random.below(2) == 0 { [x + step, y] } else { [x, y + step] });
        }
        self.base = from + self.random.below(self.places.len() - from);
        self.message(update, from, self.base)
    }

    /// The nodes from one on, released up to another one.
    fn message(&self, update: u64, from: usize, base: usize) -> Value {
        let node = |k: usize| {
            json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": k <= base, "actions": [],
                "nodePosition": { "x": self.places[k][0], "y": self.places[k][1], "mapId": "map" } })
        };
        let edge = |k: usize| {
            json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k - 1, "released": k <= base, "actions": [],
                "startNodeId": format!("n{}", k - 1), "endNodeId": format!("n{k}") })
        };
        json!({ "headerId": 1, "timestamp": "2030-01-01T00:00:00.000Z", "version": "2.1.0", "manufacturer": "sim",
            "serialNumber": "001", "orderId": "o", "orderUpdateId": update,
            "nodes": (from..self.places.len()).map(node).collect::<Vec<_>>(),
            "edges": (from + 1..self.places.len()).map(edge).collect::<Vec<_>>() })
    }
}

/// Names of what can be wrong with a message.
const DAMAGES: [&str; 14] = [
    "sequence",
    "renamed",
    "unreleased",
    "released again",
    "joined elsewhere",
    "edge",
    "text",
    "missing",
    "huge",
    "moved",
    "earlier",
    "horizon",
    "null",
    "version",
];

/// Damages a message in one way, where that is possible; `before` are the places of the nodes of the sender.
fn damage(message: &mut Value, kind: &str, random: &mut SplitMix64) {
    let count = message["nodes"].as_array().unwrap().len();
    let some = random.below(count);
    let fields = ["sequenceId", "released", "nodeId"];
    match kind {
        "sequence" => message["nodes"][some]["sequenceId"] = json!(random.below(9)),
        "renamed" => message["nodes"][0]["nodeId"] = json!("elsewhere"),
        "unreleased" => message["nodes"][0]["released"] = json!(false),
        "released again" => message["nodes"][count - 1]["released"] = json!(true),
        "joined elsewhere" if count > 1 => message["edges"][0]["endNodeId"] = json!("elsewhere"),
        "edge" if count > 1 => drop(message["edges"].as_array_mut().unwrap().pop()),
        "text" => message["nodes"][some]["nodePosition"]["x"] = json!("1"),
        "missing" => drop(message["nodes"][some].as_object_mut().unwrap().remove(fields[random.below(3)])),
        "huge" => message["nodes"][some]["nodePosition"]["y"] = json!(1e11),
        "moved" => message["nodes"][0]["nodePosition"]["x"] = json!(20.0),
        "null" => message["nodes"][some]["released"] = Value::Null,
        "version" => message["version"] = json!("9.1"),
        _ => {}
    }
}

/// Messages of one vehicle in the order of their numbers, and what is wrong with them.
fn stream(seed: u64) -> (Vec<Value>, Vec<&'static str>) {
    let (mut sender, mut random) = (Sender::new(seed), SplitMix64(seed ^ 0x5eed));
    let (mut messages, mut damages) = (Vec::new(), Vec::new());
    for update in 0..1 + random.below(5) as u64 {
        let good = sender.next(update);
        if random.below(4) > 0 {
            messages.push(good.clone());
            // Sent again, or with another content.
            if random.below(5) == 0 {
                messages.push(good.clone());
            }
            if random.below(8) == 0 {
                let mut other = good.clone();
                other["nodes"][0]["nodeId"] = json!("other");
                other["edges"] = json!([]);
                other["nodes"] = json!([other["nodes"][0]]);
                messages.push(other);
                damages.push("content");
            }
            continue;
        }
        let kind = DAMAGES[random.below(DAMAGES.len())];
        // Where an order begins is up to the place of the vehicle, which the importer does not know.
        if update == 0 && ["moved", "earlier", "horizon"].contains(&kind) {
            messages.push(good);
            continue;
        }
        let mut bad = match kind {
            "earlier" if sender.base > 0 => sender.message(update, random.below(sender.base), sender.base),
            "horizon" if sender.places.len() > sender.base + 1 => {
                sender.message(update, sender.base + 1, sender.places.len() - 1)
            }
            _ => good.clone(),
        };
        damage(&mut bad, kind, &mut random);
        damages.push(kind);
        messages.push(bad);
        // It may be sent in its place, as the first one is: what follows would be an order of its own otherwise.
        if update == 0 || random.below(2) == 0 {
            messages.push(good);
        }
    }
    (messages, damages)
}

/// What errors say, with the name of the update if they know it.
fn said(errors: &[ErrorEntry]) -> impl Iterator<Item = String> {
    errors.iter().filter_map(|error| {
        let description = error.rest.get("errorDescription").and_then(Value::as_str)?;
        let update = error.reference("orderUpdateId").unwrap_or_default();
        let id = error.reference("orderId");
        Some(id.map_or_else(|| description.to_owned(), |id| format!("{}, {description}", name(&id, &update))))
    })
}

fn name(id: &str, update: &str) -> String {
    if update == "0" { format!("order {id}") } else { format!("order {id}, update {update}") }
}

/// What the importer says is refused, and the length of the base \[m\]; or why it refuses the file.
fn imported(messages: &[Value]) -> Result<(BTreeSet<String>, f64), String> {
    let options = ImportOptions {
        radius: Some(0.4),
        speed: Some(1.0),
        acceleration: Some(0.5),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        partial: true,
        ..ImportOptions::default()
    };
    let mut warnings = Warnings::default();
    let text = messages.iter().map(Value::to_string).collect::<Vec<_>>().join("\n");
    let scenario = scenario(InputFormat::Vda5050, &text, &options, &mut warnings).map_err(|error| error.to_string())?;
    let left_out = warnings.iter().filter(|(code, ..)| *code == WarningCode::LeftOut);
    let names = left_out.flat_map(|(.., names)| names.iter().cloned()).collect();
    Ok((names, scenario.agents[0].length()))
}

/// What the supervisor tells the manager, and the length of the base that it holds \[m\].
fn supervised(messages: &[Value]) -> (BTreeSet<String>, Option<f64>) {
    let (mut pair, mut errors) = (Pair::new(), BTreeSet::new());
    for message in messages {
        let [manager, _] = crate::site::interfaces();
        let topic = manager.topic(ProtocolVersion::V2_1, &key(), TopicKind::Order);
        pair.bridge.receive(&mut pair.supervisor, &topic, message.to_string().as_bytes(), pair.time);
        pair.lasts(0.1);
        errors.extend(said(&pair.state.as_ref().unwrap().errors));
    }
    let job = pair.bridge.lanes().find_map(|lane| lane.job());
    let length = job.map(|job| job.path.node(job.order.base).unwrap() - job.path.node(0).unwrap());
    (errors, length)
}

/// What the simulated vehicle says.
fn driven(messages: &[Value]) -> BTreeSet<String> {
    let start = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
    let mut vehicle = SimulatedVehicle::new(key(), ProtocolVersion::V2_1, "map", CAN, start, 1);
    let mut errors = BTreeSet::new();
    for message in messages {
        vehicle.receive(TopicKind::Order, message.to_string().as_bytes());
        vehicle.tell_state();
        for (kind, payload) in vehicle.out() {
            if kind == TopicKind::State {
                errors.extend(said(&serde_json::from_slice::<State>(&payload).unwrap().errors));
            }
        }
    }
    errors
}

/// The importer took any node for the begin of an update, and a vehicle that stood on the base was not met.
#[test]
fn importer_supervisor_and_vehicle_refuse_the_same() {
    let mut counts: BTreeMap<(&str, bool), usize> = BTreeMap::new();
    for seed in 0..400 {
        let (messages, damages) = stream(seed);
        let text = || messages.iter().map(Value::to_string).collect::<Vec<_>>().join("\n");
        let (told, length) = supervised(&messages);
        assert_eq!(told, driven(&messages), "{seed}: {damages:?}\n{}", text());
        let is_refused = match imported(&messages) {
            Ok((refused, way)) => {
                assert_eq!(refused, told, "{seed}: {damages:?}\n{}", text());
                assert!((length.unwrap() - way).abs() < 1e-6, "{seed}: {length:?} {way}\n{}", text());
                !refused.is_empty()
            }
            Err(error) => {
                // One that cannot be read has no name in the answer to the manager.
                let is_told = told.iter().any(|told| error.ends_with(told.as_str()));
                assert!(is_told, "{seed}: {error}: {told:?}\n{}", text());
                true
            }
        };
        if let [damage] = damages[..] {
            *counts.entry((damage, is_refused)).or_default() += 1;
        }
        assert!(is_refused || !damages.is_empty() || told.is_empty(), "{seed}");
        assert!(!damages.is_empty() || !is_refused, "{seed}: a valid stream is refused: {told:?}\n{}", text());
    }
    for damage in DAMAGES.into_iter().chain(["content"]) {
        assert!(counts.contains_key(&(damage, true)), "never refused: {damage}: {counts:?}");
    }
}

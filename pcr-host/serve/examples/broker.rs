//! How long it takes over a broker from a state of a vehicle to what follows from it. Vehicles on crossing lanes, 25 one way and 25 the
//! other in a hall, as many halls as it takes, two on each lane, one behind the other: whenever the one in front has gone on and has said
//! so, the one behind it is released as much more. All say their states so many times a second, whether they were answered or not.
//!
//! `cargo run --release -p pcr-serve --example broker -- PCR VEHICLES RATE SECONDS [CORE]` starts mosquitto and `PCR serve`, which is the
//! tool, with a journal on the disc; on one core alone if that is named (`taskset`).

use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::topics::{TopicError, TopicInterface, TopicKind, VehicleId};
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::owned_path::StartPose;
use pcr_serve::vda5050::bridge::MqttMessage;
use pcr_serve::vda5050::mqtt::{BrokerAddress, LinkEvent, MqttLink};
use pcr_serve::vehicles::simulated_site::profile;
use pcr_serve::vehicles::vehicle::SimulatedVehicle;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use serde_json::{Value, json};
use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

const LANES: usize = 25;
const SPACE: f64 = 2.0;
/// From one node to the next, and between the two on a lane \[m\].
const EDGE: f64 = 2.0;
const BEHIND: f64 = 4.0;
const CAN: SimulatedTraits = SimulatedTraits {
    radius: 0.4,
    rectangle: None,
    speed: 1.0,
    acceleration: 0.5,
    rotation: 1.0,
    slip: 0.0,
    drift: 0.03,
    noise: 0.0,
    delay: 0.0,
};
/// What is measured counts from so long after everybody has got an order: until then, what came meanwhile is caught up with \[s\].
const SETTLED: f64 = 1.0;
/// So long it is tried to send a message.
const PATIENCE: Duration = Duration::from_secs(10);
/// Lanes get their orders one after the other over so long: else all vehicles would pass their nodes at the same time, again and again \[s\].
const SPREAD: f64 = 4.0;
/// Releases that follow from the one in front end as far behind it as all of those \[m\].
const SAME: f64 = 2e-3;

/// A program that ends with this one.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

struct Member {
    vehicle: SimulatedVehicle,
    /// Where its lane begins for it, and the direction of it.
    start: [f64; 2],
    along: [f64; 2],
    /// When its states were sent, by their numbers from 1.
    sent: Vec<Instant>,
    /// How far along the lane it was when it said its last one \[m\].
    said: f64,
    orders: u32,
    /// When the last of its orders came: until it has said that it has it, there is no other.
    came: Option<Instant>,
}

impl Member {
    fn length(&self, at: [f64; 2]) -> f64 {
        (at[0] - self.start[0]) * self.along[0] + (at[1] - self.start[1]) * self.along[1]
    }

    fn order(&self, length: f64) -> Value {
        let count = (length / EDGE) as usize;
        let node = |k: usize| {
            let [x, y] = [0, 1].map(|axis| self.start[axis] + self.along[axis] * EDGE * k as f64);
            json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": true, "actions": [],
                "nodePosition": { "x": x, "y": y, "mapId": "map" } })
        };
        let edge = |k: usize| {
            json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": true, "actions": [],
                "startNodeId": format!("n{k}"), "endNodeId": format!("n{}", k + 1) })
        };
        let mut order = json!({ "orderId": "through", "orderUpdateId": 0,
            "nodes": (0..=count).map(node).collect::<Vec<_>>(), "edges": (0..count).map(edge).collect::<Vec<_>>() });
        let header =
            MessageHeader::new(self.vehicle.key(), ProtocolVersion::V2_1, 1, "2030-01-01T00:00:00.000Z".into());
        if let (Value::Object(order), Ok(Value::Object(header))) = (&mut order, serde_json::to_value(header)) {
            order.extend(header);
        }
        order
    }
}

struct Load {
    link: MqttLink,
    news: Receiver<(Instant, LinkEvent)>,
    manager: TopicInterface,
    vehicles: TopicInterface,
    members: Vec<Member>,
    /// What is measured counts \[s\]: from a state to its copy for the manager; and to a release of the one behind, with how far behind
    /// the one in front that ends \[m\].
    counts: bool,
    copies: Vec<f64>,
    releases: Vec<(f64, f64)>,
    copied: usize,
}

impl Load {
    /// Takes what comes until a time.
    fn wait(&mut self, until: Instant) {
        while let Ok((at, news)) = self.news.recv_timeout(until.saturating_duration_since(Instant::now())) {
            if let LinkEvent::Message { topic, payload, .. } = news {
                self.take(at, &topic, &payload);
            }
        }
    }

    fn take(&mut self, at: Instant, topic: &str, payload: &[u8]) {
        let place = |key: &VehicleId| key.serial_number.parse::<usize>().ok().filter(|&k| k < self.members.len());
        if let Some((_, key, TopicKind::State)) = self.manager.parse(topic) {
            let Some(k) = place(&key) else { return };
            let text = String::from_utf8_lossy(payload.get(..60).unwrap_or(payload));
            let number = text.split("\"headerId\":").nth(1).and_then(|rest| rest.split(',').next()?.parse().ok());
            let Some(sent) = number.and_then(|number: usize| self.members[k].sent.get(number - 1)) else { return };
            self.copied += 1;
            if self.counts {
                self.copies.push((at - *sent).as_secs_f64());
            }
        } else if let Some((_, key, kind)) = self.vehicles.parse(topic) {
            let Some(k) = place(&key) else { return };
            self.members[k].vehicle.receive(kind, payload);
            if kind == TopicKind::Order {
                self.release(at, k, payload);
                self.members[k].orders += 1;
                self.members[k].came = Some(at);
            }
        }
    }

    /// Those behind are the second half.
    fn release(&mut self, at: Instant, k: usize, payload: &[u8]) {
        let Some(front) = k.checked_sub(self.members.len() / 2).and_then(|front| self.members.get(front)) else {
            return;
        };
        let Ok(order) = serde_json::from_slice::<Order>(payload) else { return };
        let end = order.nodes.iter().rev().find(|node| node.released).and_then(|node| node.node_position.as_ref());
        // What follows from its own state, as it has the order before only then, is none of these.
        let own = &self.members[k];
        let is_ready = |sent: &Instant| {
            own.sent.last().is_some_and(|said| said < sent && own.came.is_none_or(|came| came < *said))
        };
        let Some((end, sent)) = end.zip(front.sent.last()).filter(|(_, sent)| self.counts && is_ready(sent)) else {
            return;
        };
        self.releases.push((front.said - front.length([end.x, end.y]), (at - *sent).as_secs_f64()));
    }

    /// A vehicle goes on, and says where it is.
    fn turn(&mut self, k: usize, time: f64) {
        let member = &mut self.members[k];
        member.vehicle.advance(time);
        let mut out = member.vehicle.out();
        if !out.iter().any(|(kind, _)| *kind == TopicKind::State) {
            member.vehicle.tell_state();
            out.extend(member.vehicle.out());
        }
        for (kind, payload) in out {
            let topic = self.vehicles.topic(ProtocolVersion::V2_1, member.vehicle.key(), kind);
            if kind == TopicKind::State {
                member.said = member.length(member.vehicle.true_position());
                member.sent.push(Instant::now());
            }
            publish(&self.link, MqttMessage { topic, payload, at_least_once: false, retain: false });
        }
    }
}

/// Sends it, as soon as there is room for it.
fn publish(link: &MqttLink, message: MqttMessage) {
    let begin = Instant::now();
    while !link.publish(message.clone()) {
        assert!(begin.elapsed() < PATIENCE, "it cannot be sent");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn members(count: usize) -> Result<Vec<Member>, TopicError> {
    let width = SPACE * LANES as f64;
    let member = |k: usize| {
        let (lane, back) = (k % (count / 2), if k < count / 2 { 0.0 } else { BEHIND });
        let (hall, across, lane) = (lane / (2 * LANES), lane % 2 == 1, (lane / 2) % LANES);
        let (x, y) = (hall as f64 * (width + 20.0), SPACE * (lane as f64 + 0.5));
        let (start, along) =
            if across { ([x + y, -2.0 - back], [0.0, 1.0]) } else { ([x - 2.0 - back, y], [1.0, 0.0]) };
        let heading = if across { FRAC_PI_2 } else { 0.0 };
        let key = VehicleId::new("sim", &k.to_string())?;
        let stands = StartPose { x: start[0], y: start[1], heading };
        let vehicle = SimulatedVehicle::new(key, ProtocolVersion::V2_1, "map", CAN, stands, k as u64);
        Ok(Member { vehicle, start, along, sent: Vec::new(), said: 0.0, orders: 0, came: None })
    };
    (0..count).map(member).collect()
}

fn mosquitto(folder: &Path) -> Result<(Program, u16), Box<dyn Error>> {
    let port = std::net::TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let config = folder.join("mosquitto.conf");
    let text = "allow_anonymous true\nset_tcp_nodelay true\nmax_queued_messages 100000\nlog_dest none";
    std::fs::write(&config, format!("listener {port} 127.0.0.1\n{text}\n"))?;
    let program = if Path::new("/usr/sbin/mosquitto").exists() { "/usr/sbin/mosquitto" } else { "mosquitto" };
    let child = Command::new(program).arg("-c").arg(&config).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    let child = Program(child);
    while std::net::TcpStream::connect(("127.0.0.1", port)).is_err() {
        std::thread::sleep(Duration::from_millis(10));
    }
    Ok((child, port))
}

fn supervisor(tool: &str, core: Option<&String>, port: u16, folder: &Path) -> std::io::Result<Program> {
    let mut command = match core {
        Some(core) => {
            let mut command = Command::new("taskset");
            command.args(["-c", core, tool]);
            command
        }
        None => Command::new(tool),
    };
    command.arg("serve").arg("--journal").arg(folder.join("journal")).args(["--stay", "--log", "error"]);
    command.args(["--broker", &format!("127.0.0.1:{port}"), "--fleet"]).arg(folder.join("fleet.json"));
    command.stdin(Stdio::null()).stdout(Stdio::null()).spawn().map(Program)
}

/// Time of the cores that a program has used \[s\], where the system tells.
fn used(program: &Program) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", program.0.id())).unwrap_or_default();
    let words = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    // By hundredths of a second, as Linux counts.
    words.skip(11).take(2).filter_map(|word| word.parse::<f64>().ok()).sum::<f64>() / 100.0
}

fn told(what: &str, mut times: Vec<f64>) {
    times.sort_unstable_by(f64::total_cmp);
    let at = |part: f64| times.get((times.len() as f64 * part) as usize).or(times.last()).map_or(0.0, |it| it * 1e3);
    let [half, most, nearly, longest] = [0.5, 0.99, 0.999, 1.0].map(at);
    let count = times.len();
    println!("{what}, {count}: p50 {half:.2} ms, p99 {most:.2} ms, p99.9 {nearly:.2} ms, longest {longest:.1} ms");
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let ([tool, count, rate, seconds], core) =
        (words.first_chunk().ok_or("PCR VEHICLES RATE SECONDS [CORE]")?, words.get(4));
    let (count, rate, seconds): (usize, f64, f64) = (count.parse()?, rate.parse()?, seconds.parse()?);
    let folder = std::env::temp_dir().join(format!("pcr-broker-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let members = members(2 * (count / 2))?;
    let known = members.iter().map(|member| {
        let profile = profile(member.vehicle.key().clone(), &CAN);
        let mut known = serde_json::to_value(profile.abilities)?;
        (known["manufacturer"], known["serialNumber"]) = ("sim".into(), profile.key.serial_number.into());
        Ok(known)
    });
    let known = json!({ "vehicles": known.collect::<Result<Vec<_>, serde_json::Error>>()? });
    std::fs::write(folder.join("fleet.json"), known.to_string())?;
    let (broker, port) = mosquitto(&folder)?;
    let (manager, vehicles) = (TopicInterface::new("fleet")?, TopicInterface::new("uagv")?);
    let filters = [
        &[manager.filters(TopicKind::State)[0].clone()][..],
        &[TopicKind::Order, TopicKind::InstantActions].map(|kind| vehicles.filters(kind)[0].clone()),
    ];
    let (sender, news) = channel();
    let link = MqttLink::open(&BrokerAddress::new("127.0.0.1", port), "load", None, filters.concat(), move |it| {
        let _ = sender.send((Instant::now(), it));
    })?;
    while !link.is_up() {
        std::thread::sleep(Duration::from_millis(10));
    }
    let program = supervisor(tool, core, port, &folder)?;
    let mut own = Load {
        link,
        news,
        manager,
        vehicles,
        members,
        counts: false,
        copies: Vec::new(),
        releases: Vec::new(),
        copied: 0,
    };
    let (begin, step) = (Instant::now(), 1.0 / rate / own.members.len() as f64);
    let (mut ordered, mut ready, mut from, mut message) = (0, None, None, 0);
    // Until they have come to the end of their lanes, whatever was asked for.
    while from.is_none_or(|(from, _, _): (Instant, f64, usize)| from.elapsed().as_secs_f64() < seconds) {
        own.wait(begin + Duration::from_secs_f64(message as f64 * step));
        own.turn(message % own.members.len(), 1.0 / rate);
        message += 1;
        if ready.is_none() && own.copied > 2 * own.members.len() {
            ready = Some(Instant::now());
        }
        let lanes = own.members.len() / 2;
        let due = ready.map_or(0.0, |ready: Instant| ready.elapsed().as_secs_f64() / SPREAD * lanes as f64);
        while ordered < lanes.min(due as usize) {
            for member in [ordered, ordered + lanes].map(|k| &own.members[k]) {
                let topic = own.manager.topic(ProtocolVersion::V2_1, member.vehicle.key(), TopicKind::Order);
                let payload = member.order(SPACE * LANES as f64 + 8.0).to_string().into_bytes();
                publish(&own.link, MqttMessage { topic, payload, at_least_once: false, retain: false });
            }
            ordered += 1;
        }
        if from.is_none() && own.members.iter().all(|member| member.orders > 0) {
            from = Some((Instant::now(), used(&program), own.copied));
            println!("everybody has its order after {:.1} s", begin.elapsed().as_secs_f64());
        }
        own.counts = from.is_some_and(|(from, _, _)| from.elapsed().as_secs_f64() >= SETTLED);
    }
    let Some((from, before, copied)) = from else { return Ok(()) };
    let (time, core_time) = (from.elapsed().as_secs_f64(), used(&program) - before);
    let rate = (own.copied - copied) as f64 / time;
    let way = own.members.iter().map(|member| member.said).sum::<f64>() / own.members.len() as f64;
    println!(
        "{count} vehicles, {rate:.0} states a second, {time:.0} s, {way:.1} m each; the supervisor used {:.0} % of a core",
        100.0 * core_time / time
    );
    told("a state to its copy for the manager", own.copies);
    let mut behind: Vec<f64> = own.releases.iter().map(|(behind, _)| *behind).collect();
    behind.sort_unstable_by(f64::total_cmp);
    let usual = behind.get(behind.len() / 2).copied().unwrap_or_default();
    let all = own.releases.len();
    let follow: Vec<f64> =
        own.releases.iter().filter(|(behind, _)| (behind - usual).abs() < SAME).map(|(_, time)| *time).collect();
    println!(
        "{} of {all} releases of those behind end {usual:.3} m behind the last state of the one in front",
        follow.len()
    );
    told("a state to the release that follows from it", follow);
    drop((program, broker));
    std::fs::remove_dir_all(folder)?;
    Ok(())
}

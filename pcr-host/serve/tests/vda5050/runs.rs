//! Fleets at work.

use crate::broker::Mosquitto;
use crate::schemas;
use crate::site::{Desk, Scene, Site, at_broker, interfaces};
use crate::yard::MIXED;
use pcr_formats::vda5050::decode::MessageLimits;
use pcr_formats::vda5050::version::ProtocolVersion;
use pcr_serve::http::{self, HttpContent, Readiness};
use pcr_serve::journal_entry::NullStore;
use pcr_serve::journal_writer::WriteProgress;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::server::{ServerInput, queue, serve};
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::{BridgeConfig, Vda5050Bridge};
use pcr_serve::vda5050::broker_session::BrokerSession;
use pcr_serve::vda5050::mqtt::{BrokerAddress, LinkEvent, MqttLink};
use pcr_serve::vehicles::lossy_channel::ChannelFaults;
use pcr_serve::vehicles::vehicle_motion::SimulatedTraits;
use std::sync::mpsc::{channel, sync_channel};
use std::sync::{Arc, Mutex};

pub(crate) const FAIR: Scene<'_> = Scene {
    count: 2,
    versions: &[ProtocolVersion::V2_1],
    abilities: &[SimulatedTraits {
        radius: 0.4,
        rectangle: None,
        speed: 1.0,
        acceleration: 0.5,
        rotation: 1.0,
        slip: 0.05,
        drift: 0.02,
        noise: 0.02,
        delay: 0.0,
    }],
    climate: ChannelFaults { loss_rate: 0.0, duplicate_rate: 0.0, reorder_rate: 0.0, delay: 0.0 },
    drops: 0.0,
    pace: 10.0,
};

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn two_vehicles_do_their_missions() {
    let broker = Mosquitto::start("two");
    let (mut site, profiles) = Site::open(&broker, FAIR);
    let desk = Desk::open(&broker, profiles, "two", Box::new(NullStore));
    let told = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| site.until(1)));
    assert!(told.is_ok(), "{}", desk.tell());
    let found = site.close();
    assert!(found.travelled > 5.0, "{found:?}");
    desk.close().unwrap();
}

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn a_fleet_of_all_editions_keeps_apart() {
    let broker = Mosquitto::start("fleet");
    // By seconds of ours: ten of the vehicles go by in one..
    let scene = Scene { climate: ChannelFaults { delay: 1.0, ..MIXED.climate }, drops: 0.02, ..MIXED };
    // Who listens to everything that is said.
    let (sender, said) = channel();
    let everything = ["uagv/#".to_owned(), "fleet/#".to_owned()].to_vec();
    let ear = MqttLink::open(&broker.address(), "ear", None, everything, move |news| drop(sender.send(news))).unwrap();
    let (mut site, profiles) = Site::open(&broker, scene);
    let desk = Desk::open(&broker, profiles, "fleet", Box::new(NullStore));
    let told = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| site.until(10)));
    assert!(told.is_ok(), "{}", desk.tell());
    let found = site.close();
    assert!(found.travelled > 100.0, "{found:?}");
    desk.close().unwrap();
    ear.close();
    let messages = said.try_iter().filter_map(|news| match news {
        LinkEvent::Message { topic, payload, .. } => Some((topic, payload)),
        _ => None,
    });
    let seen = schemas::check(&messages.collect::<Vec<_>>(), &interfaces());
    // Every kind of every edition was said.
    for version in ProtocolVersion::ALL {
        for kind in ["order", "state", "visualization", "connection", "factsheet", "instantActions"] {
            assert!(seen.contains_key(&format!("{version} {kind}")), "{seen:?}");
        }
    }
}

/// What `/readyz` answers, while the broker is there, is lost, and is back.
#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn it_is_not_ready_while_the_broker_is_lost_and_says_why() {
    let mut broker = Mosquitto::start("ready");
    let [manager, vehicles] = interfaces();
    let config = BridgeConfig { manager, vehicles: vehicles.clone(), limits: MessageLimits::default() };
    let mut supervisor = Supervisor::new(at_broker(), Box::new(NullStore));
    // Nobody is waited for.
    let bridge = Vda5050Bridge::new(config, Vec::new(), &supervisor).unwrap();
    let mut station = BrokerSession::open(&broker.address(), &vehicles, &bridge, "ready").unwrap();
    let bridge = Arc::new(Mutex::new(bridge));
    let (handle, inputs) = queue();
    let server = std::thread::spawn(move || {
        serve(&mut supervisor, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
    });
    let (sender, events) = sync_channel(1 << 16);
    assert!(handle.send(ServerInput::Tell(sender)));
    let readiness = Readiness::default();
    let unready = Some(readiness.clone());
    let hosts = vec!["here".to_owned()];
    let content = HttpContent { page: String::new(), draw: None, hosts, addresses: false, unready };
    // As the tool does, until the page says this; by turns, not by time.
    let mut until = |status: &str, why: &str| {
        let mut last = String::new();
        for _ in 0..2_000 {
            station.turn(&handle, &bridge, &events).unwrap();
            let own = bridge.lock().unwrap();
            readiness.tell(station.unready(&own), station.status(&own));
            drop(own);
            let ask = |path: &str| {
                http::answer(&handle, &content, format!("GET {path} HTTP/1.1\r\nHost: here\r\n\r\n").as_bytes())
            };
            let (found, _, text) = ask("/readyz");
            if found.starts_with(status) && text.contains(why) {
                let is_connected = ask("/metrics").2.contains("\npcr_broker_connected 1\n");
                assert!(ask("/healthz").0.starts_with("200"));
                return is_connected;
            }
            last = format!("{found} {text}");
        }
        panic!("{status} {why}: {last}");
    };
    assert!(until("200", "it grants authority"));
    broker.stop();
    assert!(!until("503", "no broker: "));
    broker.begin();
    // At first it asks whether it is the only one.
    assert!(until("200", "it grants authority"));
    handle.send(ServerInput::Stop);
    server.join().unwrap().unwrap();
}

/// What a broker says first to who comes.
pub(crate) fn first(broker: &BrokerAddress) -> LinkEvent {
    let (sender, news) = channel();
    let link = MqttLink::open(broker, "who", None, vec!["a/b".into()], move |it| drop(sender.send(it))).unwrap();
    let first = news.recv().unwrap();
    link.close();
    first
}

/// Whoever had no right to the broker tried again for ever, and said nothing.
#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn a_broker_with_passwords_lets_in_who_has_one() {
    let mosquitto = Mosquitto::guarded("guarded", "pcr", "secret");
    let broker = mosquitto.address();
    let with = |password: &str| BrokerAddress { login: Some(("pcr".into(), password.into())), ..broker.clone() };
    for refused in [first(&BrokerAddress { login: None, ..broker.clone() }), first(&with("guess"))] {
        assert!(matches!(&refused, LinkEvent::Down(why) if why.contains("NotAuthorized")), "{refused:?}");
    }
    assert_eq!(first(&with("secret")), LinkEvent::Up);
}

//! The files in `deploy`, as an operator uses them: what each user can do at the broker, and the unit of systemd.

use crate::broker::{Mosquitto, folder};
use crate::runs::{FAIR, first};
use crate::site::{Desk, Scene, Site, at_broker};
use pcr_formats::vda5050::topics::TopicKind;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::supervisor::Supervisor;
use pcr_serve::vda5050::bridge::MqttMessage;
use pcr_serve::vda5050::mqtt::{BrokerAddress, LinkEvent, MqttLink};
use std::collections::BTreeSet;
use std::process::Command;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// A file of `deploy`.
pub(crate) fn file(name: &str) -> String {
    std::fs::read_to_string(format!("{}/deploy/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Users, with passwords that are theirs.
const USERS: [[&str; 2]; 5] =
    [["pcr", "p1"], ["manager", "p2"], ["sim/001", "p3"], ["sim/002", "p4"], ["witness", "p5"]];

/// Who sees and says everything: the test itself.
const WITNESS: &str = "\nuser witness\ntopic readwrite #\n";

const NAMES: [&str; 3] = ["sim/001", "sim/002", "pcr/supervisor"];

fn broker_as(mosquitto: &Mosquitto, user: &str) -> BrokerAddress {
    let [_, password] = USERS.into_iter().find(|[name, _]| *name == user).unwrap();
    BrokerAddress { login: Some((user.into(), password.into())), ..mosquitto.address() }
}

/// All topics of vehicles and of the manager.
fn topics() -> Vec<String> {
    let mut topics = Vec::new();
    for prefix in ["uagv", "fleet"] {
        for major in ["v2", "v3"] {
            for name in NAMES {
                topics.extend(TopicKind::ALL.map(|kind| format!("{prefix}/{major}/{name}/{}", kind.text())));
            }
        }
    }
    topics
}

/// Whether a user has to write on a topic, or to read it, for its work.
fn needs(user: &str, topic: &str, writes: bool) -> bool {
    let kind = TopicKind::of_topic(topic).unwrap();
    let is_of_vehicle = TopicKind::OF_VEHICLES.contains(&kind);
    let is_vehicles = topic.starts_with("uagv/");
    match user {
        "pcr" if topic == "uagv/v2/pcr/supervisor/connection" => true,
        // It is the manager of the vehicles, and the vehicles of the manager.
        "pcr" => is_vehicles == (is_of_vehicle != writes),
        "manager" => !is_vehicles && is_of_vehicle != writes,
        vehicle => is_vehicles && topic.contains(&format!("/{vehicle}/")) && is_of_vehicle == writes,
    }
}

/// A user who listens to everything, as far as it may.
fn connected(mosquitto: &Mosquitto, user: &str) -> (MqttLink, Receiver<LinkEvent>) {
    let (sender, news) = channel();
    let id = format!("test-{}", user.replace('/', "-"));
    let link = MqttLink::open(&broker_as(mosquitto, user), &id, None, vec!["#".into()], move |it| {
        drop(sender.send(it));
    });
    assert_eq!(news.recv_timeout(Duration::from_secs(20)).unwrap(), LinkEvent::Up, "{user}");
    (link.unwrap(), news)
}

fn say(link: &MqttLink, topic: &str, payload: &str) {
    let message = MqttMessage { topic: topic.into(), payload: payload.into(), at_least_once: true, retain: false };
    assert!(link.publish(message), "{topic}");
}

/// Topics that come with this text, until the text that is the last one.
fn heard(news: &Receiver<LinkEvent>, text: &str, last: &str) -> BTreeSet<String> {
    let mut topics = BTreeSet::new();
    loop {
        match news.recv_timeout(Duration::from_secs(20)).expect("the last message does not come") {
            LinkEvent::Message { payload, .. } if payload == last.as_bytes() => return topics,
            LinkEvent::Message { topic, payload, .. } if payload == text.as_bytes() => drop(topics.insert(topic)),
            LinkEvent::Message { .. } | LinkEvent::Up => {}
            LinkEvent::Down(why) => panic!("{why}"),
        }
    }
}

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn each_user_can_do_what_it_needs_and_nothing_else() {
    let mosquitto = Mosquitto::deployed("rights", &USERS, WITNESS);
    let (witness, seen) = connected(&mosquitto, "witness");
    for user in ["pcr", "manager", "sim/001", "sim/002"] {
        let (link, news) = connected(&mosquitto, user);
        let needed = |writes: bool| -> BTreeSet<String> {
            topics().into_iter().filter(|topic| needs(user, topic, writes)).collect()
        };
        let (writes, reads) = (needed(true), needed(false));
        topics().iter().for_each(|topic| say(&link, topic, user));
        say(&link, writes.first().unwrap(), "last");
        assert_eq!(heard(&seen, user, "last"), writes, "{user} writes");
        topics().iter().for_each(|topic| say(&witness, topic, "all"));
        say(&witness, reads.first().unwrap(), "end");
        assert_eq!(heard(&news, "all", "end"), reads, "{user} reads");
        link.close();
    }
    // The point of it: nobody but the supervisor gives orders to vehicles, and no vehicle speaks for another one.
    for (user, topic) in [
        ("manager", "uagv/v2/sim/001/order"),
        ("sim/001", "uagv/v2/sim/001/order"),
        ("sim/001", "uagv/v2/sim/002/state"),
        ("sim/001", "uagv/v2/pcr/supervisor/connection"),
    ] {
        assert!(topics().iter().any(|it| it == topic) && !needs(user, topic, true), "{user} {topic}");
    }
    witness.close();
    let nobody = BrokerAddress { login: None, ..mosquitto.address() };
    let guess = BrokerAddress { login: Some(("pcr".into(), "p2".into())), ..mosquitto.address() };
    for refused in [first(&nobody), first(&guess)] {
        assert!(matches!(&refused, LinkEvent::Down(why) if why.contains("NotAuthorized")), "{refused:?}");
    }
}

#[test]
#[ignore = "needs a broker: .ci/test.sh serve"]
fn a_mission_is_done_with_these_rights() {
    let mosquitto = Mosquitto::deployed("rights-mission", &USERS[..3], "");
    let [supervisor, manager, vehicle] = ["pcr", "manager", "sim/001"].map(|user| broker_as(&mosquitto, user));
    let (mut site, profiles) = Site::at([&vehicle, &manager], Scene { count: 1, ..FAIR });
    let desk = Desk::at(&supervisor, profiles, "rights", Supervisor::new(at_broker(), Box::new(NullStore)));
    let told = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| site.until(2)));
    assert!(told.is_ok(), "{}", desk.tell());
    drop(site);
    desk.close().unwrap();
}

#[test]
#[ignore = "needs systemd-analyze: .ci/test.sh serve"]
fn the_unit_is_one_for_systemd() {
    let folder = folder("unit");
    let verified = |unit: &str| {
        // The program is not installed where the tests run.
        let unit = unit.replace("ExecStart=/usr/local/bin/pcr ", "ExecStart=/bin/true ");
        let at = folder.join("pcr-serve.service");
        std::fs::write(&at, unit).unwrap();
        let analyze = |words: &[&str]| {
            let out = Command::new("systemd-analyze").args(words).arg(&at).output();
            let out = out.expect("systemd-analyze is needed: .ci/install.sh systemd");
            (out.status.success(), String::from_utf8_lossy(&out.stderr).into_owned())
        };
        let (is_right, said) = analyze(&["verify", "--man=no", "--recursive-errors=no"]);
        let (is_guarded, _) = analyze(&["security", "--offline=true", "--no-pager", "--threshold=20"]);
        (is_right && said.is_empty(), is_guarded, said)
    };
    let unit = file("pcr-serve.service");
    assert_eq!(verified(&unit), (true, true, String::new()));
    // What would be wrong is seen.
    assert!(!verified(&unit.replace("ProtectHome=yes", "ProtectHouse=yes")).0);
    let open: Vec<&str> = unit.lines().filter(|line| !line.starts_with("Protect") && !line.contains("Users")).collect();
    assert!(!verified(&open.join("\n")).1);
}
